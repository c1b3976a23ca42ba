//! Filter `cubic`: 4 by 4 texels (Mitchell & Netravali 1988). Twin of `glsl/shared/filter/cubic.glsl`.

use glam::{DVec2, DVec4};

use super::levels::Reader;
use crate::oracle::texture::{Level, add_weighted};

/// Weights of the four texels around a place t between the middle two (Mitchell & Netravali 1988).
pub fn cubic_weights(t: f64, b: f64, c: f64) -> [f64; 4] {
    let r = 1.0 - t;
    let outer = |near: f64, far: f64| near * near * (b / 6.0 * near - c * far);
    let inner = |t: f64| 1.0 - b / 3.0 + t * t * ((-3.0 + 2.0 * b + c) + (2.0 - 1.5 * b - c) * t);
    [outer(r, t), inner(t), inner(r), outer(t, r)]
}

impl Reader<'_> {
    pub(super) fn cubic_flat(&self, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let [b, c] = [self.how.more[2], self.how.more[3]].map(|bits| f64::from(f32::from_bits(bits)));
        let (wx, wy) = (cubic_weights(t.x, b, c), cubic_weights(t.y, b, c));
        let mut sum = DVec4::ZERO;
        for (j, wy) in wy.into_iter().enumerate() {
            for (i, wx) in wx.into_iter().enumerate() {
                let texel = self.flat(level, low.x - 1.0 + i as f64, low.y - 1.0 + j as f64);
                sum = add_weighted(wx * wy, texel, sum);
            }
        }
        sum
    }
}
