//! Planes, spheres, triangles and lights. In: their tables and the scene's materials. Out: the
//! types of the model, none of them degenerate.

use glam::{DVec2, DVec3};

use super::model::{Light, Material, Plane, Space, Sphere, Triangle};
use super::names::Names;
use super::reader::{COLOR, COORDINATE, Field, LENGTH};
use super::source::quoted;
use super::table::Table;
use super::validate::{collinear, parallel};
use crate::error::Result;

pub(super) const PLANE: &[&str] = &["origin", "tangent", "bitangent", "half_extent", "material"];
pub(super) const SPHERE: &[&str] = &["center", "radius", "material"];
pub(super) const TRIANGLE: &[&str] = &["vertices", "uvs", "normals", "material"];
pub(super) const LIGHT: &[&str] = &["kind", "position", "intensity", "direction", "irradiance"];
const POINT_LIGHT: &[&str] = &["kind", "position", "intensity"];
const DIRECTIONAL_LIGHT: &[&str] = &["kind", "direction", "irradiance"];

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
    Ok(Plane { origin, tangent, bitangent, half_extent, material: materials.of(table)? })
}

pub(super) fn sphere(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Sphere> {
    let center = table.required("center")?.vec3(&COORDINATE)?;
    let radius = table.required("radius")?.number(&LENGTH)?;
    Ok(Sphere { center, radius, material: materials.of(table)? })
}

pub(super) fn triangle(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Triangle> {
    let field = table.required("vertices")?;
    let vertices =
        field.array("3 vertices of 3 finite numbers each", [DVec3::ZERO; 3], |f| f.vec3(&COORDINATE))?;
    if collinear(vertices) {
        let what = "the vertices lie on one line, so the triangle has no area; move or remove it";
        return Err(field.error(what, "no area"));
    }
    let mut uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
    if let Some(field) = table.get("uvs") {
        let wanted = "3 texture coordinates of 2 finite numbers each";
        uvs = field.array(wanted, uvs, |f| f.vec2(&COORDINATE))?;
    }
    let normals = table
        .get("normals")
        .map(|field| field.array("3 normals of 3 finite numbers each", [DVec3::Z; 3], Field::direction))
        .transpose()?;
    Ok(Triangle { vertices, uvs, normals, material: materials.of(table)? })
}

pub(super) fn light(table: &Table<'_>) -> Result<Light> {
    let kind = table.required("kind")?;
    if kind.choice(&["point", "directional"], &[true, false])? {
        table.allow_only_with("point", POINT_LIGHT)?;
        let position = table.required("position")?.vec3(&COORDINATE)?;
        let intensity = table.required("intensity")?.vec3(&COLOR)?;
        Ok(Light::Point { position, intensity })
    } else {
        table.allow_only_with("directional", DIRECTIONAL_LIGHT)?;
        let direction = table.required("direction")?.direction()?;
        let irradiance = table.required("irradiance")?.vec3(&COLOR)?;
        Ok(Light::Directional { direction, irradiance })
    }
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
