//! Packs a material's mapping on one shape into the rows and the matrix that a device multiplies. Scale,
//! rotation and offset follow KHR_texture_transform; whole tiles are subtracted from the constants of planes
//! and affine mappings, single ones for `repeat`, pairs for `mirrored-repeat`, which changes no look-up. An
//! angular mapping, whose coordinates are within one turn, keeps its offset as given.

use glam::{DMat2, DQuat, DVec2, DVec3, DVec4};

use super::{EntityKind, MapKind};
use crate::scene::model::{Bounds, Entity, Environment, EnvironmentLayout, Mapping, MappingKind, Space};
use crate::schema::layout::UvProjection;
use crate::texture::sampler_spec::{Address, SamplerSpec};

/// The properties of a shape that a mapping may need.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Centroid of bounded shapes.
    pub centroid: Option<DVec3>,
    pub bounds: Option<Bounds>,
}

/// Returns the linear part of scale, then rotation: uv' = matrix · uv + offset.
pub fn uv_matrix(mapping: &Mapping) -> DMat2 {
    DMat2::from_angle(mapping.rotate.to_radians()) * DMat2::from_diagonal(mapping.scale)
}

/// Returns the period that may be subtracted from a coordinate without changing a look-up, in tiles; 0 for
/// none.
pub fn period(address: Address) -> f64 {
    match address {
        Address::Repeat => 1.0,
        Address::MirroredRepeat => 2.0,
        Address::ClampToEdge | Address::ClampToBorder | Address::MirrorClampToEdge => 0.0,
    }
}

/// Returns the periods of u and v.
pub fn periods(sampler: &SamplerSpec) -> DVec2 {
    DVec2::new(period(sampler.address[0]), period(sampler.address[1]))
}

/// Returns the whole periods in `value`, to be subtracted.
pub fn whole_tiles(value: DVec2, periods: DVec2) -> DVec2 {
    let whole = |v: f64, p: f64| if p > 0.0 { (v / p).floor() * p } else { 0.0 };
    DVec2::new(whole(value.x, periods.x), whole(value.y, periods.y))
}

/// Returns uv = matrix · (u, v) + offset, where u and v are the affine functions `row · (p, 1)`.
pub fn affine_map(mapping: &Mapping, sampler: &SamplerSpec, u: DVec4, v: DVec4) -> UvProjection {
    let m = uv_matrix(mapping);
    let mut x = m.x_axis.x * u + m.y_axis.x * v;
    let mut y = m.x_axis.y * u + m.y_axis.y * v;
    let constant = DVec2::new(x.w, y.w) + mapping.offset;
    let constant = constant - whole_tiles(constant, periods(sampler));
    (x.w, y.w) = (constant.x, constant.y);
    UvProjection { x, y, ..of_kind(MapKind::Affine) }
}

/// Returns `surface` on a plane: uv = matrix · (own + at_eye) + offset, where the plane's own coordinates
/// count from the eye's projection `at_eye` on it.
pub fn plane_map(mapping: &Mapping, sampler: &SamplerSpec, at_eye: DVec2) -> UvProjection {
    let constant = uv_matrix(mapping) * at_eye + mapping.offset;
    let constant = constant - whole_tiles(constant, periods(sampler));
    UvProjection { offset: constant, ..matrix_map(mapping, MapKind::Plane) }
}

/// Returns a mapping whose matrix is the scale and rotation.
fn matrix_map(mapping: &Mapping, kind: MapKind) -> UvProjection {
    let m = uv_matrix(mapping);
    UvProjection { m00: m.x_axis.x, m01: m.y_axis.x, m10: m.x_axis.y, m11: m.y_axis.y, ..of_kind(kind) }
}

/// Returns any mapping but `surface` on planes and triangles; `flat` is true if the texture can be read by
/// two coordinates.
pub fn projecting_map(
    mapping: &Mapping,
    sampler: &SamplerSpec,
    eye: DVec3,
    place: &Place,
    flat: bool,
) -> UvProjection {
    let [x, y, z] = frame_rows(mapping, eye, place);
    let map = match mapping.kind {
        MappingKind::Planar => affine_map(mapping, sampler, x, y),
        MappingKind::Cylindrical => angular_map(mapping, sampler, MapKind::Cylindrical, [x, y, z]),
        // `surface` occurs here on spheres only, whose own coordinates are the two angles.
        MappingKind::Spherical | MappingKind::Surface => {
            angular_map(mapping, sampler, MapKind::Spherical, [x, y, z])
        }
        MappingKind::Cube if flat => angular_map(mapping, sampler, MapKind::Box, [x, y, z]),
        MappingKind::Cube => {
            let rows = turned_about_axis(mapping, [x, y, z]);
            UvProjection { x: rows[0], y: rows[1], z: rows[2], ..of_kind(MapKind::Cube) }
        }
        MappingKind::Solid => solid_map(mapping, sampler, [x, y, z]),
    };
    let entity = match mapping.entity {
        Entity::Position | Entity::Centroid => EntityKind::Position,
        Entity::Normal => EntityKind::Normal,
        Entity::Reflection => EntityKind::Reflection,
    };
    UvProjection { entity, ..map }
}

