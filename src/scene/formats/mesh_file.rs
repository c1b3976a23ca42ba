//! Files of meshes in a scene. Input: a path, and how a scene uses the file. Output: its triangles and materials in the
//! builder; what is left out, or a library that is missing, is noted.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::gltf::{self, Drawn};
use super::mesh_materials::{add_materials, tell_missing_coordinates};
use super::{of_fault, read_file};
use crate::core::counted::{counted, verb};
use crate::core::error::Result;
use crate::mesh::gltf::{Material, Model};
use crate::mesh::{self, Mesh, MeshFormat};
use crate::scene::builder::SceneBuilder;
use crate::scene::geometry::meshes::{self, Instance, Placement};
use crate::scene::limits::{MAX_SHAPES, MAX_TRIANGLES};
use crate::scene::model::{DEFAULT, Light};

/// Most bytes of a mesh file: text of a million triangles takes 100 MB.
const MAX_BYTES: u64 = 4 << 30;
/// Endings of glTF files, in lower case.
const GLTF: [&str; 2] = ["glb", "gltf"];

/// A file that was read.
pub(super) struct MeshFile {
    path: PathBuf,
    content: Content,
}

enum Content {
    Mesh(Box<Mesh>),
    Gltf(Box<Model>),
}

/// Indices of materials of a scene by names of the file.
pub(super) type Renamed = Vec<(String, usize)>;

/// How a scene uses a file.
#[derive(Default)]
pub(super) struct Usage<'a> {
    pub placement: Placement,
    pub motion: DVec3,
    /// The material of all triangles.
    pub material: Option<usize>,
    /// Materials in place of those that the file names.
    pub materials: Renamed,
    /// The scene and the node of a glTF file.
    pub scene: Option<&'a str>,
    pub node: Option<&'a str>,
}

impl Usage<'_> {
    /// Returns the key that may be wrong if a corner is out of range.
    fn cause(&self) -> &'static str {
        if self.placement == Placement::IDENTITY { "file" } else { "transform" }
    }

    /// Returns words for what is drawn of a glTF file.
    fn part(&self) -> String {
        match (self.node, self.scene) {
            (Some(name), _) => format!("node {name:?}"),
            (None, Some(name)) => format!("scene {name:?}"),
            (None, None) => "its scene".into(),
        }
    }
}

/// A key of a [`Usage`] that does not suit the file, and why.
pub(super) struct Unsuited {
    /// The number of the usage.
    pub usage: usize,
    pub key: &'static str,
    pub what: String,
}

/// Returns whether the ending of a file's name is that of meshes.
pub fn is_mesh(path: &Path) -> bool {
    let ending = ending_of(path);
    GLTF.contains(&ending.as_str()) || format_of(&ending).is_some()
}

/// Returns the names of the formats.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    mesh::FORMATS.iter().map(|format| format.name).chain(["glTF"])
}

/// Returns the endings of mesh files, as a list in words.
pub(super) fn endings() -> String {
    let endings = mesh::FORMATS.iter().map(|format| format.ending).chain(GLTF);
    endings.map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(", ")
}

fn ending_of(path: &Path) -> String {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
}

fn format_of(ending: &str) -> Option<&'static MeshFormat> {
    mesh::FORMATS.iter().find(|format| format.ending == ending)
}

impl MeshFile {
    /// Reads a file whose ending is one of meshes; the builder gets the names of it and the files beside it.
    pub fn open(path: &Path, builder: &mut SceneBuilder) -> Result<MeshFile> {
        let format = format_of(&ending_of(path));
        let name = format.map_or("glTF", |format| format.name);
        let bytes = read_file("mesh", &[name], path, MAX_BYTES)?;
        let mut sources = vec![path.to_owned()];
        let content = match format {
            Some(format) => (format.read)(&bytes, MAX_TRIANGLES).map(|mesh| Content::Mesh(Box::new(mesh))),
            None => gltf::read(path, &bytes, &mut sources).map(|model| Content::Gltf(Box::new(model))),
        };
        let content = content.map_err(|fault| of_fault(path, name, &fault))?;
        sources.into_iter().for_each(|source| builder.source(source));
        Ok(MeshFile { path: path.to_owned(), content })
    }

