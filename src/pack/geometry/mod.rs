//! The kinds of shapes, one file each → their device records, relative to the eye, each with its map; and what the rest
//! of packing and rendering asks of all of them: how many there are, and how far f32 misplaces them.

mod plane;
mod sphere;
mod triangle;

use glam::DVec3;

use super::precision::{Camera, round};
use super::{PackedScene, TextureKind};
use crate::core::error::Result;
use crate::scene::model::{Mapping, Scene};
use crate::schema::layout;
use crate::texture::sampler_spec::SamplerSpec;

/// More shapes than this are worth lists of tiles: so few are unrolled code.
const FEW: usize = 16;

pub fn pack_shapes(packed: &mut PackedScene, scene: &Scene) -> Result<()> {
    let eye = scene.camera.eye;
    for plane in &scene.planes {
        let record = plane::pack(packed, scene, plane, eye)?;
        packed.planes.push(record);
    }
    for sphere in &scene.spheres {
        let record = sphere::pack(packed, scene, sphere, eye);
        packed.spheres.push(record);
    }
    for triangle in &scene.triangles {
        let record = triangle::pack(packed, scene, triangle, eye);
        packed.triangles.push(record);
    }
    if scene.shapes_move() {
        packed.motions = scene.motions().map(|m| layout::Motion { shift: m }).collect();
    }
    packed.header.plane_count = packed.planes.len() as u32;
    packed.header.sphere_count = packed.spheres.len() as u32;
    packed.header.triangle_count = packed.triangles.len() as u32;
    packed.header.motion_count = packed.motions.len() as u32;
    Ok(())
}

/// Whether camera rays gain by lists of the shapes that each tile may show.
pub fn gains_by_tiles(scene: &Scene) -> bool {
    scene.triangles.len() > FEW
}

/// a × b to two ulps of each component, however near to parallel (Kahan's difference of products; Jeannerod,
/// Louvet & Muller 2013).
pub fn cross(a: DVec3, b: DVec3) -> DVec3 {
    let difference = |a: f64, b: f64, c: f64, d: f64| {
        let cd = c * d;
        a.mul_add(b, -cd) + (-c).mul_add(d, cd)
    };
    DVec3::new(difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x))
}

/// The index of the shape's map; shapes without a texture share map 0, which they never read.
fn add_map(
    packed: &mut PackedScene,
    scene: &Scene,
    material: usize,
    make: impl Fn(&Mapping, &SamplerSpec, bool) -> layout::UvProjection,
) -> u32 {
    let material = &scene.materials[material];
    let Some(texture) = material.texture.or(material.bump.map(|r| r.texture)) else { return 0 };
    let kind = packed.textures[texture].kind;
    let flat = matches!(kind, TextureKind::Flat | TextureKind::Procedural);
    packed.uv_projections.push(make(&material.mapping, &scene.sampler_of(material), flat));
    packed.uv_projections.len() as u32 - 1
}

/// The largest coordinate, seen from the eye.
fn reach(p: DVec3, eye: DVec3) -> f64 {
    (p - eye).abs().max_element()
}

/// How far f32 misplaces a shape.
pub(super) trait Rounded {
    /// Index into `Scene::materials`.
    fn material(&self) -> usize;

    /// Whether it is one of many, of which each counts for itself, not by the rays that meet it.
    fn is_small(&self) -> bool {
        false
    }

    /// The largest number that it has, seen from the eye.
    fn extent(&self, eye: DVec3) -> f64;

    /// Whether its outline is off by more than can go unseen.
    fn misses_outline(&self, _: &Camera) -> bool {
        false
    }

    /// Adds the errors of texture coordinates on it, in tiles.
    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64));
}

pub(super) fn rounded_shapes(scene: &Scene) -> impl Iterator<Item = &dyn Rounded> {
    let planes = scene.planes.iter().map(|s| s as &dyn Rounded);
    let spheres = scene.spheres.iter().map(|s| s as &dyn Rounded);
    planes.chain(spheres).chain(scene.triangles.iter().map(|s| s as &dyn Rounded))
}

impl PackedScene {
    pub fn shape_count(&self) -> usize {
        self.planes.len() + self.spheres.len() + self.triangles.len()
    }

    /// Shapes that lists of tiles hold.
    pub fn listed_shapes(&self) -> usize {
        self.triangles.len()
    }

    /// Whether some shape may lie between another place of its own, or of another shape, and a light: a lone flat one
    /// does not.
    pub fn shapes_occlude(&self) -> bool {
        !self.spheres.is_empty() || self.planes.len() + self.triangles.len() > 1
    }

    /// The numbers that a device reads as f32.
    pub(super) fn round_shapes(&mut self) {
        round(&mut self.planes);
        round(&mut self.spheres);
        round(&mut self.triangles);
    }
}
