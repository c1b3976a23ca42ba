//! Texture coordinates of surface points, and their change over the footprint. Twin of
//! `glsl/shared/mapping.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::math::{affine, atan2_accurate};
use crate::pack::MapKind;
use crate::schema::layout::UvProjection;

/// The inputs of a mapping: the entity that its kind projects, the shape's own coordinate, and the changes of
/// both over the footprint.
#[derive(Clone, Copy, Debug, Default)]
pub struct MapInput {
    pub entity: DVec3,
    pub entity_change: [DVec3; 2],
    pub own: DVec2,
    pub own_change: [DVec2; 2],
    /// True if the changes are along unit vectors, not over a footprint.
    pub gradients: bool,
}

/// A texture coordinate (u, v, w), or a direction for a cube texture, and its changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinate {
    pub at: DVec3,
    pub change: [DVec3; 2],
}

impl Coordinate {
    /// Returns a coordinate of a 2D texture without a footprint.
    pub fn flat(uv: DVec2) -> Coordinate {
        Coordinate { at: uv.extend(0.0), ..Default::default() }
    }
}

/// Returns matrix · uv: scale and rotation.
pub fn turned_uv(map: &UvProjection, uv: DVec2) -> DVec2 {
    DVec2::new(map.m00 * uv.x + map.m01 * uv.y, map.m10 * uv.x + map.m11 * uv.y)
}

/// Returns matrix · uv + offset.
pub fn placed(map: &UvProjection, uv: DVec2) -> DVec2 {
    turned_uv(map, uv) + map.offset
}

/// Returns the coordinate of a mapping that ends with `placed`.
pub fn placed_coordinate(map: &UvProjection, uv: DVec2, change: [DVec2; 2]) -> Coordinate {
    Coordinate { at: placed(map, uv).extend(0.0), change: change.map(|d| turned_uv(map, d).extend(0.0)) }
}

/// Applies the linear part of the frame.
pub fn in_frame(map: &UvProjection, v: DVec3) -> DVec3 {
    DVec3::new(map.x.truncate().dot(v), map.y.truncate().dot(v), map.z.truncate().dot(v))
}

/// Selects the face of a cube for a direction, and (s, t) in [-1, 1] on it (Vulkan 1.3, "Cube Map Face
/// Selection"; ties go to z, then y). The third component is the length along the face's axis.
pub fn on_cube_face(d: DVec3) -> (DVec3, u32) {
    let a = d.abs();
    let face = if a.z >= a.x && a.z >= a.y {
        4 + u32::from(d.z < 0.0)
    } else if a.y >= a.x {
        2 + u32::from(d.y < 0.0)
    } else {
        u32::from(d.x < 0.0)
    };
    (along_cube_face(d, face), face)
}

/// Returns the face's axes of a direction, or of a change of direction that stays on it.
pub fn along_cube_face(d: DVec3, face: u32) -> DVec3 {
    match face {
        0 => DVec3::new(-d.z, -d.y, d.x),
        1 => DVec3::new(d.z, -d.y, -d.x),
        2 => DVec3::new(d.x, d.z, d.y),
        3 => DVec3::new(d.x, -d.z, -d.y),
        4 => DVec3::new(d.x, -d.y, d.z),
        _ => DVec3::new(-d.x, -d.y, -d.z),
    }
}

/// Returns the position on a face in [0, 1]² from numerator and axis: (s / major + 1) / 2.
pub fn face_uv(stm: DVec3) -> DVec2 {
    0.5 * (stm.truncate() / stm.z) + 0.5
}

/// As above for any direction: the cube's centre and NaN have a defined result too.
pub fn within_face(stm: DVec3) -> DVec2 {
    let within = |x: f64| if x >= 0.0 { x.min(1.0) } else { 0.0 };
    let uv = face_uv(stm);
    DVec2::new(within(uv.x), within(uv.y))
}

/// Returns the change of `face_uv`: the derivative of the quotient.
pub fn face_uv_change(stm: DVec3, change: DVec3) -> DVec2 {
    0.5 * (change.truncate() * stm.z - stm.truncate() * change.z) / (stm.z * stm.z)
}

/// Limits the change of an angle to one turn, as it grows without bound towards the pole.
fn within_turn(change: f64, gradients: bool) -> f64 {
    if gradients { change } else { change.clamp(-1.0, 1.0) }
}

pub fn turn_change(local: DVec3, change: DVec3, around: f64, gradients: bool) -> f64 {
    let area = local.x * change.z - local.z * change.x;
    within_turn(area / (around.max(1e-30) * (2.0 * PI)), gradients)
}

fn turn(local: DVec3) -> f64 {
    let turn = atan2_accurate(local.z, local.x) / (2.0 * PI);
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// Returns (turn, height) and its change: φ/2π and y.
pub fn cylindrical(map: &UvProjection, local: DVec3, change: [DVec3; 2], gradients: bool) -> Coordinate {
    let around = local.x * local.x + local.z * local.z;
    let of = |d: DVec3| DVec2::new(turn_change(local, d, around, gradients), d.y);
    placed_coordinate(map, DVec2::new(turn(local), local.y), change.map(of))
}

/// Returns the change of θ / π: (y dρ - ρ dy) / (ρ² + y²), where dρ = (x dx + z dz) / ρ.
pub fn polar_change(local: DVec3, change: DVec3, across: f64, squared: f64, gradients: bool) -> f64 {
    let outward = (local.x * change.x + local.z * change.z) / across.max(1e-30);
    within_turn((local.y * outward - across * change.y) / (squared.max(1e-30) * PI), gradients)
}

/// Returns (θ/π, φ/2π) and its change.
pub fn spherical(map: &UvProjection, local: DVec3, change: [DVec3; 2], gradients: bool) -> Coordinate {
    let around = local.x * local.x + local.z * local.z;
    let across = around.sqrt();
    let uv = DVec2::new(atan2_accurate(across, local.y) / PI, turn(local));
    let squared = around + local.y * local.y;
    let of = |d: DVec3| {
        let polar = polar_change(local, d, across, squared, gradients);
        DVec2::new(polar, turn_change(local, d, around, gradients))
    };
    placed_coordinate(map, uv, change.map(of))
}

pub fn texture_coordinate(map: &UvProjection, seen: &MapInput) -> Coordinate {
    let kind = map.kind;
    let local =
        || DVec3::new(affine(map.x, seen.entity), affine(map.y, seen.entity), affine(map.z, seen.entity));
    let change = seen.entity_change.map(|d| in_frame(map, d));
    match kind {
        MapKind::VertexUv => {
            Coordinate { at: seen.own.extend(0.0), change: seen.own_change.map(|d| d.extend(0.0)) }
        }
        MapKind::Plane => placed_coordinate(map, seen.own, seen.own_change),
        MapKind::Affine => Coordinate {
            at: local().truncate().extend(0.0),
            change: change.map(|d| d.truncate().extend(0.0)),
        },
        MapKind::Solid | MapKind::Cube => Coordinate { at: local(), change },
        MapKind::Box => {
            let (stm, face) = on_cube_face(local());
            let of = |d| face_uv_change(stm, along_cube_face(d, face));
            placed_coordinate(map, face_uv(stm), change.map(of))
        }
        MapKind::Cylindrical => cylindrical(map, local(), change, seen.gradients),
        MapKind::Spherical => spherical(map, local(), change, seen.gradients),
    }
}
