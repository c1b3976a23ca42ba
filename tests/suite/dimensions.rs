//! Textures of every dimension from every kind of content: texels are at the documented positions,
//! and descriptions that contradict the files are refused by name.

mod cubes;
mod scenes;
mod volumes;

use std::path::{Path, PathBuf};

use image::{DynamicImage, GrayImage, ImageBuffer, Luma, LumaA, Rgba};
use moire::internal::core::error::Result;
use moire::internal::texture::data::{Dimension, TextureData};
use moire::internal::texture::load::load;
use moire::internal::texture::source::{ReadOptions, TextureContent, TextureSource};

use crate::support::{texture_source, told};

/// Returns the direction of a texel's centre, by solving the columns sc and tc of Vulkan's cube table.
pub fn direction(face: u32, x: u32, y: u32, side: u32) -> [f32; 3] {
    let at = |i: u32| 2.0 * (i as f32 + 0.5) / side as f32 - 1.0;
    let (s, t) = (at(x), at(y));
    match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    }
}

fn source(dimension: Dimension, content: TextureContent) -> TextureSource {
    texture_source(content, dimension, ReadOptions::default())
}

fn read(dimension: Dimension, content: TextureContent) -> Result<TextureData> {
    load(&source(dimension, content))
}

fn grey(folder: &Path, name: &str, width: u32, height: u32, texels: Vec<u8>) -> PathBuf {
    save(folder, name, GrayImage::from_raw(width, height, texels).unwrap())
}

fn save(folder: &Path, name: &str, picture: impl Into<DynamicImage>) -> PathBuf {
    let path = folder.join(name);
    picture.into().save(&path).unwrap();
    path
}

fn assert_says(message: &str, words: &[&str]) {
    let missing: Vec<_> = words.iter().filter(|word| !message.contains(**word)).collect();
    assert!(missing.is_empty(), "{missing:?} not in: {message}");
}

#[test]
fn a_ramp_is_a_row_of_its_numbers() {
    let colors = vec![[0.0, 0.5, 1.0, 1.0], [2.0, -1.0, 0.25, 0.5]];
    let t = read(Dimension::One, TextureContent::Ramp(colors)).unwrap();
    assert_eq!((t.width, t.height, t.depth, t.dimension, t.file_channels), (2, 1, 1, Dimension::One, 4));
    assert_eq!(t.linear_rgba(0, 0), [0.0, 0.5, 1.0, 1.0]);
    assert_eq!(t.linear_rgba(1, 0), [2.0, -1.0, 0.25, 0.5]);
}

#[test]
fn a_picture_of_one_row_is_a_1d_texture_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let row = grey(folder.path(), "row.png", 4, 1, vec![1, 2, 3, 4]);
    let t = read(Dimension::One, TextureContent::File(row)).unwrap();
    assert_eq!((t.dimension, t.width, t.texels), (Dimension::One, 4, vec![1, 2, 3, 4]));
    let square = grey(folder.path(), "square.png", 2, 2, vec![0; 4]);
    let message = told(read(Dimension::One, TextureContent::File(square)));
    assert_says(&message, &["texture \"t\"", "square.png", "2×2", "one texel high", "\"2d\""]);
}

/// Grey, grey with alpha, 8 and 16 bits: each widened to the largest format without loss.
#[test]
fn files_of_different_formats_are_widened() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let files = vec![
        grey(folder, "a.png", 1, 1, vec![51]),
        save(folder, "b.png", ImageBuffer::<LumaA<u8>, _>::from_pixel(1, 1, LumaA([102, 0]))),
        save(folder, "c.png", ImageBuffer::<Luma<u16>, _>::from_pixel(1, 1, Luma([65_535 / 5]))),
        save(folder, "d.png", ImageBuffer::<Rgba<u8>, _>::from_pixel(1, 1, Rgba([0, 51, 255, 102]))),
    ];
    let t = read(Dimension::Three, TextureContent::Slices(files)).unwrap();
    assert_eq!((t.format.name(), t.depth, t.file_channels), ("rgba16", 4, 4));
    assert_eq!(t.linear_rgba(0, 0), [0.2, 0.2, 0.2, 1.0]);
    assert_eq!(t.linear_rgba(0, 1), [0.4, 0.4, 0.4, 0.0]);
    assert_eq!(t.linear_rgba(0, 2), [0.2, 0.2, 0.2, 1.0]);
    assert_eq!(t.linear_rgba(0, 3), [0.0, 0.2, 1.0, 0.4]);
}
