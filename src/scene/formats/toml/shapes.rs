//! Reads shapes of all kinds. Input: their tables and the names of the scene's materials. Output: shapes of the scene,
//! in the order of the file, so that the first one beyond the limit is reported. Each kind defines its keys.

use glam::{DVec2, DVec3};

use super::names::Names;
use super::reader::Field;
use super::table::Table;
use crate::core::error::{Error, Result};
use crate::scene::builder::SceneBuilder;
use crate::scene::geometry::{Fields, sections};
use crate::scene::model::DEFAULT;

/// Returns true if a section holds shapes.
pub(super) fn is_shape(section: &str) -> bool {
    sections().any(|kind| kind.name == section)
}

/// Adds all shapes; returns where the first one stands that no ray can meet.
pub(super) fn add_all(
    root: &Table<'_>,
    materials: &Names<'_>,
    builder: &mut SceneBuilder,
) -> Result<Option<String>> {
    let mut tables = Vec::new();
    for kind in sections() {
        let found = root.repeated(kind.name, &kind.keys.concat())?;
        tables.extend(found.into_iter().map(|table| (table, kind)));
    }
    tables.sort_by_key(|(table, _)| table.span.start);
    let mut dropped = None;
    for (table, kind) in &tables {
        let material = table.get("material").map_or(Ok(DEFAULT), |field| materials.resolve(field))?;
        let motion = table.get("motion").map_or(Ok(DVec3::ZERO), Field::vec3)?;
        if builder.read_shape(kind, table, material, motion)? && dropped.is_none() {
            dropped = Some(table.place_in_source());
        }
    }
    Ok(dropped)
}

impl Fields for Table<'_> {
    fn number(&self, key: &'static str) -> Result<Option<f64>> {
        self.get(key).map(Field::number).transpose()
    }

    fn vector(&self, key: &'static str) -> Result<Option<DVec3>> {
        self.get(key).map(Field::vec3).transpose()
    }

    fn vectors(&self, key: &'static str, what: &str) -> Result<Option<[DVec3; 3]>> {
        let wanted = format!("3 {what} of 3 finite numbers each");
        self.get(key).map(|field| field.array(&wanted, [DVec3::ZERO; 3], Field::vec3)).transpose()
    }

    fn coordinates(&self, key: &'static str) -> Result<Option<[DVec2; 3]>> {
        let wanted = "3 texture coordinates of 2 finite numbers each";
        self.get(key).map(|field| field.array(wanted, [DVec2::ZERO; 3], Field::vec2)).transpose()
    }

    fn choice(&self, key: &'static str, names: &[&str]) -> Result<Option<usize>> {
        let places: Vec<usize> = (0..names.len()).collect();
        self.get(key).map(|field| field.choice(names, &places)).transpose()
    }

    fn missing(&self, key: &'static str) -> Error {
        self.lacks(key)
    }
}
