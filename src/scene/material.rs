//! The material of a surface as data: its model, colour and maps, what it emits, and what its alpha means. Part of the
//! model.

use glam::{DAffine2, DVec3};

use super::bsdf::Model;
use super::mapping::Mapping;
use crate::core::named::named_enum;
use crate::schema::enums::{AlphaMode, BumpKind};

named_enum! {
    /// Where the green of a normal map points, along v.
    pub enum Green {
        /// Along growing v.
        Up = "up",
        /// Against it.
        Down = "down",
    }
}

impl BumpKind {
    /// Returns whether it holds normals.
    pub const fn is_normal_map(self) -> bool {
        matches!(self, BumpKind::Normal | BumpKind::NormalDown)
    }
}

/// A texture that turns the shading normal.
#[derive(Clone, Copy, Debug)]
pub struct BumpMap {
    /// The content of the texture.
    pub kind: BumpKind,
    /// Index into `Scene::textures`.
    pub texture: usize,
    /// Normal map: factor of the two components along the surface. Bump map: height of a texel of 1, in
    /// scene units.
    pub strength: f64,
    /// Index into `Scene::samplers`; the material's own where it is left out.
    pub sampler: Option<usize>,
    /// Read at the second texture coordinates of a mesh.
    pub second_uv: bool,
    /// Read at coordinates that no other texture has, in place of either.
    pub own_uv: Option<OwnUv>,
}

/// Coordinates of a mesh at which one texture of a material is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnUv {
    /// Which set of the mesh: 0 is the second.
    pub set: usize,
    /// Applied to these coordinates, v downwards.
    pub transform: DAffine2,
}

/// A texture as a material reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index into `Scene::textures`.
    pub texture: usize,
    /// Index into `Scene::samplers`.
    pub sampler: usize,
    /// Read at the second texture coordinates of a mesh.
    pub second_uv: bool,
    /// Read at coordinates that no other texture has, in place of either.
    pub own_uv: Option<OwnUv>,
}

/// The textures of a material.
#[derive(Clone, Copy, Debug)]
pub struct Maps {
    /// Multiplies the colour.
    pub color: Option<TextureUse>,
    /// Turns the normals.
    pub bump: Option<TextureUse>,
    /// Roughness in green, metallic in blue.
    pub roughness: Option<TextureUse>,
    /// Multiplies the emission.
    pub emission: Option<TextureUse>,
    /// Keeps light of the environment away, in red.
    pub occlusion: Option<TextureUse>,
    /// Multiplies what the surface of a dielectric reflects, in alpha.
    pub specular_weight: Option<TextureUse>,
    /// Multiplies the reflectance of a dielectric head-on.
    pub specular_tint: Option<TextureUse>,
    /// Multiplies the share of light that passes a body, in red.
    pub transmission: Option<TextureUse>,
}

named_enum! {
    /// The sides from which a surface is seen.
    pub enum Sides {
        Both = "both",
        /// Rays that come from behind pass it; shadow rays do not.
        Front = "front",
    }
}

/// The material of a surface.
#[derive(Clone, Debug)]
pub struct Material {
    /// For messages.
    pub name: String,
    /// Its reflection model.
    pub model: Model,
    /// Multiplies the texture.
    pub color: DVec3,
    /// Index into `Scene::textures`.
    pub texture: Option<usize>,
    /// Index into `Scene::samplers`; meaningful where a texture or a bump map is set.
    pub sampler: usize,
    /// The mapping of points of the surface to texture coordinates.
    pub mapping: Mapping,
    /// Whether `texture` is read at the second texture coordinates of a mesh.
    pub second_uv: bool,
    /// A texture that turns its normals.
    pub bump: Option<BumpMap>,
    /// Of `metallic-roughness`, from 0, a dielectric, to 1, a metal.
    pub metallic: f64,
    /// Multiplies roughness by its green and metallic by its blue.
    pub metallic_roughness_map: Option<TextureUse>,
    /// Of `metallic-roughness`: multiplies the reflectance head-on that the refractive index gives a dielectric.
    pub specular_tint: DVec3,
    /// Of `metallic-roughness`: multiplies what the surface of a dielectric reflects, at grazing angles too.
    pub specular_weight: f64,
    /// Multiplies that weight by its alpha.
    pub specular_weight_map: Option<TextureUse>,
    /// Multiplies that tint.
    pub specular_tint_map: Option<TextureUse>,
    /// Of `metallic-roughness`: the share of light in a dielectric's body that passes it, in place of being scattered.
    pub transmission: f64,
    /// Multiplies that share by its red.
    pub transmission_texture: Option<TextureUse>,
    /// Radiance that it emits, whatever its model.
    pub emission: DVec3,
    /// Multiplies the emission.
    pub emission_map: Option<TextureUse>,
    /// In red the share of the environment's light that arrives.
    pub occlusion_map: Option<TextureUse>,
    /// How much of this occlusion is applied, from 0 to 1.
    pub occlusion_strength: f64,
    /// The meaning of the alpha of its texture times `opacity`.
    pub alpha: AlphaMode,
    /// The alpha from which on a mask is solid.
    pub alpha_cutoff: f64,
    /// Multiplies the alpha of the texture.
    pub opacity: f64,
    /// The sides from which it is seen.
    pub sides: Sides,
    /// Colour of the highlight of `phong`.
    pub specular: DVec3,
    /// The highlight's sharpness, of `phong`.
    pub exponent: f64,
    /// Refractive index of `dielectric` and `metallic-roughness` behind the surface, over that in front of it.
    pub ior: f64,
    /// Roughness of `mirror`, `dielectric`, `oren-nayar` and `metallic-roughness`, from 0, which is smooth, to 1.
    pub roughness: f64,
}

