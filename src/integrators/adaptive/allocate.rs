//! Variances → counts. If v (n/m)^p is the variance after m samples, the picture's total for a given cost is
//! least at m ~ (v n^p)^(1/(1+p)) (Lagrange): one multiplier for all pixels, chosen so that the aim is met;
//! no pixel loses samples.

use rayon::prelude::*;

use crate::sampling::Aim;
use crate::schema::constants::{GOAL_MIN_GROWTH, GOAL_MIN_GROWTH_OF_ONE};

/// Pixels sorted into bins by the multiplier at which they begin to gain samples. Its memory is kept from pass to pass.
#[derive(Default)]
pub struct Allocation {
    weights: Vec<f32>,
    bins: Vec<Bin>,
    exponent: f64,
    pixels: f64,
}

#[derive(Clone, Copy, Default)]
struct Bin {
    /// Below that multiplier: the current variance and number of samples.
    variance: f64,
    samples: f64,
    /// Above it: both for a multiplier of 1, as v (n/w)^p = w by the choice of w.
    weight: f64,
}

impl Bin {
    fn add(&mut self, variance: f32, count: f32, weight: f32) {
        self.variance += f64::from(variance);
        self.samples += 2.0 * f64::from(count);
        self.weight += f64::from(weight);
    }
}

/// Returns the ratio in which a pixel has its share of the samples; `p` is the exponent of the error.
pub fn weight(variance: f32, count: u32, p: f32) -> f32 {
    (variance * (count as f32).powf(p)).powf(1.0 / (1.0 + p))
}

/// Returns the least factor by which a count grows: fewer extra samples would not pay for their batch and
/// would be lost to rounding.
fn min_growth(now: f64) -> f64 {
    if now < 2.0 { GOAL_MIN_GROWTH_OF_ONE } else { GOAL_MIN_GROWTH }
}

/// Pixels that one thread processes at once.
const PIXELS_PER_TASK: usize = 1 << 15;
const BINS: usize = 1024;
const BINS_AN_OCTAVE: f64 = 8.0;

impl Allocation {
    /// Weighs all pixels; the error falls as MSE ~ samples^-exponent.
    pub fn update(&mut self, variances: &[f32], counts: &[u32], exponent: f64) {
        let p = exponent as f32;
        self.weights.resize(counts.len(), 0.0);
        let chunks = self.weights.par_chunks_mut(PIXELS_PER_TASK).zip(variances.par_chunks(PIXELS_PER_TASK));
        let bins = chunks.zip(counts.par_chunks(PIXELS_PER_TASK)).map(|((weights, variances), counts)| {
            let mut bins = vec![Bin::default(); BINS];
            for ((weight, &variance), &count) in weights.iter_mut().zip(variances).zip(counts) {
                let n = count as f32;
                *weight = self::weight(variance, count, p);
                bins[bin_of(min_growth(n.into()) * f64::from(n / *weight))].add(variance, n, *weight);
            }
            bins
        });
        self.bins = chunked_sum(bins.collect());
        (self.exponent, self.pixels) = (exponent, counts.len() as f64);
    }

    /// Returns the total number of samples that meets the aim.
    pub fn cost(&self, aim: Aim) -> f64 {
        self.samples(self.multiplier(aim))
    }

    /// Replaces `next` by the samples in each half after the next pass.
    pub fn choose(&self, aim: Aim, now: &[u32], growth: f64, most: u32, next: &mut Vec<u32>) {
        let multiplier = self.multiplier(aim);
        let count = |(&weight, &now): (&f32, &u32)| {
            let wanted = (f64::from(weight) * multiplier).min(f64::from(now) * growth).min(f64::from(most));
            if wanted < min_growth(now.into()) * f64::from(now) { now } else { round_to_two_bits(wanted) }
        };
        self.weights.par_iter().zip(now).map(count).collect_into_vec(next);
    }

    /// Returns the multiplier by bisection: both aims are monotonic in it.
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
        self.sum(multiplier, |bin| bin.variance, |bin| bin.weight * fall)
    }

    fn samples(&self, multiplier: f64) -> f64 {
        self.sum(multiplier, |bin| bin.samples, |bin| 2.0 * bin.weight * multiplier)
    }

    /// Sums over pixels that keep their samples and over those that gain some.
    fn sum(&self, multiplier: f64, kept: impl Fn(&Bin) -> f64, gained: impl Fn(&Bin) -> f64) -> f64 {
        let (gaining, resting) = self.bins.split_at(bin_of(multiplier));
        resting.iter().map(kept).sum::<f64>() + gaining.iter().map(gained).sum::<f64>()
    }
}

/// Adds in the order of the chunks, so that the result does not depend on the number of cores.
fn chunked_sum(chunks: Vec<Vec<Bin>>) -> Vec<Bin> {
    let mut sums = vec![Bin::default(); BINS];
    for bins in chunks {
        for (sum, bin) in sums.iter_mut().zip(bins) {
            sum.variance += bin.variance;
            sum.samples += bin.samples;
            sum.weight += bin.weight;
        }
    }
    sums
}

fn bin_of(multiplier: f64) -> usize {
    let octave = multiplier.max(f64::MIN_POSITIVE).log2();
    (octave * BINS_AN_OCTAVE + (BINS / 2) as f64).clamp(0.0, (BINS - 1) as f64) as usize
}

