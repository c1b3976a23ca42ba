//! Texture files that are missing, damaged, mislabelled, empty, tiny or too large.

use std::fs;

use image::{GrayImage, Luma};
use moire::internal::gpu::{DeviceSelect, list_devices};

use super::Case;
use crate::stage::device_name;

#[test]
fn missing_texture_is_named_with_a_suggestion() {
    let case = Case::edit("tiles.png", "tile.png");
    case.refused(&[], &["texture \"tiles\"", "tile.png", "no such file", "did you mean", "tiles.png"]);
}

#[test]
fn truncated_texture_is_refused() {
    let case = Case::new();
    case.texture(64, 64);
    let whole = fs::read(case.path("tiles.png")).unwrap();
    for part in [whole.len() / 2, 40, 9] {
        case.put("tiles.png", &whole[..part]);
        case.refused(&[], &["texture \"tiles\"", "tiles.png"]);
    }
}

#[test]
fn mislabelled_texture_is_told_by_its_content() {
    let case = Case::new();
    for (content, what) in
        [(&b"<!DOCTYPE html><html>"[..], "a web page"), (b"GIF89a\x01\0\x01\0", "GIF"), (b"", "is empty")]
    {
        case.put("tiles.png", content);
        case.refused(&[], &["texture \"tiles\"", "tiles.png", what]);
    }
}

/// The ending says PNG, the content is TIFF: it is read by its content.
#[test]
fn a_readable_format_under_a_wrong_ending_is_read() {
    let case = Case::new();
    GrayImage::from_pixel(4, 4, Luma([100])).save(case.path("other.tiff")).unwrap();
    fs::rename(case.path("other.tiff"), case.path("tiles.png")).unwrap();
    case.renders(&[]);
}

#[test]
fn texture_without_its_last_bytes_is_rendered_with_a_warning() {
    let case = Case::new();
    let whole = fs::read(case.path("tiles.png")).unwrap();
    case.put("tiles.png", &whole[..whole.len() - 12]);
    let device = device_name();
    for device in [device.as_str(), "oracle"] {
        let args = ["render", "scene.toml", "--json", "-o", "new.png", "--device", device];
        let (code, stdout, stderr) = case.run(&[], &args);
        assert_eq!(code, Some(0), "{stderr}");
        let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
        let warning = "texture \"tiles\": tiles.png: the PNG data has no end (IEND); all texels are there";
        assert_eq!(report["warnings"][0], warning);
        assert!(stderr.contains("warning: texture \"tiles\""), "{stderr}");
    }
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [&kind[..], data].concat();
    [&(data.len() as u32).to_be_bytes()[..], &body, &crc32fast::hash(&body).to_be_bytes()].concat()
}

#[test]
fn texture_without_texels_is_refused() {
    for (width, height) in [(0u32, 4u32), (4, 0), (0, 0)] {
        let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[8, 0, 0, 0, 0]].concat();
        let png = [
            b"\x89PNG\r\n\x1a\n".to_vec(),
            chunk(b"IHDR", &header),
            chunk(b"IDAT", &[]),
            chunk(b"IEND", &[]),
        ];
        let case = Case::new();
        case.put("tiles.png", &png.concat());
        case.refused(&[], &["texture \"tiles\"", "tiles.png"]);
    }
}

#[test]
fn one_texel_is_a_texture() {
    let case = Case::new();
    case.texture(1, 1);
    for options in [&[][..], &["--texels", "image"], &["--method", "hardware"], &["--filter", "nearest"]] {
        case.renders(options);
    }
}

/// Largest side of an image on the device under test.
fn image_limit() -> u32 {
    let device = device_name();
    let select = DeviceSelect::parse(&device).unwrap();
    let devices = list_devices().unwrap();
    devices[select.choose(&devices).unwrap()].limits.max_image_2d
}

#[test]
fn texture_over_the_limit_of_the_device_is_refused_where_it_must_be_an_image() {
    let limit = image_limit();
    let case = Case::new();
    case.texture(limit + 1, 1);
    for options in [["--method", "hardware"], ["--texels", "image"]] {
        let size = format!("texture `tiles` {}×1", limit + 1);
        case.refused(
            &options,
            &[&size, "too large", &format!("at most {limit}×{limit}"), "--texels auto or buffer"],
        );
    }
    case.renders(&["--texels", "buffer"]);
}
