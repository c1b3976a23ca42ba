//! `moire texture`: its statistics, its verdicts on seams, planted ones included, and the repeated
//! picture. Expected numbers are computed by hand or from the files' known content.

use std::path::{Path, PathBuf};

use image::{ColorType, DynamicImage, ImageBuffer, Luma, Rgb, Rgb32FImage, RgbImage};
use moire::internal::texture::analysis::{Analysis, Seam, analyse};
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};
use serde_json::{Value, json};
use tempfile::tempdir;

use crate::support::{data, moire};

/// Grey float texels, rows first.
fn grey(width: u32, height: u32, texel: impl Fn(u32, u32) -> f32) -> Analysis {
    let values = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    analyse(&TextureData {
        name: "planted".into(),
        dimension: Dimension::Two,
        width,
        height,
        depth: 1,
        format: TexelFormat::GreyFloat,
        color_space: ColorSpace::Linear,
        file_channels: 1,
        texels: values.flat_map(|(x, y)| texel(x, y).to_ne_bytes()).collect(),
        stored_levels: Vec::new(),
    })
}

fn wave(i: u32, period: f64, phase: f64) -> f32 {
    (std::f64::consts::TAU * (f64::from(i) + phase) / period).sin() as f32
}

fn texture(name: &str) -> PathBuf {
    data().join("textures").join(name)
}

fn run(file: &Path, options: &[&str]) -> std::process::Output {
    moire().arg("texture").arg(file).args(options).output().unwrap()
}

fn report(file: &Path, options: &[&str]) -> Value {
    let output = run(file, &[&["--json"], options].concat());
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*told), (Some(0), ""));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn tiles(file: &Path) -> [Value; 2] {
    let told = report(file, &[]);
    ["u", "v"].map(|axis| told["tiling"][axis]["tiles"].clone())
}

/// The bundled picture with its columns and rows changed by `change`.
fn changed(name: &str, change: impl Fn(&RgbImage) -> RgbImage) -> [Value; 2] {
    let folder = tempdir().unwrap();
    let path = folder.path().join("changed.png");
    change(&image::open(texture(name)).unwrap().to_rgb8()).save(&path).unwrap();
    tiles(&path)
}

#[test]
fn bundled_textures_tile_or_not_as_they_were_made() {
    for name in ["grass.png", "tiles.png", "bench/noise.png", "bench/checker.png"] {
        assert_eq!(tiles(&texture(name)), [json!(true), json!(true)], "{name}");
    }
    // One border of the poster is almost uniform: "perhaps" is allowed, "yes" is not.
    let [u, v] = tiles(&texture("poster.png"));
    assert_eq!(u, json!(false));
    assert_ne!(v, json!(true));
}

#[test]
fn one_lost_column_or_row_of_a_tileable_texture_is_found_on_its_axis_only() {
    let column = |p: &RgbImage| image::imageops::crop_imm(p, 0, 0, p.width() - 1, p.height()).to_image();
    let row = |p: &RgbImage| image::imageops::crop_imm(p, 0, 0, p.width(), p.height() - 1).to_image();
    assert_eq!(changed("tiles.png", column), [json!(false), json!(true)]);
    assert_eq!(changed("tiles.png", row), [json!(true), json!(false)]);
}

#[test]
fn one_column_shifted_along_itself_is_found_on_its_axis_only() {
    let shifted = |p: &RgbImage| {
        let (last, height) = (p.width() - 1, p.height());
        RgbImage::from_fn(p.width(), height, |x, y| {
            *p.get_pixel(x, if x == last { (y + 16) % height } else { y })
        })
    };
    assert_eq!(changed("tiles.png", shifted), [json!(false), json!(true)]);
    let turned = |p: &RgbImage| image::imageops::rotate90(&shifted(&image::imageops::rotate270(p)));
    assert_eq!(changed("tiles.png", turned), [json!(true), json!(false)]);
}

