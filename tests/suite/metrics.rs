//! The comparison itself against planted errors of known size, and `moire compare` with its exit
//! codes.

use std::fs;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageBuffer, Luma, Rgb, Rgba};
use moire::internal::core::color::srgb_to_linear;
use moire::internal::core::film::Film;
use moire::internal::lab::metrics::{compare, difference_picture, read_picture};
use moire::internal::output::{WriteOptions, write};
use tempfile::{TempDir, tempdir};

use crate::support::{gradient, moire, told};

fn flat(value: [f32; 3]) -> Film {
    Film { width: 8, height: 4, pixels: vec![value; 32], samples: 1 }
}

#[test]
fn equal_pictures_have_no_error_and_infinite_psnr() {
    let c = compare(&gradient(8, 8), &gradient(8, 8)).unwrap();
    assert_eq!((c.rmse, c.mse, c.max, c.max_at, c.over_1_255, c.nan_pixels), (0.0, 0.0, 0.0, None, 0.0, 0));
    assert_eq!(c.psnr, f64::INFINITY);
    assert!(c.passes(Some(0.0)));
    assert!(serde_json::to_value(&c).unwrap()["psnr"].is_null());
}

#[test]
fn known_offset_gives_exactly_known_rmse_and_psnr() {
    // 0.125 in every channel, exact in f32: MSE 1/64, PSNR 10·log10(64).
    let c = compare(&flat([0.5; 3]), &flat([0.625; 3])).unwrap();
    assert_eq!((c.rmse, c.mse, c.max, c.max_at), (0.125, 1.0 / 64.0, 0.125, Some([0, 0])));
    assert!((c.psnr - 10.0 * 64f64.log10()).abs() < 1e-12);
    assert_eq!(c.over_1_255, 1.0);
    // The same in one channel of three.
    let c = compare(&flat([0.5; 3]), &flat([0.5, 0.5, 0.625])).unwrap();
    assert_eq!(c.mse, 1.0 / 64.0 / 3.0);
}

#[test]
fn single_wrong_pixel_is_counted_and_located() {
    let (a, mut b) = (flat([0.5; 3]), flat([0.5; 3]));
    b.pixels[8 * 2 + 3][1] = 0.25;
    let c = compare(&a, &b).unwrap();
    assert_eq!((c.max, c.max_at), (0.25, Some([3, 2])));
    assert_eq!((c.over_1_255_pixels, c.over_1_255), (1, 1.0 / 32.0));
    assert_eq!(c.mse, 0.0625 / 96.0);
}

#[test]
fn planted_shift_swap_and_srgb_mix_up_are_caught() {
    let a = gradient(16, 16);
    let edit = |f: &dyn Fn(usize) -> [f32; 3]| Film { pixels: (0..256).map(f).collect(), ..a.clone() };
    let shift = edit(&|i| a.pixels[i / 16 * 16 + (i + 1) % 16]);
    let swap = edit(&|i| [a.pixels[i][2], a.pixels[i][1], a.pixels[i][0]]);
    let mix_up = edit(&|i| a.pixels[i].map(|v| srgb_to_linear(f64::from(v)) as f32));
    // By hand: steps of 1/256 a pixel, 15 of them back at the row's end; 2/768 in two of three
    // channels; ∫(x − srgb_to_linear(x))² dx over [0, 1] is 0.04344.
    for (name, b, mse) in [
        ("shift", &shift, (15.0 + 15.0 * 15.0) / 16.0 / 256f64.powi(2)),
        ("swap", &swap, 2.0 / 3.0 * (2.0 / 768f64).powi(2)),
        ("mix-up", &mix_up, 0.04344),
    ] {
        let c = compare(&a, b).unwrap();
        assert!((c.mse / mse - 1.0).abs() < 0.01, "{name}: {} for {mse}", c.mse);
        assert!(!c.passes(Some(1e-3)), "{name}");
    }
}

#[test]
fn over_1_255_is_strict_on_eight_bit_steps() {
    let code = |i: u8| srgb_to_linear(f64::from(i) / 255.0) as f32;
    for i in 0..=253 {
        let of = |v: f32| flat([v, 0.5, 0.5]);
        assert_eq!(compare(&of(code(i)), &of(code(i + 1))).unwrap().over_1_255_pixels, 0, "one step at {i}");
        assert_eq!(compare(&of(code(i)), &of(code(i + 2))).unwrap().over_1_255_pixels, 32, "two at {i}");
    }
}

#[test]
fn over_1_255_ignores_what_clipping_hides_but_rmse_does_not() {
    let c = compare(&flat([1.0; 3]), &flat([3.0; 3])).unwrap();
    assert_eq!((c.rmse, c.over_1_255, c.max_encoded), (2.0, 0.0, 0.0));
}

