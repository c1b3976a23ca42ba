//! OpenEXR files as other programs write them: channels other than R, G, B, layers, parts, chroma with fewer
//! samples. The files beside this were written by OpenEXR 3.1 (`yc-*`) and its Python module 3.5.

use std::fs;
use std::path::Path;

use moire::internal::core::error::Result;
use moire::internal::texture::data::{Dimension, TextureData};
use moire::internal::texture::load::load;
use moire::internal::texture::source::{ReadOptions, TextureContent};
use tempfile::tempdir;

use crate::support::{texture_source, told};

const LAYERS: &[u8] = include_bytes!("exr/layers.exr");
const NAMED: &[u8] = include_bytes!("exr/named.exr");
const PARTS: &[u8] = include_bytes!("exr/parts.exr");

fn read(file: &[u8], layer: Option<&str>) -> Result<TextureData> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    fs::write(&path, file).unwrap();
    read_path(&path, layer)
}

fn read_path(path: &Path, layer: Option<&str>) -> Result<TextureData> {
    let reading = ReadOptions { layer: layer.map(str::to_owned), ..ReadOptions::default() };
    load(&texture_source(TextureContent::File(path.to_owned()), Dimension::Two, reading))
}

/// The sizes of `layers`, `named`, `parts` and `xyz`: 8 × 6 texels.
fn written(x: u32, y: u32) -> [f64; 3] {
    let (x, y) = (f64::from(x), f64::from(y));
    [1.0 + x + 0.5 * y, 2.0 + 0.25 * x + y, 0.5 + 0.125 * x * y]
}

fn check(texture: &TextureData, channels: usize, want: impl Fn(u32, u32) -> Vec<f64>) {
    assert_eq!((texture.width, texture.height, texture.file_channels), (8, 6, channels));
    for (x, y) in (0..6).flat_map(|y| (0..8).map(move |x| (x, y))) {
        let have: Vec<f64> = (0..channels).map(|c| texture.value(x, y, c)).collect();
        assert_eq!(have, want(x, y), "({x}, {y})");
    }
}

fn scaled(factor: f64) -> impl Fn(u32, u32) -> Vec<f64> {
    move |x, y| written(x, y).map(|v| factor * v).to_vec()
}

#[test]
fn positions_and_directions_are_read_as_red_green_blue() {
    let xyz = read(include_bytes!("exr/xyz.exr"), None).unwrap();
    check(&xyz, 3, |x, y| {
        let [r, g, b] = written(x, y);
        vec![r, g, -b]
    });
}

#[test]
fn half_float_and_integer_channels_stand_beside_each_other() {
    let mixed = read(include_bytes!("exr/mix.exr"), None).unwrap();
    check(&mixed, 3, |x, y| vec![written(x, y)[0], written(x, y)[1], f64::from(x + 10 * y)]);
}

#[test]
fn layers_are_chosen_by_name_and_else_the_one_without() {
    check(&read(LAYERS, None).unwrap(), 3, scaled(1.0));
    check(&read(LAYERS, Some("diffuse")).unwrap(), 3, scaled(10.0));
    check(&read(LAYERS, Some("depth")).unwrap(), 1, |x, y| vec![100.0 + written(x, y)[0]]);
    check(&read(LAYERS, Some("id")).unwrap(), 1, |x, y| vec![f64::from(x + 10 * y)]);
    check(&read(LAYERS, Some("diffuse.G")).unwrap(), 1, |x, y| vec![10.0 * written(x, y)[1]]);
    check(&read(NAMED, Some("spec")).unwrap(), 3, scaled(1.0));
}

#[test]
fn parts_are_chosen_by_name() {
    check(&read(PARTS, Some("left")).unwrap(), 3, scaled(1.0));
    check(&read(PARTS, Some("right")).unwrap(), 3, scaled(2.0));
    check(&read(PARTS, Some("right.B")).unwrap(), 1, |x, y| vec![2.0 * written(x, y)[2]]);
    check(&read(PARTS, Some("depth")).unwrap(), 1, |x, y| vec![7.0 * written(x, y)[0]]);
}

#[test]
fn what_cannot_be_chosen_is_listed() {
    for (file, layer, wanted) in [
        (NAMED, None, &["several layers", "\"diffuse\" (B, G, R)", "\"spec\" (B, G, R)", "layer = "][..]),
        (PARTS, None, &["several layers", "\"left\"", "\"right\"", "\"depth\" (Z)"]),
        (
            LAYERS,
            Some("difuse"),
            &["no layer is named \"difuse\"; did you mean \"diffuse\"?", "\"depth\" (Z)"],
        ),
        (PARTS, Some("G"), &["\"G\" may mean each of left.G, right.G"]),
        (LAYERS, Some("Z"), &["no layer is named \"Z\"", "without a name (B, G, R, id)"]),
    ] {
        let message = told(read(file, layer));
        for word in wanted {
            assert!(message.contains(word), "{layer:?}: {message}");
        }
        assert!(message.contains("a.exr") && message.contains("texture \"t\""), "{message}");
    }
}

