//! The results of beams in random scenes are correct in every pixel, and planted errors are
//! detected.

use glam::DVec3;
use moire::internal::oracle::beam::beam;
use moire::internal::render::Tuning;
use moire::internal::scene::model::{Algorithm, Scene};
use rayon::prelude::*;

use super::scenes::{Kind, scene, text};
use super::truth::Truth;
use super::{FEW, color, film, kind_of, many, with};
use crate::stage::{packed, render_with};

/// Irradiance of a point light is that at the centre of a strip of the pixel; and f32 on a device.
const OWN: f64 = 3e-4;
const OWN_F32: f64 = 1e-3;

/// Returns each pixel's colour, `None` if it took samples.
type Told = Vec<Option<DVec3>>;

fn told_in_float64(scene: &Scene) -> Told {
    let packed = packed(with(scene.clone(), Algorithm::Beam), None);
    let pixels = (0..scene.width * scene.height).into_par_iter();
    pixels.map(|i| beam(&packed, [i % scene.width, i / scene.width])).collect()
}

/// A pixel that took samples equals that of the sampled picture up to the order of its 16 terms. If it does not, as two
/// pipelines of one device may decide differently at an edge, it still changes with the seed, which no beam does.
fn told_by_device(scene: &Scene) -> Told {
    let packed = packed(with(scene.clone(), Algorithm::Beam), None);
    let (beams, report) = render_with(&packed, false, &Tuning::default());
    if report.sampled_pixels == Some(0) {
        return beams.pixels.iter().map(|&pixel| Some(color(pixel))).collect();
    }
    let mut other = scene.clone();
    other.sampling.seed += 1;
    let films = [beams, film(&other, Algorithm::Beam), film(scene, Algorithm::Samples)];
    let told = |i: usize| {
        let [beam, again, samples] = [0, 1, 2].map(|k| color(films[k].pixels[i]));
        (beam == again && (beam - samples).length() > 1e-6).then_some(beam)
    };
    (0..films[0].pixels.len()).map(told).collect()
}

/// Returns the pixels that are wrong, with their errors.
fn wrong(truth: &Truth, told: &Told, width: u32, own: f64) -> Vec<([u32; 2], f64)> {
    let excess = |(i, value): (usize, &Option<DVec3>)| {
        let place = [i as u32 % width, i as u32 / width];
        value.map(|value| (place, truth.excess(place, value, own))).filter(|found| found.1 > 0.0)
    };
    told.par_iter().enumerate().filter_map(excess).collect()
}

fn check_float64(seed: u64, side: u32) {
    let (text, told) = check(seed, side, "float64", told_in_float64, OWN);
    let share = told.iter().flatten().count() as f64 / f64::from(side * side);
    assert!(share > 0.7, "seed {seed}: only {share} of the pixels told\n{text}");
}

fn check_device(seed: u64, side: u32) {
    check(seed, side, "the device", told_by_device, OWN_F32);
}

fn check(seed: u64, side: u32, what: &str, told: impl Fn(&Scene) -> Told, own: f64) -> (String, Told) {
    let text = text(kind_of(seed), seed, side);
    let scene = scene(&text);
    let told = told(&scene);
    let wrong = wrong(&Truth::of(&scene), &told, side, own);
    assert!(wrong.is_empty(), "seed {seed}, {what}, {} pixels: {:?}\n{text}", wrong.len(), wrong[0]);
    (text, told)
}

#[test]
fn every_pixel_that_beams_tell_is_right() {
    (0..FEW).for_each(|seed| check_float64(seed, 24));
}

#[test]
fn every_pixel_that_beams_tell_on_a_device_is_right() {
    // A device compiles a pipeline for each.
    (0..FEW / 2).for_each(|seed| check_device(seed, 24));
}

#[test]
#[ignore = "minutes"]
fn every_pixel_of_many_scenes_is_right() {
    for seed in many() {
        check_float64(seed, 64);
        check_device(seed, 64);
    }
}

/// Returns the number of scenes, of four of a kind, with a wrong pixel after the beams' scene is changed.
fn finds(kind: Kind, change: impl Fn(&mut Scene)) -> usize {
    let found = |seed: &u64| {
        let mut right = scene(&text(kind, *seed, 32));
        right.sampling.max_depth = 1;
        let mut changed = right.clone();
        change(&mut changed);
        !wrong(&Truth::of(&right), &told_in_float64(&changed), 32, OWN).is_empty()
    };
    (100..104).filter(found).count()
}

#[test]
fn planted_errors_are_found() {
    let nothing = finds(Kind::Mirrors, |_| {});
    let turned = finds(Kind::Plain, |scene| scene.camera.look_at.x += 2e-3);
    let missing = finds(Kind::Facing, |scene| scene.shapes.triangles.truncate(5));
    let deeper = finds(Kind::Facing, |scene| scene.sampling.max_depth += 1);
    let dark = finds(Kind::Plain, |scene| scene.lights.clear());
    let lower = finds(Kind::MirrorGround, |scene| scene.shapes.planes[0].origin.y -= 1e-3);
    // Not every scene has lights, or shows a second bounce.
    assert_eq!([nothing, turned], [0, 4]);
    assert!(
        [missing, deeper, dark, lower].iter().all(|count| *count > 0),
        "{missing} {deeper} {dark} {lower}"
    );
}

/// One pixel of background, as if a polygon behind the mirror had made a hole in it.
#[test]
fn one_wrong_pixel_is_found() {
    let scene = scene(&text(Kind::Mirrors, 101, 32));
    let truth = Truth::of(&scene);
    let mut told = told_in_float64(&scene);
    let sky = scene.background.color;
    let other = told.iter().position(|p| p.is_some_and(|p| (p - sky).abs().max_element() > 0.1)).unwrap();
    told[other] = Some(sky);
    let place = [other as u32 % 32, other as u32 / 32];
    let found = wrong(&truth, &told, 32, OWN);
    assert_eq!(found.iter().map(|w| w.0).collect::<Vec<_>>(), [place]);
    told[other] = Some(DVec3::NAN);
    assert_eq!(wrong(&truth, &told, 32, OWN).len(), 1, "what is no number");
}
