//! A material's mapping on one shape → the rows and matrix that a device multiplies. Scale, rotation
//! and offset follow KHR_texture_transform; whole tiles are taken out of the constants of planes and
//! affine maps, one at a time for `repeat`, two for `mirrored-repeat`, which changes no look-up. An
//! angular map, whose coordinates lie within one turn, keeps its offset as given.

use glam::{DMat2, DQuat, DVec2, DVec3, DVec4};

use super::{MapKind, vec4};
use crate::layout::Map;
use crate::scene::model::{Mapping, MappingKind, Space};
use crate::texture::sampler_spec::{Address, SamplerSpec};

/// An axis-aligned box around a shape.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

/// The linear part of scale, then rotation: uv' = matrix · uv + offset.
pub fn uv_matrix(mapping: &Mapping) -> DMat2 {
    DMat2::from_angle(mapping.rotate.to_radians()) * DMat2::from_diagonal(mapping.scale)
}

/// How many tiles may be taken out of u and v without changing a look-up; 0 for none.
pub fn periods(sampler: &SamplerSpec) -> DVec2 {
    let period = |address| match address {
        Address::Repeat => 1.0,
        Address::MirroredRepeat => 2.0,
        Address::ClampToEdge | Address::ClampToBorder | Address::MirrorClampToEdge => 0.0,
    };
    DVec2::new(period(sampler.address[0]), period(sampler.address[1]))
}

/// The whole periods in `value`, to be subtracted.
pub fn whole_tiles(value: DVec2, periods: DVec2) -> DVec2 {
    let whole = |v: f64, p: f64| if p > 0.0 { (v / p).floor() * p } else { 0.0 };
    DVec2::new(whole(value.x, periods.x), whole(value.y, periods.y))
}

/// uv = matrix · (u, v) + offset, where u and v are the affine functions `row · (p, 1)`.
pub fn affine_map(mapping: &Mapping, sampler: &SamplerSpec, u: DVec4, v: DVec4) -> Map {
    let m = uv_matrix(mapping);
    let mut x = m.x_axis.x * u + m.y_axis.x * v;
    let mut y = m.x_axis.y * u + m.y_axis.y * v;
    let constant = DVec2::new(x.w, y.w) + mapping.offset;
    let constant = constant - whole_tiles(constant, periods(sampler));
    (x.w, y.w) = (constant.x, constant.y);
    Map { x: vec4(x), y: vec4(y), link: [MapKind::Affine as u32, 0, 0, 0], ..Default::default() }
}

/// `surface` on a plane: uv = matrix · (own + at_eye) + offset, where the plane's own coordinates are
/// counted from the eye's place `at_eye` on it.
pub fn plane_map(mapping: &Mapping, sampler: &SamplerSpec, at_eye: DVec2) -> Map {
    let constant = uv_matrix(mapping) * at_eye + mapping.offset;
    let constant = constant - whole_tiles(constant, periods(sampler));
    Map { offset: vec4(constant.extend(0.0).extend(0.0)), ..matrix_map(mapping, MapKind::Plane) }
}

/// A map whose matrix is the mapping's scale and rotation.
fn matrix_map(mapping: &Mapping, kind: MapKind) -> Map {
    let m = uv_matrix(mapping);
    Map {
        matrix: vec4(DVec4::new(m.x_axis.x, m.y_axis.x, m.x_axis.y, m.y_axis.y)),
        link: [kind as u32, 0, 0, 0],
        ..Default::default()
    }
}

/// `planar`, `cylindrical` or `spherical`, by position relative to the eye.
pub fn projecting_map(mapping: &Mapping, sampler: &SamplerSpec, eye: DVec3, bounds: Option<Bounds>) -> Map {
    let [x, y, z] = frame_rows(mapping, eye, bounds);
    match mapping.kind {
        MappingKind::Planar => affine_map(mapping, sampler, x, y),
        MappingKind::Cylindrical => angular_map(mapping, sampler, MapKind::Cylindrical, [x, y, z]),
        // `surface` reaches this on spheres only, whose own coordinates are the two angles.
        MappingKind::Spherical | MappingKind::Surface => {
            angular_map(mapping, sampler, MapKind::Spherical, [x, y, z])
        }
    }
}

fn angular_map(mapping: &Mapping, sampler: &SamplerSpec, kind: MapKind, [x, y, z]: [DVec4; 3]) -> Map {
    let offset = mapping.offset - whole_tiles(mapping.offset, periods(sampler));
    Map {
        x: vec4(x),
        y: vec4(y),
        z: vec4(z),
        offset: vec4(offset.extend(0.0).extend(0.0)),
        ..matrix_map(mapping, kind)
    }
}

/// Rows that give the frame coordinates of an eye-relative point. The frame's y is the mapping's
/// axis; x and z follow by the smallest rotation that takes +y there. In `bounds` space the shape's
/// box runs from -1 to 1 on each axis; a box that is flat on an axis keeps world units there.
fn frame_rows(mapping: &Mapping, eye: DVec3, bounds: Option<Bounds>) -> [DVec4; 3] {
    let axis = mapping.axis.normalize();
    let turn = if axis.y < -1.0 + 1e-12 {
        DQuat::from_axis_angle(DVec3::X, std::f64::consts::PI)
    } else {
        DQuat::from_rotation_arc(DVec3::Y, axis)
    };
    let (center, stretch) = match (mapping.space, bounds) {
        (Space::Bounds, Some(b)) => {
            let half = 0.5 * (b.max - b.min);
            let or_one = |h: f64| if h > 0.0 { 1.0 / h } else { 1.0 };
            (0.5 * (b.min + b.max), DVec3::new(or_one(half.x), or_one(half.y), or_one(half.z)))
        }
        _ => (DVec3::ZERO, DVec3::ONE),
    };
    // local = axes · (stretch ∘ (p + eye - center) - origin)
    [DVec3::X, DVec3::Y, DVec3::Z].map(|unit| {
        let row = turn * unit;
        let constant = row.dot(stretch * (eye - center) - mapping.origin);
        (row * stretch).extend(constant)
    })
}
