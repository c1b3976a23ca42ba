//! The difference picture of two films: |a − b| by channel in linear light, scaled so that the
//! largest difference becomes 1. Equal pictures give black; a pixel with a NaN in either is
//! magenta.

use super::compare::{Comparison, compare, differences};
use crate::core::error::Result;
use crate::core::film::Film;

const NAN_PIXEL: [f32; 3] = [1.0, 0.0, 1.0];

/// Returns the difference picture. Multiplying it by [`Comparison::max`] gives the absolute
/// differences.
pub fn difference_picture(a: &Film, b: &Film) -> Result<Film> {
    scaled(a, b, &compare(a, b)?)
}

/// Returns the difference picture for a comparison of the same films that is already known.
pub fn scaled(a: &Film, b: &Film, comparison: &Comparison) -> Result<Film> {
    let scale = if comparison.max > 0.0 { comparison.max.recip() } else { 0.0 };
    let pixel = |(&p, &q)| match differences(p, q) {
        // An infinite difference makes every finite one vanish relative to it.
        Some(d) => d.map(|d| if d.is_infinite() { 1.0 } else { (d * scale) as f32 }),
        None => NAN_PIXEL,
    };
    Ok(Film {
        width: a.width,
        height: a.height,
        pixels: a.pixels.iter().zip(&b.pixels).map(pixel).collect(),
        samples: 0,
    })
}
