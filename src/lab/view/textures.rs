//! Decoded textures that all settings of a page have in common: a change of a sampler decodes none of them again. Input: a
//! scene. Output: its textures, read anew where a file has changed.

use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use crate::core::error::Result;
use crate::render::{FileStamp, stamp};
use crate::scene::model::Scene;
use crate::texture::data::TextureData;
use crate::texture::decode::AllowedFloats;
use crate::texture::load::load_with_notes;
use crate::texture::source::TextureSource;

/// Bytes of texels that are kept.
const MAX_BYTES: usize = 1 << 30;

/// A decoded texture, and what it was decoded from.
struct Kept {
    source: TextureSource,
    files: Vec<FileStamp>,
    texture: TextureData,
    notes: Vec<String>,
}

impl Kept {
    fn bytes(&self) -> usize {
        self.texture.texels.len()
            + self.texture.stored_levels.iter().map(|own| own.texels.len()).sum::<usize>()
    }
}

/// The textures of the scenes that were read last.
#[derive(Default)]
pub struct Textures(Mutex<Vec<Arc<Kept>>>);

/// Returns the stamps of a texture's files.
fn stamps(source: &TextureSource) -> Vec<FileStamp> {
    source.content.files().into_iter().map(stamp).collect()
}

impl Textures {
    /// Returns the textures of a scene, and notes about how their files were read. Others that want some wait meanwhile,
    /// and then find the same ones.
    pub fn of(&self, scene: &Scene) -> Result<(Vec<TextureData>, Vec<String>)> {
        let found = self.found(scene)?;
        let notes = found.iter().flat_map(|own| own.notes.clone()).collect();
        Ok((found.par_iter().map(|own| own.texture.clone()).collect(), notes))
    }

    fn found(&self, scene: &Scene) -> Result<Vec<Arc<Kept>>> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let read = |source: &TextureSource| -> Result<Arc<Kept>> {
            // Before it is read: a file that changes meanwhile is read again.
            let files = stamps(source);
            if let Some(known) = kept.iter().find(|own| own.files == files && own.source == *source) {
                return Ok(known.clone());
            }
            let (texture, notes) = load_with_notes(source, AllowedFloats::Finite)?;
            Ok(Arc::new(Kept { source: source.clone(), files, texture, notes }))
        };
        // All first: of several faults, the one of the first texture is told.
        let found: Vec<Result<Arc<Kept>>> = scene.textures.par_iter().map(read).collect();
        let found = found.into_iter().collect::<Result<Vec<_>>>()?;
        let is_other = |own: &Arc<Kept>| found.iter().all(|new| new.source != own.source);
        let others = std::mem::take(&mut *kept).into_iter().filter(is_other);
        let mut bytes = 0;
        let fits = |own: &Arc<Kept>| {
            bytes += own.bytes();
            bytes <= MAX_BYTES
        };
        *kept = found.iter().cloned().chain(others).take_while(fits).collect();
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::load;

    fn texels(textures: &Textures, scene: &Path) -> Vec<Arc<Kept>> {
        textures.found(&load(scene).unwrap()).unwrap()
    }

    #[test]
    fn textures_are_decoded_once_until_their_file_changes() {
        let folder = tempfile::tempdir().unwrap();
        let (file, scene) = (folder.path().join("t.png"), folder.path().join("a.toml"));
        let save = |value: u8, side: u32| {
            image::RgbImage::from_pixel(side, side, image::Rgb([value; 3])).save(&file).unwrap();
        };
        let text = "[camera]\neye = [0, 0, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 40.0\n[image]\nwidth = 4\nheight = 4\n[[texture]]\nname = 't'\n\
                    file = 't.png'\ncolor_space = 'srgb'\n[[sampler]]\nname = 's'\nfilter = 'nearest'\n\
                    [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n\
                    [[sphere]]\ncenter = [0, 0, 0]\nradius = 1.0\nmaterial = 'm'\n";
        save(7, 2);
        std::fs::write(&scene, text).unwrap();
        let textures = Textures::default();
        let first = texels(&textures, &scene);
        std::fs::write(&scene, text.replace("nearest", "ewa")).unwrap();
        let same = texels(&textures, &scene);
        assert!(Arc::ptr_eq(&first[0], &same[0]));
        // Another reading of the file is another texture, and the first one is kept beside it.
        std::fs::write(&scene, text.replace("'srgb'", "'linear'")).unwrap();
        assert!(!Arc::ptr_eq(&first[0], &texels(&textures, &scene)[0]));
        std::fs::write(&scene, text).unwrap();
        assert!(Arc::ptr_eq(&first[0], &texels(&textures, &scene)[0]));
        save(9, 3);
        assert_eq!(texels(&textures, &scene)[0].texture.texels[0], 9);
        assert_eq!(textures.0.lock().unwrap().len(), 2, "old versions of a file are kept");
    }
}
