//! The scenes of `data/scenes` as 8-bit pictures against the stored ones of `data/golden`, which a
//! person has inspected. `MOIRE_BLESS=NAME` or `all` stores new ones, on a CPU device only, and
//! still fails: a picture passes only once it was stored, inspected and rendered again. A failure
//! leaves its pictures in `target/golden`: NAME.actual.png, NAME.expected.png, NAME.diff.png.

use std::fs;
use std::path::{Path, PathBuf};

use moire::internal::core::film::Film;
use moire::internal::gpu::DeviceKind;
use moire::internal::lab::metrics::{compare, difference_picture, read_picture};
use moire::internal::output::{WriteOptions, write};
use moire::internal::scene::model::{Model, Scene};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::TexelCenter;
use tempfile::tempdir;

use crate::stage::{device, packed, render, scene};
use crate::support::data;

/// Scene, size of the picture.
const GOLDENS: &[(&str, [u32; 2])] = &[
    ("beams", [96, 96]),
    ("centroid", [128, 77]),
    ("cones", [120, 90]),
    ("discs", [120, 90]),
    ("environment", [120, 75]),
    ("environment_cube", [120, 75]),
    ("filters", [128, 80]),
    ("formats", [172, 60]),
    ("glass", [120, 90]),
    ("glossy", [64, 48]),
    ("hardware", [164, 84]),
    ("horizon", [128, 96]),
    ("inside", [96, 96]),
    ("lanczos", [128, 64]),
    ("lecture", [128, 128]),
    ("lens", [64, 48]),
    ("lights", [120, 90]),
    ("mappings", [160, 80]),
    ("materials", [128, 64]),
    ("meshes", [128, 96]),
    ("mirrors", [120, 90]),
    ("models", [128, 96]),
    ("motion", [64, 48]),
    ("normal", [128, 54]),
    ("penumbra", [64, 48]),
    ("physical", [144, 96]),
    ("position", [144, 50]),
    ("procedural", [120, 53]),
    ("ramp", [120, 42]),
    ("reflection", [128, 54]),
    ("rough", [160, 48]),
    ("samplers", [264, 108]),
    ("shared", [120, 90]),
    ("volume", [120, 50]),
    ("zone_plate", [120, 120]),
];

/// The tolerance against the stored picture, both with 8 bits.
#[derive(Clone, Copy)]
struct Bounds {
    /// Share of the pixels that may be more than one step of 8 bits away.
    over: f64,
    /// Largest difference of any channel, in steps.
    steps: f64,
    rmse: f64,
}

/// The drivers of one class of device differ in the last bits only.
const SAME_CLASS: Bounds = Bounds { over: 0.0002, steps: 3.0, rmse: 1e-3 };
/// Other devices round differently where two texels or two shapes meet: with 4 to 16 samples per pixel, one sample on
/// the other side moves a pixel by up to a quarter of the range, so the largest difference is meaningless and their
/// number is bounded. The device's own filter, with 8 sub-texel bits on either side, stays within 2 steps of 8 bits
/// except in the steepest pixels.
const OTHER_CLASS: Bounds = Bounds { over: 0.002, steps: 255.0, rmse: 2e-3 };

fn bounds() -> Bounds {
    if device().info().kind == DeviceKind::Cpu { SAME_CLASS } else { OTHER_CLASS }
}

/// The end of infinite planes. Beyond it f32 loses the texel, so that the last row before a horizon differs between
/// devices; the comparison with float64 counts those pixels.
const END_OF_PLANES: f64 = 100.0;

fn sized(name: &str, [width, height]: [u32; 2]) -> Scene {
    let mut scene = scene(name);
    (scene.width, scene.height) = (width, height);
    for plane in &mut scene.shapes.planes {
        plane.half_extent = plane.half_extent.or(Some(END_OF_PLANES));
    }
    scene
}

/// By way of a file, as the program writes and reads it.
fn eight_bits(film: &Film) -> Film {
    let folder = tempdir().unwrap();
    let path = folder.path().join("picture.png");
    write(film, &path, &WriteOptions::default()).unwrap();
    read_picture(&path).unwrap()
}

/// Returns true if `actual` is accepted for `expected`; both have 8 bits.
fn judge(actual: &Film, expected: &Film, bounds: Bounds) -> Result<(), String> {
    let c = compare(actual, expected).map_err(|e| e.to_string())?;
    let found = format!(
        "{} pixels ({:.3} %) over 1/255, largest {:.1}/255, RMSE {:.2e}, {} NaN",
        c.over_1_255_pixels,
        c.over_1_255 * 100.0,
        c.max_encoded * 255.0,
        c.rmse,
        c.nan_pixels
    );
    let good = c.over_1_255 <= bounds.over
        && c.max_encoded * 255.0 <= bounds.steps + 0.001
        && c.passes(Some(bounds.rmse));
    if good { Ok(()) } else { Err(found) }
}

