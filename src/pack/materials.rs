//! Packs materials into device records, with the image descriptors of their textures.

use super::{PackedScene, textures};
use crate::scene::model::{BumpKind, Material, OwnUv, Sides, TextureUse};
use crate::schema::constants::{SECOND_UV_BUMP, SECOND_UV_COLOR};
use crate::schema::enums::MaterialMap;
use crate::schema::layout;

/// A texture of a material as records name it: its index or `NO_TEXTURE`, sampler, and image descriptor.
#[derive(Clone, Copy)]
struct Use {
    texture: u32,
    sampler: u32,
    slot: u32,
}

pub(super) fn material(packed: &mut PackedScene, source: &Material) -> layout::Material {
    let mut used = |found: Option<TextureUse>| match found {
        Some(TextureUse { texture, sampler, .. }) => Use {
            texture: texture as u32,
            sampler: sampler as u32,
            slot: textures::slot(packed, texture, sampler),
        },
        None => Use { texture: layout::NO_TEXTURE, sampler: source.sampler as u32, slot: 0 },
    };
    let maps = source.maps();
    let color = used(maps.color);
    let bump_map = used(maps.bump);
    let [roughness, emission, occlusion] = [maps.roughness, maps.emission, maps.occlusion].map(&mut used);
    let [specular_weight, specular_tint, transmission] =
        [maps.specular_weight, maps.specular_tint, maps.transmission].map(used);
    let bump = source.bump;
    let second =
        |map: Option<TextureUse>, bit: u32| if map.is_some_and(|map| map.second_uv) { bit } else { 0 };
    let of = |map: MaterialMap| 1 << map as u32;
    let own = [
        (of(MaterialMap::Roughness), maps.roughness),
        (of(MaterialMap::Emission), maps.emission),
        (of(MaterialMap::Occlusion), maps.occlusion),
        (of(MaterialMap::SpecularWeight), maps.specular_weight),
        (of(MaterialMap::SpecularTint), maps.specular_tint),
        (of(MaterialMap::Transmission), maps.transmission),
        (SECOND_UV_COLOR, maps.color),
        (SECOND_UV_BUMP, maps.bump),
    ];
    let first_map_uv = packed.records.map_uvs.len() as u32;
    let own_uv_maps = own_uvs(packed, own);
    layout::Material {
        color: source.color.as_vec3(),
        bump_strength: bump.map_or(0.0, |r| r.strength) as f32,
        model: source.model,
        texture_index: color.texture,
        sampler_index: color.sampler,
        image_slot: color.slot,
        bump_texture_index: bump_map.texture,
        bump_sampler_index: bump_map.sampler,
        bump_image_slot: bump_map.slot,
        bump_kind: bump.map_or(BumpKind::default(), |r| r.kind),
        alpha: source.roughness.powi(2) as f32,
        roughness: source.roughness as f32,
        metallic: source.metallic as f32,
        roughness_texture_index: roughness.texture,
        roughness_sampler_index: roughness.sampler,
        roughness_image_slot: roughness.slot,
        emission_texture_index: emission.texture,
        emission_sampler_index: emission.sampler,
        emission_image_slot: emission.slot,
        emission: source.emission.as_vec3(),
        occlusion_strength: source.occlusion_strength as f32,
        occlusion_texture_index: occlusion.texture,
        occlusion_sampler_index: occlusion.sampler,
        occlusion_image_slot: occlusion.slot,
        second_uv_maps: second(maps.color, SECOND_UV_COLOR)
            | second(maps.bump, SECOND_UV_BUMP)
            | second(maps.roughness, of(MaterialMap::Roughness))
            | second(maps.emission, of(MaterialMap::Emission))
            | second(maps.occlusion, of(MaterialMap::Occlusion))
            | second(maps.specular_weight, of(MaterialMap::SpecularWeight))
            | second(maps.specular_tint, of(MaterialMap::SpecularTint))
            | second(maps.transmission, of(MaterialMap::Transmission)),
        own_uv_maps,
        first_map_uv,
        alpha_mode: source.alpha,
        alpha_cutoff: source.alpha_cutoff as f32,
        opacity: source.opacity as f32,
        one_sided: source.sides == Sides::Front,
        transmission: source.transmission as f32,
        specular: source.head_on_color().as_vec3(),
        edge: source.specular_weight as f32,
        exponent: source.exponent as f32,
        ior: source.ior as f32,
        specular_weight_texture_index: specular_weight.texture,
        specular_weight_sampler_index: specular_weight.sampler,
        specular_weight_image_slot: specular_weight.slot,
        specular_tint_texture_index: specular_tint.texture,
        specular_tint_sampler_index: specular_tint.sampler,
        specular_tint_image_slot: specular_tint.slot,
        transmission_texture_index: transmission.texture,
        transmission_sampler_index: transmission.sampler,
        transmission_image_slot: transmission.slot,
    }
}

/// Adds the coordinates that maps have for themselves, in the order of their bits; returns the bits of these maps.
fn own_uvs<const N: usize>(packed: &mut PackedScene, mut maps: [(u32, Option<TextureUse>); N]) -> u32 {
    maps.sort_unstable_by_key(|(bit, _)| *bit);
    let mut bits = 0;
    for (bit, map) in maps {
        let Some(OwnUv { set, transform }) = map.and_then(|map| map.own_uv) else { continue };
        bits |= bit;
        packed.records.map_uvs.push(layout::MapUv {
            row_u: transform.matrix2.row(0),
            row_v: transform.matrix2.row(1),
            offset: transform.translation,
            set: set as u32,
        });
    }
    bits
}
