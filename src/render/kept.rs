//! What outlives a render. Input: the devices and decoded textures of one. Output: the same for the next one, where files
//! and descriptions have not changed. Devices keep their pipelines.

use std::path::Path;
use std::time::SystemTime;

use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::texture::data::TextureData;
use crate::texture::decode::AllowedFloats;
use crate::texture::load::load_with_notes;
use crate::texture::source::TextureSource;

/// The devices and textures of earlier renders; empty before the first. Renders that share it are on the same backends.
#[derive(Default)]
pub struct Kept {
    /// The devices among the backends, in order.
    pub(super) gpus: Vec<Gpu>,
    pub(super) textures: KeptTextures,
}

impl Kept {
    /// Begins to keep textures; without that, only devices are kept.
    pub fn with_textures() -> Kept {
        Kept { textures: KeptTextures(Some(Vec::new())), ..Kept::default() }
    }

    /// Forgets the devices, of which one is lost.
    pub fn close(&mut self) {
        self.gpus.clear();
    }
}

/// A texture with its notes, of which each names its file.
type Decoded = (TextureData, Vec<String>);

/// Decoded textures, unless none are kept.
#[derive(Default)]
pub(super) struct KeptTextures(Option<Vec<(Origin, Decoded)>>);

/// What a texture was decoded from.
#[derive(PartialEq)]
pub(super) struct Origin {
    source: TextureSource,
    values: AllowedFloats,
    files: Vec<FileStamp>,
}

/// The length of a file and the time of its last change, by which changes are noticed; nothing of a missing one.
pub type FileStamp = Option<(u64, Option<SystemTime>)>;

/// Returns the stamp of a file.
pub fn stamp(path: &Path) -> FileStamp {
    path.metadata().ok().map(|known| (known.len(), known.modified().ok()))
}

impl Origin {
    /// Returns the origin of a texture as its files are now.
    pub(super) fn now(source: &TextureSource, values: AllowedFloats) -> Origin {
        let files = source.content.files().into_iter().map(stamp).collect();
        Origin { source: source.clone(), values, files }
    }
}

impl KeptTextures {
    /// Returns a texture that is kept, or decodes it.
    pub(super) fn load(&self, origin: &Origin) -> Result<Decoded> {
        let found = self.0.as_ref().and_then(|kept| kept.iter().find(|(known, _)| known == origin));
        let decode = || load_with_notes(&origin.source, origin.values);
        found.map_or_else(decode, |(_, decoded)| Ok(decoded.clone()))
    }

    /// Keeps the textures of a scene in place of those of the scene before.
    pub(super) fn keep(&mut self, origins: Vec<Origin>, decoded: &[Decoded]) {
        if let Some(kept) = &mut self.0 {
            *kept = origins.into_iter().zip(decoded.iter().cloned()).collect();
        }
    }
}
