//! Opens mesh files and the libraries that they name. Input: a path. Output: the mesh, and its materials as materials,
//! textures and samplers of the builder; a library that is missing is noted, and leaves its materials white.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::mtl::Library;
use super::unreadable;
use crate::core::error::{Error, ErrorKind, Result};
use crate::mesh::{self, Fault, Mesh, MeshFormat, mtl};
use crate::scene::builder::SceneBuilder;
use crate::scene::limits::MAX_SHAPES;
use crate::scene::model::DEFAULT;

/// Most bytes of a mesh file: text of a million triangles takes a tenth of it.
pub(super) const MAX_BYTES: u64 = 1 << 30;
/// Most bytes of a library of materials.
const MAX_LIBRARY_BYTES: u64 = 16 << 20;

/// Reads a mesh file.
pub(super) fn open(path: &Path, format: &MeshFormat) -> Result<Mesh> {
    read(path, format, &bytes_of(path, MAX_BYTES)?)
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

/// Reads the bytes of a mesh file.
pub(super) fn read(path: &Path, format: &MeshFormat, bytes: &[u8]) -> Result<Mesh> {
    (format.read)(bytes, MAX_SHAPES).map_err(|fault| of_fault(path, format.name, &fault))
}

fn of_fault(path: &Path, name: &str, fault: &Fault) -> Error {
    Error::new(format!("cannot read {} as {name}: {fault}", path.display())).of_kind(ErrorKind::File)
}

fn bytes_of(path: &Path, most: u64) -> Result<Vec<u8>> {
    let failed = |error: std::io::Error| unreadable("file", path, &error.to_string());
    if path.is_dir() {
        return Err(unreadable("file", path, "it is a folder"));
    }
    let mut bytes = Vec::new();
    File::open(path).map_err(failed)?.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(unreadable("file", path, &format!("it is larger than {} MiB", most >> 20)));
    }
    Ok(bytes)
}

/// Adds the materials that a mesh names. Returns an index for each name: that of the material, or [`DEFAULT`] where no
/// library defines it.
pub(super) fn add_materials(path: &Path, mesh: &Mesh, builder: &mut SceneBuilder) -> Result<Vec<usize>> {
    let mut indices = vec![DEFAULT; mesh.materials.len()];
    for library in &mesh.libraries {
        let library = path.parent().unwrap_or(Path::new("")).join(library);
        let bytes = match bytes_of(&library, MAX_LIBRARY_BYTES) {
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
