//! TIFF files written by tifffile and by libtiff, value for value; and structures that are refused by name.

use std::fs;

use moire::internal::texture::data::{Dimension, TexelFormat};

use super::{assert_refused_as, fixture, load, load_bytes};
use crate::support::told;

const SIZE: [u32; 2] = [21, 18];

/// Sample `c` of texel (x, y), as in `data/pictures/make.py`.
fn code(x: u32, y: u32, c: u32, bits: u32) -> u64 {
    let [x, y, c] = [x, y, c].map(u64::from);
    let mixed = (x * 73_856_093) ^ (y * 19_349_663) ^ (c * 83_492_791);
    (mixed.wrapping_mul(2_654_435_761) & 0xffff_ffff) >> (32 - bits)
}

fn unsigned(bits: u32) -> impl Fn(u32, u32, u32) -> f64 {
    move |x, y, c| code(x, y, c, bits) as f64 / ((1u64 << bits) - 1) as f64
}

fn float(x: u32, y: u32, c: u32) -> f64 {
    (code(x, y, c, 12) as f64 - 2048.0) / 64.0
}

/// Each texel of the file has the expected values, to half a step of its format.
fn check(name: &str, format: TexelFormat, file_channels: usize, want: impl Fn(u32, u32) -> Vec<f64>) {
    let (t, notes) = load(&fixture(name), Dimension::Two).unwrap();
    let found = (t.width, t.height, t.format, t.file_channels);
    assert_eq!(found, (SIZE[0], SIZE[1], format, file_channels), "{name}");
    assert!(notes.is_empty(), "{name}: {notes:?}");
    // Half of 1/255, half of 1/65535, or 2^-24 of an f32 below 1; the floats of the files are exact.
    let tolerance = [0.5 / 255.0, 0.5 / 65_535.0, 0.6e-7][format.component() as usize] * (1.0 + 1e-9);
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        for (c, want) in want(x, y).into_iter().enumerate() {
            let found = t.value(x, y, c);
            assert!((found - want).abs() <= tolerance, "{name} ({x}, {y}) {c}: {found} for {want}");
        }
    }
}

#[test]
fn grey_of_every_depth_is_read() {
    for bits in [1, 2, 4, 6] {
        let value = unsigned(bits);
        check(&format!("grey{bits}.tif"), TexelFormat::Grey8, 1, |x, y| vec![value(x, y, 0)]);
    }
    for bits in [10, 12, 14] {
        let value = unsigned(bits);
        check(&format!("grey{bits}.tif"), TexelFormat::Grey16, 1, |x, y| vec![value(x, y, 0)]);
    }
    check("grey8-packbits.tif", TexelFormat::Grey8, 1, |x, y| vec![unsigned(8)(x, y, 0)]);
    check("grey16-white.tif", TexelFormat::Grey16, 1, |x, y| vec![1.0 - unsigned(16)(x, y, 0)]);
    check("grey32-deflate2-be.tif", TexelFormat::GreyFloat, 1, |x, y| vec![unsigned(32)(x, y, 0)]);
    check("grey-int16-lzw2.tif", TexelFormat::GreyFloat, 1, |x, y| {
        vec![(f64::from(code(x, y, 0, 16) as u16 as i16) / 32_767.0).max(-1.0)]
    });
    check("grey1-group4.tif", TexelFormat::Grey8, 1, |x, y| vec![unsigned(1)(x, y, 0)]);
}

#[test]
fn floats_of_16_32_and_64_bits_are_read() {
    for name in ["grey-half-deflate3.tif", "grey-float-lzw3-be.tif", "grey-double-tiled.tif"] {
        check(name, TexelFormat::GreyFloat, 1, |x, y| vec![float(x, y, 0)]);
    }
    check("rgb-float-big-tiled.tif", TexelFormat::RgbaFloat, 3, |x, y| {
        vec![float(x, y, 0), float(x, y, 1), float(x, y, 2), 1.0]
    });
}

#[test]
fn bits_from_the_lowest_on_are_read() {
    check("grey1-fill2.tif", TexelFormat::Grey8, 1, |x, y| vec![unsigned(1)(x, y, 0)]);
    let value = unsigned(8);
    check("rgb8-fill2-lzw2.tif", TexelFormat::Rgba8, 3, |x, y| {
        vec![value(x, y, 0), value(x, y, 1), value(x, y, 2), 1.0]
    });
}