/// Compares the picture with the file `golden`; on failure the pictures are written to `seen`. With `bless` the picture
/// becomes the file, and the test still fails.
fn check(golden: &Path, actual: &Film, bounds: Bounds, bless: bool, seen: &Path) -> Result<(), String> {
    let name = golden.file_stem().unwrap().to_str().unwrap();
    let actual = eight_bits(actual);
    let keep = |film: &Film, kind: &str| {
        fs::create_dir_all(seen).unwrap();
        write(film, &seen.join(format!("{name}.{kind}.png")), &WriteOptions::default()).unwrap();
    };
    let told = |what: String| format!("{name}: {what}; see {}", seen.display());
    if bless {
        write(&actual, golden, &WriteOptions::default()).unwrap();
        return Err(format!(
            "{name}: stored {}; look at it, then test again without MOIRE_BLESS",
            golden.display()
        ));
    }
    let expected = match read_picture(golden) {
        Ok(expected) => expected,
        Err(error) => {
            keep(&actual, "actual");
            return Err(told(format!("no stored picture: {error}")));
        }
    };
    judge(&actual, &expected, bounds).map_err(|what| {
        keep(&actual, "actual");
        keep(&expected, "expected");
        if let Ok(difference) = difference_picture(&actual, &expected) {
            keep(&difference, "diff");
        }
        told(what)
    })
}

/// `target/golden` here, else `golden` beside this binary.
fn seen() -> PathBuf {
    let here = Path::new("target");
    if here.is_dir() {
        return here.join("golden");
    }
    std::env::current_exe().unwrap().with_file_name("golden")
}

fn matches_stored(name: &str) {
    let (_, size) = *GOLDENS.iter().find(|g| g.0 == name).unwrap();
    is_stored(name, "golden", sized(name, size));
}

/// Fails unless the picture of a scene is that of this name in a folder of `data`.
pub fn is_stored(name: &str, folder: &str, scene: Scene) {
    let bless = std::env::var("MOIRE_BLESS").is_ok_and(|wish| wish == "all" || wish == name);
    assert!(!bless || device().info().kind == DeviceKind::Cpu, "pictures are stored from a CPU device only");
    let golden = data().join(folder).join(format!("{name}.png"));
    if let Err(what) = check(&golden, &render(&packed(scene, None)), bounds(), bless, &seen()) {
        panic!("{what}");
    }
}

macro_rules! goldens {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            matches_stored(stringify!($name));
        })*

        #[test]
        fn every_scene_has_a_picture_and_every_picture_a_scene() {
            assert_eq!(GOLDENS.iter().map(|g| g.0).collect::<Vec<_>>(), [$(stringify!($name)),*]);
            let stems = |folder: &str, ending: &str| {
                let entries = fs::read_dir(data().join(folder)).unwrap().map(|e| e.unwrap().path());
                let files = entries.filter(|p| p.extension().is_some_and(|e| e == ending));
                let mut stems: Vec<String> =
                    files.map(|p| p.file_stem().unwrap().to_str().unwrap().into()).collect();
                stems.sort();
                stems
            };
            let mut scenes = stems("scenes", "toml");
            // Its picture is the texture that it draws.
            scenes.retain(|s| s != "quad");
            assert_eq!(scenes, stems("golden", "png"));
            assert_eq!(scenes, [$(stringify!($name)),*]);
        }
    };
}
goldens! {
    beams centroid cones discs environment environment_cube filters formats glass glossy hardware horizon inside
    lanczos lecture lens lights mappings materials meshes mirrors models motion normal penumbra physical position procedural ramp reflection
    rough samplers shared volume zone_plate
}

/// One texel a pixel: the very bytes of the texture.
#[test]
fn quad_draws_its_texture_exactly() {
    let film = eight_bits(&render(&packed(scene("quad"), None)));
    let poster = read_picture(&data().join("textures/poster.png")).unwrap();
    assert_eq!(film, Film { samples: 0, ..poster });
}

/// Returns the ratio to the looser of the two bounds for the lecture's scene with a fault planted by `change`.
fn planted(change: impl Fn(&mut Scene)) -> Result<(), String> {
    let right = sized("lecture", [128, 128]);
    let mut wrong = right.clone();
    change(&mut wrong);
    let of = |scene| eight_bits(&render(&packed(scene, None)));
    judge(&of(wrong), &of(right), OTHER_CLASS)
}

#[test]
fn nothing_planted_passes() {
    assert_eq!(planted(|_| {}), Ok(()));
}

