//! Corrects variances from the spreads of two halves if pixels differ at random rather than by the picture.
//!
//! If one half of a pixel's samples saw nothing, the other half, which is independent of it, shows what to expect of
//! such a pixel (cross-validation: Stone 1974). Among rare bright texels that is as much as elsewhere; beside an edge,
//! which stratified samples of both halves hit or miss alike, it is next to nothing. Pixels of one part of the picture
//! and of similar counts are pooled. Pixels that saw much are then no better known than those that saw nothing: their
//! spreads are shrunk towards the mean by the reliability that the halves show (Spearman 1910, Brown 1910), as
//! otherwise the counts would follow the samples and bias the picture.

use rayon::prelude::*;

use super::{OCTAVES, octave};
use crate::schema::constants::{
    GOAL_MANY_SAMPLES, GOAL_MAX_CORRELATION, GOAL_MAX_SURE_CORRELATION, GOAL_MIN_CONTRADICTIONS,
    GOAL_MIN_UNSEEN_SHARE, GOAL_NOTHING_RATIO, GOAL_PART_SIDE,
};

/// Pixels along each side of a part of the picture.
const SIDE: usize = GOAL_PART_SIDE as usize;
/// A half has seen nothing if its variance is this many times less than that of the mean half.
const NOTHING_RATIO: f32 = GOAL_NOTHING_RATIO as f32;
/// Least number of halves that contradict their partners, and least share of the variance that they account for: a few
/// slivers at edges say nothing about their surroundings.
const MIN_CONTRADICTIONS: u32 = GOAL_MIN_CONTRADICTIONS;
const MIN_SHARE: f64 = GOAL_MIN_UNSEEN_SHARE;
/// Largest correlation of the halves, as both see any variation of the picture itself: for pixels with few samples in
/// an unknown scene; and for pixels with many samples, or scenes known to contain something small and bright.
const MAX_CORRELATION: [f64; 2] = [GOAL_MAX_CORRELATION, GOAL_MAX_SURE_CORRELATION];
/// From this number on, samples count as many.
const MANY_SAMPLES: usize = GOAL_MANY_SAMPLES as usize;

/// The variance of one sample by each half of a pixel.
pub type Spreads = [f32; 2];

#[derive(Clone, Copy, Default)]
struct Class {
    pixels: u32,
    /// Sums over all halves: of the variances, their squares, and the products of both.
    spread: f64,
    squares: f64,
    products: f64,
    /// The sum of the known variances.
    variance: f64,
    /// The number of halves whose partners saw nothing, and the sum of their variances.
    partners: u32,
    unseen: f64,
    /// The variance of a mean over that of a sample, summed over the pixels of these halves, a half for each.
    means: f64,
    contradictions: u32,
}

impl Class {
    fn add(&mut self, [a, b]: Spreads, variance: f32) {
        let [a, b] = [f64::from(a), f64::from(b)];
        self.pixels += 1;
        self.spread += a + b;
        self.squares += a * a + b * b;
        self.products += a * b;
        self.variance += f64::from(variance);
    }

    /// Compares each half with its partner, after all pixels were added.
    fn compare(&mut self, [a, b]: Spreads, count: u32) {
        let nothing = (self.spread / f64::from(2 * self.pixels)) as f32 / NOTHING_RATIO;
        for (own, partner) in [(a, b), (b, a)] {
            if own <= nothing {
                self.partners += 1;
                self.unseen += f64::from(partner);
                self.means += 0.5 / (2.0 * f64::from(count));
                self.contradictions += u32::from(partner > NOTHING_RATIO * nothing);
            }
        }
    }

    /// Returns the correlation of the halves, less one standard deviation for this number of pairs.
    fn correlation(&self) -> f64 {
        let halves = f64::from(2 * self.pixels);
        let mean = self.spread / halves;
        let variance = self.squares / halves - mean * mean;
        let covariance = 2.0 * self.products / halves - mean * mean;
        let deviation = 1.0 / f64::from(self.pixels).sqrt();
        (covariance / variance.max(f64::MIN_POSITIVE) - deviation).clamp(0.0, 1.0)
    }

    /// Returns the correction of the pixels' variances; `None` if it would be negligible.
    fn rule(&self, correlation: f64) -> Option<Rule> {
        let floor = self.unseen / f64::from(self.partners.max(1));
        let mean = self.spread / f64::from(2 * self.pixels);
        let reliability = 2.0 * correlation / (1.0 + correlation);
        let matters =
            self.contradictions >= MIN_CONTRADICTIONS && self.means * floor > MIN_SHARE * self.variance;
        matters.then_some(Rule { floor: floor as f32, mean: mean as f32, reliability: reliability as f32 })
    }
}

#[derive(Clone, Copy)]
struct Rule {
    /// The variance of a sample where nothing was seen.
    floor: f32,
    mean: f32,
    /// The share of the differences between pixels that a second set of as many samples would reproduce.
    reliability: f32,
}

