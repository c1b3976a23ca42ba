//! Reads `[[mesh]]`: a file of triangles, placed and given materials. Input: the section's tables. Output:
//! triangles of the scene.

use std::path::PathBuf;

use glam::{DAffine3, DMat3, DVec3};
use toml::de::DeValue;

use super::names::Names;
use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::builder::SceneBuilder;
use crate::scene::formats::mesh_file::{self, MeshFile, Renamed, Usage};
use crate::scene::geometry::meshes::{self, Placement};

pub(super) const MESH: &[&str] = &["file", "transform", "material", "motion", "scene", "node"];
const TRANSFORM: &[&str] = &["translate", "rotate", "scale"];

/// A section.
struct Section<'a> {
    table: Table<'a>,
    file: Field<'a>,
    path: PathBuf,
    usage: Usage<'a>,
}

/// Adds the triangles of all meshes; those of one file with the first of them.
pub(super) fn add_all(root: &Table<'_>, names: &Names<'_>, builder: &mut SceneBuilder) -> Result<()> {
    let sections = root.repeated("mesh", MESH)?.into_iter().map(|table| section(table, names));
    let mut sections: Vec<Option<Section>> =
        sections.map(|section| section.map(Some)).collect::<Result<_>>()?;
    for first in 0..sections.len() {
        let Some(section) = sections[first].take() else { continue };
        let file = MeshFile::open(&section.path, builder)
            .map_err(|error| section.file.error(&error.to_string(), "cannot be read"))?;
        let path = section.path.clone();
        let mut same = vec![section];
        if file.is_plain() {
            let others = sections[first + 1..].iter_mut();
            same.extend(others.filter_map(|other| other.take_if(|other| other.path == path)));
        }
        let (usages, places): (Vec<_>, Vec<_>) =
            same.into_iter().map(|section| (section.usage, (section.table, section.file))).unzip();
        file.add(&usages, builder)?.map_err(|unsuited| {
            let (table, file) = &places[unsuited.usage];
            table.get(unsuited.key).unwrap_or(*file).error(&unsuited.what, "does not suit the file")
        })?;
    }
    Ok(())
}

fn section<'a>(table: Table<'a>, names: &Names<'_>) -> Result<Section<'a>> {
    let file = table.required("file")?;
    let path = file.path()?;
    if !mesh_file::is_mesh(&path) {
        let wanted = format!("the path of a mesh file (its ending one of {})", mesh_file::endings());
        return Err(file.expected(&wanted));
    }
    let mut usage = Usage {
        placement: table.get("transform").map_or(Ok(Placement::IDENTITY), placement)?,
        motion: table.get("motion").map_or(Ok(DVec3::ZERO), Field::vec3)?,
        scene: table.get("scene").map(name_or_number).transpose()?,
        node: table.get("node").map(name_or_number).transpose()?,
        ..Usage::default()
    };
    if let Some(field) = table.get("material") {
        (usage.material, usage.materials) = materials(field, names)?;
    }
    Ok(Section { table, file, path, usage })
}

/// Reads the name of a material for all triangles, or a table from the file's names to those of the scene.
fn materials(field: Field<'_>, names: &Names<'_>) -> Result<(Option<usize>, Renamed)> {
    let DeValue::Table(_) = field.value() else { return Ok((Some(names.resolve(field)?), Vec::new())) };
    let of_file = |(name, field): (&str, Field<'_>)| Ok((name.to_owned(), names.resolve(field)?));
    Ok((None, field.entries().map(of_file).collect::<Result<_>>()?))
}

/// Reads a name, or a number from 0 as it is written.
fn name_or_number(field: Field<'_>) -> Result<&str> {
    match field.value() {
        DeValue::Integer(number) if number.radix() == 10 => Ok(number.as_str()),
        _ => field.string(),
    }
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
