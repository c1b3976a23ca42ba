//! Lights → their device records, relative to the eye.

use glam::{DVec3, DVec4};

use super::{LightKind, real4, vec4};
use crate::scene::model::Light;
use crate::schema::layout;

/// The largest cosine of sides that count as at right angles: what f32 rounds them to.
const RIGHT_ANGLE: f64 = 1e-6;

pub fn light(light: &Light, eye: DVec3) -> layout::Light {
    let record = |kind: LightKind, place: DVec4, power: DVec3| layout::Light {
        place: real4(place),
        power: vec4(power.extend(0.0)),
        link: [kind as u32, 0, 0, 0],
        ..Default::default()
    };
    match *light {
        Light::Point { position, intensity } => {
            record(LightKind::Point, (position - eye).extend(0.0), intensity)
        }
        Light::Directional { direction, irradiance } => {
            record(LightKind::Directional, direction.normalize().extend(0.0), irradiance)
        }
        Light::Sphere { position, radius, intensity } => {
            record(LightKind::Sphere, (position - eye).extend(radius), intensity)
        }
        Light::Rectangle { position, edge_u, edge_v, radiance } => {
            let wide = edge_u.length_squared() >= edge_v.length_squared();
            // The same rectangle, which shines to the same side.
            let sides = if wide { [edge_u, edge_v] } else { [edge_v, -edge_u] };
            let right = edge_u.normalize().dot(edge_v.normalize()).abs() <= RIGHT_ANGLE;
            let [edge_u, edge_v] = sides.map(|s| real4(s.extend(if right { s.length() } else { 0.0 })));
            layout::Light {
                edge_u,
                edge_v,
                ..record(LightKind::Rectangle, (position - eye).extend(0.0), radiance)
            }
        }
        Light::Sun { direction, angle, irradiance } => {
            // A cap of height h has the solid angle 2 pi h, and a surface that faces its middle receives
            // pi h (2 - h) of its radiance.
            let height = 2.0 * (0.25 * angle.to_radians()).sin().powi(2);
            let power = irradiance * (2.0 / (2.0 - height));
            record(LightKind::Sun, direction.normalize().extend(height), power)
        }
    }
}
