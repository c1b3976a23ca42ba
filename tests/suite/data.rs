//! The committed data is consistent: textures equal the output of the synthesis code, the
//! third-party test textures have their checksums, tileable textures tile, and scenes name existing
//! files.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageReader};

use crate::support::data;

#[path = "../../examples/make_textures/synth/mod.rs"]
mod synth;

fn decode(path: &Path) -> DynamicImage {
    let reader = ImageReader::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    reader.decode().unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn texture(name: &str) -> DynamicImage {
    decode(&data().join("textures").join(name))
}

fn files_below(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files_below(&path, ending));
        } else if path.to_str().unwrap().ends_with(ending) {
            found.push(path);
        }
    }
    found
}

#[test]
fn committed_textures_equal_what_the_code_makes() {
    for asset in synth::all() {
        let file = texture(asset.path);
        assert_eq!(file.color(), asset.image.color(), "{}: pixel type", asset.path);
        assert_eq!(file.width(), asset.image.width(), "{}: width", asset.path);
        assert!(
            file.as_bytes() == asset.image.as_bytes(),
            "{} differs: run `cargo run --release --example make_textures` and commit",
            asset.path
        );
    }
}

#[test]
fn committed_volumes_equal_what_the_code_makes() {
    for volume in synth::volumes() {
        let file = fs::read(data().join("textures").join(volume.path)).unwrap();
        assert!(
            file == volume.bytes,
            "{} differs: run `cargo run --release --example make_textures` and commit",
            volume.path
        );
    }
}

#[test]
fn every_texture_file_is_generated_except_the_noise() {
    let root = data().join("textures");
    let mut known: HashSet<PathBuf> = synth::all().iter().map(|a| root.join(a.path)).collect();
    known.extend(synth::volumes().iter().map(|v| root.join(v.path)));
    known.insert(root.join("bench/noise.png"));
    for file in files_below(&root, "") {
        assert!(known.contains(&file), "{} is made by nothing", file.display());
    }
}

#[test]
fn measuring_textures_have_their_checksums() {
    for (name, crc) in [("bench/checker.png", 0x0fab_fbf5), ("bench/noise.png", 0x56f6_80c3_u32)] {
        let picture = texture(name);
        assert_eq!((picture.width(), picture.height()), (1024, 1024), "{name}");
        let raw = picture.as_rgb8().unwrap_or_else(|| panic!("{name} is not 8-bit RGB"));
        assert_eq!(crc32fast::hash(raw), crc, "{name}: CRC-32 of the raw RGB bytes");
    }
}

/// Mean absolute difference of neighbouring texels: across the seam, and inside the picture.
fn seam_and_interior(picture: &DynamicImage) -> [(f64, f64); 2] {
    let picture = picture.to_rgb8();
    let (width, height) = picture.dimensions();
    let difference = |a: (u32, u32), b: (u32, u32)| {
        let (a, b) = (picture.get_pixel(a.0, a.1), picture.get_pixel(b.0, b.1));
        (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))).sum::<f64>()
    };
    let across = |i: u32| {
        let sum: f64 = (0..height).map(|j| difference((i, j), ((i + 1) % width, j))).sum();
        sum / f64::from(height)
    };
    let down = |j: u32| {
        let sum: f64 = (0..width).map(|i| difference((i, j), (i, (j + 1) % height))).sum();
        sum / f64::from(width)
    };
    let mean = |n: u32, of: &dyn Fn(u32) -> f64| (0..n - 1).map(of).sum::<f64>() / f64::from(n - 1);
    [(across(width - 1), mean(width, &across)), (down(height - 1), mean(height, &down))]
}

#[test]
fn tileable_textures_have_no_seam() {
    for name in ["grass.png", "tiles.png", "bench/noise.png"] {
        for (seam, interior) in seam_and_interior(&texture(name)) {
            // Twice the mean step: a step from texel to texel varies that much inside, too.
            assert!(seam < 2.0 * interior, "{name}: step {seam} across the seam, {interior} inside");
        }
    }
}

