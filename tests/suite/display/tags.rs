//! The colour tags of files: chunks of PNG, and ICC profiles, read by other code and held against published colorants.

use std::io::{Cursor, Read};

use flate2::read::ZlibDecoder;
use image::ImageDecoder;
use moire::internal::output::{DisplayTransform, Format, Gamut, WriteOptions, to_bytes_with};
use moxcms::{ColorProfile, Xyzd};

use super::NEUTRAL;
use crate::support::gradient;

fn file(format: Format, gamut: Gamut) -> Vec<u8> {
    let display = DisplayTransform { gamut, ..NEUTRAL };
    to_bytes_with(&gradient(5, 3), format, &WriteOptions { display, ..WriteOptions::default() }).unwrap()
}

/// Returns names and contents of the chunks of a PNG file.
fn chunks(png: &[u8]) -> Vec<(String, Vec<u8>)> {
    let (mut at, mut found) = (8, Vec::new());
    while at < png.len() {
        let length = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        let name = String::from_utf8(png[at + 4..at + 8].to_vec()).unwrap();
        let checked = &png[at + 4..at + 8 + length];
        let sum = u32::from_be_bytes(png[at + 8 + length..at + 12 + length].try_into().unwrap());
        assert_eq!(crc32fast::hash(checked), sum, "{name}");
        found.push((name, checked[4..].to_vec()));
        at += 12 + length;
    }
    found
}

/// The numbers of gAMA and cHRM, in units of 1/100000: gamma, then x and y of white, red, green and blue.
fn old_tags(chunks: &[(String, Vec<u8>)]) -> Vec<u32> {
    let old = chunks.iter().filter(|(name, _)| name == "gAMA" || name == "cHRM");
    old.flat_map(|(_, data)| data.chunks(4).map(|v| u32::from_be_bytes(v.try_into().unwrap()))).collect()
}

#[test]
fn png_is_srgb_and_old_readers_are_told_so() {
    let chunks = chunks(&file(Format::Png, Gamut::Srgb));
    let names: Vec<&str> = chunks.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["IHDR", "sRGB", "gAMA", "cHRM", "IDAT", "IEND"]);
    assert_eq!(chunks[1].1, [0], "the intent is perceptual");
    // PNG 3rd edition, 11.3.2.5: what stands beside sRGB.
    assert_eq!(old_tags(&chunks), [45_455, 31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6000]);
}

#[test]
fn png_of_display_p3_has_cicp_a_profile_and_old_tags_before_the_pixels() {
    let chunks = chunks(&file(Format::Png, Gamut::DisplayP3));
    let names: Vec<&str> = chunks.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["IHDR", "gAMA", "cHRM", "cICP", "iCCP", "IDAT", "IEND"]);
    assert_eq!(chunks[3].1, [12, 13, 0, 1]);
    assert_eq!(old_tags(&chunks)[3..], [68_000, 32_000, 26_500, 69_000, 15_000, 6000]);
    let mut profile = Vec::new();
    let stream = chunks[4].1.strip_prefix(b"display-p3\0\0").unwrap();
    ZlibDecoder::new(stream).read_to_end(&mut profile).unwrap();
    check(&profile, Gamut::DisplayP3);
}

/// Returns the profile that another reader finds.
fn profile_of(format: Format, bytes: Vec<u8>) -> Vec<u8> {
    let bytes = Cursor::new(bytes);
    let profile = match format {
        Format::Png => image::codecs::png::PngDecoder::new(bytes).unwrap().icc_profile(),
        Format::Jpeg => image::codecs::jpeg::JpegDecoder::new(bytes).unwrap().icc_profile(),
        _ => image::codecs::tiff::TiffDecoder::new(bytes).unwrap().icc_profile(),
    };
    profile.unwrap().unwrap_or_else(|| panic!("{format} has no profile"))
}

#[test]
fn another_reader_finds_the_profile_in_each_format() {
    for gamut in Gamut::ALL {
        for format in [Format::Jpeg, Format::Tiff] {
            check(&profile_of(format, file(format, *gamut)), *gamut);
        }
    }
    check(&profile_of(Format::Png, file(Format::Png, Gamut::DisplayP3)), Gamut::DisplayP3);
}