#[test]
fn nan_is_counted_left_out_of_the_means_and_never_passes() {
    let (a, mut b) = (flat([0.5; 3]), flat([0.5; 3]));
    b.pixels[5][2] = f32::NAN;
    for c in [compare(&a, &b).unwrap(), compare(&b, &a).unwrap(), compare(&b, &b).unwrap()] {
        assert_eq!((c.nan_pixels, c.rmse, c.over_1_255_pixels), (1, 0.0, 1));
        assert!(!c.passes(None) && !c.passes(Some(1.0)));
    }
}

#[test]
fn infinite_values_agree_with_each_other_only() {
    let (a, mut b) = (flat([0.5; 3]), flat([0.5; 3]));
    b.pixels[0][0] = f32::INFINITY;
    assert!(compare(&b, &b).unwrap().passes(Some(0.0)));
    assert!(!compare(&a, &b).unwrap().passes(None));
}

#[test]
fn different_sizes_cannot_be_compared() {
    let message = told(compare(&gradient(4, 2), &gradient(2, 4)));
    assert!(message.contains("4×2 and 2×4"), "{message}");
}

#[test]
fn difference_picture_is_scaled_to_its_largest_value() {
    let (a, mut b) = (flat([0.5; 3]), flat([0.5; 3]));
    assert!(difference_picture(&a, &b).unwrap().pixels.iter().all(|p| *p == [0.0; 3]), "black when equal");
    b.pixels[1] = [0.25, 0.5, 1.0];
    b.pixels[2] = [f32::NAN, 0.5, 0.5];
    let d = difference_picture(&a, &b).unwrap();
    assert_eq!(d.pixels[..3], [[0.0; 3], [0.5, 0.0, 1.0], [1.0, 0.0, 1.0]]);
}

#[test]
fn files_are_read_as_linear_light_grey_replicated_alpha_ignored() {
    let folder = tempdir().unwrap();
    let saved = |name: &str, picture: DynamicImage| {
        let path = folder.path().join(name);
        picture.save(&path).unwrap();
        read_picture(&path).unwrap().pixels[0]
    };
    let linear = |v: f64| srgb_to_linear(v) as f32;
    let grey = ImageBuffer::<Luma<u8>, _>::from_pixel(2, 2, Luma([100]));
    assert_eq!(saved("l.png", grey.into()), [linear(100.0 / 255.0); 3]);
    let rgba = ImageBuffer::<Rgba<u8>, _>::from_pixel(2, 2, Rgba([100, 0, 255, 7]));
    assert_eq!(saved("rgba.png", rgba.into()), [linear(100.0 / 255.0), 0.0, 1.0]);
    let deep = ImageBuffer::<Rgb<u16>, _>::from_pixel(2, 2, Rgb([1000, 0, 65_535]));
    assert_eq!(saved("rgb16.png", deep.into()), [linear(1000.0 / 65_535.0), 0.0, 1.0]);
    let float = ImageBuffer::<Rgb<f32>, _>::from_pixel(2, 2, Rgb([0.25, -1.0, 40.0]));
    assert_eq!(saved("f.tiff", float.into()), [0.25, -1.0, 40.0]);
}

fn file(folder: &TempDir, name: &str, film: &Film) -> PathBuf {
    let path = folder.path().join(name);
    write(film, &path, &WriteOptions::default()).unwrap();
    path
}

