//! The sample dimensions that a scene uses beside the position in the pixel, and the lens and shutter of the
//! header.

use super::SampleDimension;
use crate::scene::model::Scene;

/// Returns one bit for each sample dimension in use, beside the position in the pixel.
pub fn sample_dimensions(scene: &Scene) -> u32 {
    let of = |choice: &SampleDimension| match choice {
        SampleDimension::Lens => scene.camera.lens.is_some(),
        SampleDimension::Time => scene.moves(),
        SampleDimension::Lobe => scene.sampling.max_depth > 0 && (scene.is_glossy() || scene.scatters()),
        SampleDimension::Light => scene.has_wide_lights(),
        SampleDimension::Fresnel => {
            scene.sampling.max_depth > 0 && scene.materials.iter().any(|m| m.model.transmits())
        }
    };
    SampleDimension::ALL.iter().filter(|c| of(c)).fold(0, |bits, &choice| bits | 1 << choice as u32)
}

/// Returns the lens radius over a pixel's side at distance 1; 1 / focus distance; when the shutter opens, and
/// for how long.
pub fn lens(scene: &Scene, pixel: f64) -> [f32; 4] {
    let [opens, closes] = scene.camera.shutter;
    let lens = scene.camera.lens.map_or([0.0; 2], |l| [l.radius / pixel, 1.0 / l.focus_distance]);
    [lens[0], lens[1], opens, closes - opens].map(|x| x as f32)
}
