//! Sums of two halves → the variance of each pixel's mean, and the picture's mean squared error.
//!
//! A pixel's own halves say little: the square of one difference. The spread of its samples is known well,
//! but well placed samples err less than it says. So the spread tells pixels apart, and the halves of a
//! window around each how much less its samples err: v = s²/n · Σ d² / Σ s²/n, sums over the window.

use rayon::prelude::*;

use super::Sums;

/// Pixels on each side of the window's middle.
const RADIUS: usize = 3;
/// Of the largest variance beside it a pixel has at least this part: what its neighbours saw may reach
/// into it.
const OF_NEIGHBOURS: f32 = 0.02;

pub struct Estimate {
    /// Of the mean over both halves, a channel's mean.
    pub variances: Vec<f32>,
    pub mse: f64,
}

impl Estimate {
    pub fn new(sums: &Sums, counts: &[u32]) -> Estimate {
        let (width, height) = (sums.width as usize, sums.height as usize);
        // (difference of the halves, spread of the samples): either as a variance of the mean.
        let seen: Vec<[f32; 2]> = (0..counts.len()).into_par_iter().map(|i| seen(sums, counts, i)).collect();
        let mse = seen.iter().map(|s| f64::from(s[0])).sum::<f64>() / seen.len() as f64;
        let windows = window_sums(&seen, width, height);
        let own: Vec<f32> = (seen.par_iter().zip(&windows))
            .map(|(own, window)| if window[1] > 0.0 { own[1] * (window[0] / window[1]) } else { own[0] })
            .collect();
        let variances = (0..own.len())
            .into_par_iter()
            .map(|i| own[i].max(OF_NEIGHBOURS * largest_beside(&own, i, width, height)));
        Estimate { variances: variances.collect(), mse }
    }
}

fn seen(sums: &Sums, counts: &[u32], i: usize) -> [f32; 2] {
    let n = counts[i] as f32;
    let [a, b] = [sums.halves[0][i], sums.halves[1][i]];
    let channel = |c: usize| ((a[c] - b[c]) / n, (a[c] + b[c]) / (2.0 * n));
    let (mut difference, mut mean) = (0.0, 0.0);
    for (d, m) in [0, 1, 2].map(channel) {
        difference += d * d / 3.0;
        mean += m * m / 3.0;
    }
    let spread = ((a[3] + b[3]) / (2.0 * n) - mean).max(0.0);
    [difference / 4.0, spread / (2.0 * n)]
}

fn window_sums(values: &[[f32; 2]], width: usize, height: usize) -> Vec<[f32; 2]> {
    let add = |a: [f32; 2], b: [f32; 2]| [a[0] + b[0], a[1] + b[1]];
    let around = |at: usize, size: usize| at.saturating_sub(RADIUS)..(at + RADIUS + 1).min(size);
    let mut rows = vec![[0.0; 2]; values.len()];
    rows.par_chunks_mut(width).zip(values.par_chunks(width)).for_each(|(out, row)| {
        for (x, out) in out.iter_mut().enumerate() {
            *out = row[around(x, width)].iter().copied().fold([0.0; 2], add);
        }
    });
    let mut sums = vec![[0.0; 2]; values.len()];
    sums.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for row in around(y, height) {
            for (out, value) in out.iter_mut().zip(&rows[row * width..(row + 1) * width]) {
                *out = add(*out, *value);
            }
        }
    });
    sums
}

fn largest_beside(values: &[f32], i: usize, width: usize, height: usize) -> f32 {
    let (x, y) = (i % width, i / width);
    let mut most = 0.0f32;
    for row in y.saturating_sub(1)..(y + 2).min(height) {
        for value in &values[row * width + x.saturating_sub(1)..row * width + (x + 2).min(width)] {
            most = most.max(*value);
        }
    }
    most
}

/// How the picture's error falls: MSE ~ samples^-p, by the last two passes.
pub struct Exponent {
    value: f64,
    last: Option<(f64, f64)>,
}

impl Default for Exponent {
    fn default() -> Self {
        Exponent { value: 1.3, last: None }
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
