//! KTX2 files: formats, levels, supercompression, transfer functions, metadata, Basis Universal, and files that are
//! refused.

use std::fs;

use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};
use moire::internal::texture::load::load as load_source;

use super::write::{Ktx2, Level, VK_RGBA8, entry, zlib, zstd};
use super::{chain, load, load_noted, numbers, source};
use crate::support::{data, told};

/// Two levels of 2 × 1 and 1 × 1 texels.
fn two_levels() -> Ktx2 {
    Ktx2::flat(VK_RGBA8, [2, 1], &[vec![1, 2, 3, 4, 5, 6, 7, 8], vec![9; 4]])
}

#[test]
fn levels_are_the_same_however_they_are_compressed_once_more() {
    let expected = [vec![[1, 2, 3, 4], [5, 6, 7, 8]], vec![[9; 4]]];
    for file in [two_levels(), two_levels().compressed(2, zstd), two_levels().compressed(3, zlib)] {
        let texture = load(&file.bytes(), Dimension::Two).unwrap();
        assert_eq!(chain(&texture), expected, "{}", file.scheme);
    }
}

#[test]
fn the_transfer_function_says_what_values_mean_unless_the_scene_does() {
    for (transfer, format, space) in [
        (0, VK_RGBA8, ColorSpace::Linear),
        (1, VK_RGBA8, ColorSpace::Linear),
        (2, VK_RGBA8, ColorSpace::Srgb),
        (0, 43, ColorSpace::Srgb),
    ] {
        let file = Ktx2 { transfer, format, ..two_levels() }.bytes();
        assert_eq!(load(&file, Dimension::Two).unwrap().color_space, space, "{transfer} {format}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ktx2");
        fs::write(&path, &file).unwrap();
        let mut stated = source(&path, Dimension::Two);
        (stated.color_space, stated.color_space_stated) = (ColorSpace::Linear, true);
        assert_eq!(load_source(&stated).unwrap().color_space, ColorSpace::Linear);
    }
}

#[test]
fn rows_that_grow_upwards_are_reversed_in_all_levels() {
    let levels = [vec![1, 2, 3, 4, 5, 6, 7, 8], vec![9; 4]];
    let file = Ktx2 { metadata: entry("KTXorientation", "ru"), ..Ktx2::flat(VK_RGBA8, [1, 2], &levels) };
    let texture = load(&file.bytes(), Dimension::Two).unwrap();
    assert_eq!(chain(&texture), [vec![[5, 6, 7, 8], [1, 2, 3, 4]], vec![[9; 4]]]);
}

#[test]
fn two_channels_are_grey_and_alpha_only_where_the_swizzle_says_so() {
    let plain = Ktx2::flat(16, [1, 1], &[vec![128, 128]]);
    let texture = load(&plain.bytes(), Dimension::Two).unwrap();
    assert_eq!((texture.format, texture.file_channels), (TexelFormat::Rgba8, 2));
    assert_eq!(texture.texels, [128, 128, 255, 255]);
    let swizzled = Ktx2 { metadata: entry("KTXswizzle", "rrrg"), ..plain.clone() };
    let texture = load(&swizzled.bytes(), Dimension::Two).unwrap();
    assert_eq!((texture.format, &texture.texels[..]), (TexelFormat::GreyAlpha8, &[128, 128][..]));
    let odd = Ktx2 { metadata: entry("KTXswizzle", "bgra"), ..two_levels() };
    let (_, notes) = load_noted(&odd.bytes(), Dimension::Two).unwrap();
    assert!(notes[0].contains("swizzle \"bgra\" is ignored"), "{notes:?}");
}

#[test]
fn cubes_volumes_and_lines_have_their_shapes() {
    let faces: Vec<u8> = (0..6).flat_map(|face| [face; 4]).collect();
    let cube = Ktx2 { faces: 6, ..Ktx2::flat(VK_RGBA8, [1, 1], &[faces]) };
    let texture = load(&cube.bytes(), Dimension::Cube).unwrap();
    assert_eq!((texture.depth, chain(&texture)[0][5]), (6, [5; 4]));
    let volume = Ktx2 { size: [2, 1, 2], ..Ktx2::flat(VK_RGBA8, [2, 1], &[(0..16).collect(), vec![7; 4]]) };
    let texture = load(&volume.bytes(), Dimension::Three).unwrap();
    assert_eq!(([texture.width, texture.height, texture.depth], texture.stored_levels.len()), ([2, 1, 2], 1));
    let line = Ktx2 { size: [2, 0, 0], ..two_levels() };
    assert_eq!(load(&line.bytes(), Dimension::One).unwrap().height, 1);
    assert!(told(load(&cube.bytes(), Dimension::Three)).contains("holds a cube"));
}

