//! Reads `[[light]]`. Input: its table. Output: a light of the model.

use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::model::Light;

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
    "inner",
    "outer",
    "range",
];

type LightReader = fn(&Table<'_>) -> Result<Light>;
/// Kind, its keys, and its reader.
const LIGHT_KINDS: [(&str, &[&str], LightReader); 6] = [
    ("point", &["kind", "position", "intensity"], point_light),
    ("directional", &["kind", "direction", "irradiance", "angle"], directional_light),
    ("sphere", &["kind", "position", "radius", "intensity"], sphere_light),
    ("rectangle", &["kind", "position", "edge_u", "edge_v", "radiance", "intensity"], rectangle_light),
    ("spot", &["kind", "position", "direction", "intensity", "inner", "outer", "range"], spot_light),
    ("environment", &["kind"], environment_light),
];

pub(super) fn light(table: &Table<'_>) -> Result<Light> {
    let (kind, keys, read) =
        table.required("kind")?.choice(&LIGHT_KINDS.map(|kind| kind.0), &LIGHT_KINDS.map(|kind| kind))?;
    table.allow_only_with(kind, keys)?;
    read(table)
}

fn point_light(table: &Table<'_>) -> Result<Light> {
    let position = table.required("position")?.vec3()?;
    let intensity = table.required("intensity")?.vec3()?;
    Ok(Light::Point { position, intensity })
}

fn directional_light(table: &Table<'_>) -> Result<Light> {
    let direction = table.required("direction")?.vec3()?;
    let irradiance = table.required("irradiance")?.vec3()?;
    let angle = table.get("angle").map_or(Ok(0.0), Field::number)?;
    Ok(Light::Sun { direction, angle, irradiance })
}

fn sphere_light(table: &Table<'_>) -> Result<Light> {
    let position = table.required("position")?.vec3()?;
    let intensity = table.required("intensity")?.vec3()?;
    let radius = table.required("radius")?.number()?;
    Ok(Light::Sphere { position, radius, intensity })
}

fn spot_light(table: &Table<'_>) -> Result<Light> {
    let number = |key, default| table.get(key).map_or(Ok(default), Field::number);
    let outer = table.required("outer")?.number()?;
    Ok(Light::Spot {
        position: table.required("position")?.vec3()?,
        direction: table.required("direction")?.vec3()?,
        intensity: table.required("intensity")?.vec3()?,
        inner: number("inner", outer)?,
        outer,
        range: number("range", f64::INFINITY)?,
    })
}

fn environment_light(_: &Table<'_>) -> Result<Light> {
    Ok(Light::Environment)
}

fn rectangle_light(table: &Table<'_>) -> Result<Light> {
    let position = table.required("position")?.vec3()?;
    let edge_u = table.required("edge_u")?.vec3()?;
    let edge_v = table.required("edge_v")?.vec3()?;
    let radiance = match (table.get("radiance"), table.get("intensity")) {
        (Some(field), None) => field.vec3()?,
        (None, Some(field)) => field.vec3()? / edge_u.cross(edge_v).length(),
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
