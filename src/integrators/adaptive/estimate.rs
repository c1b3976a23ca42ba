//! Sums of two halves → the variance of each pixel's mean, and the picture's mean squared error.
//!
//! A pixel's own halves are a poor estimate: the square of a single difference. The variance s² of its samples is known
//! well, but stratified samples err less than it predicts. So s² distinguishes pixels, and the halves in a window
//! around each show by how much its samples err less: v = s²/n · Σ d² / Σ s²/n, with sums over the window.
//!
//! An edge that all n samples missed covers less than about 1/n of the pixel; the mean of that square is 1/3n². So no
//! variance is assumed to be less than that times the squared contrast to the nearest pixels.

use glam::{Vec3A, Vec4};
use rayon::prelude::*;

use super::unseen::{self, Spreads};
use crate::sampling::HalfSums;
use crate::schema::constants::GOAL_RADIUS;

/// Pixels that one thread processes at once.
const PIXELS_PER_TASK: usize = 1 << 15;
/// Pixels on each side of the window's centre.
const RADIUS: usize = GOAL_RADIUS as usize;

/// Its memory is kept from pass to pass: the system takes longer to give it than the estimate takes.
#[derive(Default)]
pub struct Estimate {
    /// The variance of the mean over both halves, averaged over the channels.
    pub variances: Vec<f32>,
    /// The variance of one sample.
    pub spreads: Vec<f32>,
    pub mse: f64,
    /// The standard deviation of `mse`: a difference d of variance v has E d⁴ = 3v², and d² the variance 2v².
    pub deviation: f64,
    seen: Vec<Seen>,
    /// For each pixel the sums over the row and over all of its window, of both estimates of the variance.
    rows: Vec<[f32; 2]>,
    windows: Vec<[f32; 2]>,
}

/// The statistics of one pixel.
#[derive(Clone, Copy, Default)]
struct Seen {
    mean: Vec3A,
    /// The mean's variance by the difference of the halves.
    difference: f32,
    /// The mean's variance by the variance of the samples.
    spread: f32,
    /// The variance of one sample, by each half.
    halves: Spreads,
}

impl Estimate {
    /// Estimates all variances; `bright` is true if the scene is known to contain something small and bright.
    pub fn update(&mut self, sums: &HalfSums, counts: &[u32], bright: bool) {
        let (width, height) = (sums.width as usize, sums.height as usize);
        (0..counts.len()).into_par_iter().map(|i| seen(sums, counts[i], i)).collect_into_vec(&mut self.seen);
        let differences = self.seen.iter().map(|s| f64::from(s.difference));
        let (sum, squares) = differences.fold((0.0, 0.0), |(sum, squares), d| (sum + d, squares + d * d));
        [self.mse, self.deviation] = [sum, (2.0 / 3.0 * squares).sqrt()].map(|v| v / counts.len() as f64);
        self.sum_windows(width, height);
        let (seen, windows) = (&self.seen, &self.windows);
        let variance = |i: usize| {
            let [difference, spread] = windows[i];
            let own = if spread > 0.0 { seen[i].spread * (difference / spread) } else { seen[i].difference };
            let n = 2.0 * counts[i] as f32;
            own.max(contrast(seen, i, width, height) / (3.0 * n * n))
        };
        (0..seen.len()).into_par_iter().map(variance).collect_into_vec(&mut self.variances);
        unseen::correct(&mut self.variances, |i| seen[i].halves, counts, width, bright);
        let spread = |(seen, &count): (&Seen, &u32)| seen.spread * (2.0 * count as f32);
        seen.par_iter().zip(counts).map(spread).collect_into_vec(&mut self.spreads);
    }