#[test]
fn separate_planes_in_strips_and_tiles_of_any_size_are_read() {
    for (name, bits, format) in [
        ("rgb8-planar-tiled.tif", 8, TexelFormat::Rgba8),
        ("rgb16-planar-strips-be.tif", 16, TexelFormat::Rgba16),
        ("rgb12.tif", 12, TexelFormat::Rgba16),
    ] {
        let value = unsigned(bits);
        check(name, format, 3, |x, y| vec![value(x, y, 0), value(x, y, 1), value(x, y, 2), 1.0]);
    }
}

#[test]
fn extra_samples_are_alpha_only_where_they_are_declared_so() {
    let value = unsigned(8);
    let value16 = unsigned(16);
    check("grey-alpha8-lzw2.tif", TexelFormat::GreyAlpha8, 2, |x, y| vec![value(x, y, 0), value(x, y, 1)]);
    for name in ["rgb8-x-lzw2.tif", "rgb8-xxx-planar.tif"] {
        check(name, TexelFormat::Rgba8, 3, |x, y| vec![value(x, y, 0), value(x, y, 1), value(x, y, 2), 1.0]);
    }
    check("rgb16-xa-tiled.tif", TexelFormat::Rgba16, 4, |x, y| {
        vec![value16(x, y, 0), value16(x, y, 1), value16(x, y, 2), value16(x, y, 4)]
    });
    let (t, notes) = load(&fixture("rgba8-associated.tif"), Dimension::Two).unwrap();
    let stored = |x, y| [0, 1, 2, 3].map(|c| code(x, y, c, 8).min(code(x, y, 3, 8)) as u8);
    let want: Vec<u8> = (0..18).flat_map(|y| (0..21).flat_map(move |x| stored(x, y))).collect();
    assert_eq!((t.format, t.file_channels, t.texels), (TexelFormat::Rgba8, 4, want));
    assert!(notes.len() == 1 && notes[0].contains("multiplied by alpha"), "{notes:?}");
}

#[test]
fn inks_and_palettes_become_rgb() {
    let (value, value16) = (unsigned(8), unsigned(16));
    let light = |value: &dyn Fn(u32, u32, u32) -> f64, x, y| {
        let rgb = |c| (1.0 - value(x, y, c)) * (1.0 - value(x, y, 3));
        vec![rgb(0), rgb(1), rgb(2), 1.0]
    };
    check("cmyk8-x-deflate2.tif", TexelFormat::Rgba8, 3, |x, y| light(&value, x, y));
    check("cmyk16-planar.tif", TexelFormat::Rgba16, 3, |x, y| light(&value16, x, y));
    check("palette8.tif", TexelFormat::Rgba16, 3, |x, y| {
        let index = code(x, y, 0, 6) as u32;
        vec![value16(index, 0, 0), value16(index, 0, 1), value16(index, 0, 2), 1.0]
    });
}

#[test]
fn jpeg_data_with_shared_tables_is_read() {
    let (t, _) = load(&fixture("rgb8-jpeg.tif"), Dimension::Two).unwrap();
    for (x, y) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))) {
        for (c, want) in [10 * x, 12 * y, 5 * (x + y)].into_iter().enumerate() {
            let found = t.value(x, y, c) * 255.0;
            // libjpeg errs by 1 here; quality 95 has steps of 2 and more in most frequencies.
            assert!((found - f64::from(want)).abs() <= 2.0, "({x}, {y}) {c}: {found} for {want}");
        }
    }
}

#[test]
fn first_of_several_pages_is_read_with_a_note() {
    let (t, notes) = load(&fixture("two-pages.tif"), Dimension::Two).unwrap();
    assert_eq!((t.width, t.height, t.value(3, 2, 0)), (21, 18, unsigned(8)(3, 2, 0)));
    assert_eq!(notes.len(), 1);
    assert!(notes[0].contains("the first of 2 pictures") && notes[0].contains("texture \"t\""), "{notes:?}");
}

