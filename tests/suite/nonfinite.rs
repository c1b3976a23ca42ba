//! Textures with NaN or infinite texels: refused with a message that locates them, or allowed,
//! confined to the pixels that read them, and counted; and how file formats store such pixels.

mod look_ups;

use std::fs;
use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::read_picture;
use moire::internal::output::{Format, WriteOptions, to_bytes, write};
use moire::internal::texture::data::{ColorSpace, Dimension, MipKernel, TexelFormat, TextureData};
use moire::internal::texture::mips;
use serde_json::Value;
use tempfile::TempDir;

use crate::stage::device_name;
use crate::support::{gradient, moire};

const SCENE: &str = "
camera = { eye = [0, 3, 0.1], look_at = [0, 0, 0], vertical_fov = 50 }
image = { width = 40, height = 40 }
sampling = { spp = 1, pattern = 'center' }
[[texture]]
name = 'measured'
file = 'measured.exr'
[[sampler]]
name = 's'
filter = 'nearest'
address = 'clamp-to-edge'
[[material]]
name = 'm'
model = 'unlit'
texture = 'measured'
sampler = 's'
mapping = { kind = 'surface', scale = [0.5, 0.5], offset = [0.5, 0.5] }
[[plane]]
origin = [0, 0, 0]
tangent = [1, 0, 0]
bitangent = [0, 0, 1]
half_extent = 1
material = 'm'
";

/// Texels (5, 3) and (6, 3) of 8 × 8 are NaN and infinite.
fn measured(nan: f32, infinity: f32) -> Film {
    let mut film = gradient(8, 8);
    film.pixels[3 * 8 + 5][1] = nan;
    film.pixels[3 * 8 + 6] = [infinity, 0.5, 0.5];
    film
}

fn folder(scene: &str, texture: &Film) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    write(texture, &folder.path().join("measured.exr"), &WriteOptions::default()).unwrap();
    folder
}

/// Returns exit code, report and messages.
fn run(folder: &TempDir, options: &[&str]) -> (Option<i32>, Value, String) {
    let device = ["--device".to_string(), device_name()];
    let device = if options.contains(&"--device") { &[][..] } else { &device[..] };
    let fixed = ["render", "scene.toml", "-o", "out.exr", "--json"];
    let output = moire().current_dir(folder.path()).args(fixed).args(device).args(options).output().unwrap();
    let report = serde_json::from_slice(&output.stdout).unwrap_or(Value::Null);
    (output.status.code(), report, String::from_utf8(output.stderr).unwrap())
}

fn picture(folder: &TempDir) -> Film {
    read_picture(&folder.path().join("out.exr")).unwrap()
}

fn finite(pixel: &[f32; 3]) -> bool {
    pixel.iter().all(|v| v.is_finite())
}

#[test]
fn a_texture_with_nan_is_refused_with_its_place_and_the_way_round() {
    let folder = folder(SCENE, &measured(f32::NAN, f32::INFINITY));
    let (code, report, said) = run(&folder, &[]);
    assert_eq!((code, report), (Some(2), Value::Null));
    let said = said.replace(|c: char| c.is_whitespace() || c == '│', "");
    for part in [
        "\"measured\"",
        "measured.exr",
        "texel(5,3)",
        "channelgreen",
        "NaN",
        "2valuesofthefile",
        "--allow-nonfinite",
    ] {
        assert!(said.contains(part), "{part} not in {said}");
    }
    assert!(!folder.path().join("out.exr").exists());
}

#[test]
fn nan_is_kept_to_the_pixels_that_show_it_and_they_are_counted() {
    let odd = folder(SCENE, &measured(f32::NAN, f32::INFINITY));
    let plain = folder(SCENE, &measured(0.3, 0.3));
    for options in [&[][..], &["--device", "oracle"], &["--keep-everything"], &["--texels", "image"]] {
        let (code, report, said) = run(&odd, &[options, &["--allow-nonfinite", "-v"]].concat());
        assert_eq!(code, Some(0), "{said}");
        assert_eq!(run(&plain, options).0, Some(0));
        let (with, without) = (picture(&odd), picture(&plain));
        let spoilt = with.pixels.iter().filter(|p| !finite(p)).count();
        // Two of 64 texels, on a plane that covers some three fifths of the picture.
        assert!((20..50).contains(&spoilt), "{options:?}: {spoilt} pixels");
        assert_eq!(report["nonfinite"]["pixels"], spoilt);
        assert_eq!(report["nonfinite"]["texels"]["measured"], 2);
        assert!(said.contains("2 texels not finite"), "{said}");
        assert!(said.contains(&format!("{spoilt} pixels are not finite")), "{said}");
        let others = with.pixels.iter().zip(&without.pixels).filter(|(p, _)| finite(p));
        let changed = others.filter(|(p, q)| p.map(f32::to_bits) != q.map(f32::to_bits)).count();
        assert_eq!(changed, 0, "{options:?}: other pixels changed");
    }
    let (_, report, said) = run(&plain, &[]);
    assert!(report.get("nonfinite").is_none() && !said.contains("finite"), "{said}");
    let (_, report, _) = run(&plain, &["--allow-nonfinite"]);
    assert_eq!(report["nonfinite"], serde_json::json!({ "texels": { "measured": 0 }, "pixels": 0 }));
}