fn multiplier_of(bin: usize) -> f64 {
    ((bin as f64 - (BINS / 2) as f64) / BINS_AN_OCTAVE).exp2()
}

/// Rounds to the nearest number with two significant bits: counts with many factors of two fit nets in base
/// 2, and the errors of rounding up and down cancel.
fn round_to_two_bits(wanted: f64) -> u32 {
    let step = f64::from(1u32 << (wanted.max(2.0).log2() as u32 - 1).min(30));
    ((wanted / step).round() * step) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Allocation {
        fn counts(&self, aim: Aim, now: &[u32], growth: f64, most: u32) -> Vec<u32> {
            let mut next = Vec::new();
            self.choose(aim, now, growth, most, &mut next);
            next
        }
    }

    fn allocation(variances: &[f32], counts: &[u32], exponent: f64) -> Allocation {
        let mut allocation = Allocation::default();
        allocation.update(variances, counts, exponent);
        allocation
    }

    /// Returns the number of samples after the pass and the error that the model predicts.
    fn outcome(variances: &[f32], now: &[u32], next: &[u32], exponent: f64) -> (f64, f64) {
        let samples = next.iter().map(|&n| 2.0 * f64::from(n)).sum();
        let left = |((&v, &n), &m): ((&f32, &u32), &u32)| {
            f64::from(v) * (f64::from(n) / f64::from(m)).powf(exponent)
        };
        (samples, variances.iter().zip(now).zip(next).map(left).sum::<f64>() / now.len() as f64)
    }

    /// Variances over four decades, some zero, and unequal counts.
    fn picture() -> (Vec<f32>, Vec<u32>) {
        let spread = |i: u32| 10f32.powf(-4.0 * (i as f32 * 0.618_034).fract()) / 16.0;
        let variances = (0..4096).map(|i| if i % 7 == 0 { 0.0 } else { spread(i) });
        (variances.collect(), (0..4096).map(|i| 8 << (i % 3)).collect())
    }

    /// Counts in proportion to the standard deviations of one sample cost least (Neyman 1934).
    #[test]
    fn random_samples_go_in_proportion_to_the_spread() {
        let counts = [16u32; 4];
        // The variances of one sample are 1, 16, 256, 0.
        let variances = [1.0 / 16.0, 1.0, 16.0, 0.0];
        let next = allocation(&variances, &counts, 1.0).counts(Aim::Samples(16_000.0), &counts, 1e9, 1 << 20);
        assert_eq!(next[3], 16, "a pixel without error gained samples");
        for (count, ratio) in [(next[1], 4.0), (next[2], 16.0)] {
            let found = f64::from(count) / f64::from(next[0]);
            assert!((2.0 / 3.0..1.5).contains(&(found / ratio)), "{next:?}"); // two significant bits
        }
    }

    #[test]
    fn aims_are_met_and_not_by_much_more() {
        let (variances, counts) = picture();
        for exponent in [1.0, 1.5, 2.0] {
            let allocation = allocation(&variances, &counts, exponent);
            let (taken, mse) = outcome(&variances, &counts, &counts, exponent);
            for part in [0.5, 0.1, 0.003] {
                let next = allocation.counts(Aim::Mse(part * mse), &counts, 1e9, 1 << 24);
                let (_, left) = outcome(&variances, &counts, &next, exponent);
                // Rounding up and down cancels except for the curvature of 1 / m^p; bins are 9 % wide.
                assert!((0.9..1.1).contains(&(left / (part * mse))), "p {exponent}, {part}: {left} of {mse}");
                assert!(next.iter().zip(&counts).all(|(next, now)| next >= now), "a pixel lost samples");
            }
            let next = allocation.counts(Aim::Samples(10.0 * taken), &counts, 1e9, 1 << 24);
            let (samples, left) = outcome(&variances, &counts, &next, exponent);
            assert!((0.95..1.1).contains(&(samples / (10.0 * taken))), "p {exponent}: {samples} of {taken}");
            // Better than the same number in each pixel.
            let equal: Vec<u32> = counts.iter().map(|n| 10 * n).collect();
            assert!(left < 0.6 * outcome(&variances, &counts, &equal, exponent).1, "p {exponent}: {left}");
        }
    }

    #[test]
    fn growth_and_the_largest_count_are_limits() {
        let (variances, counts) = picture();
        let next = allocation(&variances, &counts, 1.0).counts(Aim::Mse(1e-12), &counts, 8.0, 100);
        assert!(next.iter().zip(&counts).all(|(next, now)| *next <= (8 * now).min(128)));
    }

    #[test]
    fn rounding_keeps_two_significant_bits_and_what_is_worth_it_grows() {
        for wanted in (10..40_000).map(|w| f64::from(w) / 10.0) {
            let count = round_to_two_bits(wanted);
            let bits = u32::BITS - count.leading_zeros() - count.trailing_zeros();
            assert!(bits <= 2, "{wanted}: {count}");
            // Neighbours differ by a half or a third, 1 and 2 by a factor of two.
            let most = if wanted < 2.0 { 0.5 } else { 0.25 * wanted };
            assert!((f64::from(count) - wanted).abs() <= most, "{wanted}: {count}");
            let least = min_growth(count.into()) * f64::from(count);
            assert!(round_to_two_bits(least) > count, "{count} does not grow to {least}");
        }
    }
}
