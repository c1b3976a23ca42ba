//! Packs procedural textures into records of the scene buffer, with the part that is the same for every
//! look-up: the norm of a sum of octaves.

use glam::Vec3;

use crate::schema::layout;
use crate::texture::procedural::Procedural;

pub fn procedural(texture: &Procedural) -> layout::Procedural {
    let [background, figure] = texture.colors.map(Vec3::from_array);
    let octaves = if texture.kind.has_octaves() { texture.octaves } else { 1 };
    // Σ gainᵏ, so that a sum of octaves stays in [-1, 1].
    let norm: f64 = (0..octaves as i32).map(|k| f64::from(texture.gain).powi(k)).sum();
    layout::Procedural {
        background,
        figure,
        width: texture.width.into(),
        aspect: texture.aspect.into(),
        offset: texture.offset.into(),
        jitter: texture.jitter.into(),
        lacunarity: texture.lacunarity,
        gain: texture.gain,
        normalization: (1.0 / norm) as f32,
        distortion: texture.distortion,
        kind: texture.kind,
        seed: texture.seed,
        octaves,
        dimensions: texture.dimensions,
    }
}
