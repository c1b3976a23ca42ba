//! Where the files of a recorded scene are now. In: their names, lengths and checksums, and the folder of the picture. Out:
//! the place among the possible ones where they are as they were; textures one by one.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::cli::record::{FileRecord, plain};
use crate::core::built_in;
use crate::core::checksum::Checksum;
use crate::scene::model::Scene;

/// A folder in place of another one, to which recorded names are relative.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// The folder now.
    pub root: PathBuf,
    /// The folder then, from that in which the command was typed.
    own: PathBuf,
}

impl Place {
    /// Returns where a file of this recorded name is.
    pub fn actual(&self, recorded: &Path) -> PathBuf {
        let recorded = plain(recorded);
        self.root.join(recorded.strip_prefix(&self.own).unwrap_or(&recorded))
    }

    /// Returns the recorded name of a file.
    fn recorded(&self, actual: &Path) -> PathBuf {
        plain(&actual.strip_prefix(&self.root).map_or_else(|_| actual.to_owned(), |rest| self.own.join(rest)))
    }
}

/// The places where files may be, and what they were.
pub(super) struct Places<'a> {
    files: &'a [FileRecord],
    /// The folder of the picture.
    beside: &'a Path,
    all: Vec<Place>,
}

/// A scene with its files in place.
pub(super) struct Found {
    pub scene: Scene,
    /// Files by the names that they have in records.
    pub names: Vec<(PathBuf, PathBuf)>,
    /// What is wrong with files that are not there, or not as they were.
    pub faults: Vec<String>,
}

impl<'a> Places<'a> {
    /// Returns the places for a scene of this name: beside the picture, as its folder was that of the command or of the
    /// scene, and the current folder.
    pub fn new(scene: &Path, beside: &'a Path, files: &'a [FileRecord]) -> Places<'a> {
        let own = plain(scene.parent().unwrap_or(Path::new("")));
        let place = |root: &Path, own: &Path| Place { root: root.to_owned(), own: own.to_owned() };
        let none = Path::new("");
        let mut all: Vec<Place> = Vec::new();
        for place in [place(beside, none), place(beside, &own), place(none, none)] {
            if !all.contains(&place) {
                all.push(place);
            }
        }
        Places { files, beside, all }
    }

    /// Returns all places, first those where most of the recorded files are as they were.
    pub fn ranked(&self) -> Vec<&Place> {
        let is_here =
            |place: &Place, file: &FileRecord| file.checksum.is_of_file(&place.actual(Path::new(&file.path)));
        let mut ranked: Vec<(usize, &Place)> = Vec::with_capacity(self.all.len());
        for place in &self.all {
            let count = self.files.iter().filter(|file| is_here(place, file)).count();
            ranked.push((count, place));
            if count > 0 && count == self.files.len() {
                break;
            }
        }
        ranked.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        ranked.into_iter().map(|(_, place)| place).collect()
    }

    /// Returns true if there is any file at one of the places.
    pub fn has_any(&self, recorded: &Path) -> bool {
        self.all.iter().any(|place| place.actual(recorded).is_file())
    }

    /// Looks at the files of a scene that was read at a place, and lets textures that are not there be others. Files that
    /// are `typed` beside the record are taken as they are.
    pub fn checked(&self, mut scene: Scene, place: &Place, typed: &HashSet<PathBuf>) -> Found {
        let mut names = Vec::new();
        let mut faults = Vec::new();
        let is_free = |file: &Path| typed.contains(file) || built_in::bytes(file).is_some();
        for texture in &mut scene.textures {
            for file in texture.content.files_mut().into_iter().filter(|file| !is_free(file)) {
                let name = place.recorded(file);
                match self.texture(file, &name) {
                    Ok(actual) => {
                        file.clone_from(&actual);
                        names.push((actual, name));
                    }
                    Err(fault) => faults.push(format!("texture \"{}\": {fault}", texture.name)),
                }
            }
        }
        for file in scene.sources.iter().filter(|file| !is_free(file)) {
            let name = place.recorded(file);
            match self.checksum(&name) {
                Some(checksum) if !checksum.is_of_file(file) => faults.push(changed(file)),
                _ => names.push((file.clone(), name)),
            }
        }
        faults.dedup();
        Found { scene, names, faults }
    }

    fn checksum(&self, name: &Path) -> Option<Checksum> {
        self.files.iter().find(|file| plain(Path::new(&file.path)) == name).map(|file| file.checksum)
    }

    /// Returns where a texture is; of one that is not recorded, the first of its name, as it may be needless.
    fn texture(&self, file: &Path, name: &Path) -> Result<PathBuf, String> {
        let alone = self.beside.join(name.file_name().unwrap_or_default());
        let others = self.all.iter().map(|place| place.actual(name)).chain([alone]);
        let mut candidates = std::iter::once(file.to_owned()).chain(others);
        let Some(checksum) = self.checksum(name) else {
            return Ok(candidates.find(|place| place.is_file()).unwrap_or_else(|| file.to_owned()));
        };
        let mut other = None;
        for candidate in candidates {
            if checksum.is_of_file(&candidate) {
                return Ok(candidate);
            }
            other = other.or(candidate.is_file().then_some(candidate));
        }
        Err(other
            .map_or_else(|| format!("{} is missing, which its scene reads", name.display()), |o| changed(&o)))
    }
}

fn changed(file: &Path) -> String {
    format!("{} is not the file that was rendered: it has changed", file.display())
}
