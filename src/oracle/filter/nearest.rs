//! Filter `nearest`: the texel that contains a position. Twin of `glsl/shared/filter/nearest.glsl`.

use glam::{DVec3, DVec4};

use super::cube::{cube_texel, is_corner};
use super::levels::Reader;
use crate::oracle::texture::{Level, fetch_or_border, fetch_texel, flat_texel};
use crate::pack::TextureKind;

impl Reader<'_> {
    /// Returns the texel that contains a position. With `stays`, a position on the far edge of a cube's face belongs to
    /// the face that the direction selects; otherwise one beyond a corner is one of the three texels there, by `dice`
    /// in [0, 1).
    pub(super) fn nearest(
        &self,
        kind: TextureKind,
        level: &Level,
        place: DVec3,
        face: u32,
        dice: f64,
        stays: bool,
    ) -> DVec4 {
        let mut at = place.floor().to_array().map(|x| x as i64);
        if stays && kind == TextureKind::Cube {
            at = at.map(|n| n.min(level.size[0] - 1));
        }
        match kind {
            TextureKind::Cube => {
                let size = level.size[0];
                let [mut x, mut y, _] = at;
                // Beyond a corner: one of the three texels there.
                if is_corner([x, y], size) {
                    let inside = |n: i64| n.clamp(0, size - 1);
                    (x, y) = match dice {
                        d if d < 1.0 / 3.0 => (inside(x), y),
                        d if d < 2.0 / 3.0 => (x, inside(y)),
                        _ => (inside(x), inside(y)),
                    };
                }
                fetch_texel(self.scene, self.image, level, cube_texel(face, [x, y], size))
            }
            TextureKind::Flat | TextureKind::Procedural => {
                flat_texel(self.scene, self.image, self.how, level, [at[0], at[1]])
            }
            TextureKind::Volume => fetch_or_border(self.scene, self.image, self.how, level, at, 3),
        }
    }
}
