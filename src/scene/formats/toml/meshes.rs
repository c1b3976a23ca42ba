//! Reads `[[mesh]]`: a file of triangles, placed and given materials. Input: the section's tables and the scene's
//! folder. Output: triangles of the scene.

use std::path::Path;

use glam::{DAffine3, DMat3, DVec3};
use toml::de::DeValue;

use super::names::Names;
use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::builder::SceneBuilder;
use crate::scene::formats::mesh_file;
use crate::scene::geometry::meshes::{self, Placement};
use crate::scene::model::DEFAULT;

pub(super) const MESH: &[&str] = &["file", "transform", "material", "motion"];
const TRANSFORM: &[&str] = &["translate", "rotate", "scale"];

/// Adds the triangles of all meshes.
pub(super) fn add_all(
    folder: &Path,
    root: &Table<'_>,
    materials: &Names<'_>,
    builder: &mut SceneBuilder,
) -> Result<()> {
    for table in root.repeated("mesh", MESH)? {
        let field = table.required("file")?;
        let path = folder.join(field.string()?);
        let format = mesh_file::format_of(&path).ok_or_else(|| {
            field.expected(&format!("the path of a mesh file (its ending one of {})", mesh_file::endings()))
        })?;
        let placement = table.get("transform").map_or(Ok(Placement::IDENTITY), placement)?;
        let material = table.get("material").map(|field| materials.resolve(field)).transpose()?;
        let motion = table.get("motion").map_or(Ok(DVec3::ZERO), Field::vec3)?;
        let mesh = mesh_file::open(&path, format)
            .map_err(|error| field.error(&error.to_string(), "cannot be read"))?;
        builder.source(path.clone());
        // A material of the scene replaces those of the file.
        let own = match material {
            Some(_) => Vec::new(),
            None => mesh_file::add_materials(&path, &mesh, builder)?,
        };
        meshes::add(builder, &mesh, &placement, &own, material.unwrap_or(DEFAULT), motion)
            .map_err(|what| field.error(&what, "too far away"))?;
    }
    Ok(())
}

/// Reads scale, rotation and translation, or the three rows of a matrix of 3 × 4.
fn placement(field: Field<'_>) -> Result<Placement> {
    if let DeValue::Table(_) = field.value() {
        let table = Table::inline(field, "mesh.transform", TRANSFORM)?;
        let translate = table.get("translate").map_or(Ok(DVec3::ZERO), Field::vec3)?;
        let rotate = table.get("rotate").map_or(Ok(DVec3::ZERO), Field::vec3)?;
        let scale = table.get("scale").map_or(Ok(DVec3::ONE), scale)?;
        return Ok(meshes::placement(translate, rotate, scale));
    }
    let wanted = "a table with the keys translate, rotate, scale, or the 12 numbers of three rows";
    let rows: [f64; 12] = match field.value() {
        DeValue::Array(array) if array.len() == 12 => field.numbers()?,
        _ => return Err(field.expected(wanted)),
    };
    let matrix = DMat3::from_cols_array_2d(&[0, 1, 2].map(|column| [0, 4, 8].map(|row| rows[row + column])));
    Ok(DAffine3 { matrix3: matrix, translation: DVec3::new(rows[3], rows[7], rows[11]) })
}

fn scale(field: Field<'_>) -> Result<DVec3> {
    match field.value() {
        DeValue::Array(_) => field.vec3(),
        _ => {
            let number = field.number().map_err(|_| field.expected("a finite number, or 3 of them"))?;
            Ok(DVec3::splat(number))
        }
    }
}
