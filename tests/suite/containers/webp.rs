//! WebP files that Pillow wrote, lossless and lossy, with and without alpha, turned, and animated; their texels are those
//! that Pillow reads.

use std::fs;

use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};
use moire::internal::texture::load::load as load_source;
use moire::internal::texture::source::OrientationUse;

use super::{load, source};
use crate::support::{data, told};

fn read(name: &str) -> moire::internal::texture::data::TextureData {
    load_source(&source(&data().join("pictures").join(name), Dimension::Two)).unwrap()
}

/// A texel of the picture that `make.py` draws.
fn drawn(x: u8, y: u8) -> [u8; 4] {
    [10 + 50 * x, 20 + 60 * y, (x + y) % 2 * 255, 255 - 40 * x]
}

#[test]
fn lossless_pictures_have_the_texels_that_were_stored() {
    let texture = read("lossless.webp");
    assert_eq!((texture.width, texture.height, texture.format), (5, 3, TexelFormat::Rgba8));
    assert_eq!((texture.file_channels, texture.color_space), (4, ColorSpace::Linear));
    let expected: Vec<_> = (0..3).flat_map(|y| (0..5).map(move |x| drawn(x, y))).collect();
    assert_eq!(texture.texels.as_chunks::<4>().0, expected);
}

#[test]
fn lossy_pictures_have_the_texels_that_libwebp_decodes() {
    let near = |name: &str, expected: &[[u8; 4]], channels: usize| {
        let texture = read(name);
        assert_eq!(texture.file_channels, channels, "{name}");
        for (found, expected) in texture.texels.as_chunks::<4>().0.iter().zip(expected) {
            let is_near = found.iter().zip(expected).all(|(f, e)| f.abs_diff(*e) <= 1);
            assert!(is_near, "{name}: {found:?}, not {expected:?}");
        }
    };
    near("lossy.webp", &[[0, 3, 120, 255], [7, 4, 122, 255], [24, 7, 124, 255], [41, 6, 125, 255]], 3);
    let alpha =
        [[199, 39, 41, 255], [199, 39, 41, 255], [199, 39, 41, 255], [148, 68, 29, 255], [92, 173, 50, 128]];
    near("lossy-alpha.webp", &alpha, 4);
}

#[test]
fn exif_turns_a_picture_upright_unless_it_is_told_not_to() {
    let turned = read("turned.webp");
    assert_eq!((turned.width, turned.height), (3, 5));
    let texels = turned.texels.as_chunks::<4>().0;
    // Orientation 6: the first row of the file is the last column.
    assert_eq!([texels[2], texels[0]], [drawn(0, 0), drawn(0, 2)]);
    let mut stored = source(&data().join("pictures/turned.webp"), Dimension::Two);
    stored.reading.orientation = OrientationUse::Ignore;
    assert_eq!(load_source(&stored).unwrap().width, 5);
}

#[test]
fn animations_are_refused_and_damage_is_told() {
    let animated = fs::read(data().join("pictures/animated.webp")).unwrap();
    let message = told(load(&animated, Dimension::Two));
    assert!(message.contains("an animated WebP, which is not read"), "{message}");
    let whole = fs::read(data().join("pictures/lossless.webp")).unwrap();
    let message = told(load(&whole[..60], Dimension::Two));
    assert!(message.contains("the WebP data is damaged or truncated"), "{message}");
    // Sizes of 16383 texels a side, in a file of a few bytes.
    let mut large = whole.clone();
    large[21..25].copy_from_slice(&(0x3ffeu32 | 0x3ffe << 14 | 1 << 28).to_le_bytes());
    let message = told(load(&large, Dimension::Two));
    assert!(message.contains("cannot hold 16383×16383 texels"), "{message}");
}
