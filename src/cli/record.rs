//! The record that pictures of `moire render` carry: one object of JSON that says how they were made. In: the scene's
//! file, the options as typed, and what the render tells. Out: its text; and from the text of a picture the parts that
//! make it again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::core::checksum::Checksum;
use crate::core::error::{Error, Result};
use crate::integrators::adaptive::Outcome;
use crate::output::record::ascii;
use crate::render::Picture;
use crate::scene::SceneFile;

/// What `program` of a record is.
const PROGRAM: &str = "moire";
/// The commit of the sources, if the program was built in a checkout.
pub(super) const COMMIT: Option<&str> = option_env!("MOIRE_COMMIT");

/// How a picture was made. The time is no part, so that equal renders have equal files.
#[derive(Debug, Serialize, Deserialize)]
pub struct Record {
    /// The program that wrote it.
    pub program: String,
    pub version: String,
    /// What its sources were, if that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    pub scene: SceneRecord,
    /// The files that the scene was read from and its textures; none of the program's own.
    #[serde(default)]
    pub files: Vec<FileRecord>,
    /// The options that decide pixels, as typed.
    pub options: Vec<String>,
    /// What rendered, and by which version of its driver.
    pub device: String,
    #[serde(default)]
    pub driver: Option<String>,
    /// The settings that were in force, for people.
    #[serde(default)]
    pub settings: Value,
}

/// The file of a scene.
#[derive(Debug, Serialize, Deserialize)]
pub struct SceneRecord {
    /// As typed.
    pub path: String,
    /// Bytes of the file.
    pub bytes: u64,
    /// Its checksum.
    #[serde(default)]
    pub crc32: Option<u32>,
    /// The whole file, unless it is too long, no text or a model.
    #[serde(default)]
    pub text: Option<String>,
    /// Why there is no text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The textures that were arrays of the program that rendered, which no record holds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub arrays: Vec<String>,
}

/// A file that was read.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRecord {
    /// From the folder in which the command was typed.
    pub path: String,
    #[serde(flatten)]
    pub checksum: Checksum,
}

/// Returns a path without components that name the folder itself, so that equal names are equal.
pub(super) fn plain(path: &Path) -> PathBuf {
    path.components().filter(|part| !matches!(part, std::path::Component::CurDir)).collect()
}

/// What rendered.
pub struct Renderer<'a> {
    pub device: &'a str,
    pub driver: &'a str,
    /// Samples a pixel, on average.
    pub samples: u32,
    /// How the picture was made where that was chosen meanwhile.
    pub outcome: Option<&'a Outcome>,
}

impl<'a> Renderer<'a> {
    /// Returns what rendered a picture.
    pub fn of(picture: &'a Picture) -> Renderer<'a> {
        Renderer {
            device: &picture.device,
            driver: &picture.driver,
            samples: picture.film.samples,
            outcome: picture.report.outcome.as_ref(),
        }
    }

    /// Adds to the settings the samples that were taken, of each pixel or on average, and how the picture was made where
    /// that was chosen meanwhile.
    fn add_samples(&self, settings: &mut Value) {
        settings["samples"] = json!(self.samples);
        if let Some(outcome) = self.outcome {
            settings["chosen"] = json!(outcome.chosen);
            settings["samples"] = json!(outcome.mean_samples);
            settings["least_samples"] = json!(outcome.least_samples);
            settings["most_samples"] = json!(outcome.most_samples);
        }
    }
}

impl Record {
    /// Returns the record of a render. `files`: those that were read, by their names.
    pub fn new(
        path: &Path,
        file: SceneFile,
        files: impl IntoIterator<Item = (PathBuf, Checksum)>,
        options: Vec<String>,
        by: &Renderer<'_>,
        mut settings: Value,
    ) -> Record {
        by.add_samples(&mut settings);
        let files = files.into_iter();
        let files: Vec<(PathBuf, Checksum)> = files.map(|(path, sum)| (plain(&path), sum)).collect();
        let of_model = || files.iter().find(|(own, _)| *own == plain(path)).map(|(_, sum)| *sum);
        let checksum = file.checksum.or_else(of_model);
        let entry = |(path, checksum): (PathBuf, Checksum)| FileRecord {
            path: path.to_string_lossy().into_owned(),
            checksum,
        };
        Record {
            program: PROGRAM.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            commit: COMMIT.map(String::from),
            scene: SceneRecord {
                path: path.to_string_lossy().into_owned(),
                bytes: checksum.map_or(0, |sum| sum.bytes),
                crc32: checksum.map(|sum| sum.crc32),
                text: file.text,
                note: file.note,
                arrays: Vec::new(),
            },
            files: files.into_iter().map(entry).collect(),
            options,
            device: by.device.into(),
            driver: Some(by.driver.into()),
            settings,
        }
    }

    /// Returns the text that pictures carry.
    pub fn text(&self) -> String {
        ascii(&serde_json::to_string(self).unwrap_or_default())
    }

    /// Reads a record; `picture` names the file in messages.
    pub fn parse(text: &str, picture: &str) -> Result<Record> {
        let failed = |what: String| {
            Error::with_help(
                format!("{picture}: its record cannot be read: {what}"),
                "render the scene itself: moire render SCENE",
            )
        };
        let record: Record = serde_json::from_str(text).map_err(|error| failed(error.to_string()))?;
        if record.program == PROGRAM {
            return Ok(record);
        }
        Err(failed(format!("it is of another program, {:?}", record.program)))
    }
}

impl SceneRecord {
    /// Returns length and checksum of the file, if both are recorded.
    pub fn checksum(&self) -> Option<Checksum> {
        self.crc32.map(|crc32| Checksum { bytes: self.bytes, crc32 })
    }
}
