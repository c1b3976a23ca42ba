//! Variances → counts. With v (n/m)^p the variance after m samples, the sum over the picture is least for
//! its cost where m ~ (v n^p)^(1/(1+p)) (Lagrange): one multiplier for all pixels, found so that the aim is
//! met; no pixel loses samples.

use super::estimate::Estimate;

/// What a pass works towards.
#[derive(Clone, Copy, Debug)]
pub enum Aim {
    /// Samples of both halves of all pixels.
    Samples(f64),
    Mse(f64),
}

/// Pixels sorted into bins by the multiplier from which on they gain samples.
pub struct Allocation {
    weights: Vec<f32>,
    bins: Vec<Bin>,
    exponent: f64,
    pixels: f64,
}

#[derive(Clone, Copy, Default)]
struct Bin {
    /// Below it, variance and samples as they are.
    variance: f64,
    samples: f64,
    /// Above it, both for a multiplier of 1.
    variance_at_one: f64,
    weight: f64,
}

const BINS: usize = 1024;
const BINS_AN_OCTAVE: f64 = 8.0;

impl Allocation {
    pub fn new(estimate: &Estimate, counts: &[u32], exponent: f64) -> Allocation {
        let p = exponent as f32;
        let mut bins = vec![Bin::default(); BINS];
        let mut weights = Vec::with_capacity(counts.len());
        for (&variance, &count) in estimate.variances.iter().zip(counts) {
            let n = count as f32;
            let falling = variance * n.powf(p);
            let weight = falling.powf(1.0 / (1.0 + p));
            weights.push(weight);
            let bin = &mut bins[bin_of(f64::from(n / weight))];
            bin.variance += f64::from(variance);
            bin.samples += 2.0 * f64::from(n);
            if weight > 0.0 {
                bin.variance_at_one += f64::from(falling / weight.powf(p));
                bin.weight += 2.0 * f64::from(weight);
            }
        }
        Allocation { weights, bins, exponent, pixels: counts.len() as f64 }
    }

    /// Samples in each half after the next pass.
    pub fn counts(&self, aim: Aim, now: &[u32], growth: f64, most: u32) -> Vec<u32> {
        let multiplier = self.multiplier(aim);
        let count = |(&weight, &now): (&f32, &u32)| {
            let wanted = (f64::from(weight) * multiplier).min(f64::from(now) * growth).min(f64::from(most));
            // A few samples more would not pay for their job.
            if wanted < 1.2 * f64::from(now) { now } else { rounded(wanted) }
        };
        self.weights.iter().zip(now).map(count).collect()
    }

    /// By bisection: both aims are monotonic in it.
    fn multiplier(&self, aim: Aim) -> f64 {
        let (mut low, mut high) = (multiplier_of(0), multiplier_of(BINS));
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            let enough = match aim {
                Aim::Mse(mse) => self.variance(middle) <= mse * self.pixels,
                Aim::Samples(samples) => self.samples(middle) >= samples,
            };
            *(if enough { &mut high } else { &mut low }) = middle;
        }
        high
    }

    fn variance(&self, multiplier: f64) -> f64 {
        let fall = multiplier.powf(-self.exponent);
        self.sum(multiplier, |bin| bin.variance, |bin| bin.variance_at_one * fall)
    }

    fn samples(&self, multiplier: f64) -> f64 {
        self.sum(multiplier, |bin| bin.samples, |bin| bin.weight * multiplier)
    }

    /// Of pixels as they are, and of those that gain.
    fn sum(&self, multiplier: f64, kept: impl Fn(&Bin) -> f64, gained: impl Fn(&Bin) -> f64) -> f64 {
        let (gaining, resting) = self.bins.split_at(bin_of(multiplier));
        resting.iter().map(kept).sum::<f64>() + gaining.iter().map(gained).sum::<f64>()
    }
}

fn bin_of(multiplier: f64) -> usize {
    let octave = multiplier.max(f64::MIN_POSITIVE).log2();
    (octave * BINS_AN_OCTAVE + (BINS / 2) as f64).clamp(0.0, (BINS - 1) as f64) as usize
}

fn multiplier_of(bin: usize) -> f64 {
    ((bin as f64 - (BINS / 2) as f64) / BINS_AN_OCTAVE).exp2()
}

/// Up to a number with two significant bits: counts with many factors of two suit nets in base 2.
fn rounded(wanted: f64) -> u32 {
    let wanted = wanted as u32;
    let step = (wanted.max(2).ilog2() - 1).min(30);
    wanted.div_ceil(1 << step) << step
}
