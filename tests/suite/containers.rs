//! Textures as artists ship them: DDS and KTX2 files written here by the letter of their specifications, WebP and Basis
//! Universal files by other programs (`data/pictures/make.py`); their texels, levels, and what is refused.

mod blocks;
mod dds;
mod ktx2;
mod levels;
mod webp;
pub mod write;

use std::fs;
use std::path::Path;

use moire::internal::core::error::Result;
use moire::internal::texture::data::{Component, Dimension, TextureData};
use moire::internal::texture::decode::AllowedFloats;
use moire::internal::texture::load::load_with_notes;
use moire::internal::texture::source::{ReadOptions, TextureContent, TextureSource};
use tempfile::tempdir;

use crate::support::texture_source;

/// The source of a file whose colour space the scene leaves out.
fn source(path: &Path, dimension: Dimension) -> TextureSource {
    let content = match dimension {
        Dimension::Cube => TextureContent::CubeFile(path.to_path_buf(), None),
        _ => TextureContent::File(path.to_path_buf()),
    };
    let source = texture_source(content, dimension, ReadOptions::default());
    TextureSource { color_space_stated: false, ..source }
}

/// The texture of a file of these bytes, and the notes on how it was read.
fn load_noted(bytes: &[u8], dimension: Dimension) -> Result<(TextureData, Vec<String>)> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.texture");
    fs::write(&path, bytes).unwrap();
    load_with_notes(&source(&path, dimension), AllowedFloats::Finite)
}

fn load(bytes: &[u8], dimension: Dimension) -> Result<TextureData> {
    load_noted(bytes, dimension).map(|(texture, _)| texture)
}

/// The stored numbers of texels: codes of integers, or floats.
fn numbers(texture: &TextureData) -> Vec<f64> {
    let bytes = &texture.texels;
    match texture.format.component() {
        Component::Unorm8 => bytes.iter().map(|&b| b.into()).collect(),
        Component::Unorm16 => {
            bytes.as_chunks::<2>().0.iter().map(|&b| u16::from_ne_bytes(b).into()).collect()
        }
        Component::Float32 => {
            bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_ne_bytes(b).into()).collect()
        }
    }
}

/// The texels of level 0, then those of the stored levels, each of four codes of 8 bits.
fn chain(texture: &TextureData) -> Vec<Vec<[u8; 4]>> {
    let levels = std::iter::once(texture).chain(&texture.stored_levels);
    levels.map(|level| level.texels.as_chunks::<4>().0.to_vec()).collect()
}
