//! Ray against planes, spheres and triangles: the nearest hit with t > 0, or whether anything lies
//! between. Flat shapes never hit the ray that left them (`skip`); spheres rely on the offset origin.
//! Twin of `glsl/shared/intersect.glsl`.

use glam::{DVec2, DVec3};

use super::camera::Ray;
use super::math::xyz;
use crate::pack::PackedScene;
use crate::schema::layout::{NO_SHAPE, Plane, Sphere, Triangle};

/// Farther than any hit that counts.
pub const FAR: f64 = 1e30;

#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// In units of the direction's length; `FAR` on a miss.
    pub t: f64,
    /// Planes first, then spheres, then triangles; `NO_SHAPE` on a miss.
    pub shape: u32,
    /// A plane's own (u, v).
    pub local: DVec2,
}

/// How far a shape has moved at the ray's time. Shapes are met, and textured, where they are at time 0, by rays
/// that start as far back.
pub fn moved_by(scene: &PackedScene, ray: &Ray, shape: u32) -> DVec3 {
    scene.motions.get(shape as usize).map_or(DVec3::ZERO, |motion| ray.time * xyz(motion.shift))
}

pub fn at_rest(scene: &PackedScene, ray: &Ray, shape: u32) -> Ray {
    Ray { origin: ray.origin - moved_by(scene, ray, shape), ..*ray }
}

/// Distance, and the plane's own coordinates of the point counted from the eye.
pub fn plane_distance(plane: &Plane, ray: &Ray) -> (f64, DVec2) {
    let normal = xyz(plane.normal);
    let height = plane.normal[3] - normal.dot(ray.origin);
    let t = height / normal.dot(ray.direction);
    let p = ray.origin + t * ray.direction;
    let local = DVec2::new(xyz(plane.axis_u).dot(p), xyz(plane.axis_v).dot(p));
    if let Some(extent) = plane.half_extent() {
        let (u, v) = (local.x + plane.axis_u[3], local.y + plane.axis_v[3]);
        let inside = u.abs() <= extent && v.abs() <= extent;
        return (if inside { t } else { -1.0 }, local);
    }
    (t, local)
}

/// Haines, Günther & Akenine-Möller 2019; -1 on a miss.
pub fn sphere_distance(sphere: &Sphere, ray: &Ray) -> f64 {
    let f = ray.origin - xyz(sphere.ball);
    let radius = sphere.ball[3];
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

/// -1 on a miss: the edge functions d·(p × q) have one sign within the triangle.
pub fn triangle_distance(triangle: &Triangle, ray: &Ray) -> f64 {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| xyz(v) - ray.origin);
    let d = ray.direction;
    let edges = DVec3::new(d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let front = edges.cmpge(DVec3::ZERO).all();
    let back = edges.cmple(DVec3::ZERO).all();
    if !(front || back) || edges == DVec3::ZERO {
        return -1.0;
    }
    let normal = xyz(triangle.normal);
    let height = triangle.normal[3] - normal.dot(ray.origin);
    height / normal.dot(ray.direction)
}

/// The hit with the least t above 0; of hits at the same t the lowest shape.
pub fn nearest_hit(scene: &PackedScene, ray: &Ray, skip: u32) -> Hit {
    let mut hit = Hit { t: FAR, shape: NO_SHAPE, local: DVec2::ZERO };
    let mut offer = |(t, local): (f64, DVec2), shape: u32, flat: bool| {
        if t > 0.0 && t < hit.t && !(flat && shape == skip) {
            hit = Hit { t, shape, local };
        }
    };
    let [planes, spheres, _, _] = scene.header.counts;
    for (i, plane) in scene.planes.iter().enumerate() {
        let shape = i as u32;
        offer(plane_distance(plane, &at_rest(scene, ray, shape)), shape, true);
    }
    for (i, sphere) in scene.spheres.iter().enumerate() {
        let shape = planes + i as u32;
        offer((sphere_distance(sphere, &at_rest(scene, ray, shape)), DVec2::ZERO), shape, false);
    }
    for (i, triangle) in scene.triangles.iter().enumerate() {
        let shape = planes + spheres + i as u32;
        offer((triangle_distance(triangle, &at_rest(scene, ray, shape)), DVec2::ZERO), shape, true);
    }
    hit
}

/// True when a shape lies at 0 < t < t_max.
pub fn occluded(scene: &PackedScene, ray: &Ray, t_max: f64, skip: u32) -> bool {
    let between = |t: f64| t > 0.0 && t < t_max;
    let [planes, spheres, _, _] = scene.header.counts;
    let at_rest = |shape: u32| at_rest(scene, ray, shape);
    let mut flat = (0..).zip(&scene.planes);
    if flat.any(|(i, plane)| i != skip && between(plane_distance(plane, &at_rest(i)).0)) {
        return true;
    }
    let mut round = (planes..).zip(&scene.spheres);
    if round.any(|(i, sphere)| between(sphere_distance(sphere, &at_rest(i)))) {
        return true;
    }
    let mut flat = (planes + spheres..).zip(&scene.triangles);
    flat.any(|(i, triangle)| i != skip && between(triangle_distance(triangle, &at_rest(i))))
}

/// The start of a ray that leaves the surface at p along its unit geometric normal, off it by far more than
/// f64's rounding and far less than f32's; `size` is that of the largest coordinate that p came from.
pub fn offset_origin(p: DVec3, n: DVec3, size: f64) -> DVec3 {
    const CLEARANCE: f64 = 1.0 / (1u64 << 46) as f64;
    p + n * (CLEARANCE * size)
}