#[test]
fn channels_that_are_no_colours_together_are_refused() {
    use exr::prelude::*;
    let folder = tempdir().unwrap();
    let path = folder.path().join("motion.exr");
    let channels = SpecificChannels::build().with_channel("v.X").with_channel("v.Y");
    let channels = channels.with_pixel_fn(|at: Vec2<usize>| (at.0 as f32, at.1 as f32));
    Image::from_channels((8, 6), channels).write().to_file(&path).unwrap();
    let message = told(read_path(&path, None));
    assert!(message.contains("v.X, v.Y") && message.contains("layer ="), "{message}");
    let message = told(read_path(&path, Some("v")));
    assert!(message.contains("\"v\" (X, Y) are no colours"), "{message}");
    check(&read_path(&path, Some("v.Y")).unwrap(), 1, |_, y| vec![f64::from(y)]);
}

#[test]
fn only_open_exr_files_have_layers() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    image::GrayImage::new(2, 2).save(&path).unwrap();
    let message = told(read_path(&path, Some("diffuse")));
    assert!(message.contains("\"diffuse\"") && message.contains("PNG"), "{message}");
}

/// Y = (1 + x + y)⁄4; RY and BY at every second texel, (x − y)⁄16 and (x + y)⁄32, between them linear.
fn from_chroma(x: u32, y: u32) -> [f64; 3] {
    let weights = [0.2126, 0.7152, 0.0722]; // ITU-R BT.709-6, 3.2
    let luminance = 0.25 * f64::from(1 + x + y);
    let (x, y) = (f64::from(x.min(6)), f64::from(y.min(4)));
    let (r, b) = (luminance * (1.0 + (x - y) / 16.0), luminance * (1.0 + (x + y) / 32.0));
    [r, (luminance - weights[0] * r - weights[2] * b) / weights[1], b]
}

#[test]
fn luminance_and_sparse_chroma_become_red_green_blue() {
    for (name, file) in [
        ("zips", &include_bytes!("exr/yc-zips.exr")[..]),
        ("piz", include_bytes!("exr/yc-piz.exr")),
        ("pxr24", include_bytes!("exr/yc-pxr24.exr")),
    ] {
        let texture = read(file, None).unwrap();
        assert_eq!((texture.width, texture.height, texture.file_channels), (8, 6, 3), "{name}");
        for (x, y) in (0..6).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let want = from_chroma(x, y);
            let have = [0, 1, 2].map(|c| texture.value(x, y, c));
            let error = have.iter().zip(want).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 2e-4, "{name} ({x}, {y}): {have:?}, by hand {want:?}"); // four digits of the weights
        }
    }
}

#[test]
fn sparse_chroma_in_b44_is_refused_by_name() {
    let message = told(read(include_bytes!("exr/yc-b44.exr"), None));
    assert!(message.contains("subsampling") && message.contains("b44"), "{message}");
    assert!(message.contains("a.exr") && message.contains("ZIP"), "{message}");
}

#[test]
fn sparse_chroma_lies_where_the_data_window_does() {
    let texture = read(include_bytes!("exr/yc-moved.exr"), None).unwrap();
    assert_eq!((texture.width, texture.height, texture.file_channels), (8, 6, 4));
    assert_eq!(texture.linear_rgba(1, 0), [0.0; 4], "left of the data window");
    assert_eq!(texture.linear_rgba(2, 4), [0.0; 4], "below it");
    let [r, _, b, alpha] = texture.linear_rgba(5, 1);
    let [want_r, _, want_b] = from_chroma(3, 3);
    assert!((r - want_r).abs() + (b - want_b).abs() < 1e-6, "{r} {b}"); // roundings of half floats
    assert_eq!(alpha, 0.375);
}

#[test]
fn damaged_chroma_never_panics() {
    let files = [
        &include_bytes!("exr/yc-piz.exr")[..],
        include_bytes!("exr/yc-pxr24.exr"),
        include_bytes!("exr/yc-moved.exr"),
    ];
    let mut state = 1u32;
    for whole in files.into_iter().cycle().take(900) {
        let mut bytes = whole.to_vec();
        for _ in 0..2 {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            let at = (state >> 8) as usize % bytes.len();
            bytes[at] = (state >> 3) as u8;
        }
        let _ = read(&bytes, None);
    }
}