#[test]
fn what_one_such_texel_would_spoil_as_a_whole_is_refused_with_what_to_use() {
    let texture = measured(f32::NAN, 1.0);
    let filtered = SCENE.replace("spp = 1", "spp = 1, footprint = 'cone'");
    let kaiser = filtered
        .replace("file = 'measured.exr'", "file = 'measured.exr'\nmip_filter = 'kaiser'")
        .replace("filter = 'nearest'", "filter = 'linear'\nmip = 'linear'");
    for (scene, options, wanted) in [
        (SCENE, &["--algorithm", "beam"][..], ["beam", "adaptive"]),
        (&filtered, &["--filter", "summed-area"], ["summed-area", "ewa"]),
        (SCENE, &["--method", "hardware"], ["hardware", "--method shader"]),
        (&kaiser, &[], ["kaiser", "mip_filter = \"box\""]),
    ] {
        let folder = folder(scene, &texture);
        let (code, _, said) = run(&folder, &[options, &["--allow-nonfinite"]].concat());
        assert_eq!(code, Some(2), "{options:?}: {said}");
        let said = said.replace(|c: char| c.is_whitespace() || c == '│', "");
        for part in wanted.into_iter().chain(["\"measured\"", "1 texel is not finite"]) {
            assert!(said.contains(&part.replace(' ', "")), "{part} not in {said}");
        }
        assert!(!folder.path().join("out.exr").exists());
    }
}

/// Of a lit surface with a mirror on it.
const LIT: &str = "
[[light]]
kind = 'point'
position = [1, 3, 1]
intensity = [30, 30, 30]
[[material]]
name = 'ball'
model = 'mirror'
[[sphere]]
center = [0, 0.3, 0]
radius = 0.3
material = 'ball'
";

/// A texture with one different texel changes the pixels that show it: these are NaN, and no others.
#[test]
fn lit_and_mirrored_texels_that_are_no_numbers_are_seen_by_samples_and_by_cones() {
    let scene = format!("{}{LIT}", SCENE.replace("model = 'unlit'", "model = 'lambert'"));
    let folders =
        [[f32::NAN, 0.5], [0.7, 0.5], [0.2, 0.5]].map(|[nan, other]| folder(&scene, &measured(nan, other)));
    for options in
        [&["--algorithm", "cone"][..], &["--filter", "linear"], &["--footprint", "cone", "--filter", "ewa"]]
    {
        for device in [device_name().as_str(), "oracle"] {
            let options = [options, &["--device", device, "--allow-nonfinite"]].concat();
            let films = folders.each_ref().map(|folder| {
                let (code, _, said) = run(folder, &options);
                assert_eq!(code, Some(0), "{said}");
                picture(folder)
            });
            let pixels = || films[0].pixels.iter().zip(&films[1].pixels).zip(&films[2].pixels);
            let leaks = pixels().filter(|((nan, a), b)| !finite(nan) && a == b).count();
            let spoilt = pixels().filter(|((nan, _), _)| !finite(nan)).count();
            // In a small reflection the texel is part of coarser ones, which are means over the others.
            let means = pixels().filter(|((nan, a), b)| finite(nan) && a != b).count();
            assert_eq!(leaks, 0, "{options:?}: of {spoilt}");
            assert!(spoilt > 8 && means < spoilt, "{options:?}: {spoilt} spoilt, {means} changed");
        }
    }
}

#[test]
fn negative_texels_are_as_far_below_0_as_positive_ones_are_above() {
    let scene = format!("{}{LIT}", SCENE.replace("model = 'unlit'", "model = 'lambert'"));
    let positive = measured(0.25, 0.5);
    let mut negative = positive.clone();
    negative.pixels.iter_mut().flatten().for_each(|v| *v = -*v);
    let folders = [folder(&scene, &positive), folder(&scene, &negative)];
    for options in [
        &["--algorithm", "cone"][..],
        &["--algorithm", "beam"],
        &["--footprint", "cone", "--filter", "ewa"],
        &[],
    ] {
        let films = folders.each_ref().map(|folder| {
            let (code, _, said) = run(folder, options);
            assert_eq!(code, Some(0), "{said}");
            picture(folder)
        });
        assert!(films[0].pixels.iter().flatten().any(|v| *v > 0.1), "a black picture");
        for (a, b) in films[0].pixels.iter().flatten().zip(films[1].pixels.iter().flatten()) {
            // Beams store texels in steps of 2^-16 of their range, times light of up to 10.
            assert!((a + b).abs() <= 2e-4 * a.abs().max(1.0), "{options:?}: {a} and {b}");
        }
    }
}

