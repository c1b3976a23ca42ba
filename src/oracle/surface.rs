//! Hit → what shading and mapping need to know of the place. Every shape is two-sided: its normal is
//! turned towards the incoming ray. Twin of `glsl/shared/surface.glsl`.

use glam::{DMat3, DVec2, DVec3};

use super::camera::Ray;
use super::intersect::{Hit, moved_by};
use super::math::xyz;
use crate::pack::PackedScene;
use crate::schema::layout::{Plane, Sphere, Triangle};

/// Where a ray met a shape, and what it needs to know of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surface {
    pub point: DVec3,
    /// Unit, towards the incoming ray.
    pub geometric_normal: DVec3,
    /// Unit, for shading.
    pub normal: DVec3,
    /// The plane's coordinates or the vertices' interpolated uv, and their gradients along the surface.
    pub own_uv: DVec2,
    pub own_gradients: [DVec3; 2],
    /// Change of the normal a unit of way along the surface, and its mean; positive where the shape
    /// bulges towards the ray.
    pub shape_operator: DMat3,
    pub curvature: f64,
    /// The ray comes from behind the shape's own normal.
    pub inside: bool,
    pub material: u32,
    pub map: u32,
    /// The point where the shape does not move.
    pub at_rest: DVec3,
    /// Of the largest coordinate that the point came from.
    pub size: f64,
}

fn surface(point: DVec3, geometric: DVec3, normal: DVec3, link: [u32; 4]) -> Surface {
    Surface {
        point,
        geometric_normal: geometric,
        normal,
        own_uv: DVec2::ZERO,
        own_gradients: [DVec3::ZERO; 2],
        shape_operator: DMat3::ZERO,
        curvature: 0.0,
        inside: false,
        material: link[0],
        map: link[1],
        at_rest: point,
        size: point.abs().max_element(),
    }
}

fn plane_surface(plane: &Plane, point: DVec3, uv: DVec2) -> Surface {
    let normal = xyz(plane.normal).normalize();
    let own_gradients = [xyz(plane.axis_u), xyz(plane.axis_v)];
    Surface { own_uv: uv, own_gradients, ..surface(point, normal, normal, plane.link) }
}

fn sphere_surface(sphere: &Sphere, point: DVec3) -> Surface {
    let center = xyz(sphere.ball);
    let radius = sphere.ball[3];
    let normal = (point - center).normalize();
    let curvature = 1.0 / radius;
    let shape_operator = DMat3::from_diagonal(DVec3::splat(curvature));
    let size = center.abs().max_element() + radius;
    Surface {
        shape_operator,
        curvature,
        size,
        ..surface(center + radius * normal, normal, normal, sphere.link)
    }
}

/// Barycentric weights of a point of the triangle, from the vectors to its corners.
fn weights(triangle: &Triangle, point: DVec3) -> DVec3 {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| xyz(v) - point);
    let n = xyz(triangle.normal);
    let areas = DVec3::new(n.dot(b.cross(c)), n.dot(c.cross(a)), n.dot(a.cross(b)));
    areas / areas.element_sum()
}

fn triangle_surface(triangle: &Triangle, point: DVec3) -> Surface {
    let w = weights(triangle, point);
    let u = DVec3::new(triangle.a[3], triangle.b[3], triangle.c[3]);
    let v = xyz(triangle.v);
    let n = xyz(triangle.normal).normalize();
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(xyz);
    // Gradients of the weights: at right angles to the opposite side, 1 over the height.
    let twice_area = n.dot((b - a).cross(c - b));
    let [wa, wb, wc] = [c - b, a - c, b - a].map(|side| n.cross(side) / twice_area);
    let gradient = |value: DVec3| wa * value.x + wb * value.y + wc * value.z;
    let mut result = surface(point, n, n, triangle.link);
    result.own_uv = DVec2::new(w.dot(u), w.dot(v));
    result.own_gradients = [gradient(u), gradient(v)];
    if triangle.v[3] != 0.0 {
        let normals = [triangle.normal_a, triangle.normal_b, triangle.normal_c].map(xyz);
        let blend = w.x * normals[0] + w.y * normals[1] + w.z * normals[2];
        if let Some(normal) = blend.try_normalize() {
            let outer = |p: DVec3, q: DVec3| DMat3::from_cols(p * q.x, p * q.y, p * q.z);
            let change = outer(normals[0], wa) + outer(normals[1], wb) + outer(normals[2], wc);
            // Of unit length: what is along the normal itself is lost.
            let lost = outer(normal, change.transpose() * normal);
            result.normal = normal;
            result.shape_operator = (change - lost) * (1.0 / blend.length());
            result.curvature = 0.5
                * (result.shape_operator.x_axis.x
                    + result.shape_operator.y_axis.y
                    + result.shape_operator.z_axis.z);
        }
    }
    result
}

/// The surface at a hit; `hit.shape` must be a shape of the scene.
pub fn hit_surface(scene: &PackedScene, ray: &Ray, hit: &Hit) -> Surface {
    let shift = moved_by(scene, ray, hit.shape);
    let point = ray.origin - shift + hit.t * ray.direction;
    let [planes, spheres, _, _] = scene.header.counts;
    let mut surface = if hit.shape < planes {
        plane_surface(&scene.planes[hit.shape as usize], point, hit.local)
    } else if hit.shape < planes + spheres {
        sphere_surface(&scene.spheres[(hit.shape - planes) as usize], point)
    } else {
        triangle_surface(&scene.triangles[(hit.shape - planes - spheres) as usize], point)
    };
    surface.point += shift;
    if surface.geometric_normal.dot(ray.direction) > 0.0 {
        surface.geometric_normal = -surface.geometric_normal;
        surface.normal = -surface.normal;
        surface.shape_operator = -surface.shape_operator;
        surface.curvature = -surface.curvature;
        surface.inside = true;
    }
    surface
}
