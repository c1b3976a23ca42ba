//! Picture files of every structure that their formats allow: correct values, written by other
//! programs (`data/pictures/make.py`) or by the letter of the standard, and structures that are
//! refused by name.

mod hdr;
mod mutated;
mod others;
mod tiff;
mod unfinished;

use std::fs;
use std::path::{Path, PathBuf};

use moire::internal::core::error::Result;
use moire::internal::texture::data::{Dimension, TextureData};
use moire::internal::texture::decode::AllowedFloats;
use moire::internal::texture::load::load_with_notes;
use moire::internal::texture::source::{ReadOptions, TextureContent};
use tempfile::tempdir;

use crate::support::{data, texture_source, told};

fn fixture(name: &str) -> PathBuf {
    data().join("pictures").join(name)
}

/// The texture, and the notes on how its file was read.
fn load(path: &Path, dimension: Dimension) -> Result<(TextureData, Vec<String>)> {
    let content = match dimension {
        Dimension::Cube => TextureContent::CubeFile(path.to_path_buf(), None),
        _ => TextureContent::File(path.to_path_buf()),
    };
    let source = texture_source(content, dimension, ReadOptions::default());
    load_with_notes(&source, AllowedFloats::Finite)
}

fn load_bytes(bytes: &[u8]) -> Result<(TextureData, Vec<String>)> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.picture");
    fs::write(&path, bytes).unwrap();
    load(&path, Dimension::Two)
}

/// Expects a message that refuses the file for this reason, without advice to get another copy.
fn assert_refused_as(bytes: &[u8], name: &str) {
    let message = told(load_bytes(bytes));
    assert!(message.contains(name) && message.contains("is not read"), "{name}: {message}");
    assert!(!message.contains("damaged") && !message.contains("again"), "{name}: {message}");
    assert!(message.contains("a.picture") && message.contains("texture \"t\""), "{message}");
}
