//! Confidence intervals of a slope, or of a ratio of two errors, by the bootstrap (Efron 1979):
//! blocks of pixels are resampled with replacement from squared errors at each number of samples. A
//! resample uses the same blocks at all numbers, so that correlations between them, such as shared
//! first samples of one sequence, are preserved.

use super::fit::least_squares;
use crate::core::film::Film;
use crate::oracle::rng::mix_bits;

/// The blocks along each side of a picture.
const SIDE: u32 = 8;
const DRAWS: u32 = 2000;

/// Returns sums of squared errors over the three channels, of 8 × 8 parts of the picture.
pub fn blocks(film: &Film, reference: &Film) -> Vec<f32> {
    let mut blocks = vec![0f64; (SIDE * SIDE) as usize];
    let part = |at: usize, size: u32| (at as u32 * SIDE / size) as usize;
    for (i, (p, q)) in film.pixels.iter().zip(&reference.pixels).enumerate() {
        let (x, y) = (i % film.width as usize, i / film.width as usize);
        let squared: f64 = p.iter().zip(q).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
        blocks[part(y, film.height) * SIDE as usize + part(x, film.width)] += squared;
    }
    blocks.into_iter().map(|sum| sum as f32).collect()
}

/// Returns the interval of the slope of the logarithm of the blocks' sum over that of the number of
/// samples that contains the fraction `confidence` of all resamples, such as 0.95. `None` if there
/// are fewer than three numbers or blocks.
pub fn interval(points: &[(f64, &[f32])], confidence: f64) -> Option<[f64; 2]> {
    let count = points.iter().map(|p| p.1.len()).min()?;
    if points.len() < 3 || count < 3 {
        return None;
    }
    let mut slopes: Vec<f64> = (0..DRAWS).filter_map(|draw| resampled_slope(points, count, draw)).collect();
    slopes.sort_by(f64::total_cmp);
    (!slopes.is_empty()).then(|| central_part(&slopes, confidence))
}

/// Returns the interval of the ratio of the sum of `a` to that of `b`. `None` without three blocks
/// of each, or if a resample has no error.
pub fn ratio(a: &[f32], b: &[f32], confidence: f64) -> Option<[f64; 2]> {
    if a.len() < 3 || a.len() != b.len() {
        return None;
    }
    let sum = |blocks: &[f32], chosen: &[usize]| chosen.iter().map(|&i| f64::from(blocks[i])).sum::<f64>();
    let of = |draw| {
        let chosen = resample(a.len(), draw);
        Some(sum(a, &chosen) / sum(b, &chosen)).filter(|ratio| ratio.is_finite() && *ratio > 0.0)
    };
    let mut ratios = (0..DRAWS).map(of).collect::<Option<Vec<f64>>>()?;
    ratios.sort_by(f64::total_cmp);
    Some(central_part(&ratios, confidence))
}

/// Returns the interval of the sum of parts, some of which may be below 0. `None` without three of them.
pub fn sum(blocks: &[f32], confidence: f64) -> Option<[f64; 2]> {
    if blocks.len() < 3 {
        return None;
    }
    let of = |draw| resample(blocks.len(), draw).into_iter().map(|i| f64::from(blocks[i])).sum();
    let mut sums: Vec<f64> = (0..DRAWS).map(of).collect();
    sums.sort_by(f64::total_cmp);
    Some(central_part(&sums, confidence))
}

/// Returns the indices of one resample, as many as there are blocks.
fn resample(count: usize, draw: u32) -> Vec<usize> {
    (0..count).map(|k| mix_bits(mix_bits(draw) ^ k as u32) as usize % count).collect()
}

/// Returns the ends of the central part of a non-empty list of sorted values.
fn central_part(sorted: &[f64], confidence: f64) -> [f64; 2] {
    let at = |part: f64| sorted[(part * (sorted.len() as f64 - 1.0)).round() as usize];
    [at(0.5 - 0.5 * confidence), at(0.5 + 0.5 * confidence)]
}

/// Returns the slope of one resample; `None` if all of its blocks are without error.
fn resampled_slope(points: &[(f64, &[f32])], count: usize, draw: u32) -> Option<f64> {
    let chosen = resample(count, draw);
    let sum = |blocks: &[f32]| chosen.iter().map(|&i| f64::from(blocks[i])).sum::<f64>();
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, blocks)| (n.ln(), sum(blocks).ln())).collect();
    logs.iter().all(|p| p.1.is_finite()).then(|| least_squares(&logs).value)
}
