//! `[[light]]`. In: its table. Out: the light of the model, not degenerate.

use super::model::Light;
use super::reader::{CAP, COLOR, COORDINATE, NOT_NEGATIVE};
use super::table::Table;
use super::validate::parallel;
use crate::core::error::Result;

pub(super) const LIGHT: &[&str] = &[
    "kind",
    "position",
    "intensity",
    "direction",
    "irradiance",
    "angle",
    "radius",
    "edge_u",
    "edge_v",
    "radiance",
];

type LightReader = fn(&Table<'_>) -> Result<Light>;
/// Kind, its keys, how it is read.
const LIGHT_KINDS: [(&str, &[&str], LightReader); 4] = [
    ("point", &["kind", "position", "intensity"], point_light),
    ("directional", &["kind", "direction", "irradiance", "angle"], directional_light),
    ("sphere", &["kind", "position", "radius", "intensity"], sphere_light),
    ("rectangle", &["kind", "position", "edge_u", "edge_v", "radiance", "intensity"], rectangle_light),
];

/// Without an extent a sphere is a point, and a sun the directional light.
pub(super) fn light(table: &Table<'_>) -> Result<Light> {
    let (kind, keys, read) =
        table.required("kind")?.choice(&LIGHT_KINDS.map(|kind| kind.0), &LIGHT_KINDS.map(|kind| kind))?;
    table.allow_only_with(kind, keys)?;
    read(table)
}

fn point_light(table: &Table<'_>) -> Result<Light> {
    let position = table.required("position")?.vec3(&COORDINATE)?;
    let intensity = table.required("intensity")?.vec3(&COLOR)?;
    Ok(Light::Point { position, intensity })
}

fn directional_light(table: &Table<'_>) -> Result<Light> {
    let direction = table.required("direction")?.direction()?;
    let irradiance = table.required("irradiance")?.vec3(&COLOR)?;
    let angle = table.get("angle").map_or(Ok(0.0), |field| field.number(&CAP))?;
    Ok(if angle > 0.0 {
        Light::Sun { direction, angle, irradiance }
    } else {
        Light::Directional { direction, irradiance }
    })
}

fn sphere_light(table: &Table<'_>) -> Result<Light> {
    let position = table.required("position")?.vec3(&COORDINATE)?;
    let intensity = table.required("intensity")?.vec3(&COLOR)?;
    let radius = table.required("radius")?.number(&NOT_NEGATIVE)?;
    Ok(if radius > 0.0 {
        Light::Sphere { position, radius, intensity }
    } else {
        Light::Point { position, intensity }
    })
}

fn rectangle_light(table: &Table<'_>) -> Result<Light> {
    let position = table.required("position")?.vec3(&COORDINATE)?;
    let edge_u = table.required("edge_u")?.direction()?;
    let edge_v_field = table.required("edge_v")?;
    let edge_v = edge_v_field.direction()?;
    if parallel(edge_u, edge_v) {
        let what = "edge_u and edge_v are parallel and span no area; turn one of them";
        return Err(edge_v_field.error(what, "parallel to edge_u"));
    }
    let radiance = match (table.get("radiance"), table.get("intensity")) {
        (Some(field), None) => field.vec3(&COLOR)?,
        (None, Some(field)) => field.vec3(&COLOR)? / edge_u.cross(edge_v).length(),
        (Some(_), Some(field)) => {
            return Err(field.error("radiance is given too; keep one of the two", "excludes radiance"));
        }
        (None, None) => {
            let what =
                "key \"light.radiance\" is missing: give radiance, or the intensity along edge_u × edge_v";
            return Err(table.error(what, "needs radiance or intensity"));
        }
    };
    Ok(Light::Rectangle { position, edge_u, edge_v, radiance })
}