#[test]
fn poster_has_a_seam_in_both_directions() {
    for (seam, interior) in seam_and_interior(&texture("poster.png")) {
        assert!(seam > 5.0 * interior, "step {seam} across the seam, {interior} inside");
    }
}

#[test]
fn poster_differs_under_every_flip_and_turn() {
    let poster = texture("poster.png").to_rgb8();
    let corner = |picture: &image::RgbImage| *picture.get_pixel(10, 10);
    let flips = [
        image::imageops::flip_horizontal(&poster),
        image::imageops::flip_vertical(&poster),
        image::imageops::rotate180(&poster),
        image::imageops::rotate90(&poster),
        image::imageops::rotate270(&poster),
    ];
    for (k, flipped) in flips.iter().enumerate() {
        let (a, b) = (corner(&poster), corner(flipped));
        let step: u32 = (0..3).map(|c| u32::from(a[c].abs_diff(b[c]))).sum();
        assert!(step > 100, "flip {k} leaves the corner as it was: {a:?} {b:?}");
    }
}

#[test]
fn coded_textures_tell_every_texel_in_every_channel() {
    for asset in synth::all() {
        let (width, height) = (asset.image.width(), asset.image.height());
        if width * height > 64 {
            continue;
        }
        let channels = usize::from(asset.image.color().channel_count());
        let step = usize::from(asset.image.color().bytes_per_pixel()) / channels;
        let texels = asset.image.as_bytes().chunks(channels * step);
        for c in 0..channels {
            let values: HashSet<&[u8]> =
                texels.clone().map(|texel| &texel[c * step..(c + 1) * step]).collect();
            assert_eq!(values.len() as u32, width * height, "{} channel {c}", asset.path);
        }
    }
}

#[test]
fn png_files_carry_no_colour_chunks() {
    for file in files_below(&data().join("textures"), ".png") {
        let bytes = fs::read(&file).unwrap();
        let mut at = 8;
        while at + 8 <= bytes.len() {
            let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
            let kind = std::str::from_utf8(&bytes[at + 4..at + 8]).unwrap();
            assert!(["IHDR", "IDAT", "IEND"].contains(&kind), "{}: chunk {kind}", file.display());
            at += length + 12;
        }
    }
}

#[test]
fn generated_textures_stay_small_on_disk() {
    let root = data().join("textures");
    let size = |path: &Path| fs::metadata(path).unwrap().len();
    let total: u64 = synth::all().iter().map(|asset| size(&root.join(asset.path))).sum();
    assert!(total < 600_000, "{total} bytes of generated textures");
    let noise = size(&root.join("bench/noise.png"));
    assert!(noise < 3_000_000, "noise.png has {noise} bytes");
}

#[test]
fn every_scene_is_toml_and_its_textures_exist() {
    let scenes = files_below(&data().join("scenes"), ".toml");
    assert!(scenes.len() >= 14, "only {} scenes", scenes.len());
    for path in scenes {
        let text = fs::read_to_string(&path).unwrap();
        let scene: toml::Table = text.parse().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        for needed in ["camera", "image"] {
            assert!(scene.contains_key(needed), "{}: no [{needed}]", path.display());
        }
        let textures = scene.get("texture").and_then(|t| t.as_array()).cloned().unwrap_or_default();
        for name in textures.iter().flat_map(files_of) {
            let file = path.parent().unwrap().join(name);
            assert!(file.is_file(), "{}: no file {}", path.display(), file.display());
        }
    }
}

/// The files that a `[[texture]]` reads.
fn files_of(texture: &toml::Value) -> Vec<&str> {
    let keys = ["file", "faces", "slices", "volume"];
    let given = keys.iter().filter_map(|key| texture.get(key));
    given
        .flat_map(|value| match value {
            toml::Value::Array(files) => files.iter().filter_map(|f| f.as_str()).collect(),
            toml::Value::Table(volume) => volume.get("file").and_then(|f| f.as_str()).into_iter().collect(),
            other => other.as_str().into_iter().collect::<Vec<_>>(),
        })
        .collect()
}
