//! DDS files: formats of Direct3D 9 and 10, cubes and volumes, their levels, and files that are refused.

use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};

use super::write::{DXGI_RGBA8, Dds, Legacy, legacy_dds};
use super::{chain, load, load_noted, numbers};
use crate::support::told;

const NO_FORMAT: Legacy = Legacy { flags: 0, letters: [0; 4], bits: 0, masks: [0; 4], caps: 0 };

fn masked(flags: u32, bits: u32, masks: [u32; 4], data: &[u8]) -> (TexelFormat, usize, Vec<f64>) {
    let format = Legacy { flags, bits, masks, ..NO_FORMAT };
    let texture = load(&legacy_dds([1, 1, 1], 0, &format, data), Dimension::Two).unwrap();
    (texture.format, texture.file_channels, numbers(&texture))
}

#[test]
fn masks_say_where_channels_lie() {
    use TexelFormat::{Grey8, Grey16, GreyAlpha8, Rgba8};
    let bgra = [0xff_0000, 0xff00, 0xff, 0xff00_0000];
    let luminance = [0xff, 0, 0, 0xff00];
    for (flags, bits, masks, data, expected) in [
        (0x41, 32, bgra, &[3, 2, 1, 4][..], (Rgba8, 4, vec![1.0, 2.0, 3.0, 4.0])),
        (0x40, 32, bgra, &[3, 2, 1, 4], (Rgba8, 3, vec![1.0, 2.0, 3.0, 255.0])),
        (0x40, 24, bgra, &[3, 2, 1], (Rgba8, 3, vec![1.0, 2.0, 3.0, 255.0])),
        (0x40, 16, [0xf800, 0x7e0, 0x1f, 0], &[0x1f, 0xf8], (Rgba8, 3, vec![255.0, 0.0, 255.0, 255.0])),
        (0x2_0000, 8, luminance, &[9], (Grey8, 1, vec![9.0])),
        (0x2_0001, 16, luminance, &[9, 8], (GreyAlpha8, 2, vec![9.0, 8.0])),
        (0x2_0000, 16, [0xffff, 0, 0, 0], &[1, 1], (Grey16, 1, vec![257.0])),
        (2, 8, [0, 0, 0, 0xff], &[7], (GreyAlpha8, 2, vec![255.0, 7.0])),
    ] {
        assert_eq!(masked(flags, bits, masks, data), expected, "{flags:x} {bits}");
    }
}

#[test]
fn letters_name_the_format_and_premultiplied_colours_are_noted() {
    let of = |letters: &[u8; 4]| Legacy { flags: 4, letters: *letters, ..NO_FORMAT };
    let (texture, notes) =
        load_noted(&legacy_dds([4, 4, 1], 1, &of(b"DXT5"), &[0; 16]), Dimension::Two).unwrap();
    assert_eq!(
        (texture.format, texture.color_space, notes.len()),
        (TexelFormat::Rgba8, ColorSpace::Linear, 0)
    );
    let (_, notes) = load_noted(&legacy_dds([4, 4, 1], 1, &of(b"DXT4"), &[0; 16]), Dimension::Two).unwrap();
    assert!(notes[0].contains("multiplied by alpha"), "{notes:?}");
    // Number 113 of Direct3D 9 is four halves; 3C00 is 1.
    let half = legacy_dds([1, 1, 1], 1, &of(&113u32.to_le_bytes()), &[0, 0x3c, 0, 0x40, 0, 0, 0, 0x3c]);
    assert_eq!(numbers(&load(&half, Dimension::Two).unwrap()), [1.0, 2.0, 0.0, 1.0]);
}

#[test]
fn formats_of_direct3d_10_are_read_in_their_own_precision() {
    for (format, data, expected) in [
        (87, &[3, 2, 1, 4][..], vec![1.0, 2.0, 3.0, 4.0]),
        (56, &[0x34, 0x12], vec![f64::from(0x1234)]),
        (41, &1.5f32.to_le_bytes(), vec![1.5]),
        (26, &(15u32 << 6 | 16 << 17 | 14 << 27).to_le_bytes(), vec![1.0, 2.0, 0.5, 1.0]),
        (67, &(256u32 | 16 << 27).to_le_bytes(), vec![1.0, 0.0, 0.0, 1.0]),
    ] {
        let texture = load(&Dds::flat(format, [1, 1], data).bytes(), Dimension::Two).unwrap();
        assert_eq!(numbers(&texture), expected, "{format}");
    }
}

/// A code for each level and part.
fn solid(code: u8, texels: usize) -> Vec<u8> {
    [code, code + 1, code + 2, 255].repeat(texels)
}

