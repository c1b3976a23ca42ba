//! A cone and a shape: what it cuts out of the disc, how much that is, where a ray within meets it, and how deep it
//! lies. Twin of `glsl/shared/geometry/cones.glsl`.

use glam::DVec2;

use super::hit::Hit;
use super::kinds::{Form, shape_of};
use crate::oracle::camera::Ray;
use crate::oracle::cone::{Cone, FlatDepth, LEVEL, flat_in};
use crate::oracle::coverage::{Covered, Cuts};
use crate::pack::PackedScene;
use crate::schema::layout::NO_SHAPE;

/// Returns the cone with the floor of the shape that it leaves.
pub fn leaving(scene: &PackedScene, cone: Cone, shape: u32) -> Cone {
    if shape == NO_SHAPE {
        return cone;
    }
    let Some(plane) = shape_of(scene, shape).plane_of() else { return cone };
    let normal = plane.truncate();
    let Ray { origin, direction, .. } = cone.ray;
    let up = if normal.dot(direction) < 0.0 { -normal } else { normal };
    let level = LEVEL * origin.abs().max_element();
    Cone { floor: up.extend(-(up.dot(origin) + level)), ..cone }
}

/// True if a ray that leaves the shape outwards may meet it again.
pub fn is_concave(scene: &PackedScene, shape: u32) -> bool {
    shape_of(scene, shape).is_concave()
}

/// The shape that a ray must not meet again at once. From inside a ball its other side is met; a concave shape may be met
/// again anywhere.
pub fn left_shape(scene: &PackedScene, shape: u32, within: bool) -> u32 {
    let record = shape_of(scene, shape);
    let solid = record.plane_of().is_none();
    if record.is_concave() || solid && within { NO_SHAPE } else { shape }
}

/// Cuts the disc to what the shape covers; false for one that no lines stand for.
pub fn cut_shape(cuts: &mut Cuts, scene: &PackedScene, cone: &Cone, shape: u32) -> bool {
    shape_of(scene, shape).cut_by_shape(cuts, cone)
}

/// Returns the part of the disc that the shape covers.
pub fn covered_by(scene: &PackedScene, cone: &Cone, shape: u32) -> Covered {
    if let Form::Round(round) = shape_of(scene, shape).form() {
        return round.covered_by(scene, cone);
    }
    let mut cuts = Cuts::default();
    cut_shape(&mut cuts, scene, cone, shape);
    cuts.covered()
}

/// Where a ray within the shape's outline meets it; rounding may have put it just beside.
pub fn meet(scene: &PackedScene, ray: &Ray, shape: u32) -> Hit {
    let record = shape_of(scene, shape);
    let mut hit = Hit { t: -1.0, shape, local: DVec2::ZERO };
    if let Some(plane) = record.plane_of() {
        let n = plane.truncate();
        hit.t = (plane.w - n.dot(ray.origin)) / n.dot(ray.direction);
    }
    record.complete(scene, ray, &mut hit);
    hit
}

/// Returns the depth of a shape over the disc: by its own plane, or a ball's tangent plane; at a ball's outline by its
/// distance alone.
pub fn depth_of(scene: &PackedScene, cone: &Cone, shape: u32, t: f64, area: f64) -> FlatDepth {
    let record = shape_of(scene, shape);
    if record.plane_of().is_none() && area < 1.0 {
        return FlatDepth { height: t, facing: 1.0, tilt: DVec2::ZERO };
    }
    let plane = record.tangent_plane(cone, t);
    flat_in(cone, plane.truncate(), plane.w)
}
