//! The decision between candidates, by measured numbers alone. Input: costs and errors of trials, and the time that is
//! left. Output: the candidate with the least predicted error among those that fit into the time.

use crate::sampling::Candidate;

/// Bounds of the exponent with which the error of samples falls with their number.
const EXPONENTS: [f64; 2] = [1.0, 2.0];
/// Most samples a pixel: f32 sums of this many are still accurate enough.
const MAX_SAMPLES: f64 = 65_536.0;
/// Samples a pixel with which sampling pixel by pixel begins, and the least number on average that pays for placing them.
const ADAPTIVE_FROM: f64 = 20.0;
/// Time of a sample that is placed pixel by pixel over that of one of many equal ones.
const PLACED_COST: f64 = 1.6;
/// Fraction of the remaining time for which samples are planned.
pub const OF_TIME: f64 = 0.93;
/// Passes of sampling pixel by pixel.
const PASSES: f64 = 3.0;
/// Fraction of the time that its audit takes.
const AUDITS: f64 = 0.1;

/// A model of the same number of samples in each pixel.
#[derive(Clone, Copy, Debug)]
pub struct Even {
    /// Seconds of the picture, whatever the number of samples, and of each sample a pixel.
    pub once: f64,
    pub each: f64,
    /// Mean squared error of `samples` samples, and the exponent with which it falls.
    pub samples: f64,
    pub mse: f64,
    pub exponent: f64,
}

/// Seconds of a picture by two numbers of samples a pixel, the larger one first.
#[derive(Clone, Copy, Debug)]
pub struct Costs {
    pub samples: [u32; 2],
    pub seconds: [f64; 2],
}

impl Costs {
    /// Returns the seconds of each further sample a pixel. Clocks err: it is between the mean of all and a quarter of it.
    pub fn each(&self) -> f64 {
        let [many, few] = self.samples.map(f64::from);
        let mean = self.seconds[0].max(0.0) / many;
        ((self.seconds[0] - self.seconds[1]) / (many - few)).clamp(0.25 * mean, mean)
    }
}

/// A candidate of which the whole picture is rendered at once, or not at all.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    pub candidate: Candidate,
    pub mse: f64,
    pub seconds: f64,
}

/// All that is known before the decision.
#[derive(Clone, Debug)]
pub struct Prospect {
    /// Seconds.
    pub left: f64,
    pub even: Even,
    /// By how much less the mean squared error is if as many samples are placed where they are needed most.
    pub gain: f64,
    /// Seconds of the host in each pass of placing samples.
    pub hosting: f64,
    pub shots: Vec<Shot>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decision {
    /// The same number of samples in each pixel.
    Samples(u32),
    /// Samples pixel by pixel.
    Adaptive,
    Shot(Candidate),
}

impl Even {
    /// Fits the model to costs, which lack `first` seconds of the picture, and to the mean squared errors of two numbers of
    /// samples, the larger one first.
    pub fn new(costs: Costs, first: f64, samples: [u32; 2], mse: [f64; 2]) -> Even {
        let [many, few] = samples.map(f64::from);
        let exponent = (mse[1] / mse[0]).ln() / (many / few).ln();
        let exponent = if exponent.is_finite() { exponent } else { EXPONENTS[0] };
        let each = costs.each();
        let once = (costs.seconds[0] - each * f64::from(costs.samples[0])).max(0.0) + first;
        Even { once, each, samples: many, mse: mse[0], exponent: exponent.clamp(EXPONENTS[0], EXPONENTS[1]) }
    }

    /// Returns the number of samples that fit into a time.
    fn fits(&self, seconds: f64) -> f64 {
        ((seconds - self.once) / self.each.max(1e-12)).clamp(0.0, MAX_SAMPLES)
    }

    fn mse_of(&self, samples: f64) -> f64 {
        self.mse * (self.samples / samples).powf(self.exponent)
    }
}

impl Prospect {
    /// Returns the seconds of a sample that is placed pixel by pixel, in as many pixels as the picture has.
    pub fn placed_cost(&self) -> f64 {
        (PLACED_COST * self.even.each).max(1e-12)
    }

