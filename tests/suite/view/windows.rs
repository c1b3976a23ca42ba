//! What the page draws of a texture around a pixel holds the whole footprint and shows means where the part is large.

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{Rgb, RgbImage};
use serde_json::Value;
use tempfile::tempdir;

use super::View;
use crate::stage::path;

const SIZE: [u32; 2] = [16, 12];

/// Returns what a page says of all pixels.
fn told(scene: &Path, arguments: &[&str]) -> Vec<Value> {
    let own = ["--size", "16x12", "--spp", "4", "--device", "oracle"];
    let view = View::of_file(scene, &[&own, arguments].concat());
    let mut tab = view.tab("t");
    let state = tab.done();
    assert!(state["sides"][0]["failure"].is_null(), "{state}");
    let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    places.map(|(x, y)| view.get(&format!("pixel?tab=t&side=a&x={x}&y={y}")).json()).collect()
}

fn pair(value: &Value) -> [f64; 2] {
    [0, 1].map(|axis| value[axis].as_f64().unwrap_or_else(|| panic!("no pair: {value}")))
}

/// Returns the ends of the parallelogram from its centre to each axis, as the larger of both: its box.
fn reach(window: &Value) -> [f64; 2] {
    let axes = [0, 1].map(|axis| pair(&window["axes"][axis]));
    [0, 1].map(|c| 0.5 * (axes[0][c].abs() + axes[1][c].abs()))
}

/// Checks all windows of pixels; returns the widest footprint, in texels.
fn check(pixels: &[Value], what: &str) -> f64 {
    let mut widest = 0.0f64;
    let mut count = 0;
    for window in pixels.iter().flat_map(|own| own["look_ups"].as_array().unwrap()) {
        let seen = &window["window"];
        let side = seen["side"].as_f64().unwrap();
        let (centre, reach) = (pair(&seen["centre"]), reach(seen));
        for c in 0..2 {
            // A quarter of the footprint is the margin, and there is no empty page around a small one.
            assert!(
                centre[c] - 1.2 * reach[c] >= 0.0 && centre[c] + 1.2 * reach[c] <= side,
                "{what}: {window:.900}"
            );
        }
        assert!(side <= 96.0, "{what}: {window:.900}");
        let samples = seen["samples"].as_array().unwrap();
        for at in samples.iter().map(pair) {
            assert!(at.iter().all(|own| (0.0..=side).contains(own)), "{what}: {window:.900}");
        }
        count += samples.len();
        widest = widest.max(window["texels"][0].as_f64().unwrap_or_default());
    }
    assert!(count > 100, "{what}: {count} look-ups of samples are marked");
    widest
}

#[test]
fn windows_hold_whole_footprints_of_every_kind_of_texture() {
    let floor = path("start/floor");
    let wide = check(&told(&floor, &["--mip", "none", "--filter", "nearest"]), "photo without levels");
    assert!(wide > 500.0, "{wide}");
    check(&told(&floor, &["--mip", "linear", "--filter", "linear"]), "photo with levels");
    for name in ["horizon", "lecture", "environment", "environment_cube", "volume", "procedural"] {
        check(&told(&path(name), &["--mip", "none", "--filter", "nearest"]), name);
    }
}

#[test]
fn a_wide_window_shows_means_of_the_texture_and_says_so() {
    let folder = tempdir().unwrap();
    // Sides that are no powers of two, and columns of black and white, whose mean is half the light.
    let save = |name: &str, width: u32| {
        let stripes = RgbImage::from_fn(width, 77, |x, _| Rgb([if x % 2 == 0 { 255 } else { 0 }; 3]));
        stripes.save(folder.path().join(name)).unwrap();
    };
    save("t.png", 300);
    save("u.1001.png", 150);
    save("u.1002.png", 150);
    let scene = folder.path().join("scene.toml");
    let text = "[camera]\neye = [0, 0, 3]\nlook_at = [0, 0, 0]\northographic_height = 40.0\n\
                [image]\nwidth = 16\nheight = 12\n[sampling]\npattern = 'grid'\n\
                [[texture]]\nname = 't'\nfile = 't.png'\ncolor_space = 'srgb'\n\
                [[sampler]]\nname = 's'\nfilter = 'nearest'\n\
                [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n\
                [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n";
    fs::write(&scene, text).unwrap();
    let mut pixels = told(&scene, &[]);
    let of_one = pixels.len();
    fs::write(&scene, text.replace("t.png", "u.<UDIM>.png")).unwrap();
    pixels.extend(told(&scene, &[]));
    check(&pixels, "stripes");
    for (index, own) in pixels.iter().enumerate() {
        let look_up = &own["look_ups"][0];
        let window = &look_up["window"];
        let mean = pair(&window["mean"]);
        assert!(mean.iter().all(|side| *side >= 8.0), "{window:.300}");
        assert_eq!((window["level"].as_u64(), window["read"].as_u64()), (Some(0), Some(0)));
        // The footprint of a pixel is 40 / 12 tiles wide.
        let drawn = [0, 1].map(|c| 2.0 * reach(window)[c] * mean[c]);
        let size = [if index < of_one { 300.0 } else { 150.0 }, 77.0];
        assert!((0..2).all(|c| (drawn[c] / (40.0 / 12.0 * size[c]) - 1.0).abs() < 1e-3), "{drawn:?}");
        let png = STANDARD.decode(window["png"].as_str().unwrap()).unwrap();
        let shown = image::load_from_memory(&png).unwrap().to_rgb8();
        // Half the light is the code 188 of sRGB.
        for pixel in shown.pixels() {
            assert!(pixel.0.iter().all(|code| code.abs_diff(188) <= 6), "{pixel:?} of {window:.300}");
        }
        // A grid of four samples lies about the centre.
        let samples: Vec<[f64; 2]> = window["samples"].as_array().unwrap().iter().map(pair).collect();
        let centre = pair(&window["centre"]);
        let middle = [0, 1].map(|c| samples.iter().map(|at| at[c]).sum::<f64>() / 4.0);
        assert_eq!(samples.len(), 4);
        assert!((0..2).all(|c| (middle[c] - centre[c]).abs() < 1e-3), "{middle:?}, {centre:?}");
        for at in samples {
            let reach = reach(window);
            assert!((0..2).all(|c| ((at[c] - centre[c]).abs() / reach[c] - 0.5).abs() < 1e-3), "{at:?}");
        }
    }
}
