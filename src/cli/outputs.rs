//! The outputs of a render: parses `-o` and `--format` into files and the format of standard
//! output, or returns an error before anything is rendered.

use std::ffi::OsString;
use std::fs;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::output::{self, ENDING_NAMES, Format, Named, WriteOptions};
use crate::scene::{BuiltIn, is_standard_input, suggestion};

/// The name in messages.
const STANDARD_OUTPUT: &str = "standard output";

pub struct Outputs {
    pub files: Vec<PathBuf>,
    pub stream: Option<Format>,
}

impl Outputs {
    /// Returns the outputs that are asked for; without any, it is `default`.
    pub fn new(default: PathBuf, asked: &[PathBuf], format: Option<Format>, json: bool) -> Result<Outputs> {
        let (streams, mut files): (Vec<_>, Vec<_>) =
            asked.iter().cloned().partition(|path| path == Path::new("-"));
        let formats = || format!("name one with --format: {}", ENDING_NAMES.join(", "));
        let stream = match (streams.len(), format) {
            (0, None) => None,
            (0, Some(_)) => {
                return Err(Error::with_help(
                    "--format chooses the format of standard output, and nothing goes there",
                    "use -o - with it; of a file the ending chooses the format",
                ));
            }
            (1, None) => {
                return Err(Error::with_help(
                    "-o -: standard output has no ending that chooses a format",
                    formats(),
                ));
            }
            (1, format) => format,
            _ => return Err(Error::with_help("-o - is given twice", "one picture goes to standard output")),
        };
        if stream.is_some() && json {
            return Err(Error::with_help(
                "--json and -o - both write to standard output",
                "write the picture to a file, or leave --json out",
            ));
        }
        if stream.is_some() && io::stdout().is_terminal() {
            return Err(Error::with_help(
                "-o -: standard output is a terminal, which shows no pictures",
                "redirect it: moire render … -o - --format png > picture.png",
            ));
        }
        if asked.is_empty() {
            files.push(default);
        }
        Ok(Outputs { files, stream })
    }

    /// Writes all files and the pictures beside them, or none; standard output is written before any file is renamed to
    /// its final name. Without colours, only files with layers are written of the film.
    pub fn write_with(&self, film: &Film, beside: &[Named<'_>], options: &WriteOptions) -> Result<()> {
        let is_written =
            |path: &&PathBuf| options.has_colors || matches!(output::format_of(path), Ok(Format::Exr));
        let own = self.files.iter().filter(is_written).map(|path| Named { film, path, options });
        let pictures: Vec<Named<'_>> = own.chain(beside.iter().copied()).collect();
        output::write_pictures(&pictures, || match self.stream {
            Some(format) => super::print_bytes(&output::to_bytes_with(film, format, options)?),
            None => Ok(()),
        })
    }

    /// Returns the formats of all outputs.
    pub fn formats(&self) -> impl Iterator<Item = Format> {
        self.files.iter().filter_map(|path| output::format_of(path).ok()).chain(self.stream)
    }

    /// Returns descriptions for messages, the files as the user named them.
    pub fn names(&self) -> Vec<String> {
        let files = self.files.iter().map(|path| path.display().to_string());
        files.chain(self.stream.map(|_| STANDARD_OUTPUT.into())).collect()
    }
}

/// Refuses files of which two are the same one, however their paths are written.
pub fn check_distinct<'p>(paths: impl IntoIterator<Item = &'p Path>) -> Result<()> {
    let mut seen: Vec<(PathBuf, &Path)> = Vec::new();
    for path in paths {
        let place = place(path);
        if let Some((_, first)) = seen.iter().find(|(known, _)| *known == place) {
            let what = if *first == path {
                format!("{}: two outputs have this name, and one would replace the other", path.display())
            } else {
                format!(
                    "{} and {} are one file, and one output would replace the other",
                    first.display(),
                    path.display()
                )
            };
            return Err(Error::with_help(what, "give each output a name of its own with -o"));
        }
        seen.push((place, path));
    }
    Ok(())
}

/// Returns where a file lies or would lie; a missing folder is told elsewhere.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let lies = path.file_name().map_or_else(|| folder.clone(), |name| folder.join(name));
    lies.canonicalize().unwrap_or(lies)
}

/// Returns the scene's name with `.png`, in the current folder.
pub fn default_name(scene: &Path) -> PathBuf {
    let mut name = name_of(scene);
    name.push(".png");
    PathBuf::from(name)
}

/// Returns the folder that is asked for, or the scene's name with `-what` in the current folder: a new one, an empty one, or
/// one that has one of the files `own`, by which an earlier run is known.
pub fn folder_or_default(asked: Option<&Path>, scene: &Path, what: &str, own: &[&str]) -> Result<PathBuf> {
    if let Some(folder) = asked {
        return Ok(folder.to_owned());
    }
    let mut name = name_of(scene);
    name.push(format!("-{what}"));
    let folder = PathBuf::from(name);
    let is_empty = || fs::read_dir(&folder).is_ok_and(|mut files| files.next().is_none());
    if folder.is_dir() && !own.iter().any(|file| folder.join(file).is_file()) && !is_empty() {
        return Err(Error::with_help(
            format!("{}: this folder has files, and none of an earlier {what}", folder.display()),
            "name another one with --out, or the same to write beside what is there",
        ));
    }
    Ok(folder)
}

/// Returns the name of a scene, without folder and ending.
pub fn name_of(scene: &Path) -> OsString {
    let built_in = BuiltIn::named(scene).ok().flatten();
    let stem = match built_in {
        Some(built_in) => Some(built_in.name.as_ref()),
        None if is_standard_input(scene) => None,
        None => scene.file_stem(),
    };
    stem.unwrap_or("scene".as_ref()).to_owned()
}

/// Returns an error unless a reference is `word` or a file that exists.
pub fn check_reference(reference: Option<&str>, word: &str) -> Result<()> {
    match reference {
        Some(named) if named != word && !Path::new(named).exists() => Err(Error::with_help(
            format!("--reference {named}: there is no such file{}", suggestion(named, [word])),
            format!("name a picture, or {word}; left out, the reference is rendered"),
        )),
        _ => Ok(()),
    }
}
