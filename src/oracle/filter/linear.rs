//! Filter `linear`: the 2 texels around a position along each axis, for 2D textures, volumes and cubes, seamless across
//! edges and corners. Twin of `glsl/shared/filter/linear.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::cube::{cube_texel, is_corner};
use super::levels::Reader;
use crate::oracle::texture::{Level, add_weighted, fetch_or_border, fetch_texel, weighted};

impl Reader<'_> {
    pub(super) fn linear_flat(&self, level: &Level, texel: DVec2) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let row = |y: f64| {
            let left = weighted(1.0 - t.x, self.flat(level, low.x, y));
            add_weighted(t.x, self.flat(level, low.x + 1.0, y), left)
        };
        add_weighted(t.y, row(low.y + 1.0), weighted(1.0 - t.y, row(low.y)))
    }

    pub(super) fn linear_volume(&self, level: &Level, texel: DVec3) -> DVec4 {
        let low = texel.floor();
        let t = texel - low;
        let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        (0..8).map(corner).fold(DVec4::ZERO, |sum, corner| {
            let w = (1.0 - t) * (1.0 - corner) + t * corner;
            let at = (low + corner).to_array().map(|x| x as i64);
            let texel = fetch_or_border(self.scene, self.image, self.how, level, at, 3);
            add_weighted(w.element_product(), texel, sum)
        })
    }

    /// Beyond a corner there is no texel: its weight is divided among the three that meet there.
    pub(super) fn linear_cube(&self, level: &Level, face: u32, texel: DVec2) -> DVec4 {
        let size = level.size[0];
        let low = texel.floor();
        let t = texel - low;
        let mut sum = DVec4::ZERO;
        let mut three = DVec4::ZERO;
        let mut missing = 0.0;
        for k in 0..4 {
            let corner = DVec2::new(f64::from(k & 1), f64::from(k >> 1));
            let w = ((1.0 - t) * (1.0 - corner) + t * corner).element_product();
            let at = (low + corner).to_array().map(|x| x as i64);
            if is_corner(at, size) {
                missing = w;
                continue;
            }
            let value = fetch_texel(self.scene, self.image, level, cube_texel(face, at, size));
            sum = add_weighted(w, value, sum);
            three += value;
        }
        add_weighted(missing / 3.0, three, sum)
    }
}
