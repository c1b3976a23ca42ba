//! Files with an orientation tag: a JPEG's Exif segment, a PNG's eXIf chunk before or after the
//! pixels, a TIFF's tag 274. It is applied unless the scene says otherwise, in every kind of
//! texture content.

use std::fs;
use std::path::{Path, PathBuf};

use image::codecs::jpeg::JpegEncoder;
use image::{GrayImage, ImageFormat};
use moire::internal::texture::data::{Dimension, TextureData};
use moire::internal::texture::load::load;
use moire::internal::texture::source::{OrientationUse, ReadOptions, TextureContent};
use tempfile::tempdir;

use crate::support::texture_source;

const WIDTH: u32 = 24;
const HEIGHT: u32 = 16;
/// The visible picture, in quarters from the top left, whatever the file stores.
const QUARTERS: [u8; 4] = [0, 80, 160, 240];

fn quarters(width: u32, height: u32) -> GrayImage {
    GrayImage::from_fn(width, height, |x, y| {
        let index = usize::from(y * 2 >= height) * 2 + usize::from(x * 2 >= width);
        image::Luma([QUARTERS[index]])
    })
}

/// The picture as a camera with this orientation stores it: rotated back by the crate's own functions.
fn stored(tag: u8) -> GrayImage {
    use image::imageops::{flip_horizontal, flip_vertical, rotate90, rotate180, rotate270};
    let seen = quarters(WIDTH, HEIGHT);
    match tag {
        1 => seen,
        2 => flip_horizontal(&seen),
        3 => rotate180(&seen),
        4 => flip_vertical(&seen),
        5 => flip_horizontal(&rotate90(&seen)),
        6 => rotate270(&seen),
        7 => flip_horizontal(&rotate270(&seen)),
        _ => rotate90(&seen),
    }
}

/// A TIFF structure with tag 274 alone.
fn exif(tag: u8) -> Vec<u8> {
    let mut bytes = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    bytes.extend([tag, 0, 0, 0, 0, 0, 0]);
    bytes
}

fn jpeg(folder: &Path, tag: u8) -> PathBuf {
    let mut plain = Vec::new();
    JpegEncoder::new_with_quality(&mut plain, 100).encode_image(&stored(tag)).unwrap();
    let segment = [b"Exif\0\0".to_vec(), exif(tag)].concat();
    // Another APP1 segment first, as files with XMP have it.
    let xmp = b"\xff\xe1\0\x06http".to_vec();
    let head = [b"\xff\xe1".to_vec(), (segment.len() as u16 + 2).to_be_bytes().to_vec(), segment].concat();
    let path = folder.join(format!("{tag}.jpg"));
    fs::write(&path, [&plain[..2], &xmp, &head, &plain[2..]].concat()).unwrap();
    path
}

/// The chunk before the pixels for even tags, after them for odd ones.
fn png(folder: &Path, tag: u8) -> PathBuf {
    let mut plain = std::io::Cursor::new(Vec::new());
    stored(tag).write_to(&mut plain, ImageFormat::Png).unwrap();
    let plain = plain.into_inner();
    let body = [b"eXIf".to_vec(), exif(tag)].concat();
    let length = (body.len() as u32 - 4).to_be_bytes().to_vec();
    let chunk = [length, body.clone(), crc32fast::hash(&body).to_be_bytes().to_vec()].concat();
    let at = if tag.is_multiple_of(2) { 33 } else { plain.len() - 12 };
    let path = folder.join(format!("{tag}.png"));
    fs::write(&path, [&plain[..at], &chunk, &plain[at..]].concat()).unwrap();
    path
}

/// The writer's directory with one entry more: it moves to the end of the file.
fn tiff(folder: &Path, tag: u8) -> PathBuf {
    let mut file = std::io::Cursor::new(Vec::new());
    stored(tag).write_to(&mut file, ImageFormat::Tiff).unwrap();
    let mut file = file.into_inner();
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(&file[..4], b"II*\0");
    let start = word(4);
    let count = usize::from(u16::from_le_bytes([file[start], file[start + 1]]));
    let mut entries: Vec<Vec<u8>> =
        file[start + 2..start + 2 + 12 * count].chunks(12).map(<[u8]>::to_vec).collect();
    entries.push([18, 1, 3, 0, 1, 0, 0, 0, tag, 0, 0, 0].to_vec());
    entries.sort_by_key(|entry| u16::from_le_bytes([entry[0], entry[1]]));
    let moved = file.len() + file.len() % 2;
    file.resize(moved, 0);
    file[4..8].copy_from_slice(&(moved as u32).to_le_bytes());
    file.extend((entries.len() as u16).to_le_bytes());
    file.extend(entries.concat());
    file.extend([0; 4]);
    let path = folder.join(format!("{tag}.tiff"));
    fs::write(&path, file).unwrap();
    path
}

fn texture(content: TextureContent, dimension: Dimension, orientation: OrientationUse) -> TextureData {
    let reading = ReadOptions { orientation, ..ReadOptions::default() };
    load(&texture_source(content, dimension, reading)).unwrap()
}

#[test]
fn all_eight_values_are_applied_in_jpeg_png_and_tiff() {
    let folder = tempdir().unwrap();
    for tag in 1..=8 {
        for path in [jpeg(folder.path(), tag), png(folder.path(), tag), tiff(folder.path(), tag)] {
            let read = texture(TextureContent::File(path.clone()), Dimension::Two, OrientationUse::Apply);
            assert_eq!((read.width, read.height), (WIDTH, HEIGHT), "{}", path.display());
            let seen = [(2, 2), (21, 2), (2, 13), (21, 13)].map(|(x, y)| read.value(x, y, 0) * 255.0);
            for (have, want) in seen.iter().zip(QUARTERS) {
                // Blocks of 8 × 8 of one value keep it within JPEG's rounding.
                assert!((have - f64::from(want)).abs() <= 2.0, "{}: {seen:?}", path.display());
            }
        }
    }
}

#[test]
fn ignored_orientations_leave_the_texels_as_stored() {
    let folder = tempdir().unwrap();
    for path in [png(folder.path(), 6), tiff(folder.path(), 6)] {
        let read = texture(TextureContent::File(path), Dimension::Two, OrientationUse::Ignore);
        assert_eq!((read.width, read.height), (HEIGHT, WIDTH));
        assert_eq!(read.texels, stored(6).into_raw());
    }
}

#[test]
fn slices_are_turned_each_by_its_own_file() {
    let folder = tempdir().unwrap();
    let files = vec![png(folder.path(), 1), png(folder.path(), 6), tiff(folder.path(), 3)];
    let read = texture(TextureContent::Slices(files), Dimension::Three, OrientationUse::Apply);
    let whole = quarters(WIDTH, HEIGHT).into_raw();
    assert_eq!(read.texels, [whole.clone(), whole.clone(), whole].concat());
}
