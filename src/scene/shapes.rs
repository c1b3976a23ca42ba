//! Planes, spheres, triangles and lights. In: their tables and the scene's materials. Out: the
//! types of the model, none of them degenerate.

use glam::{DVec2, DVec3};

use super::model::{Light, Material, Plane, Space, Sphere, Triangle};
use super::names::Names;
use super::reader::{CAP, COLOR, COORDINATE, Field, LENGTH, NOT_NEGATIVE};
use super::source::quoted;
use super::table::Table;
use super::validate::{collinear, parallel};
use crate::core::error::Result;

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

/// Which material a shape has; `fallback` is where the default one stands or will stand.
pub(super) struct MaterialIndex<'n, 'a> {
    pub names: &'n Names<'a>,
    pub fallback: usize,
}

impl MaterialIndex<'_, '_> {
    fn of(&self, table: &Table<'_>) -> Result<usize> {
        table.get("material").map_or(Ok(self.fallback), |field| self.names.resolve(field))
    }
}

fn motion(table: &Table<'_>) -> Result<DVec3> {
    table.get("motion").map_or(Ok(DVec3::ZERO), |field| field.vec3(&COORDINATE))
}

pub(super) fn plane(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Plane> {
    let origin = table.required("origin")?.vec3(&COORDINATE)?;
    let tangent = table.required("tangent")?.direction()?;
    let bitangent_field = table.required("bitangent")?;
    let bitangent = bitangent_field.direction()?;
    if parallel(tangent, bitangent) {
        let what = "tangent and bitangent are parallel and span no plane; turn one of them";
        return Err(bitangent_field.error(what, "parallel to tangent"));
    }
    let half_extent = table.get("half_extent").map(|field| field.number(&LENGTH)).transpose()?;
    let (material, motion) = (materials.of(table)?, motion(table)?);
    Ok(Plane { origin, tangent, bitangent, half_extent, material, motion })
}

pub(super) fn sphere(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Sphere> {
    let center = table.required("center")?.vec3(&COORDINATE)?;
    let radius = table.required("radius")?.number(&LENGTH)?;
    Ok(Sphere { center, radius, material: materials.of(table)?, motion: motion(table)? })
}

/// None where the vertices lie on one line: meshes have such triangles, and no ray meets them.
pub(super) fn triangle(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Option<Triangle>> {
    let field = table.required("vertices")?;
    let vertices =
        field.array("3 vertices of 3 finite numbers each", [DVec3::ZERO; 3], |f| f.vec3(&COORDINATE))?;
    let mut uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
    if let Some(field) = table.get("uvs") {
        let wanted = "3 texture coordinates of 2 finite numbers each";
        uvs = field.array(wanted, uvs, |f| f.vec2(&COORDINATE))?;
    }
    let normals = table
        .get("normals")
        .map(|field| field.array("3 normals of 3 finite numbers each", [DVec3::Z; 3], Field::direction))
        .transpose()?;
    let triangle =
        Triangle { vertices, uvs, normals, material: materials.of(table)?, motion: motion(table)? };
    Ok((!collinear(vertices)).then_some(triangle))
}

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

/// A map in `space = "bounds"` measures in the shape's box, which an infinite plane lacks.
pub(super) fn check_bounds(table: &Table<'_>, plane: &Plane, material: &Material) -> Result<()> {
    if plane.half_extent.is_some() || material.mapping.space != Space::Bounds {
        return Ok(());
    }
    let what = format!(
        "key \"plane.half_extent\" is missing in [[plane]]: material {} maps in space \"bounds\", and an \
         infinite plane has no bounds; set half_extent, or use space \"world\"",
        quoted(&material.name)
    );
    Err(table.error(&what, "infinite plane"))
}
