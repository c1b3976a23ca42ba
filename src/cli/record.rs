//! The record that pictures of `moire render` carry: one object of JSON that says how they were made. In: the scene's
//! file, the options as typed, and what the render tells. Out: its text; and from the text of a picture the parts that
//! make it again.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::core::error::{Error, Result};
use crate::output::record::ascii;
use crate::scene::SceneFile;

/// What `program` of a record is.
const PROGRAM: &str = "moire";

/// How a picture was made.
#[derive(Debug, Serialize, Deserialize)]
pub struct Record {
    /// The program that wrote it.
    pub program: String,
    pub version: String,
    /// What its sources were, if that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The time is no part, so that equal renders have equal files.
    pub scene: SceneRecord,
    /// The options that decide pixels, as typed.
    pub options: Vec<String>,
    /// What rendered.
    pub device: String,
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
    /// Its checksum; none of a model, which is read in parts.
    #[serde(default)]
    pub crc32: Option<u32>,
    /// The whole file, unless it is too long or no text.
    #[serde(default)]
    pub text: Option<String>,
    /// Why there is no text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The textures that were arrays of the program that rendered, which no record holds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub arrays: Vec<String>,
}

impl Record {
    /// Returns the record of a render.
    pub fn new(path: &str, file: SceneFile, options: Vec<String>, device: &str, settings: Value) -> Record {
        let SceneFile { bytes, crc32, text, note } = file;
        Record {
            program: PROGRAM.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            commit: option_env!("MOIRE_COMMIT").map(String::from),
            scene: SceneRecord { path: path.into(), bytes, crc32, text, note, arrays: Vec::new() },
            options,
            device: device.into(),
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
