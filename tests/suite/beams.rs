//! One beam per pixel: areas and integrals against closed forms and converged samples, device
//! against oracle, and which pixels fall back to samples.

mod areas;
mod integrals;
mod mirrors;

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::compare;
use moire::internal::pack::PackedScene;
use moire::internal::render::Tuning;
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Scene};

use crate::stage::{assert_same_bits, packed, render, render_on_oracle, render_with, small};

fn with_beams(mut scene: Scene) -> PackedScene {
    scene.sampling.algorithm = Algorithm::Beam;
    packed(scene, None)
}

fn with_samples(mut scene: Scene, spp: u32) -> PackedScene {
    scene.sampling.algorithm = Algorithm::Samples;
    scene.sampling.pattern = Pattern::Stratified;
    scene.sampling.footprint = Footprint::None;
    scene.sampling.shared = false;
    scene.sampling.spp = spp;
    packed(scene, None)
}

fn rmse(a: &Film, b: &Film) -> f64 {
    compare(a, b).unwrap().rmse
}

/// Returns the beams' picture, and the number of pixels that took samples.
fn beams(scene: &PackedScene) -> (Film, u64) {
    let (film, report) = render_with(scene, false, &Tuning::default());
    (film, report.sampled_pixels.unwrap())
}

#[test]
fn device_and_oracle_agree() {
    for name in ["s1a", "beams", "quad"] {
        let scene = with_beams(small(name, 64, 4));
        let (film, sampled) = beams(&scene);
        assert_eq!(sampled, 0, "{name}");
        // Colours of at most 1 from some hundred f32 terms.
        let apart = rmse(&film, &render_on_oracle(&scene));
        assert!(apart < 1e-5, "{name}: RMSE {apart:e}");
    }
}

#[test]
fn lean_is_the_same_as_with_everything_kept() {
    let scene = with_beams(small("beams", 24, 4));
    let (kept, _) = render_with(&scene, true, &Tuning::default());
    assert_same_bits(&render(&scene), &kept, "beams");
}

/// Two pictures by very many samples, of two seeds.
fn converged(scene: &Scene) -> [Film; 2] {
    let mut other = scene.clone();
    other.sampling.seed = 77;
    [scene.clone(), other].map(|s| render(&with_samples(s, 64 * 64)))
}

/// Returns the number of standard deviations by which the film is further from the mean of two pictures than
/// noise explains. Half the difference of the two and the error of the mean have the same distribution, so in
/// each pixel their squares differ by a variable of mean 0, and the variance of the sum is the sum of the
/// squares. Beside noise, the beams' own bound near a horizon is allowed, RMSE 1e-4.
fn sigmas_beyond_chance(film: &Film, [a, b]: &[Film; 2]) -> f64 {
    let (mut sum, mut squares) = (0.0, 0.0);
    for ((film, a), b) in film.pixels.iter().zip(&a.pixels).zip(&b.pixels) {
        let excess: f64 = (0..3)
            .map(|c| {
                let [film, a, b] = [film, a, b].map(|p| f64::from(p[c]));
                (film - 0.5 * (a + b)).powi(2) - (0.5 * (a - b)).powi(2)
            })
            .sum();
        sum += excess - 3.0 * 1e-8;
        squares += excess * excess;
    }
    sum / squares.sqrt()
}

fn assert_meets_samples(scene: &Scene, what: &str) {
    let (film, sampled) = beams(&with_beams(scene.clone()));
    assert_eq!(sampled, 0, "{what}");
    let pictures = converged(scene);
    let sigmas = sigmas_beyond_chance(&film, &pictures);
    let noise = 0.5 * rmse(&pictures[0], &pictures[1]);
    assert!(sigmas < 3.0, "{what}: {sigmas} sigma beyond a noise of RMSE {noise:e}");
}

/// Planted: six tenths of the noise, everywhere.
#[test]
fn what_is_a_little_wrong_everywhere_does_not_pass_for_chance() {
    let scene = small("s1b", 64, 4);
    let (mut film, _) = beams(&with_beams(scene.clone()));
    let pictures = converged(&scene);
    let noise = 0.5 * rmse(&pictures[0], &pictures[1]) as f32;
    film.pixels.iter_mut().flatten().for_each(|value| *value += 0.6 * noise);
    let sigmas = sigmas_beyond_chance(&film, &pictures);
    assert!(sigmas > 3.0, "{sigmas} sigma");
}