/// Exit code, standard output, standard error of `moire compare`.
fn run(a: &Path, b: &Path, more: &[&str]) -> (Option<i32>, String, String) {
    let output = moire().arg("compare").args([a, b]).args(more).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn command_exits_0_within_and_1_above_the_bound() {
    let folder = tempdir().unwrap();
    let a = file(&folder, "a.exr", &flat([0.5; 3]));
    let b = file(&folder, "b.exr", &flat([0.625; 3]));
    let (code, out, err) = run(&a, &b, &[]);
    assert_eq!((code, err.as_str()), (Some(0), ""));
    assert!(out.contains("RMSE          1.250000e-1") && out.contains("PSNR          18.06 dB"), "{out}");
    assert_eq!(run(&a, &b, &["--max-rmse", "0.125"]).0, Some(0));
    let (code, _, err) = run(&a, &b, &["--max-rmse", "0.1249"]);
    assert_eq!(code, Some(1));
    assert!(err.contains("above the bound"), "{err}");
    assert_eq!(run(&a, &a, &["--max-rmse", "0"]).0, Some(0));
}

#[test]
fn command_holds_each_figure_against_its_own_bound() {
    let folder = tempdir().unwrap();
    let mut film = flat([0.5; 3]);
    let a = file(&folder, "a.exr", &film);
    film.pixels[7] = [0.5, 0.5, 1.0];
    let b = file(&folder, "b.exr", &film);
    let (_, out, _) = run(&a, &b, &["--json"]);
    let flip = serde_json::from_str::<serde_json::Value>(&out).unwrap()["flip"].as_f64().unwrap();
    for (option, within, beyond, name) in
        [("--max-diff", 0.5, 0.499, "max"), ("--max-flip", flip * 1.01, flip * 0.99, "FLIP")]
    {
        assert_eq!(run(&a, &b, &[option, &within.to_string()]).0, Some(0), "{option} {within}");
        let (code, _, err) = run(&a, &b, &[option, &beyond.to_string()]);
        assert_eq!((code, err.lines().count()), (Some(1), 1), "{option} {beyond}: {err}");
        assert!(err.starts_with(name) && err.contains("above the bound"), "{err}");
    }
    let (code, _, err) = run(&a, &b, &["--max-diff", "0", "--max-flip", "0", "--max-rmse", "0"]);
    assert_eq!((code, err.lines().count()), (Some(1), 3), "{err}");
}

#[test]
fn quiet_command_prints_only_what_is_above_a_bound() {
    let folder = tempdir().unwrap();
    let a = file(&folder, "a.exr", &flat([0.5; 3]));
    let b = file(&folder, "b.exr", &flat([0.625; 3]));
    assert_eq!(run(&a, &b, &["-q"]), (Some(0), String::new(), String::new()));
    let (code, out, err) = run(&a, &b, &["-q", "--max-rmse", "0.1"]);
    assert_eq!((code, out.as_str()), (Some(1), ""));
    assert!(err.contains("RMSE") && err.lines().count() == 1, "{err}");
    assert!(run(&a, &b, &["-q", "--json"]).1.contains("\"rmse\""));
}

#[test]
fn command_exits_1_on_a_nan_without_any_bound() {
    let folder = tempdir().unwrap();
    let mut film = flat([0.5; 3]);
    let a = file(&folder, "a.exr", &film);
    film.pixels[3][0] = f32::NAN;
    let b = file(&folder, "b.exr", &film);
    let (code, out, err) = run(&a, &b, &[]);
    assert_eq!(code, Some(1));
    assert!(out.contains("NaN pixels    1") && err.contains("NaN in 1 pixel\n"), "{out}{err}");
}

#[test]
fn command_prints_one_json_object() {
    let folder = tempdir().unwrap();
    let a = file(&folder, "a.exr", &flat([0.5; 3]));
    let b = file(&folder, "b.exr", &flat([0.625; 3]));
    let (_, out, _) = run(&a, &b, &["--json", "--max-rmse", "0.2"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(json["rmse"], 0.125);
    // 0.125² over 0.625² + 0.01, b being the reference.
    let relative = json["relative_mse"].as_f64().unwrap();
    assert!((relative - 0.015_625 / 0.400_625).abs() < 1e-12, "{relative}");
    assert!(json["flip"].as_f64().unwrap() > 0.05, "{json}");
    assert_eq!((&json["max_rmse"], &json["pass"]), (&0.2.into(), &true.into()));
    assert_eq!((&json["width"], &json["nan_pixels"]), (&8.into(), &0.into()));
    let (_, out, _) = run(&a, &a, &["--json"]);
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(json["psnr"].is_null() && json["max_rmse"].is_null());
}

#[test]
fn command_writes_the_difference_picture() {
    let folder = tempdir().unwrap();
    let mut film = flat([0.5; 3]);
    let a = file(&folder, "a.exr", &film);
    film.pixels[9] = [0.5, 0.75, 0.5];
    let b = file(&folder, "b.exr", &film);
    let out = folder.path().join("d.png");
    assert_eq!(run(&a, &b, &["--diff", out.to_str().unwrap()]).0, Some(0));
    let d = read_picture(&out).unwrap();
    assert_eq!((d.pixels[9], d.pixels[0]), ([0.0, 1.0, 0.0], [0.0; 3]));
}

#[test]
fn command_exits_2_on_errors_with_a_message_on_stderr() {
    let folder = tempdir().unwrap();
    let a = file(&folder, "a.exr", &flat([0.5; 3]));
    let other = file(&folder, "b.png", &gradient(3, 3));
    let text = folder.path().join("c.png");
    fs::write(&text, "no picture").unwrap();
    let diff = folder.path().join("none/d.png");
    for (b, more, what) in [
        (&other, vec![], "differ in size"),
        (&folder.path().join("missing.exr"), vec![], "no such file"),
        (&text, vec![], "looks like text"),
        (&a, vec!["--diff", diff.to_str().unwrap()], "does not exist"),
        (&a, vec!["--max-rmse", "-1"], "at least 0"),
        (&a, vec!["--max-rmse", "nan"], "finite"),
        (&a, vec!["--max-rmse", "inf"], "finite"),
        (&a, vec!["--max-rms", "1"], "--max-rmse"),
    ] {
        let (code, out, err) = run(&a, b, &more);
        // The report wraps long lines.
        let err = err.split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ");
        assert_eq!((code, out.as_str()), (Some(2), ""), "{what}: {err}");
        assert!(err.contains(what), "{what} not in: {err}");
    }
    assert_eq!(moire().arg("compare").output().unwrap().status.code(), Some(2));
}
