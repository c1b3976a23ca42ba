//! What a person names for a new scene. Input: the words of the command line. Output: what is shown, the model, and pictures;
//! of folders those that lie in them.

use std::path::{Path, PathBuf};

use super::{Kind, NewArgs};
use crate::core::error::{Error, Result};
use crate::scene::{is_model, suggestion};
use crate::texture::formats;

/// In the name of a file it stands for the numbers of tiles.
const TILES: &str = "<UDIM>";

pub(super) struct Subject {
    pub kind: Kind,
    pub model: Option<PathBuf>,
    pub pictures: Vec<PathBuf>,
    /// Files of folders that are neither, with the reason.
    pub none: Vec<String>,
}

/// Returns what is to be shown.
pub(super) fn subject(args: &NewArgs) -> Result<Subject> {
    let mut what = args.what.clone();
    let mut files = Vec::new();
    for path in args.model.iter().chain(&args.texture) {
        // `-t photo.jpg floor`, as options may come first.
        if what.is_none() && kind_of(path).is_some() && !path.exists() {
            what = Some(path.clone());
        } else {
            files.push(path.clone());
        }
    }
    let (named, first) = match &what {
        None => (None, None),
        Some(path) if is_model(path) => (Some(Kind::Model), Some(path.clone())),
        Some(word) => (Some(kind_of(word).ok_or_else(|| unknown(word))?), None),
    };
    let (mut models, mut pictures, mut none) = (Vec::new(), Vec::new(), Vec::new());
    for path in files {
        match (is_model(&path), path.is_dir()) {
            (true, _) => models.push(path),
            (false, true) => pictures.extend(pictures_in(&path, &mut none)?),
            (false, false) => pictures.push(path),
        }
    }
    let mut models = models.into_iter();
    let model = first.or_else(|| models.next());
    if let Some(second) = models.next() {
        let what = format!("{}: a second model; a new scene shows one", second.display());
        return Err(Error::with_help(what, "add further [[mesh]] sections to the scene"));
    }
    if let Some(file) = args.model.as_ref().filter(|file| !is_model(file)) {
        let what = format!("{}: expected the file of a model (glTF, OBJ, PLY, STL)", file.display());
        return Err(Error::with_help(what, "name a picture with -t"));
    }
    let kind = named.unwrap_or(if model.is_some() { Kind::Model } else { Kind::Floor });
    if let (Some(model), true) = (&model, kind != Kind::Model) {
        let what = format!("{}: this is a model, and a {kind} has none", model.display());
        return Err(Error::with_help(what, "`moire new model` shows it"));
    }
    pictures.iter().try_for_each(|path| check_tiles(path))?;
    Ok(Subject { kind, model, pictures, none })
}

fn kind_of(word: &Path) -> Option<Kind> {
    word.to_str().and_then(Kind::from_name)
}

fn unknown(word: &Path) -> Error {
    let near = suggestion(&word.to_string_lossy(), Kind::NAMES.iter().copied());
    let what = format!("{}: expected one of {}{near}", word.display(), Kind::NAMES.join(", "));
    let help = "a scene of the program begins with @, such as @lecture; name a picture with -t";
    Error::with_help(what, help)
}

/// Returns the pictures of a folder by their endings, in the order of their names; `none` gets its other files.
fn pictures_in(folder: &Path, none: &mut Vec<String>) -> Result<Vec<PathBuf>> {
    let failed = |error: std::io::Error| {
        let what = format!("{}: the folder cannot be read: {error}", folder.display());
        Error::with_help(what, "name its pictures one by one, or give yourself the right to read it")
    };
    let entries = std::fs::read_dir(folder).map_err(failed)?;
    let mut paths: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(|path| !is_hidden(path)).collect();
    paths.sort();
    let is_picture = |path: &PathBuf| {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        ending.is_some_and(|ending| formats::endings().any(|known| known == ending)) && !path.is_dir()
    };
    let (pictures, others): (Vec<_>, Vec<_>) = paths.into_iter().partition(is_picture);
    if pictures.is_empty() {
        let what = format!("{}: there are no pictures in this folder", folder.display());
        let help =
            format!("name a picture file, or a folder of them; supported are {}", formats::supported());
        return Err(Error::with_help(what, help));
    }
    let why = |path: PathBuf| match path.is_dir() {
        true => format!("{}: a folder within the one that was named", path.display()),
        false => format!("{}: by its ending no picture that is read", path.display()),
    };
    none.extend(others.into_iter().map(why));
    Ok(pictures)
}

fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

/// Refuses a name that a scene would read as that of many files.
fn check_tiles(path: &Path) -> Result<()> {
    if !path.to_string_lossy().contains(TILES) {
        return Ok(());
    }
    let (what, help) = match path.exists() {
        true => ("scenes read this part of a name as the numbers of tiles", "rename the file"),
        false => (
            "a new scene takes single pictures",
            "name one tile, such as 1001, and write <UDIM> in place of its number in the scene",
        ),
    };
    Err(Error::with_help(format!("{}: {what}", path.display()), help))
}
