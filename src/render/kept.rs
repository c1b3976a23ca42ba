//! What outlives a render. Input: the devices and decoded textures of one. Output: the same for the next one, where files
//! and descriptions have not changed. Devices keep their pipelines.

use std::collections::HashSet;
use std::path::Path;
use std::time::SystemTime;

use rayon::prelude::*;

use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::pack::LevelMaker;
use crate::scene::model::Scene;
use crate::scene::texture_advice::of_textures;
use crate::texture::data::{ColorSpace, MipKernel, TexelFormat, TextureData};
use crate::texture::decode::AllowedFloats;
use crate::texture::load::load_with_notes;
use crate::texture::mips;
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
        Kept { textures: KeptTextures::of_last_scene(), ..Kept::default() }
    }

    /// Forgets the devices, of which one is lost.
    pub fn close(&mut self) {
        self.gpus.clear();
    }
}

/// A texture with its notes, of which each names its file.
type Decoded = (TextureData, Vec<String>);

/// Textures as they are read: each is decoded once, and its levels are made once, for as long as it is kept.
#[derive(Default)]
pub struct KeptTextures {
    kept: Vec<KeptTexture>,
    /// Where those of the scene that was read last are among them.
    current: Vec<usize>,
    lasting: Lasting,
}

struct KeptTexture {
    origin: Origin,
    decoded: Decoded,
    levels: Vec<Levels>,
}

/// Levels that were made of a texture, which is packed in one format or another.
struct Levels {
    kernel: MipKernel,
    format: (TexelFormat, ColorSpace),
    made: Vec<TextureData>,
}

/// How long textures are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Lasting {
    /// Not at all.
    #[default]
    Never,
    /// Until another scene is read.
    Scene,
    Always,
}

/// What a texture was decoded from.
#[derive(PartialEq)]
struct Origin {
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
    fn now(source: &TextureSource, values: AllowedFloats) -> Origin {
        let files = source.content.files().into_iter().map(stamp).collect();
        Origin { source: source.clone(), values, files }
    }
}

impl KeptTextures {
    /// Keeps the textures of a scene until another one is read.
    pub fn of_last_scene() -> KeptTextures {
        KeptTextures { lasting: Lasting::Scene, ..KeptTextures::default() }
    }

    /// Keeps the textures of all scenes.
    pub fn of_all_scenes() -> KeptTextures {
        KeptTextures { lasting: Lasting::Always, ..KeptTextures::default() }
    }

    /// Returns the textures of a scene, and warnings about them. Those that are not kept, or whose files have changed, are
    /// decoded on all threads.
    pub fn read(&mut self, scene: &Scene, values: AllowedFloats) -> Result<(Vec<TextureData>, Vec<String>)> {
        // Before they are read: a file that changes meanwhile is read again.
        let origins: Vec<Origin> = scene.textures.iter().map(|source| Origin::now(source, values)).collect();
        // All first: of several faults, the one of the first texture is told.
        let decoded: Vec<Result<Decoded>> = origins.par_iter().map(|origin| self.decoded(origin)).collect();
        let decoded = decoded.into_iter().collect::<Result<Vec<_>>>()?;
        self.keep(origins, &decoded);
        let (textures, notes): (Vec<_>, Vec<_>) = decoded.into_iter().unzip();
        // Several textures may be of one file.
        let mut told = HashSet::new();
        let notes = notes.into_iter().flatten().filter(|note| told.insert(note.clone()));
        let doubts = notes.chain(of_textures(scene, &textures)).collect();
        Ok((textures, doubts))
    }

    fn decoded(&self, origin: &Origin) -> Result<Decoded> {
        let found = self.kept.iter().find(|own| own.origin == *origin);
        let decode = || load_with_notes(&origin.source, origin.values);
        found.map_or_else(decode, |own| Ok(own.decoded.clone()))
    }

    fn keep(&mut self, origins: Vec<Origin>, decoded: &[Decoded]) {
        let is_known = |own: &KeptTexture| origins.contains(&own.origin);
        match self.lasting {
            Lasting::Never => return,
            Lasting::Scene => self.kept.retain(is_known),
            Lasting::Always => {
                // Of a file that has changed, the earlier texels are of no use.
                let read_again = |own: &KeptTexture| {
                    let same =
                        |new: &Origin| new.source == own.origin.source && new.values == own.origin.values;
                    origins.iter().any(same)
                };
                self.kept.retain(|own| is_known(own) || !read_again(own));
            }
        }
        self.current.clear();
        for (origin, decoded) in origins.into_iter().zip(decoded) {
            let known = self.kept.iter().position(|own| own.origin == origin);
            let at = known.unwrap_or_else(|| {
                self.kept.push(KeptTexture { origin, decoded: decoded.clone(), levels: Vec::new() });
                self.kept.len() - 1
            });
            self.current.push(at);
        }
    }
}

impl LevelMaker for KeptTextures {
    fn levels(&mut self, index: usize, texture: &TextureData, kernel: MipKernel) -> Vec<TextureData> {
        let make = || mips::mip_chain(texture, kernel);
        let at = self.current.get(index);
        let Some(own) = at.and_then(|&at| self.kept.get_mut(at)) else { return make() };
        let format = (texture.format, texture.color_space);
        if let Some(found) = own.levels.iter().find(|made| made.kernel == kernel && made.format == format) {
            return found.made.clone();
        }
        let made = make();
        own.levels.push(Levels { kernel, format, made: made.clone() });
        made
    }
}
