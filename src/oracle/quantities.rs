//! The first hit of a camera ray → one of its properties in place of radiance: up to two numbers and 1, or a vector; zero
//! where the ray meets nothing that has the property. Twin of `glsl/shared/quantities.glsl`.

use glam::{DVec2, DVec3};

use super::appearance::{appearance, at_uv_of, bumped_normal, map_input};
use super::camera::Ray;
use super::filter::sample_texture::read_level;
use super::footprint::{Footprint, MAX_STRETCH, RayDifferential, endless_footprint, footprint_at};
use super::footprint_axes::{FootprintEllipse, in_texture, kind_of, texel_spread};
use super::geometry::hit::{Hit, Surface};
use super::geometry::rays::{hit_surface, nearest_hit};
use super::mapping::{Coordinate, texture_coordinate};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::constants::SECOND_UV_COLOR;
use crate::schema::enums::Quantity;
use crate::schema::layout::{Material, NO_SHAPE, NO_TEXTURE, Sampler, Texture, UvProjection};
use crate::texture::sampler_spec::Address;

/// A look-up of a texture of texels over the footprint of a pixel.
#[derive(Clone, Copy, Debug)]
pub struct LookUp<'a> {
    /// Index of the texture.
    pub texture: u32,
    pub image: &'a Texture,
    pub how: &'a Sampler,
    /// On its face, for a cube.
    pub coordinate: Coordinate,
    pub face: u32,
    pub spread: FootprintEllipse,
}

/// Returns the place in [0, 1] of a texture at which a coordinate is read.
pub fn place_in_tile(mode: Address, u: f64) -> f64 {
    match mode {
        Address::Repeat => u - u.floor(),
        Address::MirroredRepeat => 1.0 - (u - 2.0 * (0.5 * u).floor() - 1.0).abs(),
        Address::MirrorClampToEdge => u.abs().clamp(0.0, 1.0),
        Address::ClampToEdge | Address::ClampToBorder => u.clamp(0.0, 1.0),
    }
}

/// Returns the look-up of a material's texture; procedural textures have no texels.
pub fn look_up<'a>(scene: &'a PackedScene, material: &Material, mapped: &Coordinate) -> Option<LookUp<'a>> {
    let texture = material.texture_index;
    let image = scene.records.textures.get(texture as usize).filter(|_| texture != NO_TEXTURE)?;
    if kind_of(image) == TextureKind::Procedural {
        return None;
    }
    let how = &scene.records.samplers[material.sampler_index as usize];
    let (coordinate, face) = in_texture(image, mapped);
    Some(LookUp { texture, image, how, coordinate, face, spread: texel_spread(image, &coordinate) })
}

impl LookUp<'_> {
    /// Returns the place in the texture.
    pub fn place(&self) -> DVec2 {
        let at = self.coordinate.at;
        DVec2::new(place_in_tile(self.how.address_u, at.x), place_in_tile(self.how.address_v, at.y))
    }

    /// Returns the level that is read.
    pub fn level(&self) -> f64 {
        read_level(self.image, self.how, &self.spread)
    }
}

/// Returns a quantity of the look-up of a material's texture.
pub fn look_up_quantity(quantity: Quantity, look_up: &LookUp<'_>) -> DVec3 {
    let FootprintEllipse { major, minor, .. } = look_up.spread;
    let bounded = major.max(1e-30);
    let value = match quantity {
        Quantity::Texels => DVec2::new(major.sqrt(), minor.sqrt()),
        Quantity::Magnification => DVec2::new(-0.5 * bounded.log2(), 0.0),
        Quantity::Level => DVec2::new(look_up.level(), 0.0),
        Quantity::Anisotropy => DVec2::new((bounded / minor.max(1e-30)).sqrt().min(MAX_STRETCH), 0.0),
        _ => look_up.place(),
    };
    value.extend(1.0)
}

