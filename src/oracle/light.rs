//! Direct lighting: the contribution of all lights by way of a material; area lights are sampled at one
//! point. Twin of `glsl/shared/light.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::appearance::opacity_at;
use super::bsdf::scattering::balanced_lobes;
use super::bsdf::{Bsdf, Lit, evaluate, is_specular};
use super::camera::Ray;
use super::disk_sampling::{concentric_disc, on_cap};
use super::environment::{sampled_sky, sky_radiance};
use super::footprint::around;
use super::geometry::hit::{FAR, Surface};
use super::geometry::rays::{hit_surface, nearest_of_both_sides, occluded, offset_origin};
use super::rectangle::{MIN_SOLID_ANGLE, on_rectangle};
use crate::pack::{LightKind, PackedScene};
use crate::schema::constants::MAX_LAYERS;
use crate::schema::enums::AlphaMode;
use crate::schema::layout::{Light, NO_SHAPE};

/// Shadow rays end at this fraction of the distance to an area light, as shapes beyond it are the light
/// itself.
const BEFORE_LIGHT: f64 = 4095.0 / 4096.0;

/// The vector to a point on a light, the ray parameter up to which shapes occlude it, and the irradiance
/// there over the light's power and the cosine.
#[derive(Clone, Copy, Debug)]
pub struct Aim {
    pub way: DVec3,
    pub reach: f64,
    pub density: f64,
}

/// Samples the cone that the sphere subtends uniformly; from inside the sphere, all directions.
pub fn sphere_aim(light: &Light, point: DVec3, square: DVec2) -> Aim {
    let way = light.position - point;
    let radius = light.radius;
    let squared = way.length_squared().max(1e-30);
    let sine = radius * radius / squared; // squared
    let outside = sine < 1.0;
    let both = 1.0 + (1.0 - sine).max(0.0).sqrt();
    let local = on_cap(concentric_disc(square), if outside { sine / both } else { 2.0 });
    let away = squared * (local.x * local.x + local.y * local.y);
    let half_chord = (radius * radius - away).max(0.0).sqrt();
    let reach = squared.sqrt() * local.z + if outside { -half_chord } else { half_chord };
    let density = if outside { 2.0 / (squared * both) } else { 4.0 / (radius * radius) };
    Aim { way: around(way / squared.sqrt(), local), reach: reach * BEFORE_LIGHT, density }
}

/// Samples the solid angle uniformly; if it is small, or the edges are not at right angles, the area.
pub fn rectangle_aim(light: &Light, point: DVec3, square: DVec2) -> Aim {
    let [u, v] = [light.edge_u, light.edge_v];
    let to_middle = light.position - point;
    let sides = DVec2::new(light.length_u, light.length_v);
    if sides.x > 0.0 {
        let (x, y) = (u / sides.x, v / sides.y);
        let n = x.cross(y);
        let height = -to_middle.dot(n);
        let middle = DVec2::new(to_middle.dot(x), to_middle.dot(y));
        let (place, solid_angle) = on_rectangle(middle, 0.5 * sides, height.max(0.0), square);
        if height > 0.0 && solid_angle >= MIN_SOLID_ANGLE {
            let way = place.x * x + place.y * y + place.z * n;
            return Aim { way, reach: BEFORE_LIGHT, density: solid_angle / way.length() };
        }
    }
    let way = to_middle + (square.x - 0.5) * u + (square.y - 0.5) * v;
    let density = -way.dot(u.cross(v)) / way.length_squared().powi(2);
    Aim { way, reach: BEFORE_LIGHT, density: density.max(0.0) }
}

/// Samples the sun's cap uniformly.
pub fn sun_aim(light: &Light, square: DVec2) -> Aim {
    let local = on_cap(concentric_disc(square), light.cap_height);
    Aim { way: around(light.direction, local), reach: FAR, density: 1.0 }
}

/// Samples the environment's light.
pub fn sky_aim(scene: &PackedScene, square: DVec2) -> Aim {
    let sky = sampled_sky(scene, square);
    Aim { way: sky.way, reach: FAR, density: if sky.density > 0.0 { 1.0 / sky.density } else { 0.0 } }
}

/// Returns the share of its intensity that a spot, or a point with a range, has at the end of `way`
/// (KHR_lights_punctual).
pub fn punctual_share(light: &Light, way: DVec3) -> f64 {
    let squared = way.length_squared();
    let spot = match light.kind {
        LightKind::Spot => {
            let cosine = -way.dot(light.direction) / squared.sqrt();
            let slope = f64::from(light.spot_slope);
            (slope * cosine + f64::from(light.spot_offset)).clamp(0.0, 1.0).powi(2)
        }
        _ => 1.0,
    };
    let part = squared * f64::from(light.inverse_range).powi(2);
    spot * (1.0 - part * part).max(0.0)
}

