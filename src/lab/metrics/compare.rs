//! Error measures between two films, over all pixels and three channels in f64: MSE = Σ(a−b)²/3N,
//! RMSE = √MSE, relative MSE = Σ(a−b)²/(b²+0.01)/3N, PSNR = −10·log10(MSE) for a peak of 1, all in
//! linear light; "over 1/255" is measured on clipped sRGB-encoded values, where a step of an 8-bit
//! file is about the smallest visible difference.

use serde::Serialize;

use crate::core::color::linear_to_srgb;
use crate::core::error::{Error, Result};
use crate::core::film::Film;

/// The tolerance for differences of exactly one 8-bit step, which must not count as more: both
/// values were rounded to f32 in linear light with a relative error of at most 2⁻²⁴, which is at
/// most 2.7e-8 after encoding.
const ENCODED_TOLERANCE: f64 = 1e-7;
const STEP: f64 = 1.0 / 255.0;
/// Keeps the relative error of black finite (Rousselle et al. 2011).
const RELATIVE_FLOOR: f64 = 0.01;
/// The largest slope of the sRGB encoding.
const SLOPE: f64 = 12.92;

/// The measures of a comparison. Undefined values (PSNR of equal pictures, means without a
/// comparable pixel) and non-finite ones are `null` in JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    pub width: u32,
    pub height: u32,
    /// The RMSE over the pixels that are not NaN in either picture, like the other means.
    pub rmse: f64,
    pub mse: f64,
    /// The mean of (a − b)² / (b² + 0.01), where b is the reference.
    pub relative_mse: f64,
    /// The largest difference of one channel; `max_at` is the first pixel that has it.
    pub max: f64,
    pub max_at: Option<[u32; 2]>,
    /// In decibels; infinite if the pictures are equal.
    pub psnr: f64,
    /// The fraction of all pixels, in [0, 1], with a channel that differs by more than 1/255 once
    /// sRGB-encoded; NaN pixels are included.
    pub over_1_255: f64,
    pub over_1_255_pixels: u64,
    /// The largest difference of one clipped, sRGB-encoded channel.
    pub max_encoded: f64,
    /// The number of pixels with a NaN in either picture.
    pub nan_pixels: u64,
}

impl Comparison {
    /// Returns true if the pictures agree within `bound`, if there is one. A NaN or an infinite
    /// difference never passes.
    pub fn passes(&self, bound: Option<f64>) -> bool {
        self.nan_pixels == 0 && self.rmse.is_finite() && bound.is_none_or(|b| self.rmse <= b)
    }
}

pub(super) fn check_sizes(a: &Film, b: &Film) -> Result<()> {
    if (a.width, a.height) == (b.width, b.height) {
        return Ok(());
    }
    Err(Error::with_help(
        format!("the pictures differ in size: {}×{} and {}×{}", a.width, a.height, b.width, b.height),
        "only pictures of the same size can be compared",
    ))
}

pub fn compare(a: &Film, b: &Film) -> Result<Comparison> {
    check_sizes(a, b)?;
    let (mut sum, mut relative_sum) = (0.0, 0.0);
    let (mut max, mut max_at) = (0.0, None);
    let (mut over, mut max_encoded, mut nan_pixels) = (0u64, 0.0f64, 0u64);
    let rows = a.pixels.chunks(a.width.max(1) as usize).zip(b.pixels.chunks(b.width.max(1) as usize));
    for (y, (row_a, row_b)) in rows.enumerate() {
        let (mut row_sum, mut row_relative) = (0.0, 0.0);
        for (x, (&p, &q)) in row_a.iter().zip(row_b).enumerate() {
            let Some(differences) = differences(p, q) else {
                nan_pixels += 1;
                over += 1;
                continue;
            };
            let largest = differences.into_iter().fold(0.0, f64::max);
            let squares = differences.map(|d| d * d);
            row_sum += squares.iter().sum::<f64>();
            row_relative +=
                squares.iter().zip(q).map(|(s, q)| s / (f64::from(q).powi(2) + RELATIVE_FLOOR)).sum::<f64>();
            if largest > max {
                (max, max_at) = (largest, Some([x as u32, y as u32]));
            }
            // Powers are computed only where they could change the result.
            if largest * SLOPE > STEP.min(max_encoded) {
                let encoded = encoded_difference(p, q);
                max_encoded = max_encoded.max(encoded);
                over += u64::from(encoded > STEP + ENCODED_TOLERANCE);
            }
        }
        sum += row_sum;
        relative_sum += row_relative;
    }
    let pixels = a.pixels.len() as u64;
    let values = (3 * (pixels - nan_pixels)) as f64;
    let mse = sum / values;
    Ok(Comparison {
        width: a.width,
        height: a.height,
        rmse: mse.sqrt(),
        mse,
        relative_mse: relative_sum / values,
        max,
        max_at,
        psnr: -10.0 * mse.log10(),
        over_1_255: over as f64 / pixels as f64,
        over_1_255_pixels: over,
        max_encoded,
        nan_pixels,
    })
}

/// Returns |a − b| by channel, where equal infinities differ by 0, or `None` if a NaN is involved.
pub(super) fn differences(a: [f32; 3], b: [f32; 3]) -> Option<[f64; 3]> {
    if a.iter().chain(&b).any(|v| v.is_nan()) {
        return None;
    }
    let one = |i: usize| if a[i] == b[i] { 0.0 } else { (f64::from(a[i]) - f64::from(b[i])).abs() };
    Some([one(0), one(1), one(2)])
}

fn encoded_difference(a: [f32; 3], b: [f32; 3]) -> f64 {
    let encode = |v: f32| linear_to_srgb(f64::from(v).clamp(0.0, 1.0));
    a.iter().zip(b).map(|(&a, b)| (encode(a) - encode(b)).abs()).fold(0.0, f64::max)
}
