//! The buffer of meshes, and what rays ask of it: where they enter a box of a tree, and where they meet a triangle. Boxes
//! grow by what rounding may misplace (Ize 2013). Twin of `glsl/shared/geometry/mesh_tests.glsl`.

use glam::{BVec3, DVec3, Vec3};

use crate::oracle::camera::Ray;
use crate::pack::PackedScene;

pub(in crate::oracle) fn mesh_texel(scene: &PackedScene, at: u32) -> [u32; 4] {
    scene.mesh_texels[at as usize]
}

pub(super) fn point_in([x, y, z, _]: [u32; 4]) -> DVec3 {
    Vec3::new(f32::from_bits(x), f32::from_bits(y), f32::from_bits(z)).as_dvec3()
}

/// Boxes grow by this part of the largest coordinate of their corners as seen from the ray's origin: planes of boxes,
/// edge functions and distances of triangles are off by less than 16 roundings of it.
pub(super) const MARGIN: f64 = 1.0 / (1u64 << 32) as f64;

/// Components of a direction are no less than this part of the largest, so that no reciprocal is infinite. In a box, a
/// ray moves aside by less than `MARGIN` for it.
const AXIAL: f64 = MARGIN / 1024.0;

/// A ray as boxes are tested with it.
pub(super) struct Slabs {
    origin: DVec3,
    inverse: DVec3,
    falls: BVec3,
    /// Longest component of the direction.
    pub(super) longest: f64,
}

pub(super) fn slabs_of(ray: &Ray) -> Slabs {
    let longest = ray.direction.abs().max_element();
    let scaled = ray.direction * (1.0 / longest);
    let falls = scaled.cmplt(DVec3::ZERO);
    let apart = scaled.abs().max(DVec3::splat(AXIAL));
    Slabs { origin: ray.origin, inverse: 1.0 / DVec3::select(falls, -apart, apart), falls, longest }
}

/// Returns where the ray enters the box grown by this part, -1 if it does not up to the scaled distance `most`. Planes of entry and
/// exit follow from the direction: a box that is inside out, in an unused place of a node, is never entered.
pub(super) fn entry(slabs: &Slabs, least: DVec3, greatest: DVec3, part: f64, most: f64) -> f64 {
    let low = least - slabs.origin;
    let high = greatest - slabs.origin;
    let margin = part * low.abs().max(high.abs()).max_element();
    let (low, high) = (low - margin, high + margin);
    let enter = DVec3::select(slabs.falls, high, low) * slabs.inverse;
    let leave = DVec3::select(slabs.falls, low, high) * slabs.inverse;
    let near = enter.max_element().max(0.0);
    let far = leave.min_element().min(most);
    if near <= far { near } else { -1.0 }
}

pub(super) fn corners(scene: &PackedScene, at: u32) -> [DVec3; 3] {
    [0, 1, 2].map(|k| point_in(mesh_texel(scene, at + k)))
}

/// The mean of the corners' distances along a direction, weighted by edge functions of one sign; else -1. `one_sided`: it
/// is met from the front only.
fn distance_by(edges: DVec3, corners: [DVec3; 3], d: DVec3, one_sided: bool) -> f64 {
    let back = edges.cmpge(DVec3::ZERO).all() && !one_sided;
    let front = edges.cmple(DVec3::ZERO).all();
    if !(front || back) || edges == DVec3::ZERO {
        return -1.0;
    }
    let along = edges.dot(DVec3::from_array(corners.map(|corner| corner.dot(d))));
    along / (edges.element_sum() * d.length_squared())
}

/// Edge functions d·((p + q) × (q - p)), twice the volumes d·(p × q): the two triangles at a shared edge compute the same
/// value with opposite sign, and the error is a part of the edge's length. They are weights of the corners in the point.
pub(super) fn distance_between([a, b, c]: [DVec3; 3], d: DVec3, one_sided: bool) -> f64 {
    let edge = |p: DVec3, q: DVec3| d.dot((p + q).cross(q - p));
    distance_by(DVec3::new(edge(b, c), edge(c, a), edge(a, b)), [a, b, c], d, one_sided)
}
