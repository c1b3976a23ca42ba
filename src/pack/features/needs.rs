//! The features that a packed scene uses: a bit mask of modes, a count or a flag for each entry of the table of
//! features.

use super::UNROLL;
use crate::pack::{PackedScene, Schedule, TextureKind};
use crate::scene::model::{Model, PixelFilterKind};
use crate::schema::constants::{DYNAMIC, MAX_CONE_FRAGMENTS};
use crate::schema::enums::{AlphaMode, MaterialMap, Quantity, TextureSize};
use crate::schema::layout::{self, NO_TEXTURE};
use crate::texture::sampler_spec::Filter;

pub fn bit(mode: u32) -> u32 {
    1 << mode
}

pub fn bits(modes: impl Iterator<Item = u32>) -> u32 {
    modes.fold(0, |mask, mode| mask | bit(mode))
}

/// Returns the number of samples if positions depend on it: other pipelines serve any number.
pub fn counted_samples(scene: &PackedScene) -> u32 {
    if scene.header.pattern.is_progressive() { 0 } else { scene.header.samples }
}

/// Returns the number of shapes that a cone can meet, up to those that it keeps.
pub fn cone_shapes(scene: &PackedScene) -> u32 {
    let shapes = scene.shape_count();
    if shapes < MAX_CONE_FRAGMENTS as usize { shapes.max(1) as u32 } else { DYNAMIC }
}

pub fn unrolled(count: usize) -> u32 {
    if count <= UNROLL { count as u32 } else { DYNAMIC }
}

pub fn rotates(map: &layout::UvProjection) -> bool {
    map.m01 != 0.0 || map.m10 != 0.0
}

pub fn size_kind(texture: &layout::Texture) -> u32 {
    let power = texture.size.x.is_power_of_two() && texture.size.y.is_power_of_two();
    if power { TextureSize::PowerOfTwo as u32 } else { TextureSize::Any as u32 }
}

/// Returns the textures that consist of texels.
pub fn stored(scene: &PackedScene) -> impl Iterator<Item = &layout::Texture> {
    scene.records.textures.iter().filter(|t| t.kind != TextureKind::Procedural)
}

/// Returns true if the film has compensation; batches are split into short sums instead.
pub fn compensates(scene: &PackedScene) -> bool {
    scene.samples > scene.samples_at_once && scene.schedule == Schedule::Tiles
}

/// Returns true if samples are moved, which a box of one pixel does not do.
pub fn warps(scene: &PackedScene) -> bool {
    scene.header.pixel_filter != PixelFilterKind::Box || scene.header.filter_radius != 0.5
}

/// Returns the quantities of the pipeline that measures one. Those that read no texels share one; radiance is never
/// together with others, so that its pipelines have no trace of them.
pub fn quantities(quantity: Quantity) -> u32 {
    let reads_texels = |q: &Quantity| matches!(q, Quantity::Radiance | Quantity::Albedo | Quantity::Normal);
    if reads_texels(&quantity) {
        return bit(quantity as u32);
    }
    bits(Quantity::ALL.iter().filter(|q| !reads_texels(q)).map(|&q| q as u32))
}

fn has_model(scene: &PackedScene, does: fn(Model) -> bool) -> bool {
    scene.records.materials.iter().any(|m| does(m.model))
}

/// Returns true with a footprint; otherwise, look-ups of procedural textures have one of zero.
pub fn filters_procedurals(scene: &PackedScene) -> bool {
    !scene.records.procedurals.is_empty() && scene.prefilters()
}

/// Returns true if rays may continue: by reflection or refraction, or straight through surfaces that let them pass.
pub fn bounces(scene: &PackedScene) -> bool {
    bends_rays(scene) || lets_rays_pass(scene)
}

/// Returns true if rays may continue by mirrors or glass, or by surfaces that reflect what is around them.
pub fn bends_rays(scene: &PackedScene) -> bool {
    let goes_on = has_model(scene, |model| model.is_specular() || model.is_glossy())
        || scene.header.environment_rows > 0;
    scene.header.max_depth > 0 && goes_on
}

/// Returns true if some material lets rays pass.
pub fn lets_rays_pass(scene: &PackedScene) -> bool {
    scene.has_one_sided_shapes() || scene.records.materials.iter().any(|m| m.alpha_mode != AlphaMode::Opaque)
}

/// Returns the maps that materials have beside those of colour and relief.
pub fn material_maps(scene: &PackedScene) -> u32 {
    let of = |map: MaterialMap, has: fn(&layout::Material) -> bool| {
        if scene.records.materials.iter().any(has) { bit(map as u32) } else { 0 }
    };
    of(MaterialMap::Roughness, |m| m.roughness_texture_index != NO_TEXTURE)
        | of(MaterialMap::Emission, |m| m.emission_texture_index != NO_TEXTURE)
        | of(MaterialMap::Occlusion, |m| m.occlusion_texture_index != NO_TEXTURE)
        | of(MaterialMap::Mask, |m| m.alpha_mode == AlphaMode::Mask && m.texture_index != NO_TEXTURE)
        | of(MaterialMap::SpecularWeight, |m| m.specular_weight_texture_index != NO_TEXTURE)
        | of(MaterialMap::SpecularTint, |m| m.specular_tint_texture_index != NO_TEXTURE)
        | of(MaterialMap::Transmission, |m| m.transmission_texture_index != NO_TEXTURE)
}

/// Returns true if some look-ups select texels at random.
pub fn chooses(scene: &PackedScene) -> bool {
    let mask = filters(scene);
    // Some rays pass by chance.
    let blends = scene.records.materials.iter().any(|m| m.alpha_mode == AlphaMode::Blend);
    let continues =
        blends && scene.header.max_depth > 0 && has_model(scene, |m| m.is_specular() || m.is_glossy());
    let by_chance = continues || blends && scene.header.environment_rows > 0;
    by_chance || Filter::ALL.iter().any(|&f| f.traits().is_random && mask & bit(f as u32) != 0)
}

pub fn filters(scene: &PackedScene) -> u32 {
    bits(scene.records.samplers.iter().flat_map(|s| [s.mag_filter as u32, s.min_filter as u32]))
}

pub fn bump_kinds(scene: &PackedScene) -> u32 {
    bits(
        scene
            .records
            .materials
            .iter()
            .filter(|m| m.bump_texture_index != NO_TEXTURE)
            .map(|m| m.bump_kind as u32),
    )
}

/// Returns true if rough mirrors reflect an environment whose light is sampled.
pub fn mirrors_environment(scene: &PackedScene) -> bool {
    let is_rough_mirror = |m: &layout::Material| m.model.is_mirror() && m.alpha > 0.0;
    scene.header.environment_rows > 0
        && scene.header.max_depth > 0
        && scene.records.materials.iter().any(is_rough_mirror)
}

/// Returns true if shapes can occlude lights; a single flat shape cannot occlude itself.
pub fn casts_shadows(scene: &PackedScene) -> bool {
    let lit = has_model(scene, Model::is_lit) || mirrors_environment(scene);
    !scene.records.lights.is_empty() && lit && scene.shapes_occlude()
}
