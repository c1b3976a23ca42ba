//! A cone, and what shapes cover of it. Twin of `glsl/shared/cone.glsl`.

use std::f64::consts::FRAC_2_SQRT_PI;

use glam::{DVec2, DVec3, DVec4};

use super::camera::Ray;
use super::coverage::{Covered, Cuts, ball_overlap, circle_line};
use super::footprint::any_tangent;
use super::intersect::{Hit, plane_distance, sphere_distance};
use super::math::{vec4, xyz};
use crate::pack::PackedScene;
use crate::schema::layout::{NO_SHAPE, Plane, Sphere, Triangle};

/// Radius of a disc of area 1: 1 / √π.
const DISC_RADIUS: f64 = 0.5 * FRAC_2_SQRT_PI;

#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub ray: Ray,
    /// Unit, at right angles to the ray.
    pub x: DVec3,
    pub y: DVec3,
    /// Radius at the origin, and its growth a unit of t.
    pub width: f64,
    pub spread: f64,
    /// row·(p, 1) is positive above the flat surface that the cone leaves; 0 where it leaves none.
    pub floor: DVec4,
}

/// What rises above a surface by less, relatively, lies in its plane.
const LEVEL: f64 = 4e-6;

/// `width` and `spread` are those of a beam: the side of a square. Of the camera's, `across` is the way to
/// the next pixel, else 0.
pub fn cone_of(ray: Ray, width: f64, spread: f64, across: DVec3) -> Cone {
    let unit = ray.direction.normalize();
    let x = (across - across.dot(unit) * unit).try_normalize().unwrap_or_else(|| any_tangent(unit));
    let [width, spread] = [width, spread].map(|w| DISC_RADIUS * w);
    Cone { ray, x, y: unit.cross(x), width, spread, floor: DVec4::ZERO }
}

/// The same cone, which leaves a shape.
pub fn leaving(scene: &PackedScene, cone: Cone, shape: u32) -> Cone {
    if shape == NO_SHAPE {
        return cone;
    }
    let normal = match shape_of(scene, shape) {
        Shape::Plane(plane) => xyz(plane.normal),
        Shape::Triangle(triangle) => xyz(triangle.normal),
        Shape::Sphere(_) => return cone,
    };
    let Ray { origin, direction, .. } = cone.ray;
    let up = if normal.dot(direction) < 0.0 { -normal } else { normal };
    let level = LEVEL * origin.abs().max_element();
    Cone { floor: up.extend(-(up.dot(origin) + level)), ..cone }
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

    /// Half of a disc around a point of a surface lies behind the surface, and would meet what is there.
    pub(super) fn rises_to(&self, point: DVec3) -> bool {
        self.floor == DVec4::ZERO || self.floor.dot(point.extend(1.0)) > 0.0
    }

    fn aside(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.x.dot(v), self.y.dot(v))
    }
}

/// A plane in the cone: met at u at t = (height - w tilt·u) / (facing + s tilt·u), both positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flat {
    pub height: f64,
    pub facing: f64,
    pub tilt: DVec2,
}

pub(super) fn flat_in(cone: &Cone, normal: DVec3, height: f64) -> Flat {
    let above = height - normal.dot(cone.ray.origin);
    let side = if above < 0.0 { -1.0 } else { 1.0 };
    Flat {
        height: side * above,
        facing: side * normal.dot(cone.ray.direction),
        tilt: side * cone.aside(normal),
    }
}

fn cut_bounds(cuts: &mut Cuts, cone: &Cone, plane: &Flat, row: DVec4, extent: f64) {
    let start = row.truncate().dot(cone.ray.origin) + row.w;
    let along = row.truncate().dot(cone.ray.direction);
    let tilt = (start * cone.spread - along * cone.width) * plane.tilt
        + (cone.width * plane.facing + cone.spread * plane.height) * cone.aside(row.truncate());
    let place = tilt.extend(start * plane.facing + along * plane.height);
    let limit = extent * (cone.spread * plane.tilt).extend(plane.facing);
    cuts.by(limit - place);
    cuts.by(limit + place);
}

