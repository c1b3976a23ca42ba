//! Power spectra against the theory of each pattern. A mean over R realisations of a periodogram
//! whose values are nearly exponentially distributed has a sigma of its mean over √R.

use std::f64::consts::PI;

use moire::internal::lab::pattern::points::Set;
use moire::internal::lab::pattern::spectrum::{Spectrum, mean};
use moire::internal::scene::model::Pattern;

const REALISATIONS: u32 = 400;

fn spectrum(pattern: Pattern, pair: u32) -> Spectrum {
    let set = Set { pattern, samples: 64, seed: 1, pair };
    mean(|number| set.realisation(number), REALISATIONS, 32)
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) }
}

/// Returns the largest distance, in sigmas, of the power from `expected`, over all frequencies for which it
/// is defined.
fn largest_sigmas(spectrum: &Spectrum, expected: impl Fn(f64, f64) -> Option<f64>) -> f64 {
    let limit = spectrum.limit as i64;
    let mut largest = 0.0f64;
    for y in -limit..=limit {
        for x in -limit..=limit {
            if let Some(power) = expected(x as f64, y as f64).filter(|_| (x, y) != (0, 0)) {
                let sigma = power / f64::from(REALISATIONS).sqrt();
                largest = largest.max((spectrum.at(x, y) - power).abs() / sigma);
            }
        }
    }
    largest
}

/// Of 2112 independent values 6.5 sigmas: p = 2e-7 for a normal one, about 1e-5 for a mean of 400
/// exponential ones (whose upper tail is that of a gamma distribution).
const FAR: f64 = 6.5;

#[test]
fn random_points_are_white() {
    for pair in [0, 3] {
        let spectrum = spectrum(Pattern::Random, pair);
        assert!(largest_sigmas(&spectrum, |_, y| (y != 0.0).then_some(1.0)) < FAR);
        // The hash lets x of samples in a row repel each other a little: at a few frequencies of x alone
        // there is a third less power.
        let on_axis: Vec<f64> = (1..=32).map(|x| spectrum.at(x, 0)).collect();
        assert!(on_axis.iter().all(|p| (0.55..1.3).contains(p)), "{on_axis:?}");
    }
}

/// One uniform point in each of n × n cells: 1 - (sinc(x/n) sinc(y/n))² (Leneman 1966).
#[test]
fn jittered_strata_lose_low_frequencies() {
    let law = |x: f64, y: f64| (y != 0.0).then(|| 1.0 - (sinc(x / 8.0) * sinc(y / 8.0)).powi(2));
    for pair in [0, 2] {
        let sigmas = largest_sigmas(&spectrum(Pattern::Stratified, pair), law);
        assert!(sigmas < FAR, "pair {pair}: {sigmas} sigmas");
    }
    assert!(largest_sigmas(&spectrum(Pattern::Random, 0), law) > 50.0, "random points pass for strata");
}

/// On the axes only one coordinate counts, and of these patterns it is jittered in 64 strata.
#[test]
fn projections_are_jittered_in_as_many_strata_as_points() {
    let law = |x: f64, y: f64| (x * y == 0.0).then(|| 1.0 - sinc((x + y) / 64.0).powi(2));
    for pattern in [Pattern::MultiJittered, Pattern::SobolOwen, Pattern::BlueNoise, Pattern::NRooks] {
        let sigmas = largest_sigmas(&spectrum(pattern, 0), law);
        assert!(sigmas < FAR, "{pattern}: {sigmas} sigmas");
    }
    let x_only = |x: f64, y: f64| (y == 0.0).then(|| 1.0 - sinc(x / 64.0).powi(2));
    assert!(largest_sigmas(&spectrum(Pattern::Halton, 0), x_only) < FAR);
    assert!(largest_sigmas(&spectrum(Pattern::Stratified, 0), law) > 50.0);
}

/// Below half of √N, in parts of random's power.
#[test]
fn low_frequencies_have_the_known_order() {
    let low = |pattern| spectrum(pattern, 0).radial_mean()[..4].iter().sum::<f64>() / 4.0;
    assert!(low(Pattern::MultiJittered) < 0.1);
    assert!(low(Pattern::SobolOwen) < 0.3 && low(Pattern::BlueNoise) < 0.3);
    assert!(low(Pattern::Halton) < 0.4 && low(Pattern::Stratified) < 0.4);
    assert!((0.5..0.9).contains(&low(Pattern::NRooks)));
}