/// Returns a quantity of the surface itself; no hit: it is the environment's. Numbers count from 1.
pub fn surface_quantity(quantity: Quantity, hit: Option<&Hit>, surface: &Surface, albedo: DVec3) -> DVec3 {
    let number = |n: f64| DVec3::new(n, 0.0, 1.0);
    match (quantity, hit) {
        (Quantity::Material, _) => number(f64::from(surface.material) + 1.0),
        (_, None) => DVec3::ZERO,
        (Quantity::Normal, _) => surface.normal,
        (Quantity::Depth, Some(hit)) => number(hit.t),
        (Quantity::Instance, Some(hit)) => number(f64::from(hit.shape) + 1.0),
        _ => albedo,
    }
}

/// What a camera ray meets first: a surface of the scene, or the environment.
pub struct FirstHit<'a> {
    /// None for the environment.
    pub hit: Option<Hit>,
    pub surface: Surface,
    material: &'a Material,
    map: Option<&'a UvProjection>,
    print: Footprint,
}

/// Returns what a ray meets; `None` for a background of one colour.
pub fn first_hit<'a>(
    scene: &'a PackedScene,
    ray: &Ray,
    beam: &RayDifferential,
    skip: u32,
) -> Option<FirstHit<'a>> {
    let header = &scene.header;
    let hit = nearest_hit(scene, ray, skip);
    if hit.shape == NO_SHAPE {
        let material = scene.records.materials.get(header.environment_material as usize)?;
        let map = scene.records.uv_projections.get(header.environment_projection as usize);
        let print = endless_footprint(header, beam, ray);
        let surface = Surface { material: header.environment_material, ..Surface::default() };
        return Some(FirstHit { hit: None, surface, material, map, print });
    }
    let surface = hit_surface(scene, ray, &hit);
    let print = footprint_at(header, beam, ray, hit.t, surface.geometric_normal);
    let material = &scene.records.materials[surface.material as usize];
    let map = scene.records.uv_projections.get(surface.map as usize);
    Some(FirstHit { hit: Some(hit), surface, material, map, print })
}

impl<'a> FirstHit<'a> {
    /// Returns the look-up of the material's texture, if it has texels.
    pub fn look_up(&self, scene: &'a PackedScene, ray: &Ray) -> Option<LookUp<'a>> {
        let map = self.map?;
        let shown = at_uv_of(scene, self.material, SECOND_UV_COLOR, &self.surface);
        let mapped = texture_coordinate(map, &map_input(map, ray, &shown, &self.print));
        look_up(scene, self.material, &mapped)
    }
}

/// Returns the quantity that samples measure in place of radiance. Surfaces that let rays pass count as any other.
pub fn measured(
    scene: &PackedScene,
    ray: &Ray,
    beam: &RayDifferential,
    skip: u32,
    random: [u32; 2],
) -> DVec3 {
    let quantity = scene.header.quantity;
    let Some(mut first) = first_hit(scene, ray, beam, skip) else { return DVec3::ZERO };
    if is_of_look_ups(quantity) {
        let look_up = first.look_up(scene, ray);
        return look_up.map_or(DVec3::ZERO, |look_up| look_up_quantity(quantity, &look_up));
    }
    let mut albedo = DVec3::ZERO;
    if matches!(quantity, Quantity::Albedo | Quantity::Normal) {
        let FirstHit { material, map, print, .. } = first;
        if let (Some(map), Some(_)) = (map, first.hit) {
            let at = (ray, &first.surface, &print);
            first.surface.normal = bumped_normal(scene, material, map, at, random);
        }
        albedo = appearance(scene, material, map, (ray, &first.surface, &print), random).color;
    }
    surface_quantity(quantity, first.hit.as_ref(), &first.surface, albedo)
}

/// Returns true for a quantity of a look-up.
pub const fn is_of_look_ups(quantity: Quantity) -> bool {
    matches!(
        quantity,
        Quantity::Texels | Quantity::Magnification | Quantity::Level | Quantity::Anisotropy | Quantity::Uv
    )
}
