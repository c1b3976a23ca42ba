//! Helpers around `moire::internal::lab::verify` for lookup tests: failures end the test, random directions,
//! and the list of all formats.

use glam::DVec3;
use moire::internal::lab::verify::queries;
pub use moire::internal::lab::verify::queries::{Rng, coordinates, query, texture, uv_of};
use moire::internal::pack::PackedScene;
use moire::internal::texture::data::{ColorSpace, Component, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Filter, SamplerSpec};

/// Magnifying filters that are not random.
pub const CERTAIN: [Filter; 3] = [Filter::Nearest, Filter::Linear, Filter::Cubic];
/// Those of texture units.
pub const BASIC: [Filter; 2] = [Filter::Nearest, Filter::Linear];

/// Random vectors.
pub trait Vectors {
    fn vector(&mut self, reach: f64) -> DVec3;
    fn direction(&mut self) -> DVec3;
}

impl Vectors for Rng {
    fn vector(&mut self, reach: f64) -> DVec3 {
        DVec3::new(self.between(-reach, reach), self.between(-reach, reach), self.between(-reach, reach))
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if (0.01..=1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// A scene without shapes whose materials are these (texture, sampler) pairs.
pub fn pairs(textures: Vec<TextureData>, samplers: &[SamplerSpec], pairs: &[(usize, usize)]) -> PackedScene {
    queries::pairs(textures, samplers, pairs).unwrap()
}

/// The nine formats in linear space and the integer ones in sRGB.
pub fn formats() -> Vec<(TexelFormat, ColorSpace)> {
    let linear = TexelFormat::ALL.iter().map(|&f| (f, ColorSpace::Linear));
    let integer = TexelFormat::ALL.iter().filter(|f| f.component() != Component::Float32);
    linear.chain(integer.map(|&f| (f, ColorSpace::Srgb))).collect()
}
