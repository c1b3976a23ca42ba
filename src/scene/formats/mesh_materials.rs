//! The materials that a mesh names, of the libraries beside it. Input: the mesh, and the scene's own materials in place of
//! some. Output: those of its libraries in the builder; notes of what is not defined, or cannot be seen.

use std::collections::HashMap;
use std::path::Path;

use super::mtl::Library;
use super::{of_fault, read_file};
use crate::core::counted::{counted, verb};
use crate::core::error::Result;
use crate::mesh::Mesh;
use crate::mesh::mtl::{self, MtlMaterial};
use crate::scene::builder::SceneBuilder;
use crate::scene::model::DEFAULT;

/// Most bytes of a library of materials.
const MAX_LIBRARY_BYTES: u64 = 16 << 20;

/// Adds the materials that a mesh names; `own` are those of the scene in place of some. Returns an index for each name: that of the scene's own or the library's
/// material, or [`DEFAULT`] where neither defines it.
pub(super) fn add_materials(
    path: &Path,
    mesh: &Mesh,
    own: &[(String, usize)],
    builder: &mut SceneBuilder,
) -> Result<Vec<usize>> {
    let of_scene: HashMap<&str, usize> = own.iter().map(|(name, index)| (name.as_str(), *index)).collect();
    let of_scene = |name: &String| of_scene.get(name.as_str()).copied();
    let mut indices: Vec<usize> =
        mesh.materials.iter().map(|name| of_scene(name).unwrap_or(DEFAULT)).collect();
    let places: HashMap<&str, usize> =
        mesh.materials.iter().enumerate().map(|(place, name)| (name.as_str(), place)).collect();
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut define = |materials: &[MtlMaterial], mut library: Library<'_>| -> Result<()> {
        for material in materials {
            let named = places.get(material.name.as_str()).copied();
            if let Some(place) = named.filter(|&place| indices[place] == DEFAULT) {
                indices[place] = library.add(material)?;
            }
        }
        Ok(())
    };
    define(&mesh.definitions, Library::new(folder, "", path, builder))?;
    for name in &mesh.libraries {
        let library = folder.join(name);
        let bytes = match read_file("library", &["MTL"], &library, MAX_LIBRARY_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                builder.note(format!("{}: materials of this library are white: {error}", path.display()));
                continue;
            }
        };
        builder.source(library.clone());
        let materials = mtl::read(&bytes).map_err(|fault| of_fault(&library, "MTL", &fault))?;
        define(&materials, Library::new(folder, name, &library, builder))?;
    }
    let names = mesh.materials.iter().zip(&indices);
    let unknown: Vec<&String> = names.filter(|(_, index)| **index == DEFAULT).map(|(name, _)| name).collect();
    if let (Some(first), false) = (unknown.first(), mesh.libraries.is_empty()) {
        let count = unknown.len();
        builder.note(format!(
            "{}: {count} of its materials are not defined, the first {first:?}",
            path.display()
        ));
    }
    Ok(indices)
}

/// Tells of triangles without texture coordinates whose material of the file has textures. `materials`: those that the file
/// names, as indices of the scene.
pub(super) fn tell_missing_coordinates(
    path: &Path,
    mesh: &Mesh,
    materials: &[usize],
    builder: &mut SceneBuilder,
) {
    let is_textured: Vec<bool> = materials.iter().map(|&index| builder.is_textured(index)).collect();
    let Some((count, first)) = mesh.lacking_uvs(|own| is_textured.get(own) == Some(&true)) else { return };
    let (triangles, verb) = (counted(count, "triangle"), verb(count, "has", "have"));
    builder.note(format!(
        "{}: {triangles} of textured materials, the first {first:?}, {verb} no texture coordinates: each shows half a picture",
        path.display()
    ));
}