/// The file with another value of a tag that it has, in a little-endian file with values of 16 bits.
fn with_tag(name: &str, tag: u16, value: u16) -> Vec<u8> {
    let mut bytes = fs::read(fixture(name)).unwrap();
    let at = entry(&bytes, tag) + 8;
    bytes[at..at + 2].copy_from_slice(&value.to_le_bytes());
    bytes
}

fn entry(bytes: &[u8], tag: u16) -> usize {
    let start = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let count = usize::from(u16::from_le_bytes([bytes[start], bytes[start + 1]]));
    let mut entries = (0..count).map(|i| start + 2 + 12 * i);
    entries.find(|&at| bytes[at..at + 2] == tag.to_le_bytes()).unwrap()
}

#[test]
fn integers_of_32_bits_without_a_sample_format_are_integers() {
    let mut bytes = fs::read(fixture("grey8-packbits.tif")).unwrap();
    // 21×18 texels of 8 bits in a row are at least 5×17 of 32 bits.
    let bytes_of = |bytes: &[u8]| load_bytes(bytes).unwrap().0;
    let plain = bytes_of(&bytes).texels;
    for (tag, value) in [(256, 5u16), (257, 17), (278, 17), (258, 32)] {
        let at = entry(&bytes, tag) + 8;
        bytes[at..at + 2].copy_from_slice(&value.to_le_bytes());
    }
    let format = bytes.windows(2).position(|b| b == 339u16.to_le_bytes());
    assert!(format.is_none(), "the file has no SampleFormat");
    let t = bytes_of(&bytes);
    let want = u32::from_le_bytes(plain[4..8].try_into().unwrap());
    assert_eq!(
        (t.format, t.value(1, 0, 0)),
        (TexelFormat::GreyFloat, f64::from((f64::from(want) / f64::from(u32::MAX)) as f32))
    );
}

#[test]
fn structures_that_are_not_read_are_refused_by_name() {
    for (tag, value, name) in [
        (259, 2, "CCITT modified Huffman"),
        (259, 3, "CCITT group 3"),
        (259, 6, "old JPEG"),
        (259, 34_712, "JPEG 2000"),
        (259, 34_925, "LZMA"),
        (259, 50_000, "Zstandard"),
        (259, 50_001, "WebP"),
        (259, 34_887, "LERC"),
        (259, 777, "compression 777"),
        (262, 4, "transparency mask"),
        (262, 6, "YCbCr without JPEG"),
        (262, 8, "CIE L*a*b*"),
        (262, 9, "ICC L*a*b*"),
        (262, 32_803, "colour filter array"),
        (262, 32_845, "LogLuv"),
        (262, 99, "PhotometricInterpretation 99"),
        (258, 33, "integers of 33 bits"),
    ] {
        assert_refused_as(&with_tag("grey8-packbits.tif", tag, value), name);
    }
    for (tag, value, name) in [
        (317, 4, "predictor 4"),
        (317, 3, "predictor 3 (of floats) with integers"),
        (258, 12, "predictor 2 with 12 bits"),
    ] {
        assert_refused_as(&with_tag("grey-int16-lzw2.tif", tag, value), name);
    }
    for (value, name) in [(5, "complex"), (6, "complex"), (9, "SampleFormat 9")] {
        assert_refused_as(&with_tag("grey-int16-lzw2.tif", 339, value), name);
    }
    assert_refused_as(&with_tag("grey-int16-lzw2.tif", 262, 0), "signed or float samples where 0 is white");
    assert_refused_as(&with_tag("grey1-fill2.tif", 266, 3), "FillOrder 3");
    assert_refused_as(&with_tag("rgb8-x-lzw2.tif", 284, 3), "PlanarConfiguration 3");
}

#[test]
fn sizes_that_the_file_cannot_hold_are_refused_before_they_are_allocated() {
    for name in ["grey8-packbits.tif", "grey-alpha8-lzw2.tif", "grey1.tif", "grey1-group4.tif"] {
        let mut bytes = fs::read(fixture(name)).unwrap();
        for tag in [256, 257] {
            let at = entry(&bytes, tag) + 8;
            bytes[at..at + 2].copy_from_slice(&65_000u16.to_le_bytes());
        }
        let message = told(load_bytes(&bytes));
        assert!(message.contains("damaged or truncated"), "{name}: {message}");
    }
}
