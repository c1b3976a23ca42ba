//! Cones; their coverage by shapes is in `geometry/cones.rs`. Twin of `glsl/shared/cone.glsl`.

use std::f64::consts::FRAC_2_SQRT_PI;

use glam::{DVec2, DVec3, DVec4};

use super::camera::Ray;
use super::math::any_tangent;

/// Radius of a disc of area 1: 1 / √π.
const DISC_RADIUS: f64 = 0.5 * FRAC_2_SQRT_PI;

#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub ray: Ray,
    /// Unit vectors perpendicular to the ray.
    pub x: DVec3,
    pub y: DVec3,
    /// Radius at the origin, and its growth per unit of t.
    pub width: f64,
    pub spread: f64,
    /// row·(p, 1) is positive above the flat surface that the cone leaves; 0 if there is none.
    pub floor: DVec4,
}

/// Points that rise above a surface by a smaller relative amount are in its plane.
pub(super) const LEVEL: f64 = 4e-6;

/// Returns a cone from `width` and `spread` of a square. For the camera's cone, `across` is the direction to
/// the next pixel, otherwise 0.
pub fn cone_of(ray: Ray, width: f64, spread: f64, across: DVec3) -> Cone {
    let unit = ray.direction.normalize();
    let x = (across - across.dot(unit) * unit).try_normalize().unwrap_or_else(|| any_tangent(unit));
    let [width, spread] = [width, spread].map(|w| DISC_RADIUS * w);
    Cone { ray, x, y: unit.cross(x), width, spread, floor: DVec4::ZERO }
}

impl Cone {
    pub fn ray_at(&self, u: DVec2) -> Ray {
        let aside = u.x * self.x + u.y * self.y;
        Ray {
            origin: self.ray.origin + self.width * aside,
            direction: self.ray.direction + self.spread * aside,
            time: 0.0,
        }
    }

    /// Returns true if the point is above the surface that the cone leaves: half of a disc around a point of
    /// a surface is below the surface, and would meet the shapes there.
    pub(super) fn rises_to(&self, point: DVec3) -> bool {
        self.floor == DVec4::ZERO || self.floor.dot(point.extend(1.0)) > 0.0
    }

    pub(super) fn aside(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.x.dot(v), self.y.dot(v))
    }
}

/// A plane in the cone: the ray at u meets it at t = (height - w tilt·u) / (facing + s tilt·u), both
/// positive.
#[derive(Clone, Copy, Debug)]
pub struct FlatDepth {
    pub height: f64,
    pub facing: f64,
    pub tilt: DVec2,
}

pub(super) fn flat_in(cone: &Cone, normal: DVec3, height: f64) -> FlatDepth {
    let above = height - normal.dot(cone.ray.origin);
    let side = if above < 0.0 { -1.0 } else { 1.0 };
    FlatDepth {
        height: side * above,
        facing: side * normal.dot(cone.ray.direction),
        tilt: side * cone.aside(normal),
    }
}