    /// Sums both estimates of the variance over each pixel's window.
    fn sum_windows(&mut self, width: usize, height: usize) {
        let add = |a: [f32; 2], b: [f32; 2]| [a[0] + b[0], a[1] + b[1]];
        let around = |at: usize, size: usize| at.saturating_sub(RADIUS)..(at + RADIUS + 1).min(size);
        let Estimate { seen, rows, windows, .. } = self;
        rows.resize(seen.len(), [0.0; 2]);
        rows.par_chunks_mut(width).zip(seen.par_chunks(width)).for_each(|(out, row)| {
            for (x, out) in out.iter_mut().enumerate() {
                *out =
                    row[around(x, width)].iter().fold([0.0; 2], |sum, s| add(sum, [s.difference, s.spread]));
            }
        });
        windows.resize(seen.len(), [0.0; 2]);
        windows.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            out.fill([0.0; 2]);
            for row in around(y, height) {
                for (out, value) in out.iter_mut().zip(&rows[row * width..(row + 1) * width]) {
                    *out = add(*out, *value);
                }
            }
        });
    }
}

impl Estimate {
    /// Returns the mean of all variances.
    pub fn mean_variance(&self) -> f64 {
        let chunks: Vec<f64> = self
            .variances
            .par_chunks(PIXELS_PER_TASK)
            .map(|chunk| chunk.iter().map(|&v| f64::from(v)).sum())
            .collect();
        chunks.iter().sum::<f64>() / self.variances.len() as f64
    }
}

fn seen(sums: &HalfSums, count: u32, i: usize) -> Seen {
    let part = 1.0 / count as f32;
    let [a, b] = [0, 1].map(|half| part * Vec4::from_array(sums.halves[half][i]));
    let (own, other) = (Vec3A::from_vec4(a), Vec3A::from_vec4(b));
    let mean = 0.5 * (own + other);
    let difference = 0.25 * square(own - other);
    let spread = 0.5 * part * (0.5 * (a.w + b.w) - square(mean)).max(0.0);
    let halves = [(a.w - square(own)).max(0.0), (b.w - square(other)).max(0.0)];
    // A pixel that is NaN or infinite stays so: more samples would not help, and neighbours have no contrast to it.
    if mean.is_finite() && difference.is_finite() && spread.is_finite() {
        Seen { mean, difference, spread, halves }
    } else {
        Seen { mean: Vec3A::NAN, ..Seen::default() }
    }
}

/// Returns the mean over the channels.
fn square(v: Vec3A) -> f32 {
    v.length_squared() * (1.0 / 3.0)
}

/// Returns the largest squared difference to one of the four nearest pixels.
fn contrast(seen: &[Seen], i: usize, width: usize, height: usize) -> f32 {
    let (x, y) = (i % width, i / width);
    let to = |j: usize| square(seen[i].mean - seen[j].mean);
    let mut most = 0.0f32;
    for (there, j) in [
        (x > 0, i.wrapping_sub(1)),
        (x + 1 < width, i + 1),
        (y > 0, i.wrapping_sub(width)),
        (y + 1 < height, i + width),
    ] {
        if there {
            most = most.max(to(j));
        }
    }
    most
}

/// The rate at which the picture's error falls: MSE ~ samples^-p, by the last two passes.
pub struct Exponent {
    value: f64,
    last: Option<(f64, f64)>,
}

impl Default for Exponent {
    fn default() -> Self {
        Exponent { value: 1.6, last: None }
    }
}

impl Exponent {
    pub fn learn(&mut self, samples: f64, mse: f64) {
        if let Some((before, error)) = self.last
            && samples > 1.2 * before
            && mse > 0.0
        {
            self.value = ((error / mse).ln() / (samples / before).ln()).clamp(1.0, 2.0);
        }
        self.last = Some((samples, mse));
    }

    pub fn value(&self) -> f64 {
        self.value
    }
}

#[cfg(test)]
mod tests {
    use super::super::explore::pcg;
    use super::*;

    const WIDTH: usize = 64;

