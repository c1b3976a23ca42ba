//! The scene of a record. In: its text, or name and checksum of its file; settings, recorded ones first. Out: the scene
//! with its files where they are as they were, or what is wrong with them. Of other files nothing is told.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::Replay;
use super::places::{Found, Place, Places};
use crate::core::error::{Error, ErrorKind, Result};
use crate::scene::model::Scene;
use crate::scene::{self, BuiltIn, Reading, SceneFile, Setting, is_model, is_scene_name, is_standard_input};

/// A recorded scene that was read.
pub struct Recorded {
    pub scene: Scene,
    pub file: SceneFile,
    /// Files with the names that they have in the record.
    pub names: Vec<(PathBuf, PathBuf)>,
}

impl Replay<'_> {
    /// Reads the scene: its text as recorded, or the file where only that is known.
    pub fn load(&self, reading: &Reading<'_>) -> Result<Recorded> {
        let path = self.scene_path();
        if let [name, ..] = &self.record.scene.arrays[..] {
            let what = format!(
                "its texture {name:?} was an array of the program that rendered it, which no record holds"
            );
            return Err(self.refused(&what).of_kind(ErrorKind::File));
        }
        let Some(text) = &self.record.scene.text else { return self.scene_of_file(path, reading) };
        let file = SceneFile::of_bytes(text.as_bytes());
        let (bytes, crc32) = (self.record.scene.bytes, self.record.scene.crc32);
        if file.checksum.is_some_and(|sum| sum.bytes != bytes || crc32.is_some_and(|crc| crc != sum.crc32)) {
            let what =
                "the scene in its record has not the length and the checksum of the one that was rendered";
            return Err(self.refused(what));
        }
        let of_record = |error: Error| match error.to_string().starts_with("--set ") {
            true => error,
            false => error.in_copy(&format!("the record of {}", self.picture.display())),
        };
        // The files of a scene of the program are its own.
        if let Ok(Some(built_in)) = BuiltIn::named(path) {
            let scene = scene::parse_as(&built_in.path(), text, reading).map_err(of_record)?;
            return Ok(self.recorded(Found { scene, names: Vec::new(), faults: Vec::new() }, file));
        }
        let shown = if is_standard_input(path) { Path::new(scene::STANDARD_INPUT) } else { path };
        let places = Places::new(shown, self.beside(), &self.record.files);
        let read = |place: &Place, reading: &Reading<'_>| {
            let scene = scene::parse_as(&place.actual(shown), text, reading).map_err(of_record)?;
            Ok((scene, file.clone()))
        };
        self.at_best(&places, places.ranked(), reading, read)
    }

    /// Reads the scene's file, which must be the one that was recorded.
    fn scene_of_file(&self, path: &Path, reading: &Reading<'_>) -> Result<Recorded> {
        let recorded = &self.record.scene;
        let shown = path.display();
        let refused = |what: String| self.refused(&what).of_kind(ErrorKind::File);
        if !is_scene_name(path) && !is_model(path) {
            return Err(refused(format!(
                "its record lacks the text of the scene, and {shown} has no ending of a scene"
            )));
        }
        let Some(checksum) = recorded.checksum() else {
            return Err(refused(format!("its record has neither text nor checksum of the scene {shown}")));
        };
        let places = Places::new(path, self.beside(), &self.record.files);
        let mut ranked = places.ranked();
        ranked.retain(|place| checksum.is_of_file(&place.actual(path)));
        if ranked.is_empty() {
            let why = match places.has_any(path) {
                true => "is not the file that was rendered: it has changed",
                false => "is missing",
            };
            let note = recorded.note.as_deref().unwrap_or("the record does not hold the scene");
            return Err(refused(format!("{shown} {why}; {note}")));
        }
        self.at_best(&places, ranked, reading, |place, reading| {
            scene::load_recorded(&place.actual(path), reading)
        })
    }

    /// Reads the scene at the first of the places where nothing is wrong with its files.
    fn at_best(
        &self,
        places: &Places<'_>,
        ranked: Vec<&Place>,
        reading: &Reading<'_>,
        read: impl Fn(&Place, &Reading<'_>) -> Result<(Scene, SceneFile)>,
    ) -> Result<Recorded> {
        let mut failed: Option<Error> = None;
        for place in ranked {
            let settings = self.settings_at(&place.root, reading);
            let found =
                read(place, &Reading { settings: &settings, ..*reading }).and_then(|(scene, file)| {
                    let found = places.checked(scene, place, &self.typed_files(reading));
                    if found.faults.is_empty() { Ok((found, file)) } else { Err(self.faults(&found.faults)) }
                });
            match found {
                Ok((found, file)) => return Ok(self.recorded(found, file)),
                // A place that comes later is less likely.
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        Err(failed.unwrap_or_else(|| self.refused("its scene cannot be read")))
    }

    /// Returns the folder of the picture.
    fn beside(&self) -> &Path {
        self.picture.parent().unwrap_or(Path::new(""))
    }

    /// Returns all settings; the paths of recorded ones are relative to this folder.
    fn settings_at(&self, folder: &Path, reading: &Reading<'_>) -> Vec<Setting> {
        let settings = reading.settings.iter().cloned().enumerate();
        let placed = |(number, own): (usize, Setting)| match number < self.settings {
            true => own.within(folder),
            false => own,
        };
        settings.map(placed).collect()
    }

    /// Returns what settings beside the record may name as files.
    fn typed_files(&self, reading: &Reading<'_>) -> HashSet<PathBuf> {
        let typed = reading.settings.iter().skip(self.settings);
        typed.flat_map(Setting::strings).map(PathBuf::from).collect()
    }

    fn recorded(&self, found: Found, file: SceneFile) -> Recorded {
        let Found { scene: mut own, names, .. } = found;
        let path = self.scene_path();
        own.path = if is_standard_input(path) { Path::new(scene::STANDARD_INPUT) } else { path }.into();
        Recorded { scene: own, file, names }
    }

    fn faults(&self, faults: &[String]) -> Error {
        let beside = self.beside();
        let places = match beside == Path::new("") {
            true => "the current folder".into(),
            false => format!("{} and the current folder", beside.display()),
        };
        let what = format!("{}: {}", self.picture.display(), faults.join("; "));
        let help = format!(
            "files are looked for in {places}; --set texture.NAME.file=PATH, or mesh.NUMBER.file, takes another one"
        );
        Error::with_help(what, help).of_kind(ErrorKind::File)
    }
}