impl Default for Material {
    fn default() -> Self {
        Material {
            name: "default".to_owned(),
            model: Model::default(),
            color: DVec3::ONE,
            texture: None,
            sampler: 0,
            mapping: Mapping::default(),
            second_uv: false,
            bump: None,
            metallic: 0.0,
            metallic_roughness_map: None,
            specular_tint: DVec3::ONE,
            specular_weight: 1.0,
            specular_weight_map: None,
            specular_tint_map: None,
            transmission: 0.0,
            transmission_texture: None,
            emission: DVec3::ZERO,
            emission_map: None,
            occlusion_map: None,
            occlusion_strength: 1.0,
            alpha: AlphaMode::Opaque,
            alpha_cutoff: 0.5,
            opacity: 1.0,
            sides: Sides::Both,
            specular: DVec3::splat(0.5),
            exponent: 32.0,
            ior: 1.5,
            roughness: 0.0,
        }
    }
}

impl Material {
    /// Returns true if the material has a texture.
    pub fn is_mapped(&self) -> bool {
        self.textures().next().is_some()
    }

    /// Returns its textures by what they are for, each with its sampler.
    pub fn maps(&self) -> Maps {
        let color =
            |texture| TextureUse { texture, sampler: self.sampler, second_uv: self.second_uv, own_uv: None };
        let bump = |bump: BumpMap| {
            let sampler = bump.sampler.unwrap_or(self.sampler);
            TextureUse { texture: bump.texture, sampler, second_uv: bump.second_uv, own_uv: bump.own_uv }
        };
        Maps {
            color: self.texture.map(color),
            bump: self.bump.map(bump),
            roughness: self.metallic_roughness_map,
            emission: self.emission_map,
            occlusion: self.occlusion_map,
            specular_weight: self.specular_weight_map,
            specular_tint: self.specular_tint_map,
            transmission: self.transmission_texture,
        }
    }

    /// Returns the textures that it reads, each with its sampler.
    pub fn textures(&self) -> impl Iterator<Item = TextureUse> + use<> {
        let maps = self.maps();
        let Maps { color, bump, roughness, emission, occlusion, .. } = maps;
        let body = [maps.specular_weight, maps.specular_tint, maps.transmission];
        [color, bump, roughness, emission, occlusion].into_iter().chain(body).flatten()
    }

    /// Returns the colour of its highlight, or the reflectance head-on of a dielectric surface (Fresnel), which is at most
    /// its weight once a map has multiplied it.
    pub(crate) fn head_on_color(&self) -> DVec3 {
        if !self.model.is_glossy() {
            return self.specular;
        }
        let root = (self.ior - 1.0) / (self.ior + 1.0);
        let tinted = root * root * self.specular_tint;
        let bounded = if self.specular_tint_map.is_some() { tinted } else { tinted.min(DVec3::ONE) };
        bounded * self.specular_weight
    }

    /// Returns the indices of all its textures.
    pub(crate) fn texture_indices_mut(&mut self) -> impl Iterator<Item = &mut usize> {
        let (texture, _, bump, others) = self.readers_mut();
        let others = others.into_iter().flatten().map(|map| &mut map.texture);
        texture.iter_mut().chain(bump.iter_mut().map(|bump| &mut bump.texture)).chain(others)
    }

    /// Returns the indices of all samplers that it names.
    pub(crate) fn sampler_indices_mut(&mut self) -> impl Iterator<Item = &mut usize> {
        let (_, sampler, bump, others) = self.readers_mut();
        let others = others.into_iter().flatten().map(|map| &mut map.sampler);
        let bump = bump.iter_mut().filter_map(|bump| bump.sampler.as_mut());
        std::iter::once(sampler).chain(bump).chain(others)
    }

    /// Returns what reads textures: the colour's texture and its sampler, the bump map, and the other maps.
    fn readers_mut(
        &mut self,
    ) -> (&mut Option<usize>, &mut usize, &mut Option<BumpMap>, [&mut Option<TextureUse>; 6]) {
        let others = [
            &mut self.metallic_roughness_map,
            &mut self.emission_map,
            &mut self.occlusion_map,
            &mut self.specular_weight_map,
            &mut self.specular_tint_map,
            &mut self.transmission_texture,
        ];
        (&mut self.texture, &mut self.sampler, &mut self.bump, others)
    }

    /// Returns true if it mirrors a ray into one of many directions.
    pub fn is_rough_mirror(&self) -> bool {
        self.model.is_mirror() && self.roughness > 0.0
    }

    /// Returns true if rays may pass its surface without being bent.
    pub fn lets_rays_pass(&self) -> bool {
        self.alpha != AlphaMode::Opaque || self.sides == Sides::Front
    }
}
