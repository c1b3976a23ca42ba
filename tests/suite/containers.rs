//! Textures as artists ship them: DDS and KTX2 files written here by the letter of their specifications, WebP and Basis
//! Universal files by other programs (`data/pictures/make.py`); their texels, levels, and what is refused.

mod blocks;
mod command;
mod dds;
mod gltf;
mod ktx2;
mod levels;
mod udim;
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
use write::{Dds, Ktx2, Legacy, legacy_dds};

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

/// Files of several structures, by name.
pub fn samples() -> Vec<(String, Vec<u8>)> {
    let block: Vec<u8> = (0..16).map(|i| i * 37).collect();
    let ktx = |format| Ktx2::flat(format, [8, 8], &[block.repeat(4)]);
    let volume = Dds { size: [4, 4, 4], levels: 2, ..Dds::flat(98, [4, 4], &block.repeat(6)) };
    let faces = block.repeat(6);
    let cube =
        Ktx2 { faces: 6, size: [4, 4, 0], ..Ktx2::flat(145, [4, 4], &[faces.clone(), faces.clone(), faces]) };
    let rgba = |side: usize| vec![7; side * side * 4];
    let chain = Ktx2::flat(write::VK_RGBA8, [8, 8], &[rgba(8), rgba(4), rgba(2), rgba(1)]);
    let mut named = vec![
        ("bc7.volume.dds", volume.bytes()),
        ("bc7.cube.ktx2", cube.bytes()),
        ("bc6h.ktx2", ktx(143).bytes()),
        ("zstd.ktx2", ktx(137).compressed(2, write::zstd).bytes()),
        ("chain.ktx2", chain.clone().compressed(2, write::zstd).bytes()),
        ("zlib.ktx2", chain.compressed(3, write::zlib).bytes()),
    ];
    for (name, format) in [("bc1.dds", 71), ("bc4.dds", 80), ("rgb9e5.dds", 67), ("bgra.dds", 87)] {
        let stored = if name.starts_with("bc") { block[..8].repeat(4) } else { block.repeat(16) };
        named.push((name, Dds::flat(format, [8, 8], &stored).bytes()));
    }
    let masks = Legacy { flags: 0x41, letters: [0; 4], bits: 16, masks: [0xf00, 0xf0, 0xf, 0xf000], caps: 0 };
    named.push(("masks.dds", legacy_dds([8, 8, 1], 1, &masks, &block.repeat(8))));
    named.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect()
}
