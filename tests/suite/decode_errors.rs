//! Reading invalid texture files: every kind of defect has its message, and none causes a panic.

use std::fs;
use std::path::{Path, PathBuf};

use image::ImageFormat;
use moire::internal::output::{self, WriteOptions};
use moire::internal::texture::data::{ColorSpace, TextureData};
use moire::internal::texture::decode::decode;
use tempfile::{TempDir, tempdir};

use crate::support::{gradient, told};

fn load(path: &Path) -> moire::internal::core::error::Result<TextureData> {
    decode(path, "t", ColorSpace::Linear, false)
}

#[test]
fn exr_without_rgb_or_y_names_its_channels() {
    use exr::prelude::*;
    let folder = tempdir().unwrap();
    let path = folder.path().join("z.exr");
    let channel = SpecificChannels::build().with_channel("depth.Z").with_pixel_fn(|_: Vec2<usize>| (1f32,));
    Image::from_channels((4, 4), channel).write().to_file(&path).unwrap();
    let message = told(load(&path));
    assert!(message.contains("depth.Z") && message.contains("R, G, B"), "{message}");
}

#[test]
fn content_that_is_no_picture_is_described() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("grass.png");
    for (content, what) in [
        (&b""[..], "is empty"),
        (b"<!DOCTYPE html><html>", "is a web page"),
        (b"just some words\n", "looks like text"),
        (b"\xabKTX 11\xbb\r\n", "is KTX 1 (KTX2 is read)"),
        (b"GIF89a\x01\0\x01\0", "is GIF"),
        (b"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer"),
        (b"\x00\x01\x02\x03", "begins with the bytes 00 01 02 03"),
    ] {
        fs::write(&path, content).unwrap();
        let message = told(load(&path));
        assert!(message.contains(what) && message.contains("grass.png"), "{message}");
        assert!(message.contains("PNG, JPEG, TIFF") && message.contains("texture \"t\""), "{message}");
    }
}

#[test]
fn missing_file_suggests_the_closest_name() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("grass.png"), b"x").unwrap();
    let message = told(load(&folder.path().join("gras.png")));
    assert!(message.contains("no such file") && message.contains("did you mean"), "{message}");
    let message = told(load(&folder.path().join("nowhere/grass.png")));
    assert!(message.contains("nowhere does not exist"), "{message}");
}

#[test]
fn folder_in_place_of_a_picture_is_named_as_such() {
    let folder = tempdir().unwrap();
    assert!(told(load(folder.path())).contains("this is a folder"));
}

/// An RGB PNG of the given size and depth without image data: only its header can be checked.
fn png_header(width: u32, height: u32, bits: u8) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, data) in [
        (b"IHDR", [&width.to_be_bytes()[..], &height.to_be_bytes(), &[bits, 2, 0, 0, 0]].concat()),
        (b"IDAT", vec![0x78, 0x9c]),
    ] {
        bytes.extend((data.len() as u32).to_be_bytes());
        let body = [&kind[..], &data].concat();
        bytes.extend(&body);
        bytes.extend(crc32fast::hash(&body).to_be_bytes());
    }
    bytes
}

#[test]
fn zero_size_and_oversize_are_seen_in_the_header() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    for (size, what) in [
        ((0, 4, 8), "zero size"),
        ((4, 0, 8), "zero size"),
        ((65_537, 1, 8), "65537×1 texels are too many"),
        ((65_536, 65_536, 16), "not fit into memory"),
    ] {
        fs::write(&path, png_header(size.0, size.1, size.2)).unwrap();
        let message = told(load(&path));
        assert!(message.contains(what), "{size:?}: {message}");
    }
    let hdr = folder.path().join("a.hdr");
    fs::write(&hdr, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 4\n").unwrap();
    assert!(told(load(&hdr)).contains("zero size"));
}

