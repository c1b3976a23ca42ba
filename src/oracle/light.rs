//! What lights send to a surface: Lambert and the highlight of Phong, hard shadows. Twin of
//! `glsl/shared/light.glsl`.

use std::f64::consts::PI;

use glam::DVec3;

use super::camera::Ray;
use super::intersect::{FAR, occluded, offset_origin};
use super::math::xyz;
use super::surface::Surface;
use crate::pack::{LightKind, PackedScene};

/// Irradiance over π from all lights: what an albedo of 1 sends on, and a specular colour of 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lit {
    pub diffuse: DVec3,
    pub specular: DVec3,
}

/// cosⁿ α (n + 2) / 2 between the mirror direction and the way to the light.
pub fn phong_lobe(mirror: DVec3, way: DVec3, exponent: f64) -> f64 {
    let cosine = mirror.dot(way) / (mirror.length() * way.length());
    if cosine > 0.0 { cosine.min(1.0).powf(exponent) * (0.5 * exponent + 1.0) } else { 0.0 }
}

pub fn direct_light(scene: &PackedScene, surface: &Surface, shape: u32, mirror: DVec3, exponent: f64) -> Lit {
    let mut sum = Lit::default();
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
                let more = xyz(light.power) * (share / PI);
                sum.diffuse += more;
                sum.specular += more * phong_lobe(mirror, way, exponent);
            }
        }
    }
    sum
}
