//! Bounds of the rounding error of an f32 intersection: first-order error analysis of the formulas
//! (Higham 2002, chapter 3), with the vectors' own lengths as condition. A division may be off by
//! 2.5 ulp, a square root by about as much (Vulkan 1.3, "Precision and Operation of SPIR-V
//! Instructions").

use glam::DVec3;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::hit::FAR;
use moire::internal::oracle::geometry::kinds::{Search, Shape};
use moire::internal::oracle::geometry::sphere::sphere_distance;
use moire::internal::oracle::geometry::triangle::triangle_distance;
use moire::internal::oracle::math::affine;
use moire::internal::pack::PackedScene;
use moire::internal::schema::layout::{Plane, RealBits};

/// Unit roundoff of f32.
pub const U: f64 = 1.0 / 16_777_216.0;
const DIVIDE: f64 = 5.0; // 2.5 ulp
const ROOT: f64 = 8.0; // inversesqrt 2 ulp, then a division or product

#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// Negative on a miss.
    pub t: f64,
    /// Greatest error of t.
    pub error: f64,
    /// True if rounding decides whether it is a hit.
    pub unsure: bool,
    /// The rate at which the normal turns along the surface.
    pub curvature: f64,
    /// Greatest error of barycentric weights.
    pub weights: f64,
}

pub fn estimate(scene: &PackedScene, shape: u32, ray: &Ray) -> Estimate {
    let (planes, spheres) = (scene.records.planes.len() as u32, scene.records.spheres.len() as u32);
    if shape < planes {
        plane(scene, shape as usize, ray)
    } else if shape < planes + spheres {
        sphere(scene, (shape - planes) as usize, ray)
    } else if let Some(index) = disc_of(scene, shape) {
        disc(scene, index, ray)
    } else {
        triangle(scene, (shape - planes - spheres) as usize, ray)
    }
}

/// The index of a shape among the discs, which come last.
pub fn disc_of(scene: &PackedScene, shape: u32) -> Option<usize> {
    let records = &scene.records;
    (shape as usize).checked_sub(records.planes.len() + records.spheres.len() + records.triangles.len())
}

/// Error of a disc's own coordinate: of the point, of the vector from the centre, of the product with an axis.
pub fn disc_own_error(scene: &PackedScene, index: usize, point: DVec3, point_error: f64) -> f64 {
    let disc = &scene.records.discs[index];
    disc.axis_u.length() * (point_error + 6.0 * U * (point.length() + disc.center.length()))
}

fn disc(scene: &PackedScene, index: usize, ray: &Ray) -> Estimate {
    let disc = &scene.records.discs[index];
    let (t, local) = disc.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest);
    let t_plane = (disc.distance - disc.normal.dot(ray.origin)) / disc.normal.dot(ray.direction);
    let error = flat_error(disc.normal, disc.distance, ray, t_plane);
    let point = ray.origin + t_plane * ray.direction;
    let point_error = error * ray.direction.length() + 2.0 * U * (ray.origin.length() + point.length());
    let unsure = (local.length() - 1.0).abs() <= 1.5 * disc_own_error(scene, index, point, point_error);
    Estimate { t, error, unsure, curvature: 0.0, weights: 0.0 }
}

/// Error of t = (n·o' − n·o) / n·d.
fn flat_error(n: DVec3, distance: f64, ray: &Ray, t: f64) -> f64 {
    let (height, slope) = (distance - n.dot(ray.origin), n.dot(ray.direction));
    let size = distance.abs() + (n * ray.origin).abs().element_sum();
    let above = 4.0 * U * size / height.abs();
    let below = 3.0 * U * (n * ray.direction).abs().element_sum() / slope.abs();
    t.abs() * 1.01 * (above + below + DIVIDE * U)
}

fn plane(scene: &PackedScene, index: usize, ray: &Ray) -> Estimate {
    let plane = &scene.records.planes[index];
    let unbounded = Plane { half_extent: RealBits(-1.0), ..*plane };
    let (t, _) = unbounded.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest);
    let error = flat_error(plane.normal, plane.distance, ray, t);
    let point = ray.origin + t * ray.direction;
    let point_error = error * ray.direction.length() + 2.0 * U * (ray.origin.length() + point.length());
    let extent = plane.bounds().unwrap_or(0.0);
    let near_edge =
        [plane.axis_u.extend(plane.eye_u), plane.axis_v.extend(plane.eye_v)].into_iter().any(|row| {
            let own = 4.0 * U * ((row.truncate() * point).abs().element_sum() + row.w.abs());
            (affine(row, point).abs() - extent).abs() <= own + row.truncate().length() * point_error
        });
    let (t, _) = plane.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest);
    Estimate { t, error, unsure: plane.bounds().is_some() && near_edge, curvature: 0.0, weights: 0.0 }
}

fn sphere(scene: &PackedScene, index: usize, ray: &Ray) -> Estimate {
    let sphere = &scene.records.spheres[index];
    let (center, r, d) = (sphere.center, sphere.radius, ray.direction);
    let f = ray.origin - center;
    let (a, b) = (d.dot(d), -f.dot(d));
    let closest = f + (b / a) * d;
    let discriminant = r * r - closest.length_squared();
    let c = f.length_squared() - r * r;
    // Errors: of f·d, of the vector of closest approach, of its square, of the root, of c.
    let e_b = 5.0 * U * f.length() * d.length();
    let e_closest = 18.0 * U * f.length();
    let e_disc = 2.0 * closest.length() * e_closest + 4.0 * U * closest.length_squared() + 2.0 * U * r * r;
    let e_c = 6.0 * U * f.length_squared() + 2.0 * U * r * r;
    let unsure = discriminant.abs() <= e_disc || c.abs() <= e_c;
    let t = sphere_distance(sphere, ray);
    let root = (a * discriminant.max(0.0)).sqrt();
    let e_root = root * (0.5 * e_disc / discriminant.abs() + ROOT * U);
    let q = b.abs() + root;
    let relative = (e_b + e_root) / q + U + if c > 0.0 || b < 0.0 { e_c / c.abs() } else { 4.0 * U };
    let error = t.abs() * 1.01 * (relative + DIVIDE * U);
    Estimate { t, error, unsure, curvature: 2.0 / r, weights: 0.0 }
}

fn triangle(scene: &PackedScene, index: usize, ray: &Ray) -> Estimate {
    let triangle = &scene.records.triangles[index];
    let t = triangle_distance(triangle, ray);
    let corners = [triangle.a, triangle.b, triangle.c].map(|v| v - ray.origin);
    let edges = [0, 1, 2].map(|i| {
        let (p, q) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
        // Subtractions, products, differences, and the dot product: 8 roundings at most.
        (ray.direction.dot(p.cross(q)), 8.0 * U * ray.direction.length() * p.length() * q.length())
    });
    let sum = edges.iter().map(|e| e.0).sum::<f64>();
    let worst = edges.iter().map(|e| e.1).fold(0.0, f64::max);
    let unsure = edges.iter().any(|(e, error)| e.abs() <= *error);
    let weights = 4.0 * worst / sum.abs() + DIVIDE * U;
    let t_plane = if t > 0.0 { t } else { 1.0 };
    let shape_operator = if triangle.is_smooth { 2.0 * weights } else { 0.0 };
    let error = flat_error(triangle.normal, triangle.distance, ray, t_plane);
    Estimate { t, error, unsure, curvature: 0.0, weights: weights.max(shape_operator) }
}
