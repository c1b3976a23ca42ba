//! Convergence of the variance with the number of samples, on scenes made for it: smooth in every
//! pixel, one edge in every pixel, high-frequency detail in every pixel. Jittered strata have
//! slopes of -2, -3/2 and -1 (Mitchell 1996), independent samples -1 on all three. Confidence
//! intervals are bootstrapped from blocks of pixels.

use moire::internal::core::film::Film;
use moire::internal::lab::study::bootstrap::{blocks, interval};
use moire::internal::scene::model::Pattern;

use crate::stage::{packed, render};
use crate::support::data;

const COUNTS: [u32; 7] = [4, 9, 16, 36, 64, 144, 256];
const SEEDS: u32 = 3;
/// Confidence of each interval. Six are computed, so that one in 17 sets of seeds would have one outside.
const CONFIDENCE: f64 = 0.99;

fn film(name: &str, pattern: Pattern, spp: u32, seed: u32) -> Film {
    let mut scene =
        moire::internal::scene::load(&data().join(format!("scenes/slopes/slope-{name}.toml"))).unwrap();
    (scene.sampling.pattern, scene.sampling.spp, scene.sampling.seed) = (pattern, spp, seed);
    render(&packed(scene, None))
}

/// Of 65536 strata: variances of 2⁻³², 2⁻²⁴ and, with four strata in each of its cells, far below 2⁻¹⁶ of one
/// sample's, where 256 samples have 2⁻¹⁶, 2⁻¹² and 2⁻⁸.
fn converged(name: &str) -> Film {
    film(name, Pattern::Stratified, 1 << 16, 1000)
}

/// Squared errors of blocks of the pictures of all seeds.
fn errors(name: &str, reference: &Film, pattern: Pattern, spp: u32) -> Vec<f32> {
    // A different seed for each count: sequences and strata of two counts are then independent.
    let seeds = (0..SEEDS).map(|k| 10 * spp + k);
    seeds.flat_map(|seed| blocks(&film(name, pattern, spp, seed), reference)).collect()
}

fn measured(name: &str, pattern: Pattern) -> [f64; 2] {
    let reference = converged(name);
    let all: Vec<Vec<f32>> = COUNTS.iter().map(|&n| errors(name, &reference, pattern, n)).collect();
    let points: Vec<(f64, &[f32])> =
        COUNTS.iter().zip(&all).map(|(n, blocks)| (f64::from(*n), blocks.as_slice())).collect();
    interval(&points, CONFIDENCE).unwrap()
}

fn assert_slope(name: &str, pattern: Pattern, theory: f64) {
    let [low, high] = measured(name, pattern);
    println!("{name}, {pattern}: {low:.3} to {high:.3}, theory {theory}");
    assert!(high - low <= 0.2, "{name}, {pattern}: {low} to {high} says little");
    assert!((low..=high).contains(&theory), "{name}, {pattern}: {low} to {high}, not {theory}");
}

#[test]
fn jittered_samples_of_smooth_pixels_fall_with_the_square() {
    assert_slope("smooth", Pattern::Stratified, -2.0);
}

#[test]
fn jittered_samples_of_an_edge_fall_with_the_power_of_three_halves() {
    assert_slope("edge", Pattern::Stratified, -1.5);
}

#[test]
fn jittered_samples_of_busy_pixels_are_as_good_as_random_ones() {
    assert_slope("busy", Pattern::Stratified, -1.0);
}

#[test]
fn random_samples_fall_with_their_number_whatever_they_show() {
    for name in ["smooth", "edge", "busy"] {
        assert_slope(name, Pattern::Random, -1.0);
    }
}

/// Squared errors whose mean falls by a power, each the square of a normal deviate: sums of 12 uniform numbers.
fn planted(exponent: f64, seed: u32) -> Vec<Vec<f32>> {
    let uniform =
        |i: u32| f64::from(moire::internal::oracle::rng::mix_bits(i ^ seed << 20)) / f64::from(u32::MAX);
    let normal = |i: u32| (0..12).map(|k| uniform(12 * i + k)).sum::<f64>() - 6.0;
    let of = |(k, n): (u32, &u32)| {
        (0..192).map(|b| (normal(192 * k + b) * f64::from(*n).powf(0.5 * exponent)).powi(2) as f32).collect()
    };
    (0..).zip(&COUNTS).map(of).collect()
}

fn interval_of(all: &[Vec<f32>], confidence: f64) -> [f64; 2] {
    let points: Vec<(f64, &[f32])> =
        COUNTS.iter().zip(all).map(|(n, blocks)| (f64::from(*n), blocks.as_slice())).collect();
    interval(&points, confidence).unwrap()
}

/// 95 of 100 intervals contain the planted slope (two sigma are 4 more or fewer), and no other.
#[test]
fn intervals_hold_what_was_planted_as_often_as_they_say() {
    let intervals: Vec<[f64; 2]> = (1..=100).map(|seed| interval_of(&planted(-1.5, seed), 0.95)).collect();
    let held = |slope: f64| intervals.iter().filter(|[low, high]| (*low..=*high).contains(&slope)).count();
    assert!((86..=99).contains(&held(-1.5)), "{} of 100", held(-1.5));
    assert_eq!((held(-1.0), held(-1.25), held(-1.75)), (0, 0, 0));
}

#[test]
fn few_points_or_none_with_errors_have_no_interval() {
    let all = planted(-1.0, 1);
    let two: Vec<(f64, &[f32])> = [(4.0, all[0].as_slice()), (9.0, all[1].as_slice())].to_vec();
    assert_eq!(interval(&two, 0.95), None);
    let zeros = [0f32; 64];
    let exact: Vec<(f64, &[f32])> = [4.0, 9.0, 16.0].map(|n| (n, zeros.as_slice())).to_vec();
    assert_eq!(interval(&exact, 0.95), None);
    assert_eq!(interval(&[], 0.95), None);
}