#[test]
fn converged_samples_meet_the_beams() {
    for name in ["s1a", "s1b", "beams"] {
        assert_meets_samples(&small(name, 64, 4), name);
    }
}

/// No axis of the texture is parallel to a row of the picture.
#[test]
fn turned_cameras_too() {
    let mut scene = small("s1b", 64, 4);
    scene.camera.look_at = glam::DVec3::new(3.1, 0.1, -4.0);
    scene.camera.up = glam::DVec3::new(0.4, 1.0, 0.1);
    assert_meets_samples(&scene, "a turned camera");
}

/// The mirror ball and its shadow take samples; their pixels equal those of the sampled picture.
#[test]
fn what_beams_cannot_tell_is_sampled_and_counted() {
    let scene = small("s2", 64, 16);
    let beamed = with_beams(scene.clone());
    let (film, sampled) = beams(&beamed);
    assert!((200..2400).contains(&sampled), "{sampled} of 4096 pixels");
    let mut sampling = scene.clone();
    sampling.sampling.footprint = Footprint::None;
    let samples = render(&packed(sampling, None));
    let converged = render(&with_samples(scene, 64 * 64));
    let apart = |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>();
    let (mut told, mut of_beams, mut of_samples) = (0, 0.0, 0.0);
    for ((beam, sample), truth) in film.pixels.iter().zip(&samples.pixels).zip(&converged.pixels) {
        // Sums of 16 f32 in two orders.
        if apart(beam, sample) > 1e-12 {
            told += 1;
            of_beams += apart(beam, truth);
            of_samples += apart(sample, truth);
        }
    }
    assert!(told + sampled <= 4096, "{told} told, {sampled} sampled");
    // The reference itself errs by (16 / 4096)^0.75 = 1/64 of the error of 16 samples.
    assert!(of_beams < 0.01 * of_samples, "{told} pixels told: {of_beams:e} and {of_samples:e}");
}

/// More shapes in one pixel than a beam keeps.
#[test]
fn crowded_pixels_are_left_to_samples() {
    let mut scene = small("beams", 32, 64);
    scene.lights.clear();
    let first = scene.shapes.triangles[0];
    for k in 0..12 {
        let by = glam::DVec3::new(0.0, 0.02 * f64::from(k), 0.01 * f64::from(k));
        scene.shapes.triangles.push(moire::internal::scene::model::Triangle {
            vertices: first.vertices.map(|v| v + by),
            ..first
        });
    }
    let (film, sampled) = beams(&with_beams(scene.clone()));
    assert!(sampled > 0 && sampled < 600, "{sampled}");
    let converged = render(&with_samples(scene, 64 * 64));
    assert!(rmse(&film, &converged) < 5e-3);
}

#[test]
fn boxes_of_any_width_too() {
    let mut scene = small("beams", 48, 4);
    scene.pixel_filter.radius = 0.6;
    assert_meets_samples(&scene, "a wide box");
}

/// Unequal weights: every pixel equals that of the samples.
#[test]
fn other_pixel_filters_take_samples() {
    let mut scene = small("beams", 24, 16);
    scene.pixel_filter = moire::internal::scene::model::PixelFilter::new(PixelFilterKind::Gaussian, None);
    let beams = render(&with_beams(scene.clone()));
    scene.sampling.algorithm = Algorithm::Samples;
    scene.sampling.footprint = Footprint::None;
    assert_same_bits(&beams, &render(&packed(scene, None)), "gaussian");
}

#[test]
fn orthographic_pictures_too() {
    let mut scene = small("beams", 64, 4);
    scene.camera.projection = moire::internal::scene::model::Projection::Orthographic(1.0);
    assert_meets_samples(&scene, "parallel rays");
    let beamed = with_beams(scene);
    assert!(rmse(&render(&beamed), &render_on_oracle(&beamed)) < 1e-5);
}
