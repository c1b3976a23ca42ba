//! Procedural textures → records of the scene buffer, with what is the same for every look-up
//! worked out: the norm of a sum of octaves.

use crate::schema::layout;
use crate::texture::procedural::Procedural;

pub fn procedural(texture: &Procedural) -> layout::Procedural {
    let [background, figure] = texture.colors.map(|[r, g, b]| [r, g, b, 0.0]);
    let octaves = if texture.kind.has_octaves() { texture.octaves } else { 1 };
    // Σ gainᵏ, so that a sum of octaves stays in [-1, 1].
    let norm: f64 = (0..octaves as i32).map(|k| f64::from(texture.gain).powi(k)).sum();
    layout::Procedural {
        background,
        figure,
        shape: [texture.width, texture.aspect, texture.offset, texture.jitter].map(f64::from),
        octaves: [texture.lacunarity, texture.gain, (1.0 / norm) as f32, texture.distortion],
        link: [texture.kind as u32, texture.seed, octaves, texture.dimensions],
    }
}
