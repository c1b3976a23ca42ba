//! The file of a scene as pictures record it. In: its bytes. Out: their number and checksum, and the text where it is
//! not too long.

use crate::core::checksum::Checksum;

/// Longer texts are left out of records: scenes that a person writes have some KB.
pub const MAX_RECORDED_BYTES: usize = 256 << 10;

/// The file of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneFile {
    /// Its length and checksum; none of a model, which is among the files that its scene was read from.
    pub checksum: Option<Checksum>,
    /// Its text.
    pub text: Option<String>,
    /// The reason if there is no text.
    pub note: Option<String>,
}

impl SceneFile {
    /// Returns what is recorded of a scene's bytes.
    pub fn of_bytes(bytes: &[u8]) -> SceneFile {
        let is_short = bytes.len() <= MAX_RECORDED_BYTES;
        let text = std::str::from_utf8(bytes).ok().filter(|_| is_short).map(String::from);
        let note = text.is_none().then(|| {
            format!(
                "the scene has {} KiB, more than the {} KiB that are recorded",
                bytes.len() >> 10,
                MAX_RECORDED_BYTES >> 10
            )
        });
        SceneFile { checksum: Some(Checksum::of(bytes)), text, note }
    }

    /// Returns what is recorded of a model.
    pub fn of_model() -> SceneFile {
        let note = "the scene is a model, of which name, length and checksum are recorded";
        SceneFile { checksum: None, text: None, note: Some(note.into()) }
    }
}
