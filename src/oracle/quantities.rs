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
use super::material_maps::{TextureUse, use_of};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::constants::SECOND_UV_BUMP;
use crate::schema::enums::{MaterialMap, Quantity};
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

/// What a material reads a texture for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Slot {
    Color,
    Bump,
    Roughness,
    Emission,
    Occlusion,
    SpecularWeight,
    SpecularTint,
    Transmission,
}

impl Slot {
    pub const ALL: [Slot; 8] = [
        Slot::Color,
        Slot::Bump,
        Slot::Roughness,
        Slot::Emission,
        Slot::Occlusion,
        Slot::SpecularWeight,
        Slot::SpecularTint,
        Slot::Transmission,
    ];

    /// Returns texture, sampler and bit of the coordinates.
    fn of(self, m: &Material) -> [u32; 3] {
        let map = |map| {
            let TextureUse { texture_index, sampler_index, second_uv } = use_of(m, map);
            [texture_index, sampler_index, second_uv]
        };
        match self {
            Slot::Color => map(MaterialMap::Mask),
            Slot::Bump => [m.bump_texture_index, m.bump_sampler_index, SECOND_UV_BUMP],
            Slot::Roughness => map(MaterialMap::Roughness),
            Slot::Emission => map(MaterialMap::Emission),
            Slot::Occlusion => map(MaterialMap::Occlusion),
            Slot::SpecularWeight => map(MaterialMap::SpecularWeight),
            Slot::SpecularTint => map(MaterialMap::SpecularTint),
            Slot::Transmission => map(MaterialMap::Transmission),
        }
    }
}

/// Returns what the texture is for whose look-ups are measured: the colour, or else the first map that the material has.
pub fn measured_slot(material: &Material) -> Option<Slot> {
    Slot::ALL.into_iter().find(|slot| slot.of(material)[0] != NO_TEXTURE)
}

/// Returns the look-up of a texture; procedural textures have no texels.
fn look_up<'a>(
    scene: &'a PackedScene,
    [texture, sampler]: [u32; 2],
    mapped: &Coordinate,
) -> Option<LookUp<'a>> {
    let image = scene.records.textures.get(texture as usize).filter(|_| texture != NO_TEXTURE)?;
    if kind_of(image) == TextureKind::Procedural {
        return None;
    }
    let how = &scene.records.samplers[sampler as usize];
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

/// A unit vector as a whole number: two octahedral components of 12 bits each (Cigolle et al. 2014).
fn direction_number(n: DVec3) -> f64 {
    let p = n.truncate() / ((n.x.abs() + n.y.abs()) + n.z.abs());
    let toward = |x: f64, other: f64| if x < 0.0 { other.abs() - 1.0 } else { 1.0 - other.abs() };
    let folded = DVec2::new(toward(p.x, p.y), toward(p.y, p.x));
    let p = if n.z < 0.0 { folded } else { p };
    let steps = (4095.0 * (0.5 * p + 0.5).clamp(DVec2::ZERO, DVec2::ONE) + 0.5).floor();
    steps.x * 4096.0 + steps.y
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
        (Quantity::Place, _) => surface.at_rest,
        (Quantity::Facet, Some(hit)) => DVec3::new(
            f64::from(hit.shape) + 1.0,
            direction_number(surface.geometric_normal),
            direction_number(surface.normal),
        ),
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
    /// Returns the indices of texture and sampler that the material reads for something, and the texture coordinate.
    pub fn mapped(&self, slot: Slot, scene: &PackedScene, ray: &Ray) -> Option<([u32; 2], Coordinate)> {
        let [texture, sampler, second_uv] = slot.of(self.material);
        let map = self.map.filter(|_| texture != NO_TEXTURE)?;
        let shown = at_uv_of(scene, self.material, second_uv, &self.surface);
        let mapped = texture_coordinate(map, &map_input(map, ray, &shown, &self.print));
        Some(([texture, sampler], mapped))
    }

    /// Returns the look-up of one of the material's textures, if it has texels.
    pub fn look_up(&self, slot: Slot, scene: &'a PackedScene, ray: &Ray) -> Option<LookUp<'a>> {
        let (used, mapped) = self.mapped(slot, scene, ray)?;
        look_up(scene, used, &mapped)
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
        let look_up = measured_slot(first.material).and_then(|slot| first.look_up(slot, scene, ray));
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
