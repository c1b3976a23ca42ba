//! The scene formats, in one table. Input: a path, or text and the path by which it is known. Output: the whole scene,
//! with every reference an index, or the first error. A format reads its bytes into a `SceneBuilder`, which knows all
//! limits, and reports the position in its file of a value that the builder refuses.

mod foreign;
mod gltf;
mod mesh_file;
mod mesh_materials;
mod mesh_scene;
mod mtl;
mod scene_file;
mod toml;

use std::io::{ErrorKind as Io, Read};
use std::path::Path;

use super::built_in::BuiltIn;
use super::model::Scene;
use super::setting::Setting;
use crate::core::built_in::{self, Opened};
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::panics;
use crate::mesh::Fault;
use crate::texture::open_file::hint;
pub use mesh_file::is_mesh as is_model;
pub use mesh_scene::{ModelView, model_view};
pub use scene_file::SceneFile;
pub use toml::{parse, parse_as, path_of, setting_keys};

/// A format of scene files.
struct Format {
    name: &'static str,
    /// Endings of file names, in lower case.
    endings: &'static [&'static str],
    /// The longest file that is read.
    max_bytes: u64,
    /// Reads a scene from the bytes of the file at this path.
    read: fn(&Path, Vec<u8>, &Reading<'_>) -> Result<Scene>,
}

/// How a scene is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading<'a> {
    /// A camera of a glTF file: its number from 0, or its name. Other files have no cameras to choose from.
    pub camera: Option<&'a str>,
    /// Meshes, and nodes of glTF files, become shapes of their own, which the layer `instance` numbers.
    pub keeps_meshes: bool,
    /// What replaces values of the file, in this order.
    pub settings: &'a [Setting],
}

/// All formats of scenes; every format of meshes is one of scenes, too. The first one applies to standard input and to
/// files with other endings.
const FORMATS: [Format; 1] = [toml::FORMAT];

/// Returns the endings of models, which are scenes, too, as a list in words.
pub fn model_endings() -> String {
    mesh_file::endings()
}

/// The kind of a scene's file, for messages.
const SCENE: &str = "scene";

/// The name of a scene that was not read from a file.
pub const STANDARD_INPUT: &str = "<stdin>";

/// Returns true if a path denotes standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// Reads a scene file, a scene of the program if the path is `@NAME`, or standard input if it is `-`; paths in it are
/// then relative to the current folder.
/// Textures are named, not opened.
pub fn load(path: &Path) -> Result<Scene> {
    load_as(path, &Reading::default())
}

/// Reads a scene as [`load`] does, seen by one of the cameras of a glTF file.
pub fn load_seen_by(path: &Path, camera: Option<&str>) -> Result<Scene> {
    load_as(path, &Reading { camera, ..Reading::default() })
}

/// Reads a scene as [`load`] does, in the stated way.
pub fn load_as(path: &Path, reading: &Reading<'_>) -> Result<Scene> {
    load_told(path, reading, |_| ()).map(|(scene, _)| scene)
}

/// Reads a scene as [`load_as`] does, and returns what pictures record of its file.
pub fn load_recorded(path: &Path, reading: &Reading<'_>) -> Result<(Scene, SceneFile)> {
    let (scene, file) = load_told(path, reading, SceneFile::of_bytes)?;
    Ok((scene, file.unwrap_or_else(SceneFile::of_model)))
}

