//! How well a slope is known. In: mean squared errors of blocks of pixels, at each number of samples. Out: the
//! interval that the slope of their sum keeps to when blocks are drawn anew, with repetition (Efron 1979). A
//! draw takes the same blocks at all numbers: what they have in common there, such as the first samples of one
//! sequence, tells in no other way.

use super::analysis::least_squares;
use crate::film::Film;
use crate::oracle::rng::mix_bits;

/// Blocks along each side of a picture.
const SIDE: u32 = 8;
const DRAWS: u32 = 2000;

/// Sums of squared errors over the three channels, of 8 × 8 parts of the picture.
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

/// Of the slope of the logarithm of the blocks' sum over that of the number of samples: the middle part of all
/// draws, such as 0.95 of them. None where there are fewer than three numbers or blocks.
pub fn interval(points: &[(f64, &[f32])], confidence: f64) -> Option<[f64; 2]> {
    let count = points.iter().map(|p| p.1.len()).min()?;
    if points.len() < 3 || count < 3 {
        return None;
    }
    let mut slopes: Vec<f64> = (0..DRAWS).filter_map(|draw| drawn(points, count, draw)).collect();
    slopes.sort_by(f64::total_cmp);
    let at = |part: f64| slopes.get((part * (slopes.len() as f64 - 1.0)).round() as usize).copied();
    Some([at(0.5 - 0.5 * confidence)?, at(0.5 + 0.5 * confidence)?])
}

/// None where all blocks that were drawn are without error.
fn drawn(points: &[(f64, &[f32])], count: usize, draw: u32) -> Option<f64> {
    let chosen = (0..count).map(|k| mix_bits(mix_bits(draw) ^ k as u32) as usize % count);
    let chosen: Vec<usize> = chosen.collect();
    let sum = |blocks: &[f32]| chosen.iter().map(|&i| f64::from(blocks[i])).sum::<f64>();
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, blocks)| (n.ln(), sum(blocks).ln())).collect();
    logs.iter().all(|p| p.1.is_finite()).then(|| least_squares(&logs).value)
}
