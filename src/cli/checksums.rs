//! The files that a picture is rendered from, for its record. In: a scene. Out: length and checksum of each, taken on a
//! thread of its own while the picture is rendered.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;

use crate::core::built_in;
use crate::core::checksum::Checksum;
use crate::render::{FileStamp, stamp};
use crate::scene::model::Scene;

/// More files are not recorded, so that records can be read again.
const MAX_FILES: usize = 10_000;

/// Checksums that are being taken.
pub(super) struct Checksums {
    files: Vec<(PathBuf, FileStamp)>,
    work: Option<JoinHandle<Vec<Option<Checksum>>>>,
}

/// What was read.
pub(super) struct Files {
    pub known: Vec<(PathBuf, Checksum)>,
    /// Files that changed while the picture was rendered, so that it is unknown which of them it shows.
    pub changed: Vec<PathBuf>,
}

impl Checksums {
    /// Begins with the files of meshes and textures; those of the program are known by its version.
    pub fn begin(scene: &Scene) -> Checksums {
        let textures = scene.textures.iter().flat_map(|texture| texture.content.files());
        let all = scene.sources.iter().map(PathBuf::as_path).chain(textures);
        let mut seen = HashSet::new();
        let new = all.filter(|file| built_in::bytes(file).is_none() && seen.insert(*file));
        let files: Vec<(PathBuf, FileStamp)> =
            new.take(MAX_FILES).map(|file| (file.to_owned(), stamp(file))).collect();
        let paths: Vec<PathBuf> = files.iter().map(|(path, _)| path.clone()).collect();
        let work = (!paths.is_empty()).then(|| std::thread::spawn(move || taken(&paths)));
        Checksums { files, work }
    }

    /// Waits for the checksums.
    pub fn finish(self) -> Files {
        let work = self.work.map(|work| work.join().unwrap_or_default()).unwrap_or_default();
        let mut told = Files { known: Vec::new(), changed: Vec::new() };
        for ((path, seen), checksum) in self.files.into_iter().zip(work) {
            match checksum {
                Some(checksum) if stamp(&path) == seen => told.known.push((path, checksum)),
                Some(_) => told.changed.push(path),
                // One of several that a texture may be, and is not.
                None => {}
            }
        }
        told
    }
}

impl Files {
    /// Returns the files by the names that they have in a record: their own, unless there is another one.
    pub fn named(self, names: &[(PathBuf, PathBuf)]) -> impl Iterator<Item = (PathBuf, Checksum)> {
        self.known.into_iter().map(|(path, checksum)| {
            let name = names.iter().find(|(actual, _)| *actual == path).map(|(_, name)| name.clone());
            (name.unwrap_or(path), checksum)
        })
    }

    /// Returns a warning for each file of which the record says nothing.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.changed.iter().map(|file| {
            format!("{} changed during the render: the record has no checksum of it", file.display())
        })
    }
}

/// Returns checksums of files; of those that cannot be read, or are no regular files, none.
fn taken(paths: &[PathBuf]) -> Vec<Option<Checksum>> {
    let of = |path: &Path| if path.is_file() { Checksum::of_file(path).ok() } else { None };
    paths.iter().map(|path| of(path)).collect()
}
