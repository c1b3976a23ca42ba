//! What is given as a scene and is a model or a picture. Input: the name of a file, or its first bytes. Output: an error that
//! says what a scene may be, in place of one about TOML.

use std::path::Path;

use super::{FORMATS, SCENE, mesh_file, unreadable};
use crate::core::error::Error;
use crate::texture::open_file::check_bytes;

/// Endings of models that are not read, in lower case.
const MODELS: [&str; 22] = [
    "3dm", "3ds", "3mf", "abc", "blend", "c4d", "dae", "dxf", "fbx", "iges", "igs", "lwo", "ma", "max", "mb",
    "off", "step", "stp", "usd", "usda", "usdc", "usdz",
];
/// First bytes of models, which no scene has.
const BEGINNINGS: [(&[u8], &str); 12] = [
    (b"ply", "a PLY file"),
    (b"glTF", "a glTF file"),
    (b"{", "JSON, as glTF files are"),
    (b"solid ", "an STL file"),
    (b"v ", "an OBJ file"),
    (b"o ", "an OBJ file"),
    (b"g ", "an OBJ file"),
    (b"mtllib ", "an OBJ file"),
    (b"newmtl ", "a library of materials (MTL)"),
    (b"Kaydara FBX", "an FBX file"),
    (b"BLENDER", "a file of Blender"),
    (b"PXR-USDC", "a USD file"),
];

/// Refuses a file whose ending is that of a model that is not read.
pub(super) fn check_ending(path: &Path) -> Result<(), Error> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !MODELS.contains(&ending.as_str()) {
        return Ok(());
    }
    Err(unreadable(SCENE, path, &format!("models with the ending .{ending} are not read"))
        .and_help(Some(format!("{}; export the model as glTF (.glb)", allowed()))))
}

/// Refuses bytes that begin as those of a picture or of a model; the ending of `path` says otherwise, or there is none.
pub(super) fn check_beginning(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    if check_bytes(bytes, path).is_ok() {
        return Err(unreadable(SCENE, path, "it is a picture, where a scene in TOML is needed").and_help(Some(
            "`moire new floor -t PICTURE` writes a scene that shows it; a picture that moire rendered is made again with \
             `moire render --from PICTURE`"
                .into(),
        )));
    }
    let is_comment = |line: &&[u8]| line.is_empty() || line.starts_with(b"#");
    let first = bytes.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).find(|line| !is_comment(line));
    let first = first.unwrap_or_default();
    let Some((_, what)) = BEGINNINGS.iter().find(|(begin, _)| first.starts_with(begin)) else {
        return Ok(());
    };
    Err(unreadable(SCENE, path, &format!("it is {what}, where a scene in TOML is needed")).and_help(Some(
        format!("{}; models are read from files alone, whose ending tells the format", allowed()),
    )))
}

/// Returns the endings that a scene may have, in words.
fn allowed() -> String {
    let scenes = FORMATS.iter().flat_map(|format| format.endings).map(|ending| format!(".{ending}"));
    format!("allowed are {}, {}", scenes.collect::<Vec<_>>().join(", "), mesh_file::endings())
}
