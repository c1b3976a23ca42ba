//! Direct lighting: the contribution of all lights by way of a material; area lights are sampled at one
//! point. Twin of `glsl/shared/light.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::bsdf::{Bsdf, Lit, evaluate};
use super::camera::Ray;
use super::disk_sampling::{concentric_disc, on_cap};
use super::footprint::around;
use super::geometry::hit::{FAR, Surface};
use super::geometry::rays::{occluded, offset_origin};
use super::rectangle::{MIN_SOLID_ANGLE, on_rectangle};
use crate::pack::{LightKind, PackedScene};
use crate::schema::layout::Light;

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

/// Returns the radiance by direct lighting; `chosen` returns the hit's sample on a light.
pub fn direct_light(
    scene: &PackedScene,
    surface: &Surface,
    time: f64,
    shape: u32,
    bsdf: &Bsdf<'_>,
    chosen: &dyn Fn(u32) -> DVec2,
) -> Lit {
    let mut sum = Lit::default();
    let start = offset_origin(surface.point, surface.geometric_normal, surface.size);
    for (i, light) in (0..).zip(&scene.records.lights) {
        let square = || chosen(i);
        let kind = light.kind;
        let aim = match kind {
            LightKind::Point => {
                let way = light.position - surface.point;
                Aim { way, reach: 1.0, density: way.length().powi(-3) }
            }
            LightKind::Directional => Aim { way: light.direction, reach: FAR, density: 1.0 },
            LightKind::Sphere => sphere_aim(light, surface.point, square()),
            LightKind::Rectangle => rectangle_aim(light, surface.point, square()),
            LightKind::Sun => sun_aim(light, square()),
        };
        let facing = surface.normal.dot(aim.way);
        if facing > 0.0 && surface.geometric_normal.dot(aim.way) > 0.0 {
            let from_start = matches!(kind, LightKind::Point | LightKind::Rectangle);
            let to_light = if from_start { aim.way + (surface.point - start) } else { aim.way };
            if !occluded(scene, &Ray { origin: start, direction: to_light, time }, aim.reach, shape) {
                let more = light.power.as_dvec3() * (facing * aim.density / PI);
                let [first, second] = evaluate(bsdf, aim.way);
                sum.first += more * first;
                sum.second += more * second;
            }
        }
    }
    sum
}
