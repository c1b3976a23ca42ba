//! Packs lights into device records, relative to the eye.

use glam::{DVec3, Vec3};

use super::LightKind;
use crate::scene::model::Light;
use crate::schema::layout;

/// Largest cosine between edges that count as perpendicular: the rounding error of f32.
const RIGHT_ANGLE: f64 = 1e-6;

/// Cosines between the inner and the outer angle of a spot, at least: the light of equal angles ends within 0.003° from 15°
/// on, and single precision resolves that.
const LEAST_FADE: f64 = 1e-5;

pub fn light(light: &Light, eye: DVec3) -> layout::Light {
    let at = |kind: LightKind, position: DVec3, power: DVec3| layout::Light {
        position: position - eye,
        power: power.as_vec3(),
        kind,
        ..Default::default()
    };
    let towards = |kind: LightKind, direction: DVec3, power: DVec3| layout::Light {
        direction: direction.normalize(),
        power: power.as_vec3(),
        kind,
        ..Default::default()
    };
    match *light {
        Light::Point { position, intensity } => at(LightKind::Point, position, intensity),
        Light::Directional { direction, irradiance } => {
            towards(LightKind::Directional, direction, irradiance)
        }
        Light::Sphere { position, radius, intensity } => {
            layout::Light { radius, ..at(LightKind::Sphere, position, intensity) }
        }
        Light::Rectangle { position, edge_u, edge_v, radiance } => {
            let wide = edge_u.length_squared() >= edge_v.length_squared();
            // The same rectangle, emitting to the same side.
            let sides = if wide { [edge_u, edge_v] } else { [edge_v, -edge_u] };
            let right = edge_u.normalize().dot(edge_v.normalize()).abs() <= RIGHT_ANGLE;
            let [length_u, length_v] = sides.map(|s| if right { s.length() } else { 0.0 });
            let [edge_u, edge_v] = sides;
            let light = at(LightKind::Rectangle, position, radiance);
            layout::Light { edge_u, length_u, edge_v, length_v, ..light }
        }
        Light::Spot { position, direction, intensity, inner, outer, range } => {
            // As KHR_lights_punctual has it.
            let [inner, outer] = [inner, outer].map(|angle| angle.to_radians().cos());
            let slope = 1.0 / (inner - outer).max(LEAST_FADE);
            let whole = outer <= -1.0;
            layout::Light {
                direction: direction.normalize(),
                spot_slope: if whole { 0.0 } else { slope as f32 },
                spot_offset: if whole { 1.0 } else { (-outer * slope) as f32 },
                inverse_range: (1.0 / range) as f32,
                ..at(LightKind::Spot, position, intensity)
            }
        }
        Light::Environment => {
            layout::Light { power: Vec3::ONE, kind: LightKind::Environment, ..Default::default() }
        }
        Light::Sun { direction, angle, irradiance } => {
            // A cap of height h has the solid angle 2 pi h, and the irradiance pi h (2 - h) times its
            // radiance on a surface that faces its centre.
            let height = 2.0 * (0.25 * angle.to_radians()).sin().powi(2);
            let power = irradiance * (2.0 / (2.0 - height));
            layout::Light { cap_height: height, ..towards(LightKind::Sun, direction, power) }
        }
    }
}