/// Returns whether the environment lights surfaces.
pub fn is_lit_by_environment(scene: &PackedScene) -> bool {
    scene.header.environment_rows > 0
}

/// Returns whether some ray may pass a surface.
fn is_transparent(scene: &PackedScene) -> bool {
    scene.records.materials.iter().any(|m| m.alpha_mode != AlphaMode::Opaque)
}

/// Returns what arrives along a ray up to `t_max`: all light, times what surfaces on the way let pass, and for light of
/// the environment (`from_sky`) times its radiance there.
pub fn arriving_light(
    scene: &PackedScene,
    mut ray: Ray,
    mut t_max: f64,
    mut skip: u32,
    from_sky: bool,
    random: [u32; 2],
) -> DVec3 {
    let radiance = if from_sky { sky_radiance(scene, &ray, random) } else { DVec3::ONE };
    if !is_transparent(scene) {
        return if occluded(scene, &ray, t_max, skip) { DVec3::ZERO } else { radiance };
    }
    let mut share = 1.0;
    for _ in 0..=MAX_LAYERS {
        let hit = nearest_of_both_sides(scene, &ray, skip);
        if hit.shape == NO_SHAPE || hit.t >= t_max {
            return share * radiance;
        }
        let surface = hit_surface(scene, &ray, &hit);
        let material = &scene.records.materials[surface.material as usize];
        let map = scene.records.uv_projections.get(surface.map as usize);
        share *= 1.0 - opacity_at(scene, material, map, &ray, &surface, random);
        if share <= 0.0 {
            return DVec3::ZERO;
        }
        // The way that is left ends at the same point.
        t_max -= hit.t;
        ray.origin = offset_origin(surface.point, -surface.geometric_normal, surface.size);
        skip = hit.shape;
    }
    DVec3::ZERO
}

/// What direct lighting at a hit depends on beside its surface.
pub struct Directions<'a> {
    pub time: f64,
    /// The shape that is hit.
    pub shape: u32,
    /// Share of the environment's light that arrives.
    pub occlusion: f64,
    /// True if the path may go on, so that the environment is also sampled by the material.
    pub continues: bool,
    pub random: [u32; 2],
    /// Returns the hit's sample on a light.
    pub chosen: &'a dyn Fn(u32) -> DVec2,
}

/// Returns the radiance by direct lighting.
pub fn direct_light(scene: &PackedScene, surface: &Surface, by: &Directions<'_>, bsdf: &Bsdf<'_>) -> Lit {
    let mut sum = Lit::default();
    let start = offset_origin(surface.point, surface.geometric_normal, surface.size);
    for (i, light) in (0..).zip(&scene.records.lights) {
        let square = || (by.chosen)(i);
        let kind = light.kind;
        let aim = match kind {
            LightKind::Point | LightKind::Spot => {
                let way = light.position - surface.point;
                Aim { way, reach: 1.0, density: way.length().powi(-3) * punctual_share(light, way) }
            }
            LightKind::Directional => Aim { way: light.direction, reach: FAR, density: 1.0 },
            LightKind::Sphere => sphere_aim(light, surface.point, square()),
            LightKind::Rectangle => rectangle_aim(light, surface.point, square()),
            LightKind::Sun => sun_aim(light, square()),
            LightKind::Environment => sky_aim(scene, square()),
        };
        let facing = surface.normal.dot(aim.way);
        // Mirrors reflect what rays see.
        let reflects = kind == LightKind::Environment || !is_specular(bsdf.material.model);
        if reflects && facing > 0.0 && surface.geometric_normal.dot(aim.way) > 0.0 {
            let from_start = matches!(kind, LightKind::Point | LightKind::Spot | LightKind::Rectangle);
            let to_light = if from_start { aim.way + (surface.point - start) } else { aim.way };
            let shadow = Ray { origin: start, direction: to_light, time: by.time };
            let from_sky = kind == LightKind::Environment;
            let arrives = arriving_light(scene, shadow, aim.reach, by.shape, from_sky, by.random);
            let mut lobes = evaluate(bsdf, aim.way);
            if from_sky {
                if by.continues {
                    lobes = balanced_lobes(bsdf, lobes, aim.way, 1.0 / aim.density.max(1e-30));
                }
                lobes.x *= by.occlusion;
            }
            let more = arrives * light.power.as_dvec3() * (facing * aim.density / PI);
            sum.first += more * lobes.x;
            sum.second += more * lobes.y;
            sum.third += more * lobes.z;
        }
    }
    sum
}
