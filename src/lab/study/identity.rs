//! The identity of a measured point as a hash of everything on which it depends: the program, the
//! device and its driver, the picture's size and seed, the scene file, what replaced its values, and every file that it
//! names.
//! Runs with equal hashes measure the same thing.

use std::fs;
use std::path::Path;

use crate::core::built_in;
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::scene::BuiltIn;
use crate::scene::model::Scene;
use crate::texture::source::TextureContent;

use super::record::Conditions;

/// The version of the points' format: points of other versions lack fields that are used now.
const FORMAT: &str = "points 3";

/// FNV-1a in 64 bits (Fowler, Noll, Vo), which is fast and stable across compiler versions;
/// security is not a concern.
#[derive(Clone, Copy, Debug)]
pub struct Hash(u64);

impl Hash {
    pub fn new() -> Hash {
        Hash(0xCBF2_9CE4_8422_2325)
    }

    #[must_use]
    pub fn bytes(self, bytes: &[u8]) -> Hash {
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3);
        // The length distinguishes "ab", "c" from "a", "bc".
        let length = (bytes.len() as u64).to_le_bytes();
        Hash(length.iter().chain(bytes).fold(self.0, step))
    }

    #[must_use]
    pub fn text(self, text: &str) -> Hash {
        self.bytes(text.as_bytes())
    }

    #[must_use]
    pub fn picture(self, film: &Film) -> Hash {
        self.text(&format!("{}×{}", film.width, film.height)).bytes(bytemuck::cast_slice(&film.pixels))
    }

    pub fn hex(self) -> String {
        format!("{:016x}", self.0)
    }
}

/// Returns the hash of the conditions that all points of a study share.
pub fn of(conditions: &Conditions, scene: &Scene) -> Result<Hash> {
    let device = &conditions.device;
    let mut hash = Hash::new()
        .text(FORMAT)
        .text(&conditions.program)
        .text(&device.name)
        .text(&device.driver)
        .text(&format!("{:?} {}", conditions.size, conditions.seed))
        // Files of models have several.
        .text(&format!("{:?}", scene.camera));
    hash = scene.settings.iter().fold(hash, |hash, setting| hash.text(setting));
    let textures = scene.textures.iter().flat_map(|t| t.content.files());
    let sources = scene.sources.iter().map(std::path::PathBuf::as_path);
    for path in std::iter::once(scene.path.as_path()).chain(sources).chain(textures) {
        hash = file(hash, path)?;
    }
    // Programs that render scenes may have replaced texels by their own.
    let own = scene.textures.iter().filter_map(|t| match &t.content {
        TextureContent::Texels(texels) => Some(texels),
        _ => None,
    });
    Ok(own.fold(hash, |hash, texels| {
        hash.text(&format!("{}×{}", texels.width, texels.height)).bytes(&texels.bytes)
    }))
}

pub fn file(hash: Hash, path: &Path) -> Result<Hash> {
    let own = BuiltIn::named(path)?.map(BuiltIn::path);
    if let Some(bytes) = built_in::bytes(own.as_deref().unwrap_or(path)) {
        return Ok(hash.bytes(bytes));
    }
    let bytes = fs::read(path).map_err(|e| Error::new(format!("{}: cannot be read: {e}", path.display())))?;
    Ok(hash.bytes(&bytes))
}

#[cfg(test)]
mod tests {
    use super::Hash;

    #[test]
    fn boundaries_and_order_of_parts_count() {
        let hash = |parts: &[&str]| parts.iter().fold(Hash::new(), |h, p| h.text(p)).hex();
        assert_ne!(hash(&["ab", "c"]), hash(&["a", "bc"]));
        assert_ne!(hash(&["a", "b"]), hash(&["b", "a"]));
        assert_eq!(hash(&["a", "b"]), hash(&["a", "b"]));
    }

    #[test]
    fn agrees_with_the_published_vector() {
        // FNV-1a 64 of "" is the offset basis; of "a" 0xaf63dc4c8601ec8c (Noll's test vectors).
        let a = (Hash::new().0 ^ u64::from(b'a')).wrapping_mul(0x0100_0000_01B3);
        assert_eq!(a, 0xAF63_DC4C_8601_EC8C);
    }
}
