//! glTF files as parts of a scene. Input: the file, and which of its scenes and nodes are drawn. Output: one mesh for each
//! of its materials, all in the file's space; its materials, camera and lights.

mod coordinates;
mod images;
mod materials;
mod notes;
mod stage;

use std::collections::HashMap;
use std::path::Path;

use glam::{DAffine3, DVec3, Vec4};
use rayon::prelude::*;

use super::read_file;
use crate::core::error::Result;
use crate::mesh::gltf::{self, Instance, Model, Primitive};
use crate::mesh::{Fault, Mesh, MeshTriangle};
use crate::scene::geometry::meshes::{normal_matrix, shares};
use crate::scene::limits::MAX_TRIANGLES;

use coordinates::{Along, CoordinateSets};
pub(super) use materials::add as add_material;
pub(super) use notes::MaterialNotes;
pub(super) use stage::{View, camera, lights};

/// Most bytes of a buffer in a file of its own.
const MAX_BUFFER_BYTES: u64 = 4 << 30;

/// Vertices or triangles that a thread takes at once.
const AT_ONCE: usize = 1 << 12;

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
        let named = model.named(name);
        let numbered = number_in(name, model.nodes.len()).filter(|_| named.is_empty());
        let roots: Vec<usize> = named.into_iter().chain(numbered).collect();
        if roots.is_empty() {
            let names = listed(model.nodes.iter().map(|node| node.name.as_str()), model.nodes.len());
            return Err(format!(
                "expected the name or the number of a node of the file, found {name:?}{names}"
            ));
        }
        return Ok(model.below(&roots));
    }
    let Some(name) = scene else { return Ok(model.in_scene(model.default_scene)) };
    let found = model.scenes.iter().position(|scene| scene.name == name);
    found.or_else(|| number_in(name, model.scenes.len())).map(|index| model.in_scene(index)).ok_or_else(
        || {
            let names = listed(model.scenes.iter().map(|scene| scene.name.as_str()), model.scenes.len());
            format!("expected the name or the number of a scene of the file, found {name:?}{names}")
        },
    )
}

/// Returns a word as the number, from 0, of one of `count` things.
fn number_in(word: &str, count: usize) -> Option<usize> {
    word.parse().ok().filter(|number| *number < count)
}

/// Returns a list of names for a message, and the numbers of all `count` things.
fn listed<'a>(names: impl Iterator<Item = &'a str>, count: usize) -> String {
    const MOST: usize = 12;
    let names: Vec<String> = names.filter(|name| !name.is_empty()).map(|name| format!("{name:?}")).collect();
    let numbers = match count {
        0 => "; there is none".to_owned(),
        1 => "; the only number is 0".to_owned(),
        _ => format!("; numbers are 0 to {}", count - 1),
    };
    match names.len() {
        0 => format!("{numbers}, and none has a name"),
        named if named > MOST => {
            format!("; it has {}, … ({named} in all){numbers}", names[..MOST].join(", "))
        }
        _ => format!("; it has {}{numbers}", names.join(", ")),
    }
}

/// Returns whether some material is seen from the front only; the default one is.
pub(super) fn has_one_sided(model: &Model) -> bool {
    let is_default = |instance: &Instance| instance.material.is_none();
    model.instances.iter().any(is_default) || model.materials.iter().any(|material| !material.double_sided)
}

/// A part of what is drawn: a mesh in the file's space, or one that stands in several places.
pub(super) struct Drawn {
    pub mesh: Mesh,
    /// Where it stands, with the index of its material in the file.
    pub instances: Vec<(DAffine3, Option<usize>)>,
}

/// What the triangles of a primitive look like beside their place: coordinates of two sets, and tangents.
#[derive(PartialEq)]
struct Look<'a> {
    primitive: usize,
    sets: CoordinateSets<'a>,
    /// Along which coordinates tangents run.
    tangents: Option<Along>,
}

impl Look<'_> {
    fn of<'a>(model: &'a Model, primitive: usize, material: Option<usize>) -> Look<'a> {
        let material = material.map(|index| &model.materials[index]);
        let sets = material.map_or_else(CoordinateSets::default, CoordinateSets::of);
        let normal = material.and_then(|material| material.normal_texture.as_ref());
        let tangents = normal.map(|normal| sets.along(normal));
        Look { primitive, sets, tangents }
    }

    fn complete(&self, mesh: &mut Mesh) {
        match self.tangents {
            Some(along) => along.complete(mesh),
            None => mesh.tangents.clear(),
        }
    }
}

