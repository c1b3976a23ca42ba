//! Opens mesh files and the libraries that they name. Input: a path. Output: the mesh, and its materials as materials,
//! textures and samplers of the builder; a library that is missing is noted, and leaves its materials white.

use std::path::Path;

use super::mtl::Library;
use super::read_file;
use crate::core::error::{Error, ErrorKind, Result};
use crate::mesh::{self, Fault, Mesh, MeshFormat, mtl};
use crate::scene::builder::SceneBuilder;
use crate::scene::limits::MAX_SHAPES;
use crate::scene::model::DEFAULT;

/// Most bytes of a mesh file: text of a million triangles takes a tenth of it.
const MAX_BYTES: u64 = 1 << 30;
/// Most bytes of a library of materials.
const MAX_LIBRARY_BYTES: u64 = 16 << 20;

/// Reads a mesh file.
pub(super) fn open(path: &Path, format: &MeshFormat) -> Result<Mesh> {
    let bytes = read_file("mesh", &[format.name], path, MAX_BYTES)?;
    (format.read)(&bytes, MAX_SHAPES).map_err(|fault| of_fault(path, format.name, &fault))
}

/// Returns the format that the ending of a file's name names.
pub(super) fn format_of(path: &Path) -> Option<&'static MeshFormat> {
    let ending = path.extension()?.to_str()?.to_lowercase();
    mesh::FORMATS.iter().find(|format| format.ending == ending)
}

/// Returns the endings of mesh files, as a list in words.
pub(super) fn endings() -> String {
    let endings: Vec<String> = mesh::FORMATS.iter().map(|format| format!(".{}", format.ending)).collect();
    endings.join(", ")
}

fn of_fault(path: &Path, name: &str, fault: &Fault) -> Error {
    Error::new(format!("cannot read {} as {name}: {fault}", path.display())).of_kind(ErrorKind::File)
}

/// Adds the materials that a mesh names. Returns an index for each name: that of the material, or [`DEFAULT`] where no
/// library defines it.
pub(super) fn add_materials(path: &Path, mesh: &Mesh, builder: &mut SceneBuilder) -> Result<Vec<usize>> {
    let mut indices = vec![DEFAULT; mesh.materials.len()];
    for library in &mesh.libraries {
        let library = path.parent().unwrap_or(Path::new("")).join(library);
        let bytes = match read_file("library", &["MTL"], &library, MAX_LIBRARY_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                builder.note(format!("{}: its materials are white: {error}", path.display()));
                continue;
            }
        };
        builder.source(library.clone());
        let materials = mtl::read(&bytes).map_err(|fault| of_fault(&library, "MTL", &fault))?;
        let mut library = Library::new(&library, builder);
        for material in &materials {
            let named = mesh.materials.iter().position(|name| *name == material.name);
            if let Some(place) = named.filter(|&place| indices[place] == DEFAULT) {
                indices[place] = library.add(material);
            }
        }
    }
    let unknown: Vec<&str> = mesh
        .materials
        .iter()
        .zip(&indices)
        .filter(|(_, index)| **index == DEFAULT)
        .map(|(name, _)| name.as_str())
        .collect();
    if let (Some(first), false) = (unknown.first(), mesh.libraries.is_empty()) {
        let count = unknown.len();
        builder.note(format!(
            "{}: {count} of its materials are not defined, the first {first:?}",
            path.display()
        ));
    }
    Ok(indices)
}
