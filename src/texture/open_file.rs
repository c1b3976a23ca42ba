//! Opens a picture file, or returns an error that explains what is wrong with the path or suggests
//! which file may be meant.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use super::formats::supported;
use super::read_file::{identify, no_picture, unreadable};
use super::sniff::{self, Content, HEAD_BYTES};
use crate::core::built_in::{self, Opened};
use crate::core::error::{Error, Result};

pub(super) fn open(path: &Path) -> Result<Opened> {
    let failed = |error| unreadable(path, &error);
    if built_in::bytes(path).is_some() {
        return Opened::new(path).map_err(failed);
    }
    let metadata = fs::metadata(path).map_err(|e| match e.kind() {
        ErrorKind::NotFound => {
            let shown: String = path.to_string_lossy().chars().flat_map(escaped).collect();
            Error::new(format!("{shown}: there is no such file")).and_help(hint(path))
        }
        _ => failed(e),
    })?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "a folder" } else { "not a regular file" };
        return Err(Error::with_help(
            format!("{}: this is {what}, where a picture is needed", path.display()),
            format!("name a picture file; supported are {}", supported()),
        ));
    }
    Opened::new(path).map_err(failed)
}

/// Refuses a file that is none of the pictures that can be read, by its first bytes.
pub(crate) fn check_file(path: &Path) -> Result<()> {
    let mut source = open(path)?;
    refuse_other(identify(&mut source).map_err(|e| unreadable(path, &e))?, path)
}

/// Refuses bytes that are none of the pictures that can be read, by the first of them; `name` is for messages.
pub(crate) fn check_bytes(bytes: &[u8], name: &Path) -> Result<()> {
    refuse_other(sniff::identify(bytes.get(..HEAD_BYTES).unwrap_or(bytes)), name)
}

fn refuse_other(content: Content, path: &Path) -> Result<()> {
    match content {
        Content::Picture(_) => Ok(()),
        Content::Other(what) => Err(no_picture(path, &what)),
    }
}

/// Returns a hint about a missing path: suspicious characters, the missing folder, or the closest
/// name in the folder.
pub(crate) fn hint(path: &Path) -> Option<String> {
    if let Some(odd) = odd_path(path) {
        return Some(odd);
    }
    if let Ok(to) = fs::read_link(path) {
        return Some(format!("it is a link to {}, which is not there", to.display()));
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = fs::read_dir(folder) else {
        return Some(format!("the folder {} does not exist or cannot be read", folder.display()));
    };
    let wanted = path.file_name()?.to_string_lossy().to_lowercase();
    let names = entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned());
    let scored = names.map(|name| (strsim::jaro_winkler(&wanted, &name.to_lowercase()), name));
    let (score, name) = scored.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (score > 0.85).then(|| format!("did you mean {}?", folder.join(name).display()))
}

/// Returns the character as messages show it on one line.
fn escaped(c: char) -> Vec<char> {
    if c.is_control() { c.escape_default().collect() } else { vec![c] }
}

/// Returns true if the ending of a file's name is that of a volume; nothing is opened.
pub fn is_volume(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("nrrd") || e.eq_ignore_ascii_case("nhdr"))
}

/// Returns advice for a path written with backslashes: TOML escapes turn some of them into other
/// characters, and only Windows separates folders with them.
fn odd_path(path: &Path) -> Option<String> {
    let text = path.to_string_lossy();
    if text.contains(char::is_control) {
        return Some(
            "the name has a control character: within \"…\" in a scene file, \\t, \\n, \\b and \\f are escapes; write \
             folder/name, or 'folder\\name' in single quotes"
                .into(),
        );
    }
    (cfg!(not(windows)) && text.contains('\\'))
        .then(|| format!("folders are divided by / here: {}", text.replace('\\', "/")))
}
