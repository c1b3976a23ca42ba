//! Ray → radiance, one hit of its path at a time. Twin of `glsl/shared/shade.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::camera::Ray;
use super::intersect::{FAR, Hit, nearest_hit, occluded, offset_origin};
use super::mapping::texture_coordinate;
use super::math::xyz;
use super::texture::look_up;
use crate::layout::{Material, NO_SHAPE, NO_TEXTURE, Plane, Sphere, Triangle};
use crate::pack::{LightKind, PackedScene};
use crate::scene::model::Model;

/// Where a ray met a shape, and what it needs to know of it.
pub struct Surface {
    pub point: DVec3,
    /// Unit, towards the incoming ray.
    pub geometric_normal: DVec3,
    /// Unit, for shading.
    pub normal: DVec3,
    /// The plane's coordinates or the vertices' interpolated uv.
    pub own_uv: DVec2,
    pub material: u32,
    pub map: u32,
}

fn surface(point: DVec3, geometric: DVec3, normal: DVec3, uv: DVec2, link: [u32; 4]) -> Surface {
    Surface { point, geometric_normal: geometric, normal, own_uv: uv, material: link[0], map: link[1] }
}

fn plane_surface(plane: &Plane, point: DVec3, uv: DVec2) -> Surface {
    let normal = xyz(plane.normal).normalize();
    surface(point, normal, normal, uv, plane.link)
}

fn sphere_surface(sphere: &Sphere, point: DVec3) -> Surface {
    let center = xyz(sphere.ball);
    let normal = (point - center).normalize();
    surface(center + f64::from(sphere.ball[3]) * normal, normal, normal, DVec2::ZERO, sphere.link)
}

fn triangle_surface(triangle: &Triangle, point: DVec3, edges: DVec3) -> Surface {
    let w = edges / edges.element_sum();
    let u = DVec3::new(triangle.a[3].into(), triangle.b[3].into(), triangle.c[3].into());
    let uv = DVec2::new(w.dot(u), w.dot(xyz(triangle.v)));
    let geometric = xyz(triangle.normal).normalize();
    let mut normal = geometric;
    if triangle.v[3] != 0.0 {
        let [a, b, c] = [triangle.normal_a, triangle.normal_b, triangle.normal_c].map(xyz);
        normal = (w.x * a + w.y * b + w.z * c).try_normalize().unwrap_or(geometric);
    }
    surface(point, geometric, normal, uv, triangle.link)
}

/// The surface at a hit; `hit.shape` must be a shape of the scene.
pub fn hit_surface(scene: &PackedScene, ray: &Ray, hit: &Hit) -> Surface {
    let point = ray.origin + hit.t * ray.direction;
    let [planes, spheres, _, _] = scene.header.counts;
    let mut surface = if hit.shape < planes {
        plane_surface(&scene.planes[hit.shape as usize], point, hit.local.truncate())
    } else if hit.shape < planes + spheres {
        sphere_surface(&scene.spheres[(hit.shape - planes) as usize], point)
    } else {
        triangle_surface(&scene.triangles[(hit.shape - planes - spheres) as usize], point, hit.local)
    };
    if surface.geometric_normal.dot(ray.direction) > 0.0 {
        surface.geometric_normal = -surface.geometric_normal;
        surface.normal = -surface.normal;
    }
    surface
}

/// The material's colour, linear RGB, times its texture where it has one.
pub fn surface_color(scene: &PackedScene, material: &Material, surface: &Surface) -> DVec3 {
    let color = xyz(material.color);
    let [_, texture, sampler, _] = material.link;
    if texture == NO_TEXTURE {
        return color;
    }
    let uv = texture_coordinate(&scene.maps[surface.map as usize], surface.point, surface.own_uv);
    let texel = look_up(scene, &scene.textures[texture as usize], &scene.samplers[sampler as usize], uv);
    color * texel.truncate()
}

/// Irradiance over π from all lights: what an albedo of 1 sends on.
pub fn direct_light(scene: &PackedScene, surface: &Surface, shape: u32) -> DVec3 {
    let mut sum = DVec3::ZERO;
    let start = offset_origin(surface.point, surface.geometric_normal);
    for light in &scene.lights {
        let point_light = light.link[0] == LightKind::Point as u32;
        let way = if point_light { xyz(light.place) - surface.point } else { xyz(light.place) };
        let squared = way.dot(way);
        let facing = surface.normal.dot(way);
        let share = if point_light { facing / (squared * squared.sqrt()) } else { facing };
        if facing > 0.0 && surface.geometric_normal.dot(way) > 0.0 {
            let (to_light, t_max) =
                if point_light { (xyz(light.place) - start, 1.0) } else { (xyz(light.place), FAR) };
            if !occluded(scene, &Ray { origin: start, direction: to_light }, t_max, shape) {
                sum += xyz(light.power) * (share / PI);
            }
        }
    }
    sum
}

/// d - 2 (d·n) n, for unit n.
pub fn mirrored(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// A path between two hits: the ray, what it still carries, the shape that it leaves.
pub struct Path {
    pub ray: Ray,
    pub throughput: DVec3,
    pub skip: u32,
    pub depth: u32,
    /// False: the path has ended.
    pub goes_on: bool,
}

pub fn camera_path(ray: Ray) -> Path {
    Path { ray, throughput: DVec3::ONE, skip: NO_SHAPE, depth: 0, goes_on: true }
}

/// Follows the path to its next hit; what that adds to the sample is returned.
pub fn advance(scene: &PackedScene, path: &mut Path) -> DVec3 {
    let hit = nearest_hit(scene, &path.ray, path.skip);
    path.goes_on = false;
    if hit.shape == NO_SHAPE {
        return path.throughput * xyz(scene.header.background);
    }
    let surface = hit_surface(scene, &path.ray, &hit);
    let material = &scene.materials[surface.material as usize];
    path.throughput *= surface_color(scene, material, &surface);
    match Model::ALL[material.link[0] as usize] {
        Model::Unlit => return path.throughput,
        Model::Lambert => return path.throughput * direct_light(scene, &surface, hit.shape),
        Model::Mirror => {}
    }
    path.ray = Ray {
        origin: offset_origin(surface.point, surface.geometric_normal),
        direction: mirrored(path.ray.direction, surface.normal),
    };
    path.skip = hit.shape;
    path.goes_on = path.depth < scene.header.size[3];
    path.depth += 1;
    DVec3::ZERO
}
