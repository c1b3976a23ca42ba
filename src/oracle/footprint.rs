//! The width of a ray, on surfaces and after reflection and refraction. Twin of `glsl/shared/footprint.glsl`.

use glam::{DMat3, DVec3};

use super::camera::Ray;
use super::math::any_tangent;
use crate::pack::ProjectionKind;
use crate::scene::model::Footprint as FootprintKind;
use crate::schema::layout::Header;

#[derive(Clone, Copy, Debug, Default)]
pub struct RayDifferential {
    /// Change of the ray's origin over the sample's share of the pixel, to the right and down.
    pub origin: [DVec3; 2],
    pub direction: [DVec3; 2],
    /// Width of the cone at the origin.
    pub width: f64,
    /// Growth of the width per unit of t.
    pub spread: f64,
}

/// The footprint of a ray differential on a surface: changes of the point and of the direction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Footprint {
    pub point: [DVec3; 2],
    pub direction: [DVec3; 2],
}

pub fn is_filtered(header: &Header) -> bool {
    header.footprint != FootprintKind::None
}

pub fn uses_cones(header: &Header) -> bool {
    header.footprint == FootprintKind::Cone
}

pub fn camera_differential(header: &Header, ray: &Ray) -> RayDifferential {
    let orthographic = header.projection == ProjectionKind::Orthographic;
    let share = header.sample_side;
    let steps = [header.step_x * share, header.step_y * share];
    let side = header.pixel_side * share;
    let none = [DVec3::ZERO; 2];
    if orthographic {
        RayDifferential { origin: steps, direction: none, width: side, spread: 0.0 }
    } else {
        RayDifferential {
            origin: none,
            direction: steps,
            width: 0.0,
            spread: side / ray.direction.length().sqrt(),
        }
    }
}

/// Transforms v from the frame around +z to one around the unit vector n.
pub fn around(n: DVec3, v: DVec3) -> DVec3 {
    let tangent = any_tangent(n);
    v.x * tangent + v.y * n.cross(tangent) + v.z * n
}

/// Grazing footprints are truncated at this value of 1 / cos.
pub const MAX_STRETCH: f64 = 65536.0;

/// Returns the footprint around the point origin + t direction with unit normal n.
pub fn footprint_at(header: &Header, beam: &RayDifferential, ray: &Ray, t: f64, n: DVec3) -> Footprint {
    let length = ray.direction.length();
    let mut facing = n.dot(ray.direction);
    let least = length / MAX_STRETCH;
    if facing.abs() < least {
        facing = if facing < 0.0 { -least } else { least };
    }
    if !uses_cones(header) {
        let on_surface = |i: usize| {
            let moved = beam.origin[i] + t * beam.direction[i];
            moved - (n.dot(moved) / facing) * ray.direction
        };
        return Footprint { point: [on_surface(0), on_surface(1)], direction: beam.direction };
    }
    let width = (beam.width + beam.spread * t).abs();
    let d = ray.direction / length;
    let across = n.cross(d);
    let sine = across.length();
    // At normal incidence all directions across are equivalent.
    let minor = if sine > 1e-4 { across / sine } else { any_tangent(n) };
    let major = minor.cross(n);
    Footprint {
        point: [minor * width, major * (width * length / facing.abs())],
        direction: [minor * beam.spread, d.cross(minor) * beam.spread],
    }
}

/// Returns the footprint of a ray that escapes the scene: only the change of its direction matters.
pub fn endless_footprint(header: &Header, beam: &RayDifferential, ray: &Ray) -> Footprint {
    if !uses_cones(header) {
        return Footprint { point: [DVec3::ZERO; 2], direction: beam.direction };
    }
    let d = ray.direction.normalize();
    let side = any_tangent(d);
    Footprint { point: [DVec3::ZERO; 2], direction: [side * beam.spread, d.cross(side) * beam.spread] }
}

/// Returns the change of the mirrored direction, given the change of the normal.
pub fn mirrored_change(direction: DVec3, n: DVec3, change: DVec3, normal_change: DVec3) -> DVec3 {
    let d_change = change.dot(n) + direction.dot(normal_change);
    change - 2.0 * (direction.dot(n) * normal_change + d_change * n)
}

/// The intersection of a ray differential with a surface.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    pub ray: Ray,
    pub t: f64,
    pub print: Footprint,
    /// Unit, facing the ray.
    pub normal: DVec3,
    /// Change of the unit normal per unit of distance along the surface, and its mean.
    pub shape_operator: DMat3,
    pub curvature: f64,
}

/// Returns the ray differential after reflection.
pub fn reflected_differential(beam: &RayDifferential, at: &Meeting) -> RayDifferential {
    let d = at.ray.direction;
    let change = |i: usize| {
        mirrored_change(d, at.normal, at.print.direction[i], at.shape_operator * at.print.point[i])
    };
    let width = beam.width + beam.spread * at.t;
    RayDifferential {
        origin: at.print.point,
        direction: [change(0), change(1)],
        width,
        spread: beam.spread + 2.0 * at.curvature * width * d.length(),
    }
}

/// Returns the change of the refracted direction r d - (r d·n + k) n with k² = d² - r² (d² - (d·n)²).
pub fn refracted_change(
    direction: DVec3,
    n: DVec3,
    ratio: f64,
    change: DVec3,
    normal_change: DVec3,
) -> DVec3 {
    let along = direction.dot(n);
    let along_change = change.dot(n) + direction.dot(normal_change);
    let rr = ratio * ratio;
    let squared = direction.length_squared();
    let k = (squared - rr * (squared - along * along)).max(1e-6 * squared).sqrt();
    let k_change = ((1.0 - rr) * direction.dot(change) + rr * along * along_change) / k;
    ratio * change - (ratio * along + k) * normal_change - (ratio * along_change + k_change) * n
}

/// Returns the ray differential after refraction.
pub fn refracted_differential(beam: &RayDifferential, at: &Meeting, ratio: f64) -> RayDifferential {
    let d = at.ray.direction;
    let change = |i: usize| {
        refracted_change(d, at.normal, ratio, at.print.direction[i], at.shape_operator * at.print.point[i])
    };
    let before = (d.dot(at.normal).abs() / d.length()).min(1.0);
    let behind = (1.0 - ratio * ratio * (1.0 - before * before)).max(1e-6).sqrt();
    let squeeze = (behind / before.max(1e-6)).sqrt();
    let width = (beam.width + beam.spread * at.t) * squeeze;
    RayDifferential {
        origin: at.print.point,
        direction: [change(0), change(1)],
        width,
        spread: beam.spread * (ratio / squeeze)
            + (ratio * before - behind) * at.curvature * width * d.length(),
    }
}
