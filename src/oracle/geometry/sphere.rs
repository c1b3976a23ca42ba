//! Spheres. Beams do not know their outline: they ask only whether one may lie in the way. Twin of
//! `glsl/shared/geometry/sphere.glsl`.

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::hit::{Hit, Surface, surface};
use super::kinds::{Form, Round, Search, Shape};
use crate::oracle::camera::Ray;
use crate::oracle::cone::Cone;
use crate::oracle::coverage::{Covered, Cuts, ball_overlap, circle_line};
use crate::oracle::polygon::{AffineFunction, Polygon, middle};
use crate::oracle::projective::{PixelFrustum, point_at, ray_at};
use crate::pack::{LightKind, PackedScene};
use crate::schema::layout::{Header, Light, Sphere};

/// Haines, Günther & Akenine-Möller 2019; -1 on a miss.
pub fn sphere_distance(sphere: &Sphere, ray: &Ray) -> f64 {
    let f = ray.origin - sphere.center;
    let radius = sphere.radius;
    let a = ray.direction.dot(ray.direction);
    let b = -f.dot(ray.direction);
    let closest = f + (b / a) * ray.direction;
    let discriminant = radius * radius - closest.dot(closest);
    let c = f.dot(f) - radius * radius;
    if discriminant.is_nan() || discriminant <= 0.0 || (c > 0.0 && b <= 0.0) {
        return -1.0;
    }
    let root = (a * discriminant).sqrt();
    let q = b + if b < 0.0 { -root } else { root };
    if c > 0.0 || b < 0.0 { c / q } else { q / a }
}

/// A shape as a circle of the disc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub middle: DVec2,
    pub radius: f64,
    /// The radius less the middle's distance; 1 and more covers the disc.
    pub edge: f64,
}

fn circle_of(cone: &Cone, sphere: &Sphere) -> Circle {
    let f = cone.ray.origin - sphere.center;
    let radius = sphere.radius;
    let t = -f.dot(cone.ray.direction) / cone.ray.direction.length_squared();
    // From the inside it is all around, from behind nowhere.
    if f.length_squared() <= radius * radius {
        return Circle { middle: DVec2::ZERO, radius: 1e6, edge: 1e6 };
    }
    if t.is_nan() || t <= 0.0 {
        return Circle { middle: DVec2::ZERO, radius: 1.0, edge: -2.0 };
    }
    let closest = f + t * cone.ray.direction;
    let reach = cone.width + cone.spread * t;
    let scale = 1.0 / if reach < 0.0 { reach.min(-1e-20) } else { reach.max(1e-20) };
    Circle {
        middle: cone.aside(closest) * -scale,
        radius: radius * scale.abs(),
        edge: (radius - closest.length()) * scale.abs(),
    }
}

impl Shape for Sphere {
    fn links(&self) -> [u32; 2] {
        [self.material, self.uv_projection]
    }

    fn distance_to(&self, _: &PackedScene, ray: &Ray, _: f64, _: Search) -> (f64, DVec2) {
        (sphere_distance(self, ray), DVec2::ZERO)
    }

    fn surface_of(&self, _: &PackedScene, point: DVec3, _: DVec2) -> Surface {
        let center = self.center;
        let radius = self.radius;
        let normal = (point - center).normalize();
        let curvature = 1.0 / radius;
        let shape_operator = DMat3::from_diagonal(DVec3::splat(curvature));
        let size = center.abs().max_element() + radius;
        Surface {
            shape_operator,
            curvature,
            size,
            ..surface(center + radius * normal, normal, normal, self.links())
        }
    }

    /// False for a ball that no line stands for: smaller than the cone.
    fn cut_by_shape(&self, cuts: &mut Cuts, cone: &Cone) -> bool {
        let circle = circle_of(cone, self);
        cuts.by(circle_line(circle.middle, circle.radius, circle.edge));
        circle.radius >= 1.0
    }

    fn complete(&self, _: &PackedScene, ray: &Ray, hit: &mut Hit) {
        let t = sphere_distance(self, ray);
        let nearest = (self.center - ray.origin).dot(ray.direction) / ray.direction.length_squared();
        hit.t = if t > 0.0 { t } else { nearest };
    }

    fn tangent_plane(&self, cone: &Cone, t: f64) -> DVec4 {
        let center = self.center;
        let normal = (cone.ray.origin + t * cone.ray.direction - center).normalize();
        normal.extend(normal.dot(center) + self.radius)
    }

    fn may_meet(&self, _: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool {
        let (way, origin) = ray_at(frame, middle(polygon));
        let unit = way.normalize();
        let to = self.center - origin;
        let radius = self.radius;
        let along = to.dot(unit);
        if to.length_squared() <= radius * radius {
            return true;
        }
        if along <= -radius {
            return false;
        }
        // The tangent of the widest angle to a corner, or the farthest of the parallel rays.
        let mut wide = 0.0f64;
        for &corner in &polygon.corners[..polygon.count] {
            let (w, o) = ray_at(frame, corner);
            let away =
                if frame.parallel { (o - origin).length() } else { w.cross(unit).length() / w.dot(unit) };
            wide = wide.max(away);
        }
        let away = (to - along * unit).length();
        let reach = if frame.parallel {
            radius + wide
        } else {
            radius * (1.0 + wide * wide).sqrt() + along.max(0.0) * wide
        };
        away <= 1.0001 * reach
    }

    fn plane_of(&self) -> Option<DVec4> {
        None
    }

    fn form(&self) -> Form<'_> {
        Form::Round(self)
    }
}

impl Round for Sphere {
    fn covered_by(&self, _: &PackedScene, cone: &Cone) -> Covered {
        let circle = circle_of(cone, self);
        ball_overlap(circle.middle, circle.radius, circle.edge)
    }

    fn may_shade(
        &self,
        (frame, near): (&PixelFrustum, AffineFunction),
        polygon: &Polygon,
        light: &Light,
    ) -> bool {
        let (center, radius) = (self.center, self.radius);
        let from = point_at(frame, near, middle(polygon));
        let point = |k: usize| point_at(frame, near, polygon.corners[k]);
        let wide = (0..polygon.count).map(|k| (point(k) - from).length()).fold(0.0, f64::max);
        let way = if light.kind == LightKind::Point { light.position - from } else { light.direction };
        let to = center - from;
        let squared = way.length_squared();
        let mut along = (to.dot(way) / squared).max(0.0);
        if light.kind == LightKind::Point {
            along = along.min(1.0);
        }
        let apart = (to - along * way).length();
        // NaN counts as true.
        apart.is_nan() || apart <= radius + wide
    }
}
