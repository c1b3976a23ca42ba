//! Who reads a texture. Input: a scene. Output: the samplers of a texture, by which its format and levels are chosen.

use crate::scene::model::Scene;
use crate::texture::sampler_spec::SamplerSpec;

/// Returns the samplers that read this texture.
pub(super) fn readers(scene: &Scene, texture: usize) -> impl Iterator<Item = &SamplerSpec> {
    let read = scene.materials.iter().flat_map(|m| m.textures()).filter(move |used| used.texture == texture);
    let environment = scene.background.environment.filter(|e| e.texture == texture).map(|e| e.sampler);
    read.map(|used| used.sampler).chain(environment).map(|sampler| &scene.samplers[sampler])
}
