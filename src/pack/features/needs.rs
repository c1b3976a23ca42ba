//! What a packed scene uses: a bit mask of modes, a number or yes and no for each entry of the table of features.

use super::{DYNAMIC, TextureSize, UNROLL};
use crate::pack::{PackedScene, Schedule, TextureKind};
use crate::scene::model::{Model, Pattern, PixelFilterKind};
use crate::schema::layout::{self, NO_TEXTURE};
use crate::texture::sampler_spec::Filter;

pub fn bit(mode: u32) -> u32 {
    1 << mode
}

pub fn bits(modes: impl Iterator<Item = u32>) -> u32 {
    modes.fold(0, |mask, mode| mask | bit(mode))
}

/// The number of samples, where positions depend on it: pipelines without it serve any number.
pub fn counted_samples(scene: &PackedScene) -> u32 {
    let [pattern, _, samples, _] = scene.header.sampling;
    if Pattern::ALL[pattern as usize].is_progressive() { 0 } else { samples }
}

/// Shapes that a cone can touch, up to those that it keeps.
pub fn cone_shapes(scene: &PackedScene) -> u32 {
    // Of `fragments.glsl`.
    const MAX_FRAGMENTS: usize = 8;
    let shapes = scene.shape_count();
    if shapes < MAX_FRAGMENTS { shapes.max(1) as u32 } else { DYNAMIC }
}

pub fn unrolled(count: usize) -> u32 {
    if count <= UNROLL { count as u32 } else { DYNAMIC }
}

pub fn rotates(map: &layout::UvProjection) -> bool {
    map.matrix[1] != 0.0 || map.matrix[2] != 0.0
}

pub fn size_kind(texture: &layout::Texture) -> u32 {
    let [_, width, height, _] = texture.place;
    let power = width.is_power_of_two() && height.is_power_of_two();
    if power { TextureSize::PowerOfTwo as u32 } else { TextureSize::Any as u32 }
}

/// Textures that are texels.
pub fn stored(scene: &PackedScene) -> impl Iterator<Item = &layout::Texture> {
    scene.textures.iter().filter(|t| t.link[3] != TextureKind::Procedural as u32)
}

/// Jobs sum in chunks of their own.
pub fn compensates(scene: &PackedScene) -> bool {
    scene.samples > scene.chunk && scene.schedule == Schedule::Tiles
}

/// A box of one pixel leaves samples where they are.
pub fn warps(scene: &PackedScene) -> bool {
    let [kind, radius, _, _] = scene.header.pixel_filter;
    kind != PixelFilterKind::Box as u32 || f32::from_bits(radius) != 0.5
}

fn has_model(scene: &PackedScene, does: fn(Model) -> bool) -> bool {
    scene.materials.iter().any(|m| does(Model::ALL[m.link[0] as usize]))
}

/// Without a footprint, look-ups of procedural textures pass one of zero.
pub fn filters_procedurals(scene: &PackedScene) -> bool {
    !scene.procedurals.is_empty() && scene.prefilters()
}

/// Mirrors and glass, if their rays may go on.
pub fn bounces(scene: &PackedScene) -> bool {
    scene.header.size[3] > 0 && has_model(scene, Model::is_specular)
}

/// Whether look-ups take texels at random.
pub fn chooses(scene: &PackedScene) -> bool {
    let mask = filters(scene);
    Filter::ALL.iter().any(|&f| f.traits().is_random && mask & bit(f as u32) != 0)
}

pub fn filters(scene: &PackedScene) -> u32 {
    bits(scene.samplers.iter().flat_map(|s| [s.modes[2], s.link[1]]))
}

pub fn bump_kinds(scene: &PackedScene) -> u32 {
    bits(scene.materials.iter().filter(|m| m.detail[0] != NO_TEXTURE).map(|m| m.detail[3]))
}

/// A lone flat shape cannot lie between itself and a light.
pub fn casts_shadows(scene: &PackedScene) -> bool {
    let lit = has_model(scene, Model::is_lit);
    !scene.lights.is_empty() && lit && scene.shapes_occlude()
}
