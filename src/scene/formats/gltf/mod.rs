//! glTF files as parts of a scene. Input: the file, and which of its scenes and nodes are drawn. Output: one mesh for each
//! of its materials, all in the file's space; its materials, camera and lights. Texture coordinates are transformed here,
//! so that a material has one mapping.

mod materials;
mod stage;

use std::path::Path;

use glam::{DAffine3, DMat2, DVec2};

use super::read_file;
use crate::core::error::Result;
use crate::mesh::gltf::{self, Model, Primitive, TextureRef};
use crate::mesh::{Fault, Mesh, MeshTriangle};
use crate::scene::geometry::meshes::normal_matrix;
use crate::scene::limits::MAX_TRIANGLES;

pub(super) use materials::{MaterialNotes, add as add_material};
pub(super) use stage::{camera, lights};

/// Most bytes of a buffer in a file of its own.
const MAX_BUFFER_BYTES: u64 = 4 << 30;

/// Reads a file; `sources` gets the files of buffers beside it.
pub(super) fn read(path: &Path, bytes: &[u8], sources: &mut Vec<std::path::PathBuf>) -> Result<Model, Fault> {
    let folder = path.parent().unwrap_or(Path::new(""));
    gltf::read(bytes, MAX_TRIANGLES, &mut |name| {
        let file = folder.join(name);
        let bytes =
            read_file("buffer", &["glTF"], &file, MAX_BUFFER_BYTES).map_err(|error| error.to_string())?;
        sources.push(file);
        Ok(bytes)
    })
}

/// Returns for each node whether it is drawn: the nodes of a scene, by default the file's own choice, or those of a name
/// with all below them. The error says which names there are.
pub(super) fn drawn(model: &Model, scene: Option<&str>, node: Option<&str>) -> Result<Vec<bool>, String> {
    if let Some(name) = node {
        let roots = model.named(name);
        if roots.is_empty() {
            let names = model.nodes.iter().map(|node| node.name.as_str());
            return Err(format!("expected the name of a node of the file, found {name:?}{}", listed(names)));
        }
        return Ok(model.below(&roots));
    }
    let Some(name) = scene else { return Ok(model.in_scene(model.default_scene)) };
    let found = model.scenes.iter().position(|scene| scene.name == name);
    found.map(|index| model.in_scene(index)).ok_or_else(|| {
        let names = listed(model.scenes.iter().map(|scene| scene.name.as_str()));
        format!("expected the name of a scene of the file, found {name:?}{names}")
    })
}

/// Returns a list of names for a message.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    const MOST: usize = 12;
    let names: Vec<String> = names.filter(|name| !name.is_empty()).map(|name| format!("{name:?}")).collect();
    match names.len() {
        0 => "; the file names none".into(),
        count if count > MOST => format!("; it has {}, … ({count} in all)", names[..MOST].join(", ")),
        _ => format!("; it has {}", names.join(", ")),
    }
}

/// Returns whether something that is drawn has colours at its vertices.
pub(super) fn has_colors(model: &Model, drawn: &[bool]) -> bool {
    let is_drawn = |instance: &&gltf::Instance| drawn.get(instance.node) == Some(&true);
    let mut instances = model.instances.iter().filter(is_drawn);
    instances.any(|instance| !model.primitives[instance.primitive].colors.is_empty())
}

/// Returns the drawn primitives, those of one material as one mesh.
pub(super) fn meshes(model: &Model, drawn: &[bool]) -> Vec<(Option<usize>, Mesh)> {
    let mut meshes: Vec<(Option<usize>, Mesh)> = Vec::new();
    for instance in model.instances.iter().filter(|instance| drawn.get(instance.node) == Some(&true)) {
        let place = meshes.iter().position(|(material, _)| *material == instance.material);
        let place = place.unwrap_or_else(|| {
            meshes.push((instance.material, Mesh::default()));
            meshes.len() - 1
        });
        let coordinates = instance.material.and_then(|index| materials::coordinates(&model.materials[index]));
        append(&mut meshes[place].1, &model.primitives[instance.primitive], &instance.matrix, coordinates);
    }
    meshes
}

/// Adds a primitive that stands somewhere. A set of texture coordinates that it lacks is all (0, 0).
fn append(mesh: &mut Mesh, primitive: &Primitive, matrix: &DAffine3, coordinates: Option<&TextureRef>) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(primitive.positions.iter().map(|p| matrix.transform_point3(*p)));
    let first_normal = mesh.normals.len() as u32;
    let normals = normal_matrix(&matrix.matrix3);
    mesh.normals.extend(primitive.normals.iter().map(|n| normals * *n));
    let set = coordinates.map_or(0, |reference| reference.uv_set);
    let uvs = primitive.uvs.get(set).map_or(&[][..], Vec::as_slice);
    let transform = transform(coordinates);
    let uv_of = |index: usize| {
        let uv = transform(uvs.get(index).copied().unwrap_or(DVec2::ZERO));
        // v of meshes grows upwards.
        DVec2::new(uv.x, 1.0 - uv.y)
    };
    mesh.uvs.extend((0..primitive.positions.len()).map(uv_of));
    let mirrors = matrix.matrix3.determinant() < 0.0;
    mesh.extend(primitive.faces().map(|[a, b, c]| {
        let corners = if mirrors { [a, c, b] } else { [a, b, c] };
        let positions = corners.map(|corner| first + corner);
        let normals = corners.map(|corner| first_normal + corner);
        let normals = (!primitive.normals.is_empty()).then_some(normals);
        MeshTriangle { positions, uvs: Some(positions), normals, material: None }
    }));
}

/// Returns what KHR_texture_transform does to coordinates: scale, then a rotation that is clockwise in (u, v), then the
/// offset.
fn transform(coordinates: Option<&TextureRef>) -> impl Fn(DVec2) -> DVec2 {
    let transform = coordinates.and_then(|reference| reference.transform);
    move |uv| match transform {
        Some(t) => DMat2::from_angle(-t.rotation) * (t.scale * uv) + t.offset,
        None => uv,
    }
}