/// Reads a scene, and returns what `tell` makes of the bytes of its file, unless it is a model.
fn load_told<T>(
    path: &Path,
    reading: &Reading<'_>,
    tell: impl FnOnce(&[u8]) -> T,
) -> Result<(Scene, Option<T>)> {
    let camera = reading.camera;
    let is_stdin = is_standard_input(path);
    let stage = if is_stdin { STANDARD_INPUT.into() } else { path.display().to_string() };
    panics::contain(&format_args!("{stage}: reading this scene"), || {
        if is_stdin {
            no_camera(&stage, camera)?;
            let [format, ..] = &FORMATS;
            let path = Path::new(STANDARD_INPUT);
            let bytes = bytes_of(std::io::stdin().lock(), 0, SCENE, path, format.max_bytes)?;
            foreign::check_beginning(path, &bytes)?;
            let told = tell(&bytes);
            return Ok(((format.read)(path, bytes, reading)?, Some(told)));
        }
        if let Some(built_in) = BuiltIn::named(path)? {
            no_camera(&stage, camera)?;
            let [format, ..] = &FORMATS;
            let mut scene = (format.read)(&built_in.path(), built_in.text().into(), reading)?;
            scene.path = path.to_owned();
            return Ok((scene, Some(tell(built_in.text().as_bytes()))));
        }
        if mesh_file::is_mesh(path) {
            return Ok((mesh_scene::read(path, reading)?, None));
        }
        no_camera(&stage, camera)?;
        let format = format_of(path);
        let names: Vec<&str> = FORMATS.iter().map(|format| format.name).chain(mesh_file::names()).collect();
        foreign::check_ending(path)?;
        let bytes = read_file(SCENE, &names, path, format.max_bytes)?;
        if !is_named(path, format) {
            foreign::check_beginning(path, &bytes)?;
        }
        let told = tell(&bytes);
        Ok(((format.read)(path, bytes, reading)?, Some(told)))
    })
}

/// Refuses the choice of a camera for a scene file, which says itself where its camera is.
fn no_camera(file: &str, camera: Option<&str>) -> Result<()> {
    camera.map_or(Ok(()), |camera| {
        let what =
            format!("--camera: {file}: found {camera:?} for a scene file, which has one camera of its own");
        Err(Error::with_help(
            what,
            "change [camera] in the scene file; --camera chooses among those of a glTF file",
        ))
    })
}

fn format_of(path: &Path) -> &'static Format {
    let [first, ..] = &FORMATS;
    FORMATS.iter().find(|format| is_named(path, format)).unwrap_or(first)
}

/// Returns true if the ending of a file's name is that of a scene file.
pub fn is_scene_name(path: &Path) -> bool {
    FORMATS.iter().any(|format| is_named(path, format))
}

/// Returns true if the ending of a file's name is one of the format.
fn is_named(path: &Path, format: &Format) -> bool {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    format.endings.contains(&ending.as_str())
}

fn unreadable(kind: &str, path: &Path, what: &str) -> Error {
    Error::new(format!("cannot read {kind} {}: {what}", path.display())).of_kind(ErrorKind::File)
}

/// Returns the error of a model that is not what its ending says.
fn of_fault(path: &Path, name: &str, fault: &Fault) -> Error {
    Error::new(format!("cannot read {} as {name}: {fault}", path.display())).of_kind(ErrorKind::File)
}

/// Returns the bytes of a file, of which there are at most `most`; `formats` names those that its kind may have.
fn read_file(kind: &str, formats: &[&str], path: &Path, most: u64) -> Result<Vec<u8>> {
    if path.is_dir() {
        let help = format!("name a {kind} file ({}) in it", formats.join(", "));
        return Err(unreadable(kind, path, "it is a folder").and_help(Some(help)));
    }
    // Opening a pipe waits for whoever writes; a scene may come from one.
    let is_special =
        || built_in::bytes(path).is_none() && path.metadata().is_ok_and(|known| !known.is_file());
    if kind != SCENE && is_special() {
        let help = format!("name a {kind} file ({}) on a disk", formats.join(", "));
        return Err(unreadable(kind, path, "it is not a regular file").and_help(Some(help)));
    }
    let file = Opened::new(path).map_err(|error| {
        let help = if error.kind() == Io::NotFound { hint(path) } else { None };
        unreadable(kind, path, &error.to_string()).and_help(help)
    })?;
    let expected = file.length().map_or(0, |length| length.min(most));
    bytes_of(file, expected, kind, path, most)
}

/// Reads all of a source, for which memory is taken beforehand if its length is known.
fn bytes_of(source: impl Read, expected: u64, kind: &str, path: &Path, most: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // One more, as the end is found by reading. If there is not so much, reading says so.
    let _ = bytes.try_reserve_exact(expected as usize + 1);
    source
        .take(most + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| unreadable(kind, path, &error.to_string()))?;
    if bytes.len() as u64 > most {
        let what = format!("it is larger than {} MiB, the most a {kind} file may have", most >> 20);
        return Err(unreadable(kind, path, &what));
    }
    Ok(bytes)
}
