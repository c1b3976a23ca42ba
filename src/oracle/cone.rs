//! A cone, the shapes that it touches, and what is seen of each. Twin of `glsl/shared/cone.glsl`.

use std::f64::consts::FRAC_2_SQRT_PI;

use glam::{DVec2, DVec3, DVec4};

use super::camera::Ray;
use super::coverage::{Covered, Cuts, LEAST_SHARE, NOTHING, ball_overlap, circle_line};
use super::footprint::any_tangent;
use super::intersect::{FAR, Hit, plane_distance, sphere_distance, triangle_distance};
use super::math::{vec4, xyz};
use crate::layout::{Plane, Sphere, Triangle};
use crate::pack::PackedScene;

/// Shapes that a cone keeps: the nearest.
pub const MOST_PIECES: usize = 8;

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
}

/// A shape in the cone.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub shape: u32,
    /// At the centroid; the least and the largest over the disc.
    pub t: f64,
    pub near: f64,
    pub far: f64,
    /// Share of the cone's cross-section; of that, what nothing nearer hides; the centroid of what is seen.
    pub area: f64,
    pub seen: f64,
    pub center: DVec2,
}

/// The nearest pieces, in order.
#[derive(Clone, Debug)]
pub struct Pieces {
    pub list: Vec<Piece>,
    /// What pieces that were not kept leave of a place, if they lie anywhere.
    pub clear: f64,
}

/// `width` and `spread` are those of a beam: the side of a square. Of the camera's, `across` is the way to
/// the next pixel, else 0.
pub fn cone_of(ray: Ray, width: f64, spread: f64, across: DVec3) -> Cone {
    let unit = ray.direction.normalize();
    let x = (across - across.dot(unit) * unit).try_normalize().unwrap_or_else(|| any_tangent(unit));
    Cone { ray, x, y: unit.cross(x), width: DISC_RADIUS * width, spread: DISC_RADIUS * spread }
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

    fn aside(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.x.dot(v), self.y.dot(v))
    }
}

/// A plane in the cone: met at u at t = (height - w tilt·u) / (facing + s tilt·u), both positive.
#[derive(Clone, Copy, Debug)]
pub struct Flat {
    height: f64,
    facing: f64,
    tilt: DVec2,
}