#[test]
fn a_texture_may_tile_along_one_axis_only() {
    for phase in [0.0, 0.3, 4.0, 8.0] {
        let along_u = grey(32, 24, |x, y| wave(x, 32.0, phase) + y as f32);
        let tiles = [&along_u.u, &along_u.v].map(|axis| axis.seam.tiles());
        assert_eq!(tiles, [Some(true), Some(false)], "phase {phase}");
        let along_v = grey(24, 32, |x, y| wave(y, 32.0, phase) + x as f32);
        let tiles = [&along_v.u, &along_v.v].map(|axis| axis.seam.tiles());
        assert_eq!(tiles, [Some(false), Some(true)], "phase {phase}");
    }
}

#[test]
fn the_ratio_of_a_ramp_is_its_number_of_steps() {
    let ramp = grey(9, 2, |x, _| x as f32 * 0.5);
    assert_eq!((ramp.u.seam_rms, ramp.u.interior_rms, ramp.u.ratio), (Some(4.0), Some(0.5), Some(8.0)));
    let rank = ramp.u.rank.unwrap();
    assert_eq!((rank.share, ramp.u.seam), (1.0, Seam::Visible));
    // Floats are weighed by asinh(v / m), m = 2.5 the middle of 0.5 to 4: the first step is the largest.
    let largest = (0.5f64 / 2.5).asinh();
    assert!((rank.of_largest.unwrap() - (4.0f64 / 2.5).asinh() / largest).abs() < 1e-12, "{rank:?}");
    assert_eq!((ramp.v.seam_rms, ramp.v.interior_rms, ramp.v.ratio), (Some(0.0), Some(0.0), None));
    assert_eq!(ramp.v.seam, Seam::Constant);
}

#[test]
fn hard_edges_that_recur_inside_are_a_pattern_and_others_are_not() {
    let checker = grey(32, 32, |x, y| ((x / 8 + y / 8) % 2) as f32);
    assert_eq!((checker.u.seam, checker.u.recurrence), (Seam::Pattern, Some(0.0)));
    let joint = grey(64, 32, |x, _| if x == 63 { 1.0 } else { 0.01 * (x % 2) as f32 });
    assert_eq!(joint.u.seam, Seam::Pattern, "a line drawn along the border has its other edge inside");
    let odd = grey(40, 32, |x, y| if x < 32 { 0.0 } else { (y % 3) as f32 * (x - 31) as f32 });
    assert_eq!(odd.u.seam, Seam::Visible);
}

#[test]
fn a_last_column_that_repeats_the_first_is_told() {
    let doubled = grey(33, 4, |x, _| wave(x % 32, 32.0, 0.0));
    assert_eq!((doubled.u.seam, doubled.u.seam.tiles()), (Seam::Doubled, Some(true)));
    let flat_border = grey(33, 4, |x, _| if x % 32 < 2 { 0.5 } else { wave(x, 7.0, 0.2) });
    assert_ne!(flat_border.u.seam, Seam::Doubled, "{:?}", flat_border.u);
}

#[test]
fn an_axis_of_one_texel_tiles_and_has_no_steps() {
    let one = grey(1, 1, |_, _| 0.25);
    for axis in [&one.u, &one.v] {
        assert_eq!((axis.seam, axis.interior_rms, axis.ratio), (Seam::Constant, None, None));
        assert_eq!(axis.seam.tiles(), Some(true));
    }
    let column = grey(1, 16, |_, y| y as f32);
    assert_eq!((column.u.seam, column.v.seam), (Seam::Constant, Seam::Visible));
    let row = grey(16, 1, |x, _| x as f32);
    assert_eq!((row.u.seam, row.v.seam), (Seam::Visible, Seam::Constant));
    let pair = grey(2, 1, |x, _| x as f32);
    assert_eq!((pair.u.seam, pair.u.ratio), (Seam::Smooth, Some(1.0)), "both steps are the same pair");
}

