//! Planes, spheres and triangles. In: their tables and the names of the scene's materials. Out: shapes of the scene, in
//! the order of the file, so that of too many the first one over is the one told.

use glam::{DVec2, DVec3};

use super::names::Names;
use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::builder::{DEFAULT, SceneBuilder};
use crate::scene::geometry::{Plane, Sphere, Triangle};

/// Adds the shape of a table; returns whether no ray meets it.
type Reader = fn(&Table<'_>, &Names<'_>, &mut SceneBuilder) -> Result<bool>;

/// Section, its keys, how it is read.
pub(super) const SHAPES: [(&str, &[&str], Reader); 3] = [
    (
        "plane",
        &["origin", "tangent", "bitangent", "half_extent", "material", "motion"],
        |table, materials, builder| {
            builder.shape(plane(table, materials)?);
            Ok(false)
        },
    ),
    ("sphere", &["center", "radius", "material", "motion"], |table, materials, builder| {
        builder.shape(sphere(table, materials)?);
        Ok(false)
    }),
    ("triangle", &["vertices", "uvs", "normals", "material", "motion"], |table, materials, builder| {
        let triangle = triangle(table, materials)?;
        builder.shape(triangle);
        Ok(triangle.is_empty())
    }),
];

/// Adds all shapes. Returns the line of the first that no ray meets.
pub(super) fn add_all(
    root: &Table<'_>,
    materials: &Names<'_>,
    builder: &mut SceneBuilder,
) -> Result<Option<usize>> {
    let mut tables = Vec::new();
    for (section, keys, read) in SHAPES {
        tables.extend(root.repeated(section, keys)?.into_iter().map(|table| (table, read)));
    }
    tables.sort_by_key(|(table, _)| table.span.start);
    let mut dropped = None;
    for (table, read) in &tables {
        if read(table, materials, builder)? && dropped.is_none() {
            dropped = Some(table.line());
        }
    }
    Ok(dropped)
}

fn material(table: &Table<'_>, names: &Names<'_>) -> Result<usize> {
    table.get("material").map_or(Ok(DEFAULT), |field| names.resolve(field))
}

fn motion(table: &Table<'_>) -> Result<DVec3> {
    table.get("motion").map_or(Ok(DVec3::ZERO), Field::vec3)
}

fn plane(table: &Table<'_>, materials: &Names<'_>) -> Result<Plane> {
    let origin = table.required("origin")?.vec3()?;
    let tangent = table.required("tangent")?.vec3()?;
    let bitangent = table.required("bitangent")?.vec3()?;
    let half_extent = table.get("half_extent").map(Field::number).transpose()?;
    let (material, motion) = (material(table, materials)?, motion(table)?);
    Ok(Plane { origin, tangent, bitangent, half_extent, material, motion })
}

fn sphere(table: &Table<'_>, materials: &Names<'_>) -> Result<Sphere> {
    let center = table.required("center")?.vec3()?;
    let radius = table.required("radius")?.number()?;
    Ok(Sphere { center, radius, material: material(table, materials)?, motion: motion(table)? })
}

fn triangle(table: &Table<'_>, materials: &Names<'_>) -> Result<Triangle> {
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