#[test]
fn what_is_not_read_or_not_whole_is_refused_by_name() {
    let level = |stored: Vec<u8>, bytes| vec![Level { stored, bytes }];
    for (file, says) in [
        (Ktx2 { layers: 2, ..two_levels() }, "an array of 2 textures, which is not read"),
        (Ktx2 { format: 157, ..two_levels() }, "of Vulkan format 157, which is not read"),
        (Ktx2 { scheme: 4, ..two_levels() }, "not supported: supercompression scheme 4"),
        (Ktx2 { size: [0, 1, 0], ..two_levels() }, "zero size"),
        (Ktx2 { size: [4, 1, 0], ..two_levels() }, "level 0 takes 16 bytes, and the file has 8"),
        (Ktx2 { size: [1, 1, 0], ..two_levels() }, "2 levels of 1×1 texels"),
        (Ktx2 { size: [u32::MAX, 1, 0], ..two_levels() }, "are too many"),
        (Ktx2 { faces: 3, ..two_levels() }, "3 faces"),
        (Ktx2 { faces: 6, ..two_levels() }, "a cube's faces of 2×1"),
        (Ktx2 { scheme: 2, levels: level(zstd(&[1; 7]), 8), ..two_levels() }, "fewer than 8 bytes"),
        (Ktx2 { scheme: 2, levels: level(zstd(&[1; 9]), 8), ..two_levels() }, "more than 8 bytes"),
        (
            Ktx2 { scheme: 3, levels: level(zlib(&[1; 8]), 9), ..two_levels() },
            "level 0 takes 8 bytes, and the file has 9",
        ),
        (
            Ktx2 {
                size: [60_000, 60_000, 0],
                scheme: 2,
                levels: level(zstd(&[1]), 14_400_000_000),
                ..two_levels()
            },
            "bytes cannot become 14400000000",
        ),
    ] {
        let message = told(load(&file.bytes(), Dimension::Two));
        assert!(message.contains(says) && message.contains("a.texture"), "{says}: {message}");
    }
    let whole = two_levels().bytes();
    for (length, says) in [
        (70, "the file ends early"),
        (100, "level 0 lies outside"),
        (whole.len() - 1, "level 1 lies outside"),
    ] {
        assert!(told(load(&whole[..length], Dimension::Two)).contains(says), "{length}");
    }
}

/// The mean of each channel over a quadrant of 8 × 8 texels.
fn quadrant(texture: &moire::internal::texture::data::TextureData, column: usize, row: usize) -> [f64; 4] {
    let numbers = numbers(texture);
    let mut sums = [0.0; 4];
    for (x, y) in (0..16).map(|i| (4 * column + i % 4, 4 * row + i / 4)) {
        (0..4).for_each(|c| sums[c] += numbers[(y * 8 + x) * 4 + c] / 16.0);
    }
    sums
}

#[test]
fn basis_universal_gives_the_colours_that_were_encoded() {
    let colors = [[200.0, 40.0, 40.0], [40.0, 200.0, 40.0], [40.0, 40.0, 200.0], [200.0, 200.0, 200.0]];
    let alphas = [255.0, 128.0, 64.0, 0.0];
    for (name, levels, has_alpha, tolerance) in [
        ("etc1s.ktx2", 4, false, 6.0),
        ("etc1s-alpha.ktx2", 1, true, 8.0),
        ("uastc.ktx2", 1, true, 3.0),
        ("uastc-zstd.ktx2", 4, true, 3.0),
    ] {
        let texture = load_source(&source(&data().join("pictures").join(name), Dimension::Two)).unwrap();
        let found = (texture.width, texture.height, texture.format, texture.file_channels);
        assert_eq!(found, (8, 8, TexelFormat::Rgba8, if has_alpha { 4 } else { 3 }), "{name}");
        assert_eq!(texture.stored_levels.len() + 1, levels, "{name}");
        let space = if name == "uastc.ktx2" { ColorSpace::Linear } else { ColorSpace::Srgb };
        assert_eq!(texture.color_space, space, "{name}");
        for (i, color) in colors.iter().enumerate() {
            let mean = quadrant(&texture, i % 2, i / 2);
            let alpha = if has_alpha { alphas[i] } else { 255.0 };
            let expected = [color[0], color[1], color[2], alpha];
            // What a texel of alpha 0 has for a colour, an encoder may choose.
            let near = (0..4).all(|c| (mean[c] - expected[c]).abs() <= tolerance || alpha == 0.0 && c < 3);
            assert!(near, "{name} {i}: {mean:?}, not {expected:?}");
        }
    }
}