fn cut_plane(cuts: &mut Cuts, cone: &Cone, plane: &Plane) {
    let seen = flat_in(cone, xyz(plane.normal), plane.normal[3]);
    cuts.by((-cone.width * seen.tilt).extend(seen.height));
    if let Some(extent) = plane.half_extent() {
        cut_bounds(cuts, cone, &seen, vec4(plane.axis_u), extent);
        cut_bounds(cuts, cone, &seen, vec4(plane.axis_v), extent);
    } else {
        cuts.by((cone.spread * seen.tilt).extend(seen.facing));
    }
}

/// A point as a place of the disc, homogeneous.
fn in_disc(cone: &Cone, point: DVec3) -> DVec3 {
    let p = point - cone.ray.origin;
    let t = cone.ray.direction.dot(p) / cone.ray.direction.length_squared();
    cone.aside(p).extend(cone.width + cone.spread * t)
}

fn cut_triangle(cuts: &mut Cuts, cone: &Cone, triangle: &Triangle) {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| in_disc(cone, xyz(v)));
    let normal = xyz(triangle.normal);
    let height = triangle.normal[3] - normal.dot(cone.ray.origin);
    let side = if height < 0.0 { -1.0 } else { 1.0 };
    cuts.by(((-side * cone.width) * cone.aside(normal)).extend(side * height));
    cuts.by(side * a.cross(b));
    cuts.by(side * b.cross(c));
    cuts.by(side * c.cross(a));
}

/// A sphere as a circle of the disc.
#[derive(Clone, Copy, Debug)]
struct Circle {
    middle: DVec2,
    radius: f64,
    /// The radius less the middle's distance; 1 and more covers the disc.
    edge: f64,
}

fn circle_of(cone: &Cone, sphere: &Sphere) -> Circle {
    let f = cone.ray.origin - xyz(sphere.ball);
    let radius = sphere.ball[3];
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

pub(super) enum Shape<'a> {
    Plane(&'a Plane),
    Sphere(&'a Sphere),
    Triangle(&'a Triangle),
}

pub(super) fn shape_of(scene: &PackedScene, shape: u32) -> Shape<'_> {
    let [planes, spheres, _, _] = scene.header.counts;
    if shape < planes {
        Shape::Plane(&scene.planes[shape as usize])
    } else if shape < planes + spheres {
        Shape::Sphere(&scene.spheres[(shape - planes) as usize])
    } else {
        Shape::Triangle(&scene.triangles[(shape - planes - spheres) as usize])
    }
}

/// False for a ball that no line stands for: smaller than the cone.
pub(super) fn cut_shape(cuts: &mut Cuts, scene: &PackedScene, cone: &Cone, shape: u32) -> bool {
    match shape_of(scene, shape) {
        Shape::Plane(plane) => cut_plane(cuts, cone, plane),
        Shape::Triangle(triangle) => cut_triangle(cuts, cone, triangle),
        Shape::Sphere(sphere) => {
            let circle = circle_of(cone, sphere);
            cuts.by(circle_line(circle.middle, circle.radius, circle.edge));
            return circle.radius >= 1.0;
        }
    }
    true
}

/// What the shape covers.
pub(super) fn covered_by(scene: &PackedScene, cone: &Cone, shape: u32) -> Covered {
    if let Shape::Sphere(sphere) = shape_of(scene, shape) {
        let circle = circle_of(cone, sphere);
        return ball_overlap(circle.middle, circle.radius, circle.edge);
    }
    let mut cuts = Cuts::default();
    cut_shape(&mut cuts, scene, cone, shape);
    cuts.covered()
}

/// Where a ray within the shape's outline meets it; rounding may have put it just beside.
pub fn meet(scene: &PackedScene, ray: &Ray, shape: u32) -> Hit {
    let on_plane =
        |normal: [f64; 4]| (normal[3] - xyz(normal).dot(ray.origin)) / xyz(normal).dot(ray.direction);
    match shape_of(scene, shape) {
        Shape::Plane(plane) => Hit { t: on_plane(plane.normal), shape, local: plane_distance(plane, ray).1 },
        Shape::Triangle(triangle) => Hit { t: on_plane(triangle.normal), shape, local: DVec2::ZERO },
        Shape::Sphere(sphere) => {
            let t = sphere_distance(sphere, ray);
            let nearest = (xyz(sphere.ball) - ray.origin).dot(ray.direction) / ray.direction.length_squared();
            Hit { t: if t > 0.0 { t } else { nearest }, shape, local: DVec2::ZERO }
        }
    }
}