#[test]
fn values_that_are_not_finite_are_counted_and_left_out_of_the_rest() {
    let planted = grey(4, 2, |x, y| match (x, y) {
        (2, 0) => f32::NAN,
        (1, 1) => f32::INFINITY,
        (3, 1) => f32::NEG_INFINITY,
        _ => (x + y) as f32,
    });
    let channel = &planted.channels[0];
    assert_eq!((channel.nan, channel.infinite), (1, 2));
    // Finite are 0, 1, 3 above and 1, 3 below.
    assert_eq!((channel.min, channel.max, channel.mean), (Some(0.0), Some(3.0), Some(8.0 / 5.0)));
    assert_eq!((planted.non_finite_texels, planted.first_non_finite), (3, Some([2, 0])));
    // The one pair across the seam in u is 3 → 0, the one inside 0 → 1.
    assert_eq!((planted.u.seam_rms, planted.u.interior_rms), (Some(3.0), Some(1.0)));
    let none = grey(3, 3, |_, _| f32::NAN);
    let channel = &none.channels[0];
    assert_eq!((channel.min, channel.max, channel.mean), (None, None, None));
    assert_eq!((none.u.seam, none.u.seam.tiles(), none.non_finite_texels), (Seam::Unknown, None, 9));
}

#[test]
fn a_float_file_with_nan_is_described_not_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("nan.exr");
    let mut picture = Rgb32FImage::from_pixel(3, 2, Rgb([1.0, 2.0, -4.0]));
    picture.put_pixel(1, 1, Rgb([f32::NAN, f32::INFINITY, 5.0]));
    DynamicImage::from(picture).save(&path).unwrap();
    let told = report(&path, &[]);
    assert_eq!((&told["non_finite_texels"], &told["first_non_finite"]), (&json!(1), &json!([1, 1])));
    let channel = |i: usize| &told["channels"][i];
    assert_eq!((&channel(0)["nan"], &channel(1)["infinite"]), (&json!(1), &json!(1)));
    assert_eq!((&channel(2)["min"], &channel(2)["max"]), (&json!(-4.0), &json!(5.0)));
    assert_eq!(channel(2)["mean"], json!(-2.5));
    let text = String::from_utf8(run(&path, &[]).stdout).unwrap();
    assert!(text.contains("non-finite  1, first (1, 1)") && text.contains("1 NaN, 0 infinite"), "{text}");
}

#[test]
fn range_and_mean_follow_the_color_space_but_alpha_does_not() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("two.png");
    let texels = [255, 0, 51, 51, 0, 0, 51, 153];
    image::save_buffer(&path, &texels, 2, 1, ColorType::Rgba8).unwrap();
    let stored = report(&path, &[]);
    assert_eq!(
        stored["channels"][0],
        json!({"name": "red", "min": 0.0, "max": 1.0, "mean": 0.5, "nan": 0, "infinite": 0})
    );
    assert_eq!((&stored["channels"][2]["min"], &stored["channels"][3]["max"]), (&json!(0.2), &json!(0.6)));
    let linear = report(&path, &["--color-space", "srgb"]);
    // IEC 61966-2-1: ((0.2 + 0.055) / 1.055)^2.4.
    let blue = linear["channels"][2]["mean"].as_f64().unwrap();
    assert!((blue - 0.033_104_766_570_885_055).abs() < 1e-15, "{blue}");
    assert_eq!(linear["channels"][3], stored["channels"][3]);
    assert_eq!(linear["tiling"], stored["tiling"], "seams are measured on stored values");
}

#[test]
fn json_is_one_object_with_the_documented_fields() {
    let told = report(&texture("grey-alpha16.png"), &[]);
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let fields = [
        "bytes",
        "channels",
        "color_profile",
        "color_space",
        "depth",
        "dimension",
        "encoding",
        "file",
        "file_channels",
        "first_non_finite",
        "format",
        "levels",
        "non_finite_texels",
        "normals",
        "out",
        "size",
        "stated_color_space",
        "tiling",
    ];
    assert_eq!(keys(&told), fields);
    assert_eq!((&told["format"], &told["file_channels"]), (&json!("grey-alpha16"), &json!(2)));
    assert_eq!(keys(&told["channels"][1]), ["infinite", "max", "mean", "min", "name", "nan"]);
    let axis = [
        "interior_rms",
        "misfit",
        "of_largest",
        "period",
        "rank",
        "ratio",
        "recurrence",
        "seam",
        "seam_rms",
        "tiles",
        "verdict",
    ];
    assert_eq!(keys(&told["tiling"]["u"]), axis);
    let three = report(&texture("tiles.png"), &[]);
    assert_eq!((&three["format"], &three["file_channels"]), (&json!("rgba8"), &json!(3)));
    assert_eq!(three["channels"].as_array().unwrap().len(), 3, "the added alpha is not the file's");
    assert_eq!(three["size"], json!([256, 256]));
}