impl Rule {
    /// Returns the corrected variance of a pixel's mean.
    fn apply(&self, variance: f32, [a, b]: Spreads, count: u32) -> f32 {
        let own = 0.5 * (a + b);
        let drawn = self.mean + self.reliability * (own - self.mean);
        let factor = if own > 0.0 { drawn / own } else { 0.0 };
        (variance * factor).max(self.floor / (2.0 * count as f32))
    }
}

/// Corrects the variances of means where half of the samples have not seen what the other half has; `bright` is true if
/// the scene is known to contain something small and bright.
pub fn correct(
    variances: &mut [f32],
    halves: impl Fn(usize) -> Spreads + Sync,
    counts: &[u32],
    width: usize,
    bright: bool,
) {
    let (across, height) = (width.div_ceil(SIDE), counts.len() / width.max(1));
    let rules: Vec<Option<Box<Rules>>> = (0..across * height.div_ceil(SIDE))
        .into_par_iter()
        .map(|part| {
            let (left, top) = (part % across * SIDE, part / across * SIDE);
            let columns = left..(left + SIDE).min(width);
            let rows = top..(top + SIDE).min(height);
            let pixels = || rows.clone().flat_map(|y| columns.clone().map(move |x| y * width + x));
            part_rules(variances, &halves, counts, pixels, bright)
        })
        .collect();
    if rules.iter().all(|rules| rules.is_none()) {
        return;
    }
    variances.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
        for (part, pixels) in row.chunks_mut(SIDE).enumerate() {
            let Some(rules) = &rules[y / SIDE * across + part] else { continue };
            for (x, variance) in pixels.iter_mut().enumerate() {
                let i = y * width + part * SIDE + x;
                if let Some(rule) = rules[octave(counts[i])] {
                    *variance = rule.apply(*variance, halves(i), counts[i]);
                }
            }
        }
    });
}

type Rules = [Option<Rule>; OCTAVES];

/// Returns the corrections for one part of the picture; `None` if no class of counts has one.
fn part_rules<P: Iterator<Item = usize>>(
    variances: &[f32],
    halves: &(impl Fn(usize) -> Spreads + Sync),
    counts: &[u32],
    pixels: impl Fn() -> P,
    bright: bool,
) -> Option<Box<Rules>> {
    let mut classes = [Class::default(); OCTAVES];
    for i in pixels() {
        classes[octave(counts[i])].add(halves(i), variances[i]);
    }
    // None if the halves agree on the differences between pixels, or if there is no pixel.
    let correlation: [Option<f64>; OCTAVES] = std::array::from_fn(|octave| {
        let most = MAX_CORRELATION[usize::from(bright || 1 << octave >= MANY_SAMPLES)];
        (classes[octave].pixels > 0)
            .then(|| classes[octave].correlation())
            .filter(|correlation| *correlation < most)
    });
    if correlation.iter().all(Option::is_none) {
        return None;
    }
    for i in pixels().filter(|&i| correlation[octave(counts[i])].is_some()) {
        classes[octave(counts[i])].compare(halves(i), counts[i]);
    }
    let rules = std::array::from_fn(|octave| {
        correlation[octave].and_then(|correlation| classes[octave].rule(correlation))
    });
    rules.iter().any(Option::is_some).then(|| Box::new(rules))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 64;

    fn corrected(halves: &[Spreads], count: u32) -> Vec<f32> {
        let counts = vec![count; halves.len()];
        let mut variances: Vec<f32> =
            halves.iter().map(|[a, b]| 0.5 * (a + b) / (2.0 * count as f32)).collect();
        correct(&mut variances, |i| halves[i], &counts, WIDTH, false);
        variances
    }

    /// Each half meets a bright texel in one of five pixels.
    #[test]
    fn pixels_that_met_no_rare_texel_are_taken_to_vary_like_the_others() {
        let mut rng = fastrand::Rng::with_seed(3);
        let mut half = || if rng.f32() < 0.2 { 1.0 } else { 0.0 };
        let halves: Vec<Spreads> = (0..WIDTH * WIDTH).map(|_| [half(), half()]).collect();
        for (i, variance) in corrected(&halves, 8).into_iter().enumerate() {
            // One part has 1024 pixels and 1640 halves beside halves that saw nothing: 5 sigma are 25 %.
            let part = variance / (0.2 / 16.0);
            assert!((0.75..1.4).contains(&part), "{i}: {part} of the right one, {:?}", halves[i]);
        }
    }

    #[test]
    fn what_is_flat_beside_edges_stays_so() {
        let mut halves = vec![[0.0; 2]; WIDTH * WIDTH];
        // Two edges that both halves meet; at the third, some slivers that only one half meets.
        for x in 0..WIDTH {
            halves[10 * WIDTH + x] = [0.2, 0.25];
            halves[50 * WIDTH + x] = [0.1, 0.05];
            halves[51 * WIDTH + x] = if x % 8 == 0 { [0.0, 0.06] } else { [0.0; 2] };
        }
        let variances = corrected(&halves, 16);
        for (i, [a, b]) in halves.iter().enumerate() {
            assert_eq!(variances[i], 0.5 * (a + b) / 32.0, "{i}");
        }
    }
}