#[test]
fn half_a_texel_of_shift_fails() {
    assert!(planted(|s| s.samplers.iter_mut().for_each(|x| x.texel_center = TexelCenter::Integer)).is_err());
}

#[test]
fn swapped_axes_fail() {
    let swap = |s: &mut Scene| {
        s.shapes.planes.iter_mut().for_each(|p| std::mem::swap(&mut p.tangent, &mut p.bitangent));
    };
    assert!(planted(swap).is_err());
}

#[test]
fn undecoded_srgb_fails() {
    assert!(planted(|s| s.textures.iter_mut().for_each(|t| t.color_space = ColorSpace::Linear)).is_err());
}

#[test]
fn a_missing_row_order_fails() {
    assert!(planted(|s| s.textures.iter_mut().for_each(|t| t.flip_v = false)).is_err());
}

/// The ground is lit as if nothing stood on it, the rest is unchanged.
#[test]
fn a_missing_shadow_fails() {
    let right = sized("lecture", [128, 128]);
    let mut alone = right.clone();
    alone.shapes.spheres.clear();
    alone.shapes.triangles.clear();
    // White where a pixel shows the ground directly, black elsewhere.
    let mut mask = right.clone();
    mask.lights.clear();
    mask.background.color = glam::DVec3::ZERO;
    for material in &mut mask.materials {
        material.texture = None;
        material.color = glam::DVec3::splat(if material.name == "ground" { 1.0 } else { 0.0 });
        material.model = Model::Unlit;
    }
    let [film, alone, mask] = [right, alone, mask].map(|s| render(&packed(s, None)));
    let mut wrong = film.clone();
    for (i, pixel) in wrong.pixels.iter_mut().enumerate() {
        if mask.pixels[i] == [1.0; 3] {
            *pixel = alone.pixels[i];
        }
    }
    let shown = judge(&eight_bits(&wrong), &eight_bits(&film), OTHER_CLASS);
    assert!(shown.is_err());
}

#[test]
fn a_missing_or_mis_sized_picture_fails_and_shows_what_was_rendered() {
    let folder = tempdir().unwrap();
    let (golden, seen) = (folder.path().join("a.png"), folder.path().join("seen"));
    let film = crate::support::gradient(8, 4);
    let what = check(&golden, &film, SAME_CLASS, false, &seen).unwrap_err();
    assert!(what.contains("no stored picture") && seen.join("a.actual.png").is_file(), "{what}");
    write(&crate::support::gradient(4, 8), &golden, &WriteOptions::default()).unwrap();
    let what = check(&golden, &film, SAME_CLASS, false, &seen).unwrap_err();
    assert!(what.contains("differ in size") && seen.join("a.expected.png").is_file(), "{what}");
}

#[test]
fn blessing_stores_the_picture_and_fails() {
    let folder = tempdir().unwrap();
    let (golden, seen) = (folder.path().join("a.png"), folder.path().join("seen"));
    let film = crate::support::gradient(8, 4);
    assert!(check(&golden, &film, SAME_CLASS, true, &seen).unwrap_err().contains("stored"));
    assert_eq!(check(&golden, &film, SAME_CLASS, false, &seen), Ok(()));
    assert!(!seen.exists(), "nothing failed, nothing to show");
}

#[test]
fn failures_show_actual_expected_and_difference() {
    let folder = tempdir().unwrap();
    let (golden, seen) = (folder.path().join("a.png"), folder.path().join("seen"));
    let mut film = crate::support::gradient(100, 100);
    write(&film, &golden, &WriteOptions::default()).unwrap();
    // 2 of 10000 pixels may be two or three steps away, none four.
    let step = |film: &mut Film, at: usize, steps: f64| {
        let code = (moire::internal::core::color::linear_to_srgb(f64::from(film.pixels[at][1])) * 255.0)
            .round()
            + steps;
        film.pixels[at][1] = moire::internal::core::color::srgb_to_linear(code / 255.0) as f32;
    };
    step(&mut film, 4000, 3.0);
    step(&mut film, 5000, 2.0);
    assert_eq!(check(&golden, &film, SAME_CLASS, false, &seen), Ok(()));
    let mut third = film.clone();
    step(&mut third, 6000, 2.0);
    assert!(check(&golden, &third, SAME_CLASS, false, &seen).is_err(), "three pixels");
    step(&mut film, 4000, 1.0);
    assert!(check(&golden, &film, SAME_CLASS, false, &seen).is_err(), "four steps");
    for kind in ["actual", "expected", "diff"] {
        assert!(seen.join(format!("a.{kind}.png")).is_file(), "{kind}");
    }
}
