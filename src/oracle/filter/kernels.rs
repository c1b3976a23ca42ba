//! Filters by a kernel wider than that of `linear`, the same along both axes of a 2D texture: `cubic`, 4 by 4 texels
//! (Mitchell & Netravali 1988), and `lanczos-2` and `lanczos-3`, twice the radius (Duchon 1979). Twin of
//! `glsl/shared/filter/kernels.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec4};

use super::levels::Reader;
use crate::oracle::texture::{Level, add_weighted};
use crate::schema::layout::Sampler;
use crate::texture::sampler_spec::Filter;

/// Returns the weights of the four texels around a position t between the middle two (Mitchell & Netravali 1988).
pub fn cubic_weights(t: f64, b: f64, c: f64) -> [f64; 4] {
    let r = 1.0 - t;
    let outer = |near: f64, far: f64| near * near * (b / 6.0 * near - c * far);
    let inner = |t: f64| 1.0 - b / 3.0 + t * t * ((-3.0 + 2.0 * b + c) + (2.0 - 1.5 * b - c) * t);
    [outer(r, t), inner(t), inner(r), outer(t, r)]
}

/// Returns sinc(x) sinc(x / radius).
fn lanczos_weight(x: f64, radius: f64) -> f64 {
    let sinc = |x: f64| if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) };
    sinc(x) * sinc(x / radius)
}

/// Returns the weights of the texels around a position t between the middle two, normalised to a sum of 1, which a
/// windowed sinc does not have by itself.
pub fn lanczos_weights(t: f64, radius: u32) -> Vec<f64> {
    let before = t + f64::from(radius) - 1.0;
    let weights: Vec<f64> =
        (0..2 * radius).map(|i| lanczos_weight(before - f64::from(i), f64::from(radius))).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|w| w / sum).collect()
}

/// Returns true if a filter has such a kernel.
pub fn has_kernel(filter: Filter) -> bool {
    matches!(filter, Filter::Cubic | Filter::Lanczos2 | Filter::Lanczos3)
}

/// Returns the weight of each texel along an axis.
fn kernel_weights(filter: Filter, how: &Sampler, t: f64) -> Vec<f64> {
    let [b, c] = [how.cubic_b, how.cubic_c].map(f64::from);
    match filter {
        Filter::Cubic => cubic_weights(t, b, c).to_vec(),
        Filter::Lanczos2 => lanczos_weights(t, 2),
        Filter::Lanczos3 => lanczos_weights(t, 3),
        _ => vec![0.0, 1.0],
    }
}

impl Reader<'_> {
    pub(super) fn kernel_flat(&self, filter: Filter, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let [wx, wy] = [t.x, t.y].map(|t| kernel_weights(filter, self.how, t));
        let first = low - (wx.len() / 2 - 1) as f64;
        let mut sum = DVec4::ZERO;
        for (j, wy) in wy.iter().enumerate() {
            for (i, wx) in wx.iter().enumerate() {
                let texel = self.flat(level, first.x + i as f64, first.y + j as f64);
                sum = add_weighted(wx * wy, texel, sum);
            }
        }
        sum
    }
}