    /// Returns the mean squared error that sampling pixel by pixel would reach; infinite if there is no time for it.
    fn adaptive_mse(&self) -> f64 {
        let time = self.left * (1.0 - AUDITS) - PASSES * self.hosting - self.even.once;
        let samples = time / self.placed_cost();
        if samples < ADAPTIVE_FROM { f64::INFINITY } else { self.even.mse_of(samples) / self.gain }
    }
}

/// Returns the best decision and its predicted mean squared error. If nothing fits into the time, it is what takes the
/// least.
pub fn decide(prospect: &Prospect) -> (Decision, f64) {
    let Prospect { even, left, .. } = prospect;
    let samples = even.fits(OF_TIME * left).floor().max(1.0);
    let mut best = (Decision::Samples(samples as u32), even.mse_of(samples));
    let mut seconds = even.once + even.each * samples;
    let adaptive = prospect.adaptive_mse();
    if adaptive < best.1 {
        best = (Decision::Adaptive, adaptive);
    }
    for shot in &prospect.shots {
        let is_better = if shot.seconds <= *left && seconds <= *left {
            shot.mse < best.1
        } else {
            shot.seconds < seconds
        };
        if is_better {
            best = (Decision::Shot(shot.candidate), shot.mse.max(0.0));
            seconds = shot.seconds;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture in 5 ms and 2 ms a sample, of RMSE 0.02 with 8 samples.
    fn even() -> Even {
        Even { once: 5e-3, each: 2e-3, samples: 8.0, mse: 4e-4, exponent: 1.5 }
    }

    fn prospect(left: f64, shots: &[(Candidate, f64, f64)]) -> Prospect {
        let shot = |&(candidate, rmse, seconds): &(Candidate, f64, f64)| Shot {
            candidate,
            mse: rmse * rmse,
            seconds,
        };
        let shots = shots.iter().map(shot).collect();
        Prospect { left, even: even(), gain: 8.0, hosting: 6e-3, shots }
    }

    const FILTER: (Candidate, f64, f64) = (Candidate::Prefiltered, 8e-3, 10e-3);
    const CONE: (Candidate, f64, f64) = (Candidate::Cone, 5e-3, 40e-3);

    #[test]
    fn a_prefilter_wins_where_samples_have_time_for_few() {
        let decided = decide(&prospect(0.02, &[FILTER, CONE])).0;
        assert_eq!(decided, Decision::Shot(Candidate::Prefiltered), "the cone takes twice the time");
        let decided = decide(&prospect(0.045, &[FILTER, CONE])).0;
        assert_eq!(decided, Decision::Shot(Candidate::Cone), "now it has the time");
    }

    #[test]
    fn a_prefilter_is_refused_where_its_bias_is_larger_than_the_noise() {
        let biased = (Candidate::Prefiltered, 8e-2, 10e-3);
        assert_eq!(decide(&prospect(0.02, &[biased])).0, Decision::Samples(6));
    }

    #[test]
    fn samples_are_placed_pixel_by_pixel_where_there_is_time_for_passes() {
        assert_eq!(decide(&prospect(0.05, &[])).0, Decision::Samples(20));
        assert_eq!(decide(&prospect(0.5, &[FILTER, CONE])).0, Decision::Adaptive);
        let slow = Prospect { hosting: 0.16, ..prospect(0.5, &[]) };
        assert_eq!(decide(&slow).0, Decision::Samples(230), "the host takes longer than the samples");
    }

    #[test]
    fn what_takes_the_least_is_chosen_where_nothing_fits() {
        assert_eq!(decide(&prospect(1e-3, &[FILTER, CONE])).0, Decision::Samples(1));
        let quick = (Candidate::Prefiltered, 8e-3, 4e-3);
        assert_eq!(decide(&prospect(1e-3, &[quick])).0, Decision::Shot(Candidate::Prefiltered));
    }

    #[test]
    fn costs_and_exponents_follow_the_trials_within_bounds() {
        let costs = |seconds| Costs { samples: [8, 2], seconds };
        let fitted = Even::new(costs([21e-3, 9e-3]), 1e-3, [8, 2], [4e-4, 3.2e-3]);
        assert!((fitted.each - 2e-3).abs() < 1e-9 && (fitted.once - 6e-3).abs() < 1e-9, "{fitted:?}");
        assert!((fitted.exponent - 1.5).abs() < 1e-9, "{fitted:?}");
        let odd = Even::new(costs([8e-3, 16e-3]), 6e-3, [8, 2], [0.0, 0.0]);
        assert!(odd.each > 0.0 && (odd.once - 12e-3).abs() < 1e-9 && odd.exponent == EXPONENTS[0], "{odd:?}");
    }
}
