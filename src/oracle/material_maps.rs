//! What a material looks like at a hit, and its maps beside those of its colour and its relief: how each is read, and what
//! it changes. Twin of `glsl/shared/material_maps.glsl`.

use glam::{DVec3, DVec4};

use crate::schema::constants::SECOND_UV_COLOR;
use crate::schema::enums::MaterialMap;
use crate::schema::layout::Material;

/// What a material looks like at a hit.
#[derive(Clone, Copy, Debug)]
pub struct Appearance {
    /// Linear RGB.
    pub color: DVec3,
    pub opacity: f64,
    pub metallic: f64,
    pub roughness: f64,
    pub emission: DVec3,
    /// Share of the environment's light that arrives.
    pub occlusion: f64,
    /// Reflectance of a dielectric surface head-on.
    pub dielectric: DVec3,
    /// And at grazing angles.
    pub edge: f64,
    /// Share of the light in a body that passes it.
    pub transmission: f64,
}

/// A texture as a material reads it.
pub struct TextureUse {
    pub texture_index: u32,
    pub sampler_index: u32,
    /// The bit of `Material::second_uv_maps`.
    pub second_uv: u32,
}

/// Returns how a map is read; that of the mask is the colour's texture.
pub fn use_of(material: &Material, map: MaterialMap) -> TextureUse {
    let m = material;
    let [texture_index, sampler_index, second_uv] = match map {
        MaterialMap::Roughness => {
            [m.roughness_texture_index, m.roughness_sampler_index, 1 << MaterialMap::Roughness as u32]
        }
        MaterialMap::Emission => {
            [m.emission_texture_index, m.emission_sampler_index, 1 << MaterialMap::Emission as u32]
        }
        MaterialMap::Occlusion => {
            [m.occlusion_texture_index, m.occlusion_sampler_index, 1 << MaterialMap::Occlusion as u32]
        }
        MaterialMap::Mask => [m.texture_index, m.sampler_index, SECOND_UV_COLOR],
        MaterialMap::SpecularWeight => {
            let bit = 1 << MaterialMap::SpecularWeight as u32;
            [m.specular_weight_texture_index, m.specular_weight_sampler_index, bit]
        }
        MaterialMap::SpecularTint => {
            let bit = 1 << MaterialMap::SpecularTint as u32;
            [m.specular_tint_texture_index, m.specular_tint_sampler_index, bit]
        }
        MaterialMap::Transmission => {
            let bit = 1 << MaterialMap::Transmission as u32;
            [m.transmission_texture_index, m.transmission_sampler_index, bit]
        }
    };
    TextureUse { texture_index, sampler_index, second_uv }
}

/// Applies what was read of a map other than the mask.
pub fn apply_map(map: MaterialMap, texel: DVec4, material: &Material, look: &mut Appearance) {
    match map {
        MaterialMap::Roughness => {
            look.roughness *= texel.y;
            look.metallic *= texel.z;
        }
        MaterialMap::Emission => look.emission *= texel.truncate(),
        MaterialMap::Occlusion => {
            look.occlusion = 1.0 + f64::from(material.occlusion_strength) * (texel.x - 1.0);
        }
        MaterialMap::SpecularWeight => {
            look.dielectric *= texel.w;
            look.edge *= texel.w;
        }
        // After the weight, which bounds it: the order is that of the maps.
        MaterialMap::SpecularTint => {
            look.dielectric = (look.dielectric * texel.truncate()).min(DVec3::splat(look.edge));
        }
        MaterialMap::Transmission => look.transmission *= texel.x,
        MaterialMap::Mask => {}
    }
}
