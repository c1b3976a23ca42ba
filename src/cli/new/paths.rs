//! Paths in a new scene. Input: a file and the scene's folder. Output: the way from there to the file, as TOML has it.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::core::built_in;
use crate::core::error::{Error, Result};

/// Returns the path of a file as a scene in this folder names it; files of the program lie beside it.
pub(super) fn relative(file: &Path, folder: &Path) -> Result<String> {
    let found = match file.file_name() {
        Some(name) if built_in::bytes(file).is_some() => PathBuf::from(name),
        _ if file.is_absolute() || folder.as_os_str().is_empty() => file.to_owned(),
        _ => between(file, folder).unwrap_or_else(|| file.to_owned()),
    };
    found.into_os_string().into_string().map_err(|name| {
        let what = format!("{}: the name is not UTF-8, and scenes are", name.to_string_lossy());
        Error::with_help(what, "rename the file, or its folder")
    })
}

/// Returns the way from a folder to a file, or the whole path if they have nothing in common.
fn between(file: &Path, folder: &Path) -> Option<PathBuf> {
    let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let file = parent.canonicalize().ok()?.join(file.file_name()?);
    let folder = folder.canonicalize().ok()?;
    let common = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    if common < 2 {
        return Some(file);
    }
    let up = folder.components().skip(common).map(|_| Path::new(".."));
    Some(up.map(Path::as_os_str).chain(file.components().skip(common).map(|part| part.as_os_str())).collect())
}

/// Returns a string of TOML.
pub(super) fn toml_string(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04x}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