/// One file of each format; gradients, so that a lost row cannot look like a kept one.
fn samples(folder: &TempDir) -> Vec<PathBuf> {
    let film = gradient(23, 17);
    let mut paths = Vec::new();
    for name in ["a.png", "a.jpg", "a.tif", "a.hdr", "a.exr"] {
        let path = folder.path().join(name);
        output::write(&film, &path, &WriteOptions::default()).unwrap();
        paths.push(path);
    }
    let zip = folder.path().join("zip.exr");
    exr::prelude::write_rgb_file(&zip, 23, 17, |x, y| (x as f32, y as f32, 0.5f32)).unwrap();
    paths.push(zip);
    paths
}

#[test]
fn truncated_file_is_an_error_at_every_length_that_loses_a_texel() {
    let folder = tempdir().unwrap();
    for path in samples(&folder) {
        let whole = fs::read(&path).unwrap();
        let texels = load(&path).unwrap().texels;
        let format = image::guess_format(&whole).unwrap();
        let mut failed = 0;
        for length in (0..whole.len()).step_by(whole.len() / 200 + 1).chain(whole.len() - 16..whole.len()) {
            fs::write(&path, &whole[..length]).unwrap();
            match load(&path) {
                Ok(t) => assert_eq!(t.texels, texels, "{format:?} cut to {length} of {}", whole.len()),
                Err(e) => {
                    let message = told::<()>(Err(e));
                    assert!(message.contains(path.to_str().unwrap()), "{message}");
                    failed += 1;
                }
            }
        }
        assert!(failed > 100, "{format:?}: only {failed} cuts were seen");
    }
}

#[test]
fn damaged_bytes_never_panic() {
    let folder = tempdir().unwrap();
    for path in samples(&folder) {
        let whole = fs::read(&path).unwrap();
        let mut state = 1u32;
        for _ in 0..400 {
            let mut bytes = whole.clone();
            for _ in 0..3 {
                state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
                // Half of the damage in the first 512 bytes, where the headers are.
                let range = if state & 1 == 0 { bytes.len() } else { bytes.len().min(512) };
                bytes[(state >> 8) as usize % range] = (state >> 3) as u8;
            }
            fs::write(&path, &bytes).unwrap();
            let _ = load(&path);
        }
    }
}

#[test]
fn nan_and_infinite_texels_are_located_and_counted() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let mut film = gradient(4, 3);
    film.pixels[4 + 2][1] = f32::NAN;
    output::write(&film, &path, &WriteOptions::default()).unwrap();
    let message = told(load(&path));
    assert!(message.contains("texel (2, 1), channel green, is NaN; 1 value"), "{message}");
    film.pixels[3][2] = f32::INFINITY;
    output::write(&film, &path, &WriteOptions::default()).unwrap();
    let message = told(decode(&path, "t", ColorSpace::Linear, true));
    assert!(message.contains("texel (3, 0), channel blue, is inf; 2 values"), "{message}");
}

#[test]
fn srgb_on_float_texels_says_use_linear() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    output::write(&gradient(4, 3), &path, &WriteOptions::default()).unwrap();
    let message = told(decode(&path, "sky", ColorSpace::Srgb, false));
    assert!(message.contains("\"sky\"") && message.contains("color_space = \"linear\""), "{message}");
}

#[test]
fn decode_limit_admits_more_than_the_decoders_default_of_512_mib() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    // 16384 × 16384 × 3 bytes = 768 MiB, refused by default; here it only lacks its data.
    fs::write(&path, png_header(16_384, 16_384, 8)).unwrap();
    let message = told(load(&path));
    assert!(message.contains("damaged or truncated"), "{message}");
}

#[test]
fn picture_formats_are_found_by_their_signatures() {
    let folder = tempdir().unwrap();
    let found: Vec<_> =
        samples(&folder).iter().map(|p| image::guess_format(&fs::read(p).unwrap()).unwrap()).collect();
    use ImageFormat::{Hdr, Jpeg, OpenExr, Png, Tiff};
    assert_eq!(found, [Png, Jpeg, Tiff, Hdr, OpenExr, OpenExr]);
}
