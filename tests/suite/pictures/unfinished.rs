//! Truncated files: if all texels are present they are read with a note, otherwise refused. Also
//! unsupported kinds of JPEG and PNG.

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::{assert_refused_as, fixture, load_bytes};
use crate::support::told;

const SIZE: u32 = 40;

fn rgb() -> Vec<u8> {
    (0..SIZE * SIZE * 3).map(|i| (i * i % 241) as u8).collect()
}

fn png() -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes).write_image(&rgb(), SIZE, SIZE, ExtendedColorType::Rgb8).unwrap();
    bytes
}

fn jpeg() -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut bytes, 90);
    encoder.write_image(&rgb(), SIZE, SIZE, ExtendedColorType::Rgb8).unwrap();
    bytes
}

/// Every length of the file: texels of the whole file with a note, or an error. `cut` are the lengths at which
/// no texel is lost.
fn check(whole: &[u8], cut: std::ops::Range<usize>, note: &str) {
    let (texels, notes) = load_bytes(whole).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    for length in (20..whole.len()).step_by(97).chain(whole.len() - 40..whole.len()) {
        match load_bytes(&whole[..length]) {
            Ok((t, notes)) => {
                assert_eq!(t.texels, texels.texels, "cut to {length} of {}", whole.len());
                assert!(notes.len() == 1 && notes[0].contains(note), "{notes:?}");
            }
            Err(e) => {
                let message = told::<()>(Err(e));
                assert!(
                    message.contains("damaged or truncated") || message.contains("signature"),
                    "{message}"
                );
                assert!(!cut.contains(&length), "cut to {length} of {}: {message}", whole.len());
            }
        }
    }
}

#[test]
fn png_without_its_end_is_read_where_all_texels_are_there() {
    let whole = png();
    // The end is a chunk of 12 bytes, and 4 before it are the checksum of the texels.
    check(&whole, whole.len() - 16..whole.len(), "no end (IEND)");
}

#[test]
fn jpeg_without_its_last_marker_is_read_where_all_texels_are_there() {
    let whole = jpeg();
    check(&whole, whole.len() - 2..whole.len(), "no end-of-image marker");
    let progressive = std::fs::read(fixture("progressive.jpg")).unwrap();
    check(&progressive, progressive.len() - 2..progressive.len(), "no end-of-image marker");
}

#[test]
fn kinds_of_jpeg_and_png_that_are_not_read_are_refused_by_name() {
    for (marker, precision, name) in [
        (0xc1, 12, "12 bits"),
        (0xc3, 8, "lossless JPEG"),
        (0xc5, 8, "hierarchical"),
        (0xc9, 8, "arithmetic coding"),
        (0xca, 8, "arithmetic coding"),
        (0xf7, 8, "JPEG-LS"),
    ] {
        let frame = [0xff, marker, 0, 11, precision, 0, 8, 0, 8, 1, 1, 0x11, 0];
        let bytes = [&[0xff, 0xd8][..], &frame, &[0xff, 0xd9]].concat();
        assert_refused_as(&bytes, name);
    }
    let png = png();
    let apples = [&png[..8], b"\0\0\0\x04CgBI\x50\0\x20\x06\x2b\xd5\xb3\x2c", &png[8..]].concat();
    assert_refused_as(&apples, "CgBI");
}