    fn estimate(sums: &HalfSums, counts: &[u32]) -> Estimate {
        let mut estimate = Estimate::default();
        estimate.update(sums, counts, false);
        estimate
    }

    /// Uniform random numbers of variance 1, at least for the samples that are requested here.
    fn noise(pixel: usize, half: usize, s: u32) -> f32 {
        let bits = pcg(pcg(pixel as u32 * 2 + half as u32).wrapping_add(s)) >> 8;
        (bits as f32 / 16_777_216.0 - 0.5) * 12f32.sqrt()
    }

    /// Returns a picture whose samples deviate by `spread` from `mean`.
    fn sums(counts: &[u32], mean: impl Fn(usize) -> f32, spread: impl Fn(usize) -> f32) -> HalfSums {
        let half = |half: usize| {
            let sum = |i: usize| {
                let mut sum = [0.0; 4];
                for s in 0..counts[i] {
                    let value = mean(i) + spread(i) * noise(i, half, s);
                    (0..3).for_each(|c| sum[c] += value);
                    sum[3] += value * value;
                }
                sum
            };
            (0..counts.len()).map(sum).collect()
        };
        HalfSums { width: WIDTH as u32, height: (counts.len() / WIDTH) as u32, halves: [half(0), half(1)] }
    }

    #[test]
    fn random_samples_err_as_their_spread_says() {
        let counts = vec![32u32; WIDTH * WIDTH];
        let spread = |i: usize| if i % WIDTH < WIDTH / 2 { 0.1 } else { 1.0 };
        let estimate = estimate(&sums(&counts, |_| 0.5, spread), &counts);
        // Half of the pixels 0.01 / 64, half 1 / 64; for 4096 squares of a normal deviate 3 sigma are 9 %.
        let exact = 0.505 / 64.0;
        assert!((estimate.mse / exact - 1.0).abs() < 0.09, "{:e}, exactly {exact:e}", estimate.mse);
        for (i, v) in estimate.variances.iter().enumerate() {
            let exact = spread(i) * spread(i) / 64.0;
            // In a corner a window has 16 such squares: p = 1e-5 below 0.15 and above 3.2; spreads vary too.
            assert!((0.1..4.0).contains(&(v / exact)), "{i}: {v:e}, exactly {exact:e}");
        }
    }

    /// Halves that agree better than the variance of samples predicts show that samples are stratified.
    #[test]
    fn agreeing_halves_lower_the_variance() {
        let counts = vec![32u32; WIDTH * WIDTH];
        let mut same = sums(&counts, |_| 0.5, |_| 0.3);
        same.halves[1] = same.halves[0].clone();
        let estimate = estimate(&same, &counts);
        assert_eq!(estimate.mse, 0.0);
        // The contrast of neighbours remains.
        assert!(estimate.variances.iter().all(|v| *v < 0.01 * 0.09 / 64.0));
    }

    #[test]
    fn a_pixel_beside_an_edge_that_no_sample_met_keeps_a_variance() {
        let counts = vec![8u32; WIDTH * 8];
        let edge = |i: usize| if i % WIDTH < 20 { 0.0 } else { 1.0 };
        let estimate = estimate(&sums(&counts, edge, |_| 0.0), &counts);
        for (i, v) in estimate.variances.iter().enumerate() {
            let wanted = if [19, 20].contains(&(i % WIDTH)) { 1.0 / (3.0 * 256.0) } else { 0.0 };
            assert!((v - wanted).abs() < 1e-6, "{i}: {v:e}, not {wanted:e}");
        }
    }

    #[test]
    fn the_exponent_follows_the_error_within_its_bounds() {
        let mut exponent = Exponent::default();
        exponent.learn(100.0, 1e-3);
        exponent.learn(400.0, 1e-3 / 8.0);
        assert!((exponent.value() - 1.5).abs() < 1e-9);
        exponent.learn(1600.0, 1e-3);
        assert_eq!(exponent.value(), 1.0);
    }
}
