//! Errors of neighbouring pixels: blue noise makes them negatively correlated, so that a picture's
//! error has little energy at visible frequencies.

use std::f64::consts::TAU;

use moire::internal::scene::model::Pattern;

use super::{set, unit};

const SIDE: usize = 128;

/// Each pixel's error of the mean of `f` over its points, less the mean error.
fn errors(pattern: Pattern, samples: u32, seed: u32, pair: u32, f: fn([f64; 2]) -> f64) -> Vec<f64> {
    errors_of(pattern, samples, seed, pair, f, SIDE)
}

fn errors_of(
    pattern: Pattern,
    samples: u32,
    seed: u32,
    pair: u32,
    f: fn([f64; 2]) -> f64,
    side: usize,
) -> Vec<f64> {
    let mean_of = |i: usize| {
        let points = unit(&set(pattern, samples, seed, [(i % side) as u32, (i / side) as u32], pair));
        points.into_iter().map(f).sum::<f64>() / f64::from(samples)
    };
    let means: Vec<f64> = (0..side * side).map(mean_of).collect();
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    means.iter().map(|m| m - mean).collect()
}

fn edge(p: [f64; 2]) -> f64 {
    f64::from(p[0] + 0.6 * p[1] < 0.7)
}

fn smooth(p: [f64; 2]) -> f64 {
    p[0] * p[1] + p[0]
}

/// Correlation of pixels with their right and lower neighbours. Of white noise: sigma 1 / √(2 · 128²) = 0.0055.
fn neighbour_correlation(errors: &[f64]) -> f64 {
    let at = |x: usize, y: usize| errors[y % SIDE * SIDE + x % SIDE];
    let mut sum = 0.0;
    for y in 0..SIDE {
        for x in 0..SIDE {
            sum += at(x, y) * (at(x + 1, y) + at(x, y + 1));
        }
    }
    sum / (2.0 * errors.iter().map(|e| e * e).sum::<f64>())
}

/// Mean power over frequencies up to 16 of 64, over the mean power of all. Of white noise 1, with a sigma of
/// 1/√398: there are 398 such frequencies that are not another's opposite.
fn low_energy(errors: &[f64]) -> f64 {
    let mut sum = 0.0;
    let mut count = 0.0;
    for fy in 0..=16i32 {
        for fx in -16..=16i32 {
            if (fy == 0 && fx <= 0) || fx * fx + fy * fy > 256 {
                continue;
            }
            let (mut re, mut im) = (0.0, 0.0);
            for (i, e) in errors.iter().enumerate() {
                let turn = TAU * (f64::from(fx) * (i % SIDE) as f64 + f64::from(fy) * (i / SIDE) as f64)
                    / SIDE as f64;
                re += e * turn.cos();
                im += e * turn.sin();
            }
            sum += re * re + im * im;
            count += 1.0;
        }
    }
    sum / count / errors.iter().map(|e| e * e).sum::<f64>()
}

#[test]
fn errors_of_neighbours_are_opposite_and_low_frequencies_weak() {
    for (samples, f) in
        [(1, edge as fn([f64; 2]) -> f64), (1, smooth), (4, edge), (4, smooth), (8, edge), (16, smooth)]
    {
        for pair in [0, 1] {
            let errors = errors(Pattern::BlueNoise, samples, 3, pair, f);
            let (correlation, low) = (neighbour_correlation(&errors), low_energy(&errors));
            // Seven sigmas of white noise, and six.
            assert!(correlation < -0.04, "{samples} samples, pair {pair}: correlation {correlation}");
            assert!(low < 0.7, "{samples} samples, pair {pair}: low frequencies {low}");
        }
    }
}

#[test]
fn errors_of_other_patterns_are_white() {
    for pattern in
        [Pattern::Random, Pattern::Stratified, Pattern::MultiJittered, Pattern::Halton, Pattern::SobolOwen]
    {
        let errors = errors(pattern, 4, 3, 0, edge);
        // Five sigmas each: p = 6e-7.
        let (correlation, low) = (neighbour_correlation(&errors), low_energy(&errors));
        assert!(correlation.abs() < 0.028, "{pattern}: correlation {correlation}");
        assert!((low - 1.0).abs() < 0.25, "{pattern}: low frequencies {low}");
    }
}

/// The errors themselves are not larger. A picture has one scrambling, which fits an edge more or less well:
/// over 40 of them the mean square has a sigma of a tenth of itself.
#[test]
fn blue_noise_has_the_error_of_sobol_owen() {
    let mean_square = |pattern| {
        let of_seed = |seed| {
            let block = errors_of(pattern, 16, seed, 0, edge, 24);
            block.iter().map(|e| e * e).sum::<f64>() / block.len() as f64
        };
        (0..40).map(of_seed).sum::<f64>() / 40.0
    };
    let ratio = mean_square(Pattern::BlueNoise) / mean_square(Pattern::SobolOwen);
    assert!((0.6..1.5).contains(&ratio), "{ratio}");
}