fn flat_in(cone: &Cone, normal: DVec3, height: f64) -> Flat {
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
    let seen = flat_in(cone, xyz(plane.normal), plane.normal[3].into());
    cuts.by((-cone.width * seen.tilt).extend(seen.height));
    if plane.link[3] != 0 {
        let extent = f32::from_bits(plane.link[2]).into();
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
    let height = f64::from(triangle.normal[3]) - normal.dot(cone.ray.origin);
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
    let radius = f64::from(sphere.ball[3]);
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

enum Shape<'a> {
    Plane(&'a Plane),
    Sphere(&'a Sphere),
    Triangle(&'a Triangle),
}

fn shape_of(scene: &PackedScene, shape: u32) -> Shape<'_> {
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
fn cut_shape(cuts: &mut Cuts, scene: &PackedScene, cone: &Cone, shape: u32) -> bool {
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

/// Where a ray within the shape's outline meets it; rounding may have put it just beside.
pub fn meet(scene: &PackedScene, ray: &Ray, shape: u32) -> Hit {
    let on_plane = |normal: [f32; 4]| {
        (f64::from(normal[3]) - xyz(normal).dot(ray.origin)) / xyz(normal).dot(ray.direction)
    };
    match shape_of(scene, shape) {
        Shape::Plane(plane) => Hit { t: on_plane(plane.normal), shape, local: plane_distance(plane, ray).1 },
        Shape::Triangle(triangle) => {
            Hit { t: on_plane(triangle.normal), shape, local: triangle_distance(triangle, ray).1 }
        }
        Shape::Sphere(sphere) => {
            let t = sphere_distance(sphere, ray);
            let nearest = (xyz(sphere.ball) - ray.origin).dot(ray.direction) / ray.direction.length_squared();
            Hit { t: if t > 0.0 { t } else { nearest }, shape, local: DVec3::ZERO }
        }
    }
}

/// How deep a shape lies over the disc.
fn depth_of(scene: &PackedScene, cone: &Cone, shape: u32, t: f64, area: f64) -> Flat {
    match shape_of(scene, shape) {
        Shape::Plane(plane) => flat_in(cone, xyz(plane.normal), plane.normal[3].into()),
        Shape::Triangle(triangle) => flat_in(cone, xyz(triangle.normal), triangle.normal[3].into()),
        Shape::Sphere(_) if area < 1.0 => Flat { height: t, facing: 1.0, tilt: DVec2::ZERO },
        Shape::Sphere(sphere) => {
            let center = xyz(sphere.ball);
            let normal = (cone.ray.origin + t * cone.ray.direction - center).normalize();
            flat_in(cone, normal, normal.dot(center) + f64::from(sphere.ball[3]))
        }
    }
}

/// t of a flat at the two ends of the disc between which it changes.
fn depths(cone: &Cone, depth: &Flat) -> [f64; 2] {
    let tilt = depth.tilt.length();
    let [first, second] = [tilt, -tilt].map(|tilt| {
        let facing = depth.facing + tilt * cone.spread;
        if facing > 0.0 { ((depth.height - tilt * cone.width) / facing).max(0.0) } else { FAR }
    });
    [first.min(second), first.max(second)]
}

fn keep(pieces: &mut Pieces, scene: &PackedScene, cone: &Cone, shape: u32, covered: Covered, t_max: f64) {
    let Covered { share, center } = covered;
    let t = meet(scene, &cone.ray_at(center), shape).t;
    if !(share > LEAST_SHARE && t > 0.0 && t < t_max) {
        return;
    }
    let [near, far] = depths(cone, &depth_of(scene, cone, shape, t, share));
    let at = pieces.list.partition_point(|p| p.t <= t);
    pieces.list.insert(at, Piece { shape, t, near, far, area: share, seen: share, center });
    if pieces.list.len() > MOST_PIECES
        && let Some(farthest) = pieces.list.pop()
    {
        pieces.clear *= 1.0 - farthest.area;
    }
}

/// What the shape covers.
fn covered_by(scene: &PackedScene, cone: &Cone, shape: u32) -> Covered {
    if let Shape::Sphere(sphere) = shape_of(scene, shape) {
        let circle = circle_of(cone, sphere);
        return ball_overlap(circle.middle, circle.radius, circle.edge);
    }
    let mut cuts = Cuts::default();
    cut_shape(&mut cuts, scene, cone, shape);
    cuts.covered()
}

/// All shapes but `skip` that the cone touches before t_max; the nearest ones, in order.
pub fn gather(scene: &PackedScene, cone: &Cone, skip: u32, t_max: f64) -> Pieces {
    let mut pieces = Pieces { list: Vec::new(), clear: 1.0 };
    let [planes, spheres, triangles, _] = scene.header.counts;
    for shape in (0..planes + spheres + triangles).filter(|shape| *shape != skip) {
        let covered = covered_by(scene, cone, shape);
        if covered.share > 0.0 {
            keep(&mut pieces, scene, cone, shape, covered, t_max);
        }
    }
    // Nothing behind the first that covers all is seen, if nothing of it lies before that.
    let (mut far, mut count) = (FAR, 0);
    for (i, piece) in pieces.list.iter().enumerate() {
        count = if piece.near < far { i + 1 } else { count };
        far = if piece.area >= 1.0 { far.min(piece.far) } else { far };
    }
    pieces.list.truncate(count);
    pieces
}

/// How two pieces lie over each other: where a hides b, or where b hides a; and whether both are so.
fn hidden(scene: &PackedScene, cone: &Cone, a: &Piece, b: &Piece, turned: bool) -> (Covered, bool) {
    let mut cuts = Cuts::default();
    let mut has_lines = |p: &Piece| p.area >= 1.0 || cut_shape(&mut cuts, scene, cone, p.shape);
    let (a_has_lines, b_has_lines) = (has_lines(a), has_lines(b));
    if !a_has_lines || !b_has_lines {
        // As good as anywhere.
        let center = if a_has_lines { b.center } else { a.center };
        return (Covered { share: if turned { 0.0 } else { a.area * b.area }, center }, false);
    }
    let [p, q] = [a, b].map(|piece| depth_of(scene, cone, piece.shape, piece.t, piece.area));
    let tilt = (q.height * cone.spread + cone.width * q.facing) * p.tilt
        - (p.height * cone.spread + cone.width * p.facing) * q.tilt;
    let before = tilt.extend(q.height * p.facing - p.height * q.facing);
    cuts.by(if turned { -before } else { before });
    (cuts.covered(), before.z * before.z < tilt.length_squared())
}

fn within_disc(center: DVec2) -> DVec2 {
    center / center.length().max(1.0)
}

/// What is seen of each piece, and its centroid; what nothing covers is the answer. A piece that is seen in
/// part hides in proportion.
pub fn lay_over(pieces: &mut Pieces, scene: &PackedScene, cone: &Cone) -> Covered {
    let list = &mut pieces.list;
    let mut rest = 1.0 - list.first().map_or(0.0, |p| p.area);
    for i in 1..list.len() {
        let piece = list[i];
        let (mut seen, mut moment) = (piece.area, piece.area * piece.center);
        for other in &mut list[..i] {
            let (lost, crossing) = hidden(scene, cone, other, &piece, false);
            let share = lost.share * (other.seen / other.area);
            seen -= share;
            moment -= share * lost.center;
            if crossing {
                // The piece behind comes through the one before it.
                let (lost, _) = hidden(scene, cone, other, &piece, true);
                let left = (other.seen - lost.share).max(0.0);
                rest += other.seen - left;
                if left > LEAST_SHARE {
                    other.center = (other.seen * other.center - lost.share * lost.center) / left;
                }
                other.seen = left;
            }
        }
        seen = seen.min(rest);
        let piece = &mut list[i];
        if seen > LEAST_SHARE {
            piece.center = within_disc(moment / seen);
            piece.seen = seen;
        } else {
            piece.seen = 0.0;
        }
        rest -= piece.seen;
    }
    if rest.is_nan() || rest <= LEAST_SHARE {
        return NOTHING;
    }
    let moment: DVec2 = list.iter().map(|p| p.seen * p.center).sum();
    Covered { share: rest, center: within_disc(-moment / rest) }
}
