//! The value at a position of one level by one filter. Twin of `glsl/shared/filter/levels.glsl`.

use glam::{DVec3, DVec4};

use super::kernels::has_kernel;
use super::stochastic::stochastic_place;
use crate::oracle::address::reduced_coordinate;
use crate::oracle::footprint_axes::kind_of;
use crate::oracle::texture::{Level, addresses, flat_texel};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Filter, TexelCenter};

/// The inputs of a look-up in one level.
pub struct Reader<'a> {
    pub scene: &'a PackedScene,
    pub image: &'a Texture,
    pub how: &'a Sampler,
}

impl Reader<'_> {
    pub fn flat(&self, level: &Level, x: f64, y: f64) -> DVec4 {
        flat_texel(self.scene, self.image, self.how, level, [x as i64, y as i64])
    }

    /// Returns the value at a position of one level by one filter; `dice` in [0, 1) are for the stochastic
    /// one.
    pub fn level(&self, filter: Filter, level: &Level, at: DVec3, face: u32, dice: DVec3) -> DVec4 {
        let kind = kind_of(self.image);
        let size = DVec3::from_array(level.size.map(|n| n as f64));
        let mut texel = if kind == TextureKind::Cube {
            at * size.x
        } else {
            let [u, v, w] = addresses(self.how);
            let integer_centers = self.how.texel_center == TexelCenter::Integer;
            let depth = if kind == TextureKind::Volume { reduced_coordinate(w, at.z, size.z) } else { 0.0 };
            DVec3::new(reduced_coordinate(u, at.x, size.x), reduced_coordinate(v, at.y, size.y), depth)
                + if integer_centers { 0.5 } else { 0.0 }
        };
        let chosen = filter == Filter::Stochastic;
        if chosen {
            texel = stochastic_place(texel, dice);
        }
        if chosen || filter == Filter::Nearest {
            return self.nearest(kind, level, texel, face, dice.z, !chosen);
        }
        let texel = texel - 0.5;
        match kind {
            TextureKind::Cube => self.linear_cube(level, face, texel.truncate()),
            TextureKind::Volume => self.linear_volume(level, texel),
            TextureKind::Flat | TextureKind::Procedural if has_kernel(filter) => {
                self.kernel_flat(filter, level, texel.truncate())
            }
            TextureKind::Flat | TextureKind::Procedural => self.linear_flat(level, texel.truncate()),
        }
    }
}
