//! Scenes that the program has in itself, by name: `@lecture`. Input: a path. Output: the path of the file that it stands
//! for, or an error that names the nearest; a list with what each scene shows.

use std::path::{Path, PathBuf};

use super::suggestion::suggestion;
use crate::core::built_in;
use crate::core::error::{Error, ErrorKind, Result};

/// The beginning of a name.
const MARK: char = '@';
const FOLDER: &str = "scenes/";
const ENDING: &str = ".toml";
/// In characters.
const LONGEST_SUMMARY: usize = 100;

/// A scene of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuiltIn {
    /// Its name without the mark.
    pub name: &'static str,
    /// The path of its file below the program's folder.
    path: &'static str,
}

impl BuiltIn {
    /// Returns all scenes by name.
    pub fn all() -> Vec<BuiltIn> {
        let scene = |path: &'static str| {
            let (_, name) = path
                .strip_prefix(FOLDER)?
                .strip_suffix(ENDING)
                .map(|below| below.rsplit_once('/').unwrap_or(("", below)))?;
            Some(BuiltIn { name, path })
        };
        let mut scenes: Vec<BuiltIn> = built_in::names().filter_map(scene).collect();
        scenes.sort_by_key(|scene| scene.name);
        scenes
    }

    /// Returns the scene that a path names, nothing for a path of the disk, or an error that suggests one.
    pub fn named(path: &Path) -> Result<Option<BuiltIn>> {
        let Some(name) = path.to_str().and_then(|path| path.strip_prefix(MARK)) else { return Ok(None) };
        let scenes = BuiltIn::all();
        if let Some(scene) = scenes.iter().find(|scene| scene.name == name) {
            return Ok(Some(*scene));
        }
        // A file may have such a name, too.
        if path.exists() {
            return Ok(None);
        }
        let near = suggestion(name, scenes.iter().map(|scene| scene.name));
        let near = near.replacen(" \"", " \"@", 1);
        let what = format!("{MARK}{name:.60}: the program has no scene of this name{near}");
        Err(Error::with_help(what, "`moire new --list` lists the scenes").of_kind(ErrorKind::File))
    }

    /// Returns the name as the command line takes it.
    pub fn shown(self) -> String {
        format!("{MARK}{}", self.name)
    }

    /// Returns the path by which its file is opened.
    pub fn path(self) -> PathBuf {
        built_in::path_of(self.path)
    }

    /// Returns its text.
    pub fn text(self) -> &'static str {
        built_in::bytes(&self.path()).and_then(|bytes| std::str::from_utf8(bytes).ok()).unwrap_or_default()
    }

    /// Returns the first sentence of its opening comment, not too much of it.
    pub fn summary(self) -> String {
        let comment = self.text().lines().map_while(|line| line.strip_prefix('#')).map(str::trim);
        let text = comment.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
        let sentence = text.split(". ").next().unwrap_or_default().trim_end_matches(['.', ':']);
        if sentence.chars().count() <= LONGEST_SUMMARY {
            return sentence.to_owned();
        }
        let head: String = sentence.chars().take(LONGEST_SUMMARY).collect();
        format!("{} …", head.rsplit_once(' ').map_or(&*head, |(words, _)| words))
    }
}
