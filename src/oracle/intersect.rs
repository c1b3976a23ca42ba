//! Ray against planes, spheres and triangles: the nearest hit with t > 0, or whether anything lies
//! between. Twin of `glsl/shared/intersect.glsl`.

use glam::DVec3;

use super::camera::Ray;
use super::math::{affine, xyz};
use crate::layout::{NO_SHAPE, Plane, Sphere, Triangle};
use crate::pack::PackedScene;

/// Farther than any hit that counts.
pub const FAR: f64 = 1e30;

#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub t: f64,
    /// Planes first, then spheres, then triangles; `NO_SHAPE` on a miss.
    pub shape: u32,
    /// Barycentric weights of a triangle's vertices b and c.
    pub weights: [f64; 2],
}

pub fn plane_distance(plane: &Plane, ray: &Ray) -> f64 {
    let normal = xyz(plane.normal);
    let height = f64::from(plane.normal[3]) - normal.dot(ray.origin);
    let t = height / normal.dot(ray.direction);
    if plane.link[3] != 0 {
        let p = ray.origin + t * ray.direction;
        let extent = f64::from(f32::from_bits(plane.link[2]));
        let inside = affine(plane.extent_u, p).abs() <= extent && affine(plane.extent_v, p).abs() <= extent;
        return if inside { t } else { -1.0 };
    }
    t
}

/// Haines, Günther & Akenine-Möller 2019.
pub fn sphere_distance(sphere: &Sphere, ray: &Ray) -> f64 {
    let f = ray.origin - xyz(sphere.ball);
    let radius = f64::from(sphere.ball[3]);
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

/// Distance and the barycentric weights of b and c.
pub fn triangle_distance(triangle: &Triangle, ray: &Ray) -> (f64, [f64; 2]) {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| xyz(v) - ray.origin);
    let ea = ray.direction.dot(b.cross(c));
    let eb = ray.direction.dot(c.cross(a));
    let ec = ray.direction.dot(a.cross(b));
    let sum = (ea + eb) + ec;
    let front = ea >= 0.0 && eb >= 0.0 && ec >= 0.0;
    let back = ea <= 0.0 && eb <= 0.0 && ec <= 0.0;
    if !(front || back) || sum == 0.0 {
        return (-1.0, [0.0; 2]);
    }
    let normal = xyz(triangle.normal);
    let height = f64::from(triangle.normal[3]) - normal.dot(ray.origin);
    (height / normal.dot(ray.direction), [eb / sum, ec / sum])
}

pub fn nearest_hit(scene: &PackedScene, ray: &Ray, skip: u32) -> Hit {
    let mut hit = Hit { t: FAR, shape: NO_SHAPE, weights: [0.0; 2] };
    let mut offer = |t: f64, shape: u32, weights: [f64; 2], flat: bool| {
        if t > 0.0 && t < hit.t && !(flat && shape == skip) {
            hit = Hit { t, shape, weights };
        }
    };
    let [planes, spheres, _, _] = scene.header.counts;
    for (i, plane) in scene.planes.iter().enumerate() {
        offer(plane_distance(plane, ray), i as u32, [0.0; 2], true);
    }
    for (i, sphere) in scene.spheres.iter().enumerate() {
        offer(sphere_distance(sphere, ray), planes + i as u32, [0.0; 2], false);
    }
    for (i, triangle) in scene.triangles.iter().enumerate() {
        let (t, weights) = triangle_distance(triangle, ray);
        offer(t, planes + spheres + i as u32, weights, true);
    }
    hit
}

/// True when a shape lies at 0 < t < t_max.
pub fn occluded(scene: &PackedScene, ray: &Ray, t_max: f64, skip: u32) -> bool {
    let between = |t: f64| t > 0.0 && t < t_max;
    let [planes, spheres, _, _] = scene.header.counts;
    let mut flat = scene.planes.iter().enumerate();
    if flat.any(|(i, plane)| i as u32 != skip && between(plane_distance(plane, ray))) {
        return true;
    }
    if scene.spheres.iter().any(|sphere| between(sphere_distance(sphere, ray))) {
        return true;
    }
    let mut flat = scene.triangles.iter().enumerate();
    flat.any(|(i, triangle)| {
        planes + spheres + i as u32 != skip && between(triangle_distance(triangle, ray).0)
    })
}

/// The point moved along the geometric normal by far more than f64's rounding and far less than
/// f32's, where the shader moves it by ulps (Wächter & Binder 2019).
pub fn offset_origin(p: DVec3, n: DVec3) -> DVec3 {
    p + n * (1e-12 * (1.0 + p.abs().max_element()))
}