/// Returns the drawn primitives: those of one material as one mesh, but for those that stand in so many places that
/// their triangles are better held once. Those of a material that is kept `apart` are a mesh for each node. Says why if they
/// are too many.
pub(super) fn meshes(
    model: &Model,
    drawn: &[bool],
    apart: impl Fn(Option<usize>) -> bool,
) -> Result<Vec<Drawn>, String> {
    let part = |instance: &Instance| (instance.material, apart(instance.material).then_some(instance.node));
    let mut primitives_of: HashMap<(Option<usize>, Option<usize>), usize> = HashMap::new();
    for instance in instances(model, drawn).filter(|instance| apart(instance.material)) {
        *primitives_of.entry(part(instance)).or_default() += 1;
    }
    // Whose node has more of the same material is a part of a mesh.
    let is_whole = |instance: &Instance| primitives_of.get(&part(instance)).is_none_or(|&count| count == 1);
    let mut looks: Vec<(Look, Vec<&Instance>)> = Vec::new();
    let mut of_primitive: HashMap<usize, Vec<usize>> = HashMap::new();
    let mut known: HashMap<(usize, Option<usize>), usize> = HashMap::new();
    for instance in instances(model, drawn) {
        let place = *known.entry((instance.primitive, instance.material)).or_insert_with(|| {
            let look = Look::of(model, instance.primitive, instance.material);
            let of_primitive = of_primitive.entry(instance.primitive).or_default();
            of_primitive.iter().copied().find(|&place| looks[place].0 == look).unwrap_or_else(|| {
                of_primitive.push(looks.len());
                looks.push((look, Vec::new()));
                looks.len() - 1
            })
        });
        looks[place].1.push(instance);
    }
    let is_shared: Vec<bool> = looks
        .iter()
        .map(|(look, instances)| {
            let placements: Vec<&DAffine3> = instances.iter().map(|instance| &instance.matrix).collect();
            shares(model.primitives[look.primitive].faces().count(), &placements)
                && instances.iter().all(|instance| is_whole(instance))
        })
        .collect();
    let copied = instances(model, drawn).filter(|i| !is_shared[known[&(i.primitive, i.material)]]);
    let count = copied.map(|instance| model.primitives[instance.primitive].faces().count()).sum::<usize>();
    if count > MAX_TRIANGLES {
        return Err(format!("{count} triangles in all places; a scene may have {MAX_TRIANGLES} at most"));
    }
    let mut meshes: Vec<Drawn> = Vec::new();
    let mut of_part: HashMap<(Option<usize>, Option<usize>), usize> = HashMap::new();
    for instance in instances(model, drawn) {
        let Instance { primitive, material, .. } = *instance;
        if is_shared[known[&(primitive, material)]] {
            continue;
        }
        let place = *of_part.entry(part(instance)).or_insert_with(|| {
            meshes.push(Drawn { mesh: Mesh::default(), instances: vec![(DAffine3::IDENTITY, material)] });
            meshes.len() - 1
        });
        let look = Look::of(model, primitive, material);
        append(&mut meshes[place].mesh, &model.primitives[primitive], &instance.matrix, &look.sets);
    }
    for Drawn { mesh, instances } in &mut meshes {
        Look::of(model, 0, instances[0].1).complete(mesh);
    }
    for ((look, instances), _) in looks.into_iter().zip(is_shared).filter(|(_, is_shared)| *is_shared) {
        let mut mesh = Mesh::default();
        append(&mut mesh, &model.primitives[look.primitive], &DAffine3::IDENTITY, &look.sets);
        look.complete(&mut mesh);
        let instances = instances.iter().map(|instance| (instance.matrix, instance.material)).collect();
        meshes.push(Drawn { mesh, instances });
    }
    Ok(meshes)
}

/// Returns the number of places where something is drawn.
pub(super) fn parts(model: &Model, drawn: &[bool]) -> usize {
    instances(model, drawn).count()
}

fn instances<'a>(model: &'a Model, drawn: &'a [bool]) -> impl Iterator<Item = &'a Instance> {
    model.instances.iter().filter(|instance| drawn.get(instance.node) == Some(&true))
}

/// Returns the least and the greatest coordinates of what is drawn.
pub(super) fn bounds(model: &Model, drawn: &[bool]) -> [DVec3; 2] {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    instances(model, drawn).fold(none, |bounds, instance| {
        let primitive = &model.primitives[instance.primitive];
        let positions = primitive.faces().flatten().map(|corner| primitive.positions[corner as usize]);
        positions
            .map(|p| instance.matrix.transform_point3(p))
            .fold(bounds, |[min, max], p| [min.min(p), max.max(p)])
    })
}

/// Adds a primitive that stands somewhere. A set of texture coordinates that it lacks is all (0, 0), and colours that only
/// some primitives have are white on the others.
fn append(mesh: &mut Mesh, primitive: &Primitive, matrix: &DAffine3, sets: &CoordinateSets<'_>) {
    let first = mesh.positions.len() as u32;
    let before = mesh.triangle_count();
    let positions = primitive.positions.par_iter().with_min_len(AT_ONCE);
    mesh.positions.par_extend(positions.map(|p| matrix.transform_point3(*p)));
    let count = mesh.positions.len();
    let first_normal = mesh.normals.len() as u32;
    let normals = normal_matrix(&matrix.matrix3);
    mesh.normals.par_extend(primitive.normals.par_iter().with_min_len(AT_ONCE).map(|n| normals * *n));
    sets.append(mesh, primitive);
    if !primitive.colors.is_empty() {
        mesh.colors.resize(first as usize, Vec4::ONE);
        mesh.colors.extend(primitive.colors.iter().map(|color| color.as_vec4()));
    } else if !mesh.colors.is_empty() {
        mesh.colors.resize(count, Vec4::ONE);
    }
    let mirrors = matrix.matrix3.determinant() < 0.0;
    let turned = |[a, b, c]: [u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
    let faces = || primitive.faces().map(turned);
    if !primitive.tangents.is_empty() {
        mesh.tangents.resize(before, [Vec4::ZERO; 3]);
        let tangent = |corner: u32| {
            let tangent = primitive.tangents[corner as usize];
            let way = matrix.transform_vector3(tangent.truncate()).normalize_or_zero();
            way.extend(if mirrors { -tangent.w } else { tangent.w }).as_vec4()
        };
        mesh.tangents.extend(faces().map(|corners| corners.map(tangent)));
    }
    let has_normals = !primitive.normals.is_empty();
    if first == first_normal || !has_normals {
        let faces = primitive.faces_at_once().with_min_len(AT_ONCE);
        let corners = faces.map(|corners| turned(corners).map(|corner| first + corner)).collect();
        return mesh.extend_of_vertices(corners, true, has_normals);
    }
    mesh.extend(faces().map(|corners| {
        let positions = corners.map(|corner| first + corner);
        let normals = Some(corners.map(|corner| first_normal + corner));
        MeshTriangle { positions, uvs: Some(positions), normals, material: None }
    }));
}