#[test]
fn cubes_have_all_levels_of_a_face_before_the_next() {
    let data: Vec<u8> =
        (0..6).flat_map(|face| [solid(10 * face, 4), solid(10 * face + 100, 1)].concat()).collect();
    let file = Dds { levels: 2, is_cube: true, ..Dds::flat(DXGI_RGBA8, [2, 2], &data) };
    let texture = load(&file.bytes(), Dimension::Cube).unwrap();
    assert_eq!((texture.dimension, texture.width, texture.height, texture.depth), (Dimension::Cube, 2, 2, 6));
    let reds: Vec<Vec<u8>> = chain(&texture).iter().map(|l| l.iter().map(|t| t[0]).collect()).collect();
    assert_eq!(
        reds[0],
        [0, 0, 0, 0, 10, 10, 10, 10, 20, 20, 20, 20, 30, 30, 30, 30, 40, 40, 40, 40, 50, 50, 50, 50]
    );
    assert_eq!(reds[1], [100, 110, 120, 130, 140, 150]);
    let message = told(load(&file.bytes(), Dimension::Two));
    assert!(
        message.contains("holds a cube with faces of 2×2") && message.contains("dimension = \"cube\""),
        "{message}"
    );
}

#[test]
fn volumes_halve_along_all_three_axes() {
    let data = [solid(1, 4 * 2 * 2), solid(50, 2), solid(90, 1)].concat();
    let file = Dds { size: [4, 2, 2], levels: 3, ..Dds::flat(DXGI_RGBA8, [4, 2], &data) };
    let texture = load(&file.bytes(), Dimension::Three).unwrap();
    let sizes: Vec<_> = texture.stored_levels.iter().map(|l| [l.width, l.height, l.depth]).collect();
    assert_eq!(
        ([texture.width, texture.height, texture.depth], sizes),
        ([4, 2, 2], vec![[2, 1, 1], [1, 1, 1]])
    );
    assert_eq!([chain(&texture)[1][0][0], chain(&texture)[2][0][0]], [50, 90]);
    assert!(told(load(&file.bytes(), Dimension::Two)).contains("volume of 4×2×2"));
    let flat = Dds::flat(DXGI_RGBA8, [1, 1], &[0; 4]).bytes();
    assert!(told(load(&flat, Dimension::Three)).contains("one flat picture of 1×1"));
}

#[test]
fn what_is_not_read_or_not_whole_is_refused_by_name() {
    let flat = || Dds::flat(DXGI_RGBA8, [2, 2], &[0; 16]);
    let letters = Legacy { flags: 4, letters: *b"PVR2", ..NO_FORMAT };
    let some_faces = Legacy { flags: 4, letters: *b"DXT1", caps: 0x600, ..NO_FORMAT };
    let odd_mask = Legacy { flags: 0x40, bits: 32, masks: [0x5, 0xff00, 0xff_0000, 0], ..NO_FORMAT };
    for (bytes, says) in [
        (Dds { layers: 3, ..flat() }.bytes(), "an array of 3 textures, which is not read"),
        (Dds { format: 12, ..flat() }.bytes(), "of DXGI format 12, which is not read"),
        (Dds { levels: 3, ..flat() }.bytes(), "damaged or truncated: 3 levels of 2×2 texels"),
        (Dds { levels: 2, ..flat() }.bytes(), "level 1 takes 4 bytes, and 0 are left"),
        (Dds { size: [0, 2, 1], ..flat() }.bytes(), "zero size"),
        (Dds { size: [65_536, 65_536, 1], ..flat() }.bytes(), "level 0 takes 17179869184 bytes"),
        (Dds { size: [u32::MAX, u32::MAX, 1], ..flat() }.bytes(), "level 0 takes"),
        (Dds { is_cube: true, size: [2, 1, 1], ..flat() }.bytes(), "a cube's faces of 2×1"),
        (legacy_dds([4, 4, 1], 1, &letters, &[0; 8]), "of the format PVR2, which is not read"),
        (legacy_dds([4, 4, 1], 1, &some_faces, &[0; 8]), "of a cube that lacks faces"),
        (legacy_dds([1, 1, 1], 1, &odd_mask, &[0; 4]), "of 32 bits with masks 5, ff00, ff0000, 0"),
        (flat().bytes()[..100].to_vec(), "the header has not the size of one"),
        (flat().bytes()[..140].to_vec(), "the file ends within the header"),
    ] {
        let message = told(load(&bytes, Dimension::Two));
        assert!(message.contains(says) && message.contains("a.texture"), "{says}: {message}");
    }
}