/// Pixels that are NaN or infinite have no error that samples could lower.
#[test]
fn sampling_to_a_goal_ends_beside_pixels_that_are_no_numbers() {
    let folder = folder(&SCENE.replace("nearest", "linear"), &measured(f32::NAN, f32::INFINITY));
    for options in [
        &["--algorithm", "adaptive", "--pattern", "sobol-owen", "--spp", "32"][..],
        &["--target-error", "0.01"],
        &["--budget", "0.5"],
        &["--target-error", "0.01", "--footprint", "cone"],
    ] {
        let (code, report, said) = run(&folder, &[options, &["--allow-nonfinite"]].concat());
        assert_eq!(code, Some(0), "{options:?}: {said}");
        let reached = &report["reached"];
        assert!(reached["estimated_rmse"].as_f64().is_some_and(f64::is_finite), "{options:?}: {reached}");
        // A picture without noise takes fewer samples than the time allows.
        let timed = options.contains(&"--budget");
        assert!(timed || reached["reached"] == true, "{options:?}: {reached}");
        let spoilt = picture(&folder).pixels.iter().filter(|p| !finite(p)).count();
        assert!((20..200).contains(&spoilt), "{options:?}: {spoilt} pixels");
    }
}

fn texture(format: TexelFormat, [width, height]: [u32; 2], texels: &[f32]) -> TextureData {
    TextureData {
        name: "t".into(),
        dimension: Dimension::Two,
        width,
        height,
        depth: 1,
        format,
        color_space: ColorSpace::Linear,
        file_channels: format.channels(),
        texels: bytemuck::cast_slice(texels).to_vec(),
        stored_levels: Vec::new(),
    }
}

#[test]
fn a_level_is_the_mean_of_the_texels_that_are_numbers() {
    let nan = f32::NAN;
    let grey = texture(TexelFormat::GreyFloat, [4, 2], &[1.0, nan, nan, nan, 3.0, 5.0, f32::INFINITY, nan]);
    assert_eq!(grey.nonfinite_texels(), 5);
    let levels = mips::mip_chain_of_finite(&grey);
    assert_eq!((levels[0].value(0, 0, 0), levels[1].value(0, 0, 0)), (3.0, 3.0));
    assert!(levels[0].value(1, 0, 0).is_nan(), "a mean of nothing");
    // A texel with one bad channel counts in no channel.
    let color = texture(
        TexelFormat::RgbaFloat,
        [2, 2],
        &[2.0, 1.0, 0.0, 0.25, 4.0, 1.0, 0.0, 0.75, 9.0, nan, 9.0, 1.0, 8.0, 8.0, 8.0, 0.0],
    );
    let level = &mips::mip_chain_of_finite(&color)[0];
    let expected = [14.0 / 3.0, 10.0 / 3.0, 8.0 / 3.0, 1.0 / 3.0];
    for (c, expected) in expected.into_iter().enumerate() {
        // A rounding of f32 each for sum, share and quotient.
        assert!((level.value(0, 0, c) - expected).abs() < 1e-6, "{c}: {}", level.value(0, 0, c));
    }
    // Without such texels it equals the ordinary mip chain.
    let plain =
        moire::internal::lab::verify::queries::texture(13, 6, TexelFormat::RgbaFloat, ColorSpace::Linear, 3);
    let usual = mips::mip_chain(&plain, MipKernel::Box);
    for (a, b) in mips::mip_chain_of_finite(&plain).iter().zip(&usual) {
        let values = |t: &TextureData| bytemuck::pod_collect_to_vec::<u8, f32>(&t.texels);
        for (a, b) in values(a).iter().zip(values(b)) {
            assert!((a - b).abs() <= 4.0 * f32::EPSILON * 8.0, "{a} and {b}"); // sums over shares of 1, up to 8
        }
    }
}

#[test]
fn files_hold_nan_as_black_and_infinity_as_their_largest_value() {
    let mut film = Film::new(16, 16, 1);
    film.pixels.fill([f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    let folder = tempfile::tempdir().unwrap();
    for (name, format, wanted, doubt) in [
        ("a.png", Format::Png, [0.0, 1.0, 0.0], 0.0),
        ("a.tif", Format::Tiff, [0.0, 1.0, 0.0], 0.0),
        // Compression blurs colours: two steps of 255.
        ("a.jpg", Format::Jpeg, [0.0, 1.0, 0.0], 0.008),
        ("a.hdr", Format::Hdr, [0.0, 255.0 / 256.0 * 127f32.exp2(), 0.0], 0.0),
    ] {
        fs::write(folder.path().join(name), to_bytes(&film, format).unwrap()).unwrap();
        let read = read_picture(&folder.path().join(name)).unwrap();
        for (value, wanted) in read.pixels[100].iter().zip(wanted) {
            assert!((value - wanted).abs() <= doubt, "{name}: {:?}", read.pixels[100]);
        }
    }
    let path = folder.path().join("a.exr");
    write(&film, &path, &WriteOptions::default()).unwrap();
    let [nan, high, low] = read_picture(Path::new(&path)).unwrap().pixels[0];
    assert!(nan.is_nan() && high == f32::INFINITY && low == f32::NEG_INFINITY);
}
