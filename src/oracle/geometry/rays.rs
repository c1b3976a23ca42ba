//! A ray and all shapes: the nearest hit with t > 0, whether anything lies between, and the surface at a hit. Flat shapes
//! never hit the ray that left them (`skip`); others rely on the offset origin. Twin of
//! `glsl/shared/geometry/rays.glsl`.

use glam::{DVec2, DVec3};

use super::hit::Surface;
pub use super::hit::{FAR, Hit, at_rest, moved_by};
use super::kinds::{Query, Search, Shape, each_list, shape_of};
use crate::oracle::camera::Ray;
use crate::pack::PackedScene;
use crate::schema::layout::NO_SHAPE;
use crate::schema::shapes::with_shapes;

/// The hit with the least t above 0; of hits at the same t the lowest shape.
pub fn nearest_hit(scene: &PackedScene, ray: &Ray, skip: u32) -> Hit {
    nearest_of(scene, ray, skip, Search::Nearest)
}

/// As `nearest_hit`, of shapes from whichever side.
pub fn nearest_of_both_sides(scene: &PackedScene, ray: &Ray, skip: u32) -> Hit {
    nearest_of(scene, ray, skip, Search::NearestOfBothSides)
}

fn nearest_of(scene: &PackedScene, ray: &Ray, skip: u32, search: Search) -> Hit {
    let mut hit = Hit { t: FAR, shape: NO_SHAPE, local: DVec2::ZERO };
    let query = Query { scene, ray, skip, search };
    with_shapes!(each_list, scene, |first, list| Shape::nearest(list, first, &query, &mut hit));
    hit
}

/// True when a shape lies at 0 < t < t_max, whichever is found first.
pub fn occluded(scene: &PackedScene, ray: &Ray, t_max: f64, skip: u32) -> bool {
    let query = Query { scene, ray, skip, search: Search::Any };
    let mut is_occluded = false;
    with_shapes!(each_list, scene, |first, list| {
        is_occluded = is_occluded || Shape::occlude(list, first, &query, t_max);
    });
    is_occluded
}

/// The surface at a hit; `hit.shape` must be a shape of the scene.
pub fn hit_surface(scene: &PackedScene, ray: &Ray, hit: &Hit) -> Surface {
    let shift = moved_by(scene, ray, hit.shape);
    let point = ray.origin - shift + hit.t * ray.direction;
    let mut surface = shape_of(scene, hit.shape).surface_of(scene, point, hit.local);
    surface.point += shift;
    if surface.geometric_normal.dot(ray.direction) > 0.0 {
        surface.geometric_normal = -surface.geometric_normal;
        surface.normal = -surface.normal;
        surface.shape_operator = -surface.shape_operator;
        surface.curvature = -surface.curvature;
        surface.inside = true;
    }
    surface
}

/// The start of a ray that leaves the surface at p along its unit geometric normal, off it by far more than
/// f64's rounding and far less than f32's; `size` is that of the largest coordinate that p came from.
pub fn offset_origin(p: DVec3, n: DVec3, size: f64) -> DVec3 {
    const CLEARANCE: f64 = 1.0 / (1u64 << 46) as f64;
    p + n * (CLEARANCE * size)
}
