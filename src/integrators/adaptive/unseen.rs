//! Spreads of two halves → variances where chance, not the picture, tells pixels apart.
//!
//! Where one half of a pixel's samples saw nothing, the other half, which does not know that, tells what is to be
//! expected of such a pixel (cross-validation: Stone 1974). Among rare bright texels that is as much as elsewhere;
//! beside an edge, which well placed samples of both halves meet or miss alike, it is next to nothing. Pixels of one
//! part of the picture and of like counts share what their halves say. There pixels that saw much are no better known
//! than those that saw nothing: their spreads are drawn towards the mean by the reliability that the halves show
//! (Spearman 1910, Brown 1910), or counts would follow the samples and bend the picture.

use rayon::prelude::*;

use super::{OCTAVES, octave};

/// Pixels along each side of a part of the picture.
const SIDE: usize = 32;
/// A half has seen nothing where it varies so many times less than the mean half.
const NOTHING: f32 = 16.0;
/// So many halves must contradict their partners, and what they say must be such a share of the variance: a few
/// slivers at edges do not speak for their surroundings.
const CONTRADICTIONS: u32 = 8;
const SHARE: f64 = 0.1;
/// And halves must be no more alike than by such a correlation, for what the picture itself varies both see: where
/// they have few samples and nothing is known of the scene, and where they have many, or the scene something small and
/// bright.
const ALIKE: [f64; 2] = [0.25, 0.5];
/// So many are meant.
const MANY: usize = 64;

/// What a pixel's halves say: the variance of one sample by each.
pub type Spreads = [f32; 2];

#[derive(Clone, Copy, Default)]
struct Class {
    pixels: u32,
    /// Of all halves: sums, squares, and products of both.
    spread: f64,
    squares: f64,
    products: f64,
    /// Of the variances known.
    variance: f64,
    /// Halves whose partners saw nothing, and their spreads.
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

    /// What halves say of their partners, once all pixels are there.
    fn compare(&mut self, [a, b]: Spreads, count: u32) {
        let nothing = (self.spread / f64::from(2 * self.pixels)) as f32 / NOTHING;
        for (own, partner) in [(a, b), (b, a)] {
            if own <= nothing {
                self.partners += 1;
                self.unseen += f64::from(partner);
                self.means += 0.5 / (2.0 * f64::from(count));
                self.contradictions += u32::from(partner > NOTHING * nothing);
            }
        }
    }

    /// The correlation of halves, less one standard deviation of that of so many pairs.
    fn alike(&self) -> f64 {
        let halves = f64::from(2 * self.pixels);
        let mean = self.spread / halves;
        let variance = self.squares / halves - mean * mean;
        let covariance = 2.0 * self.products / halves - mean * mean;
        let by_chance = 1.0 / f64::from(self.pixels).sqrt();
        (covariance / variance.max(f64::MIN_POSITIVE) - by_chance).clamp(0.0, 1.0)
    }

    /// What is made of its pixels' spreads; none where that is no matter.
    fn rule(&self, alike: f64) -> Option<Rule> {
        let floor = self.unseen / f64::from(self.partners.max(1));
        let mean = self.spread / f64::from(2 * self.pixels);
        let reliability = 2.0 * alike / (1.0 + alike);
        let matters = self.contradictions >= CONTRADICTIONS && self.means * floor > SHARE * self.variance;
        matters.then_some(Rule { floor: floor as f32, mean: mean as f32, reliability: reliability as f32 })
    }
}

#[derive(Clone, Copy)]
struct Rule {
    /// The variance of a sample where nothing was seen.
    floor: f32,
    mean: f32,
    /// How much of what tells pixels apart a second set of as many samples would show again.
    reliability: f32,
}

impl Rule {
    /// The variance of a mean, of whose samples the halves say that much.
    fn apply(&self, variance: f32, [a, b]: Spreads, count: u32) -> f32 {
        let own = 0.5 * (a + b);
        let drawn = self.mean + self.reliability * (own - self.mean);
        let factor = if own > 0.0 { drawn / own } else { 0.0 };
        (variance * factor).max(self.floor / (2.0 * count as f32))
    }
}

/// Changes the variances of means where half of the samples do not know what the other half has seen; `bright` where
/// the scene is known to have something small and bright.
pub fn settle(
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

/// For one part of the picture; none where there is none for any class.
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
    // None where halves agree on what tells pixels apart, or where there is no pixel.
    let alike: [Option<f64>; OCTAVES] = std::array::from_fn(|octave| {
        let most = ALIKE[usize::from(bright || 1 << octave >= MANY)];
        (classes[octave].pixels > 0).then(|| classes[octave].alike()).filter(|alike| *alike < most)
    });
    if alike.iter().all(Option::is_none) {
        return None;
    }
    for i in pixels().filter(|&i| alike[octave(counts[i])].is_some()) {
        classes[octave(counts[i])].compare(halves(i), counts[i]);
    }
    let rules = std::array::from_fn(|octave| alike[octave].and_then(|alike| classes[octave].rule(alike)));
    rules.iter().any(Option::is_some).then(|| Box::new(rules))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 64;

    fn settled(halves: &[Spreads], count: u32) -> Vec<f32> {
        let counts = vec![count; halves.len()];
        let mut variances: Vec<f32> =
            halves.iter().map(|[a, b]| 0.5 * (a + b) / (2.0 * count as f32)).collect();
        settle(&mut variances, |i| halves[i], &counts, WIDTH, false);
        variances
    }

    /// Each half meets a bright texel in one pixel of five.
    #[test]
    fn pixels_that_met_no_rare_texel_are_taken_to_vary_like_the_others() {
        let mut rng = fastrand::Rng::with_seed(3);
        let mut half = || if rng.f32() < 0.2 { 1.0 } else { 0.0 };
        let halves: Vec<Spreads> = (0..WIDTH * WIDTH).map(|_| [half(), half()]).collect();
        for (i, variance) in settled(&halves, 8).into_iter().enumerate() {
            // One of 1024 pixels of a part, 1640 of its halves beside such as saw nothing: 5 sigma are 25 %.
            let part = variance / (0.2 / 16.0);
            assert!((0.75..1.4).contains(&part), "{i}: {part} of the right one, {:?}", halves[i]);
        }
    }

    #[test]
    fn what_is_flat_beside_edges_stays_so() {
        let mut halves = vec![[0.0; 2]; WIDTH * WIDTH];
        // Two edges, met by both halves; at the third some slivers by one only.
        for x in 0..WIDTH {
            halves[10 * WIDTH + x] = [0.2, 0.25];
            halves[50 * WIDTH + x] = [0.1, 0.05];
            halves[51 * WIDTH + x] = if x % 8 == 0 { [0.0, 0.06] } else { [0.0; 2] };
        }
        let variances = settled(&halves, 16);
        for (i, [a, b]) in halves.iter().enumerate() {
            assert_eq!(variances[i], 0.5 * (a + b) / 32.0, "{i}");
        }
    }
}
