//! The file of a scene as pictures record it. In: its bytes. Out: their number and checksum, and the text where it is
//! not too long.

use flate2::Crc;

/// Longer texts are left out of records: scenes that a person writes have some KB.
pub const MAX_RECORDED_BYTES: usize = 256 << 10;

/// The file of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneFile {
    /// Its length.
    pub bytes: u64,
    /// Its CRC-32, as gzip has it; none of a model.
    pub crc32: Option<u32>,
    /// Its text.
    pub text: Option<String>,
    /// The reason if there is no text.
    pub note: Option<String>,
}

impl SceneFile {
    /// Returns what is recorded of a scene's bytes.
    pub fn of_bytes(bytes: &[u8]) -> SceneFile {
        let mut crc = Crc::new();
        crc.update(bytes);
        let is_short = bytes.len() <= MAX_RECORDED_BYTES;
        let text = std::str::from_utf8(bytes).ok().filter(|_| is_short).map(String::from);
        let note = text.is_none().then(|| {
            format!(
                "the scene has {} KiB, more than the {} KiB that are recorded",
                bytes.len() >> 10,
                MAX_RECORDED_BYTES >> 10
            )
        });
        SceneFile { bytes: bytes.len() as u64, crc32: Some(crc.sum()), text, note }
    }

    /// Returns what is recorded of a model of this length.
    pub fn of_model(bytes: u64) -> SceneFile {
        let note = "the scene is a model, of which only the name is recorded";
        SceneFile { bytes, crc32: None, text: None, note: Some(note.into()) }
    }
}
