//! The kinds of shapes, and what each one answers. Outside this folder nobody knows them: a shape is a number, and those
//! of one kind follow each other. Twin of `glsl/shared/geometry/kinds.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::hit::{Hit, Surface};
use crate::oracle::camera::Ray;
use crate::oracle::cone::Cone;
use crate::oracle::coverage::{Covered, Cuts};
use crate::oracle::polygon::{AffineFunction, Polygon};
use crate::oracle::projective::{ConvexRegion, PixelFrustum, RationalMap};
use crate::pack::PackedScene;
use crate::schema::layout::{Header, Light, UvProjection};

/// What a shape answers to rays and to cones.
pub trait Shape {
    /// Material and map.
    fn links(&self) -> [u32; 2];

    /// Distance and own coordinates of where the ray meets it; not above 0 on a miss.
    fn distance_to(&self, ray: &Ray) -> (f64, DVec2);

    fn surface_of(&self, point: DVec3, local: DVec2) -> Surface;

    /// Cuts the disc to what it covers; false for one that no lines stand for.
    fn cut_by_shape(&self, cuts: &mut Cuts, cone: &Cone) -> bool;

    /// A hit of a ray within the outline; rounding may have put it just beside.
    fn complete(&self, ray: &Ray, hit: &mut Hit);

    /// The plane that touches it at t.
    fn tangent_plane(&self, cone: &Cone, t: f64) -> DVec4;

    /// False where no ray of the polygon can meet it.
    fn may_meet(&self, header: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool;

    /// What it is where it lies in a plane; else what it is without.
    fn form(&self) -> Form<'_>;
}

/// The two families of shapes.
pub enum Form<'a> {
    Flat(&'a dyn Flat),
    Round(&'a dyn Round),
}

/// A shape in a plane within straight lines: a ray never meets again the one that it leaves, and beams know its outline.
pub trait Flat {
    /// Unit normal, and height over the eye.
    fn plane_of(&self) -> DVec4;

    fn has_smooth_normals(&self) -> bool;

    /// Adds the lines around it.
    fn add_outline(&self, frame: &PixelFrustum, near: AffineFunction, region: &mut ConvexRegion);

    /// Texture coordinates by a map of its own coordinates.
    fn own_coordinates(&self, frame: &PixelFrustum, near: AffineFunction, map: &UvProjection) -> RationalMap;

    /// Adds the lines around it on another surface of this inverse depth, seen from the light. `rise`: of the light
    /// before the plane, or of a way's length towards it.
    fn add_shadow(
        &self,
        surface: (&PixelFrustum, AffineFunction),
        light: &Light,
        rise: f64,
        region: &mut ConvexRegion,
    );
}

/// Any other shape.
pub trait Round {
    fn covered_by(&self, cone: &Cone) -> Covered;

    /// False where no way from the polygon on a surface of this inverse depth to the light can pass it.
    fn may_shade(&self, surface: (&PixelFrustum, AffineFunction), polygon: &Polygon, light: &Light) -> bool;
}

/// For the list of each kind: `$body` with the number of its first shape.
macro_rules! each_kind {
    ($scene:expr, |$first:ident, $list:ident| $body:expr) => {{
        let (planes, spheres) = ($scene.header.plane_count, $scene.header.sphere_count);
        {
            let ($first, $list) = (0, &$scene.planes);
            $body
        }
        {
            let ($first, $list) = (planes, &$scene.spheres);
            $body
        }
        {
            let ($first, $list) = (planes + spheres, &$scene.triangles);
            $body
        }
    }};
}
pub(super) use each_kind;

pub fn shape_of(scene: &PackedScene, shape: u32) -> &dyn Shape {
    let (planes, spheres) = (scene.header.plane_count, scene.header.sphere_count);
    if shape < planes {
        &scene.planes[shape as usize]
    } else if shape < planes + spheres {
        &scene.spheres[(shape - planes) as usize]
    } else {
        &scene.triangles[(shape - planes - spheres) as usize]
    }
}

pub fn shape_count(scene: &PackedScene) -> u32 {
    scene.header.plane_count + scene.header.sphere_count + scene.header.triangle_count
}