    /// Returns the least and the greatest coordinates of what is drawn without further choice.
    pub fn bounds(&self) -> [DVec3; 2] {
        match &self.content {
            Content::Mesh(mesh) => mesh.bounds(),
            Content::Gltf(model) => gltf::bounds(model, &model.in_scene(model.default_scene)),
        }
    }

    /// Returns a camera of the file, by its number from 0 or its name; without either the first one, if there is any.
    pub fn camera(&self, chosen: Option<&str>) -> Result<Option<gltf::View>, String> {
        match (&self.content, chosen) {
            (Content::Gltf(model), _) => gltf::camera(model, chosen, &model.in_scene(model.default_scene)),
            (Content::Mesh(_), None) => Ok(None),
            (Content::Mesh(_), Some(_)) => Err("only glTF files have cameras".into()),
        }
    }

    /// Returns the lights of the file.
    pub fn lights(&self) -> Vec<Light> {
        let Content::Gltf(model) = &self.content else { return Vec::new() };
        gltf::lights(model, &model.in_scene(model.default_scene))
    }

    /// Returns whether it can be added in several places at once, so that these share its triangles.
    pub fn is_plain(&self) -> bool {
        matches!(self.content, Content::Mesh(_))
    }

    /// Adds triangles and materials, for each usage once; of a glTF file for one. Returns how many triangles have no area and
    /// were left out.
    pub fn add(self, usages: &[Usage<'_>], builder: &mut SceneBuilder) -> Result<Result<usize, Unsuited>> {
        let path = self.path;
        let told = match &self.content {
            Content::Mesh(_) => 0,
            Content::Gltf(model) => model.degenerate,
        };
        let dropped = match self.content {
            Content::Mesh(mesh) => {
                mesh.notes.iter().for_each(|note| builder.note(format!("{}: {note}", path.display())));
                let instances = match instances(&path, &mesh, usages, builder)? {
                    Ok(instances) => instances,
                    Err(unsuited) => return Ok(Err(unsuited)),
                };
                meshes::add(builder, *mesh, &instances, false).map_err(|(usage, what)| Unsuited {
                    usage,
                    key: usages[usage].cause(),
                    what,
                })
            }
            Content::Gltf(model) => usages
                .iter()
                .enumerate()
                .map(|(number, usage)| {
                    let unsuited = |(key, what)| Unsuited { usage: number, key, what };
                    add_model(&path, &model, usage, builder).map_err(unsuited)
                })
                .sum(),
        };
        Ok(dropped.map(|dropped| {
            if dropped > 0 {
                let (triangles, verb) = (counted(dropped, "triangle"), verb(dropped, "has", "have"));
                builder.note(format!("{}: left out {triangles} that {verb} no area", path.display()));
            }
            dropped + told
        }))
    }
}

/// Returns where a mesh stands, with its materials there.
fn instances(
    path: &Path,
    mesh: &Mesh,
    usages: &[Usage<'_>],
    builder: &mut SceneBuilder,
) -> Result<Result<Vec<Instance>, Unsuited>> {
    let mut of_file: Option<Vec<usize>> = None;
    let mut instances = Vec::with_capacity(usages.len());
    for (number, usage) in usages.iter().enumerate() {
        let unsuited = |(key, what)| Ok(Err(Unsuited { usage: number, key, what }));
        let chosen = [("node", usage.node), ("scene", usage.scene)];
        if let Some((key, _)) = chosen.iter().find(|(_, name)| name.is_some()) {
            return unsuited((*key, "only glTF files have nodes and scenes".into()));
        }
        if let Err(why) = check_names(usage, mesh.materials.iter().map(String::as_str)) {
            return unsuited(why);
        }
        // A material of the scene replaces those of the file, which are the same in all places otherwise.
        let material_of = match (&of_file, usage.material) {
            (_, Some(_)) => Vec::new(),
            (Some(known), None) if usage.materials.is_empty() => known.clone(),
            _ => add_materials(path, mesh, &usage.materials, builder)?,
        };
        if usage.material.is_none() && usage.materials.is_empty() {
            of_file = Some(material_of.clone());
        }
        let other = usage.material.unwrap_or(DEFAULT);
        instances.push(Instance { placement: usage.placement, motion: usage.motion, material_of, other });
    }
    tell_missing_coordinates(path, mesh, of_file.as_deref().unwrap_or_default(), builder);
    Ok(Ok(instances))
}

/// Adds what is drawn of a glTF file; returns how many triangles have no area.
fn add_model(
    path: &Path,
    model: &Model,
    usage: &Usage<'_>,
    builder: &mut SceneBuilder,
) -> Result<usize, (&'static str, String)> {
    check_names(usage, model.materials.iter().map(|material| material.name.as_str()))?;
    let key = if usage.node.is_some() { "node" } else { "scene" };
    let drawn = gltf::drawn(model, usage.scene, usage.node).map_err(|what| (key, what))?;
    model.notes.iter().for_each(|note| builder.note(format!("{}: {note}", path.display())));
    let mut notes = gltf::MaterialNotes::default();
    // What names no material has the default one of the specification.
    let default = Material { name: "default".into(), ..Material::default() };
    let mut dropped = 0;
    let mut known: HashMap<Option<usize>, usize> = HashMap::new();
    let found = |material: Option<usize>| material.map_or(&default, |index| &model.materials[index]);
    let named = |material: Option<usize>| {
        let renamed = || usage.materials.iter().find(|(name, _)| *name == found(material).name);
        material.and_then(|_| renamed()).map(|(_, index)| *index)
    };
    if gltf::parts(model, &drawn) > MAX_SHAPES && builder.keep_meshes(false) {
        builder.note(format!(
            "{}: too many nodes for shapes of their own; they are not numbered",
            path.display()
        ));
    }
    let apart = |material| builder.is_kept_whole(usage.material.or(named(material)).unwrap_or(DEFAULT));
    let parts = gltf::meshes(model, &drawn, apart).map_err(|what| ("file", what))?;
    if parts.is_empty() && model.degenerate == 0 {
        builder.note(format!("{}: {} has no triangles", path.display(), usage.part()));
    }
    for Drawn { mut mesh, instances } in parts {
        let names_material = usage.material.is_none();
        let instances = instances.into_iter().map(|(placement, material)| {
            let material_of = match (known.get(&material), named(material)) {
                _ if usage.material.is_some() => Vec::new(),
                (_, Some(index)) => vec![index],
                (Some(index), None) => vec![*index],
                (None, None) => {
                    let found = found(material);
                    let index = gltf::add_material(path, model, found, builder, &mut notes);
                    let index = index.map_err(|what| ("file", what))?;
                    known.insert(material, index);
                    vec![index]
                }
            };
            Ok(Instance {
                placement: usage.placement * placement,
                motion: usage.motion,
                material_of,
                other: usage.material.unwrap_or(DEFAULT),
            })
        });
        let instances: Vec<Instance> = instances.collect::<Result<_, _>>()?;
        mesh.set_material(names_material.then_some(0));
        dropped += meshes::add(builder, mesh, &instances, gltf::has_one_sided(model))
            .map_err(|(_, what)| (usage.cause(), what))?;
    }
    notes.sentences().for_each(|note| builder.note(format!("{}: {note}", path.display())));
    Ok(dropped)
}

/// Refuses names of materials that the file does not have.
fn check_names<'a>(
    usage: &Usage<'_>,
    names: impl Iterator<Item = &'a str>,
) -> Result<(), (&'static str, String)> {
    let names: Vec<&str> = names.collect();
    match usage.materials.iter().find(|(name, _)| !names.contains(&name.as_str())) {
        None => Ok(()),
        Some((unknown, _)) => {
            let listed: Vec<String> = names.iter().take(12).map(|name| format!("{name:?}")).collect();
            let has = if names.is_empty() { "none".into() } else { listed.join(", ") };
            Err(("material", format!("the file has no material {unknown:?}; it names {has}")))
        }
    }
}
