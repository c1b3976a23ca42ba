//! Checks of lights: none is degenerate.

use super::super::limits::{CAP, COLOR, COORDINATE, LENGTH, NOT_NEGATIVE, parallel};
use super::super::model::Light;
use super::super::refusal::{Check, Key};

pub fn light(key: Key, light: &Light) -> Check {
    let [position, direction] = ["position", "direction"].map(|name| key.of(name));
    let [intensity, irradiance, radiance] = ["intensity", "irradiance", "radiance"].map(|name| key.of(name));
    match *light {
        Light::Point { position: place, intensity: power } => {
            position.vector(place, &COORDINATE)?;
            intensity.vector(power, &COLOR)
        }
        Light::Sphere { position: place, radius, intensity: power } => {
            position.vector(place, &COORDINATE)?;
            intensity.vector(power, &COLOR)?;
            key.of("radius").number(radius, &NOT_NEGATIVE)
        }
        Light::Spot { position: place, direction: axis, intensity: power, inner, outer, range } => {
            position.vector(place, &COORDINATE)?;
            direction.direction(axis)?;
            intensity.vector(power, &COLOR)?;
            key.of("outer").number(outer, &CAP)?;
            key.of("inner").number(inner, &CAP)?;
            if inner > outer {
                return key
                    .of("inner")
                    .refuse("inner is above outer; it is the smaller angle", "above outer");
            }
            if range == f64::INFINITY { Ok(()) } else { key.of("range").number(range, &LENGTH) }
        }
        Light::Environment => Ok(()),
        Light::Directional { direction: towards, irradiance: power } => {
            direction.direction(towards)?;
            irradiance.vector(power, &COLOR)
        }
        Light::Sun { direction: towards, angle, irradiance: power } => {
            direction.direction(towards)?;
            irradiance.vector(power, &COLOR)?;
            key.of("angle").number(angle, &CAP)
        }
        Light::Rectangle { position: place, edge_u, edge_v, radiance: power } => {
            position.vector(place, &COORDINATE)?;
            key.of("edge_u").direction(edge_u)?;
            key.of("edge_v").direction(edge_v)?;
            if parallel(edge_u, edge_v) {
                let what = "edge_u and edge_v are parallel and span no area; turn one of them";
                return key.of("edge_v").refuse(what, "parallel to edge_u");
            }
            radiance.vector(power, &COLOR)
        }
    }
}
