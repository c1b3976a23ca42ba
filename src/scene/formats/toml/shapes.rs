//! Planes, spheres, triangles and lights. In: their tables and the names of the scene's materials. Out: the
//! types of the model.

use glam::{DVec2, DVec3};

use super::names::Names;
use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::builder::DEFAULT;
use crate::scene::model::{Light, Plane, Sphere, Triangle};

pub(super) const PLANE: &[&str] = &["origin", "tangent", "bitangent", "half_extent", "material", "motion"];
pub(super) const SPHERE: &[&str] = &["center", "radius", "material", "motion"];
pub(super) const TRIANGLE: &[&str] = &["vertices", "uvs", "normals", "material", "motion"];
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

fn material(table: &Table<'_>, names: &Names<'_>) -> Result<usize> {
    table.get("material").map_or(Ok(DEFAULT), |field| names.resolve(field))
}

fn motion(table: &Table<'_>) -> Result<DVec3> {
    table.get("motion").map_or(Ok(DVec3::ZERO), Field::vec3)
}

pub(super) fn plane(table: &Table<'_>, materials: &Names<'_>) -> Result<Plane> {
    let origin = table.required("origin")?.vec3()?;
    let tangent = table.required("tangent")?.vec3()?;
    let bitangent = table.required("bitangent")?.vec3()?;
    let half_extent = table.get("half_extent").map(Field::number).transpose()?;
    let (material, motion) = (material(table, materials)?, motion(table)?);
    Ok(Plane { origin, tangent, bitangent, half_extent, material, motion })
}

pub(super) fn sphere(table: &Table<'_>, materials: &Names<'_>) -> Result<Sphere> {
    let center = table.required("center")?.vec3()?;
    let radius = table.required("radius")?.number()?;
    Ok(Sphere { center, radius, material: material(table, materials)?, motion: motion(table)? })
}

pub(super) fn triangle(table: &Table<'_>, materials: &Names<'_>) -> Result<Triangle> {
    let field = table.required("vertices")?;
    let vertices = field.array("3 vertices of 3 finite numbers each", [DVec3::ZERO; 3], Field::vec3)?;
    let mut uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
    if let Some(field) = table.get("uvs") {
        let wanted = "3 texture coordinates of 2 finite numbers each";
        uvs = field.array(wanted, uvs, Field::vec2)?;
    }
    let normals = table
        .get("normals")
        .map(|field| field.array("3 normals of 3 finite numbers each", [DVec3::Z; 3], Field::vec3))
        .transpose()?;
    Ok(Triangle { vertices, uvs, normals, material: material(table, materials)?, motion: motion(table)? })
}

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