/// Returns the mapping of an environment: `spherical` with the azimuth as u, or the direction for a cube.
pub fn environment_map(environment: &Environment) -> UvProjection {
    let turn = DQuat::from_rotation_y(environment.rotate.to_radians());
    let (axes, kind, [m00, m01, m10, m11]) = match environment.layout {
        // The azimuth grows from +z towards -x, so that -z is in the middle and +x to its right.
        EnvironmentLayout::Equirectangular => {
            ([DVec3::Z, DVec3::Y, DVec3::NEG_X], MapKind::Spherical, [0.0, 1.0, 1.0, 0.0])
        }
        EnvironmentLayout::Cube => ([DVec3::X, DVec3::Y, DVec3::Z], MapKind::Cube, [1.0, 0.0, 0.0, 1.0]),
    };
    // A mirrored environment is read at the mirror image of the direction.
    let across = DVec3::new(if environment.mirror { -1.0 } else { 1.0 }, 1.0, 1.0);
    let [x, y, z] = axes.map(|axis| (turn * (across * axis)).extend(0.0));
    UvProjection { x, y, z, m00, m01, m10, m11, entity: EntityKind::Direction, ..of_kind(kind) }
}

fn of_kind(kind: MapKind) -> UvProjection {
    UvProjection { kind, ..Default::default() }
}

fn angular_map(
    mapping: &Mapping,
    sampler: &SamplerSpec,
    kind: MapKind,
    [x, y, z]: [DVec4; 3],
) -> UvProjection {
    let offset = mapping.offset - whole_tiles(mapping.offset, periods(sampler));
    UvProjection { x, y, z, offset, ..matrix_map(mapping, kind) }
}

/// Returns scale, rotation about the frame's axis and offset, without whole tiles.
fn solid_map(mapping: &Mapping, sampler: &SamplerSpec, rows: [DVec4; 3]) -> UvProjection {
    let scale = mapping.scale.extend(mapping.scale_w).to_array();
    let offset = mapping.offset.extend(mapping.offset_w).to_array();
    let mut rows = turned_about_axis(mapping, rows);
    let period = [sampler.address[0], sampler.address[1], sampler.address_w].map(period);
    for (i, row) in rows.iter_mut().enumerate() {
        *row *= scale[i];
        row.w += offset[i];
        if period[i] > 0.0 {
            row.w -= (row.w / period[i]).floor() * period[i];
        }
    }
    UvProjection { x: rows[0], y: rows[1], z: rows[2], ..of_kind(MapKind::Solid) }
}

/// Rotates frame coordinates by `rotate` about the frame's y, from z towards x.
fn turned_about_axis(mapping: &Mapping, [x, y, z]: [DVec4; 3]) -> [DVec4; 3] {
    let (sin, cos) = mapping.rotate.to_radians().sin_cos();
    [x * cos + z * sin, y, z * cos - x * sin]
}

/// Returns the rows that transform an eye-relative point, or a direction, to frame coordinates. The frame's y
/// is the mapping's axis; x and z follow by the smallest rotation that takes +y there. In `bounds` space the
/// shape's box extends from -1 to 1 on each axis; a box that is flat on an axis keeps world units there.
fn frame_rows(mapping: &Mapping, eye: DVec3, place: &Place) -> [DVec4; 3] {
    let axis = mapping.axis.normalize();
    let turn = if axis.y < -1.0 + 1e-12 {
        DQuat::from_axis_angle(DVec3::X, std::f64::consts::PI)
    } else {
        DQuat::from_rotation_arc(DVec3::Y, axis)
    };
    let (center, stretch) = match (mapping.space, place.bounds) {
        (Space::Bounds, Some(b)) => {
            let half = 0.5 * (b.max - b.min);
            let or_one = |h: f64| if h > 0.0 { 1.0 / h } else { 1.0 };
            (0.5 * (b.min + b.max), DVec3::new(or_one(half.x), or_one(half.y), or_one(half.z)))
        }
        _ => (DVec3::ZERO, DVec3::ONE),
    };
    let origin = if mapping.entity == Entity::Centroid {
        // Transformed by the box's scale, if there is one, as all points are.
        mapping.origin + stretch * (place.centroid.unwrap_or(DVec3::ZERO) - center)
    } else {
        mapping.origin
    };
    // local = axes · (stretch ∘ (p + eye - center) - origin)
    [DVec3::X, DVec3::Y, DVec3::Z].map(|unit| {
        let row = turn * unit;
        if mapping.entity.is_direction() {
            return row.extend(0.0);
        }
        let constant = row.dot(stretch * (eye - center) - origin);
        (row * stretch).extend(constant)
    })
}