#[test]
fn the_repeated_picture_has_the_values_of_the_file_four_times() {
    let folder = tempdir().unwrap();
    let (file, out) = (folder.path().join("all.png"), folder.path().join("twice.png"));
    let all = RgbImage::from_fn(16, 16, |x, y| {
        let v = (y * 16 + x) as u8;
        Rgb([v, 255 - v, v.wrapping_mul(7)])
    });
    all.save(&file).unwrap();
    for space in ["linear", "srgb"] {
        let told = report(&file, &["--color-space", space, "--out", out.to_str().unwrap()]);
        assert_eq!(told["out"], json!(out.to_str().unwrap()));
        let twice = image::open(&out).unwrap();
        assert_eq!(twice, RgbImage::from_fn(32, 32, |x, y| *all.get_pixel(x % 16, y % 16)).into());
    }
}

#[test]
fn the_repeated_picture_keeps_16_bits_and_floats() {
    let folder = tempdir().unwrap();
    let (file, out) = (folder.path().join("all.png"), folder.path().join("twice.png"));
    let all = ImageBuffer::from_fn(256, 256, |x, y| Luma([(y * 256 + x) as u16]));
    DynamicImage::from(all).save(&file).unwrap();
    report(&file, &["-o", out.to_str().unwrap()]);
    let DynamicImage::ImageRgb16(twice) = image::open(&out).unwrap() else { panic!("not 16 bits") };
    assert_eq!(twice.dimensions(), (512, 512));
    for (x, y, pixel) in twice.enumerate_pixels() {
        assert_eq!(pixel.0, [(y % 256 * 256 + x % 256) as u16; 3], "at ({x}, {y})");
    }
    let out = folder.path().join("twice.exr");
    report(&texture("ramp.exr"), &["-o", out.to_str().unwrap()]);
    let (once, twice) = (image::open(texture("ramp.exr")).unwrap(), image::open(&out).unwrap());
    let (once, twice) = (once.to_rgb32f(), twice.to_rgb32f());
    assert_eq!(twice.dimensions(), (2 * once.width(), 2 * once.height()));
    for (x, y, pixel) in twice.enumerate_pixels() {
        assert_eq!(pixel, once.get_pixel(x % once.width(), y % once.height()), "at ({x}, {y})");
    }
}

#[test]
fn what_cannot_be_read_or_written_is_exit_2_and_nothing_is_written() {
    let folder = tempdir().unwrap();
    let cut = folder.path().join("cut.png");
    let whole = std::fs::read(texture("tiles.png")).unwrap();
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let out = folder.path().join("out.png");
    let out = out.to_str().unwrap();
    let cases: &[(PathBuf, &[&str], &str)] = &[
        (texture("tile.png"), &["-o", out], "did you mean"),
        (cut, &["-o", out], "damaged or truncated"),
        (texture("ramp.exr"), &["-o", out, "--color-space", "srgb"], "float texels are linear"),
        (texture("tiles.png"), &["-o", "out.bmp"], ".bmp is unknown"),
        (texture("tiles.png"), &["-o", out, "--color-space", "sRGB"], "possible values: linear, srgb"),
    ];
    for (file, options, expected) in cases {
        let output = run(file, options);
        let told = String::from_utf8_lossy(&output.stderr).replace("\n  │ ", " ");
        assert_eq!(output.status.code(), Some(2), "{file:?}: {told}");
        assert!(told.contains(expected), "{expected:?} not in: {told}");
        assert!(output.stdout.is_empty() && !Path::new(out).exists(), "{file:?}");
    }
}

#[test]
fn the_repeated_picture_does_not_replace_the_texture() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("t.png");
    std::fs::copy(texture("tiles.png"), &file).unwrap();
    let before = std::fs::read(&file).unwrap();
    let output = moire().arg("texture").arg(&file).arg("--out").arg(&file).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("t.png") && told.contains("choose another name"), "{told}");
    assert_eq!(std::fs::read(&file).unwrap(), before);
}