/// The colorants under D50: CSS Color 4, matrices to XYZ of D50, whose Z is 0.8251 there and 0.8249 in profiles.
const SRGB: [[f64; 3]; 3] =
    [[0.436_066, 0.222_493, 0.013_924], [0.385_152, 0.716_887, 0.097_081], [0.143_078, 0.060_617, 0.714_099]];
const DISPLAY_P3: [[f64; 3]; 3] = [
    [0.515_119, 0.241_189, -0.001_051],
    [0.291_978, 0.692_244, 0.041_879],
    [0.157_104, 0.066_567, 0.784_071],
];
/// From D65 to D50 by Bradford: B. Lindbloom's table, where D50 has a Z of 0.8252 and D65 one of 1.0888.
const ADAPTATION: [[f64; 3]; 3] = [
    [1.047_811_2, 0.022_886_6, -0.050_127_0],
    [0.029_542_4, 0.990_484_4, -0.017_049_1],
    [-0.009_234_5, 0.015_043_6, 0.752_131_6],
];

fn assert_xyz(found: Xyzd, wanted: [f64; 3]) {
    let far = [found.x, found.y, found.z].iter().zip(wanted).any(|(f, w)| (f - w).abs() > 2.2e-4);
    assert!(!far, "{found:?} is not {wanted:?}");
}

/// Holds a profile against the specification and the colorants of its space.
fn check(bytes: &[u8], gamut: Gamut) {
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(number(0), bytes.len());
    assert_eq!(&bytes[36..40], b"acsp");
    let mut tags = Vec::new();
    for i in 0..number(128) {
        let at = 132 + 12 * i;
        let (from, length) = (number(at + 4), number(at + 8));
        assert!(from % 4 == 0 && from + length <= bytes.len(), "tag {i}");
        tags.push((bytes[at..at + 4].to_vec(), from, length));
    }
    // ICC.1:2022, 8.3.3: what a display profile of three components must have.
    for required in ["desc", "cprt", "wtpt", "chad", "rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"] {
        assert!(tags.iter().any(|(name, ..)| name == required.as_bytes()), "no {required}");
    }

    let profile = ColorProfile::new_from_slice(bytes).unwrap();
    let colorants = if gamut == Gamut::Srgb { SRGB } else { DISPLAY_P3 };
    assert_xyz(profile.red_colorant, colorants[0]);
    assert_xyz(profile.green_colorant, colorants[1]);
    assert_xyz(profile.blue_colorant, colorants[2]);
    assert_xyz(profile.media_white_point.unwrap(), [0.9642, 1.0, 0.8249]);
    let adaptation = profile.chromatic_adaptation.unwrap();
    for (found, wanted) in adaptation.v.iter().zip(ADAPTATION) {
        assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 5e-4), "{found:?} is not {wanted:?}");
    }
}

/// A color management system turns the file's numbers to those of sRGB: the same colour whatever the gamut.
#[test]
fn a_color_management_system_shows_both_gamuts_alike() {
    let film = gradient(8, 8);
    let pixels = |gamut| {
        let display = DisplayTransform { gamut, ..NEUTRAL };
        let options = WriteOptions { png_bits: 16, display, ..WriteOptions::default() };
        let bytes = to_bytes_with(&film, Format::Png, &options).unwrap();
        image::load_from_memory(&bytes).unwrap().into_rgb16().into_raw()
    };
    let wide = pixels(Gamut::DisplayP3);
    let bytes = profile_of(Format::Png, file(Format::Png, Gamut::DisplayP3));
    let profile = ColorProfile::new_from_slice(&bytes).unwrap();
    let layout = moxcms::Layout::Rgb;
    let transform = profile
        .create_transform_16bit(
            layout,
            &ColorProfile::new_srgb(),
            layout,
            moxcms::TransformOptions::default(),
        )
        .unwrap();
    let mut managed = vec![0; wide.len()];
    transform.transform(&wide, &mut managed).unwrap();
    for (managed, plain) in managed.iter().zip(pixels(Gamut::Srgb)) {
        // Its tables and fixed-point numbers err by a few steps of 12 bits.
        assert!(managed.abs_diff(plain) < 200, "{managed} is not {plain}");
    }
    assert_ne!(wide, pixels(Gamut::Srgb));
}
