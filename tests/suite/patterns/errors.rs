//! Errors of pixels: each pattern on a smooth function and on an edge, relative to random points.

use moire::internal::lab::pattern::measures::star_discrepancy;
use moire::internal::oracle::patterns::sample_pair;
use moire::internal::scene::model::Pattern;

use super::{SCATTERED, header, points, set, unit};

const SEEDS: u32 = 400;

/// Mean squared error of the mean of `samples` values of `f`, whose integral over the pixel is known.
fn variance(pattern: Pattern, samples: u32, f: fn([f64; 2]) -> f64, integral: f64) -> f64 {
    let error = |seed: u32| {
        let header = header(pattern, samples, false, seed);
        let points = points(&header, [4, 2], 0);
        let positions: Vec<[u32; 2]> = (0..samples).map(|s| sample_pair(&points, s)).collect();
        unit(&positions).into_iter().map(f).sum::<f64>() / f64::from(samples) - integral
    };
    (0..SEEDS).map(|seed| error(seed).powi(2)).sum::<f64>() / f64::from(SEEDS)
}

fn smooth(p: [f64; 2]) -> f64 {
    (p[0] + p[1] * p[1]).exp()
}

/// (e - 1) ∫ exp(y²) dy, Dawson's integral.
const SMOOTH: f64 = 1.718_281_828_459_045 * 1.462_651_745_907_181_6;

/// The pixel cut by a line through (0.5, 0.35) and (0, 0.1), to its right (0.75, …): area below it.
fn edge(p: [f64; 2]) -> f64 {
    f64::from(p[1] < 0.1 + 0.5 * p[0])
}

const EDGE: f64 = 0.35;

fn ratio(pattern: Pattern, samples: u32, f: fn([f64; 2]) -> f64, integral: f64) -> f64 {
    variance(Pattern::Random, samples, f, integral) / variance(pattern, samples, f, integral)
}

/// A ratio of two variances over 400 seeds each has a sigma of about a tenth of itself.
#[test]
fn every_pattern_beats_random_points_by_what_theory_says() {
    for pattern in SCATTERED.into_iter().filter(|p| *p != Pattern::Random) {
        let smooth = ratio(pattern, 64, smooth, SMOOTH);
        let edge = ratio(pattern, 64, edge, EDGE);
        // Variance falls as N⁻² (smooth) and N⁻¹·⁵ (edge) with strata in the plane (Mitchell 1996); n-rooks
        // take what is a sum of functions of x and y alone.
        let (least_smooth, least_edge) = match pattern {
            Pattern::Stratified => (25.0, 5.0),
            Pattern::NRooks => (12.0, 2.0),
            Pattern::MultiJittered => (45.0, 8.0),
            Pattern::Halton => (40.0, 4.0),
            _ => (500.0, 7.0),
        };
        assert!(smooth > least_smooth, "{pattern}: {smooth} on a smooth function");
        assert!(edge > least_edge, "{pattern}: {edge} on an edge");
    }
}

/// Doubly logarithmic slope of the variance from 16 to 1024 samples.
fn slope(pattern: Pattern, f: fn([f64; 2]) -> f64, integral: f64) -> f64 {
    (variance(pattern, 1024, f, integral) / variance(pattern, 16, f, integral)).ln() / 64f64.ln()
}

#[test]
fn variances_fall_as_theory_says() {
    // A sigma of a variance over 400 seeds is 7 % of it: 0.1 over ln 64 makes one of the slope 0.024.
    for (pattern, of_smooth, of_edge) in
        [(Pattern::Random, -1.0, -1.0), (Pattern::Stratified, -2.0, -1.5), (Pattern::SobolOwen, -3.0, -1.5)]
    {
        let (smooth, edge) = (slope(pattern, smooth, SMOOTH), slope(pattern, edge, EDGE));
        // Sobol's smooth slope of -3 has a logarithm of N in it (Owen 1997): flatter by up to 0.3 here.
        let slack = if pattern == Pattern::SobolOwen { 0.4 } else { 0.15 };
        assert!((smooth - of_smooth).abs() < slack, "{pattern}: {smooth} on a smooth function");
        assert!((edge - of_edge).abs() < 0.15, "{pattern}: {edge} on an edge");
    }
}

/// Sequences are uniform after any number of samples.
#[test]
fn prefixes_have_low_discrepancy() {
    for pattern in [Pattern::Halton, Pattern::SobolOwen] {
        for count in [10, 27, 100, 333, 999] {
            let mean = |pattern| {
                let one = |seed| star_discrepancy(&unit(&set(pattern, count, seed, [0, 0], 0)));
                (0..20).map(one).sum::<f64>() / 20.0
            };
            let (own, random) = (mean(pattern), mean(Pattern::Random));
            // As √N against (log N)²: from a factor 1.3 at 10 points on.
            let least = if count < 20 { 1.3 } else { 1.8 };
            assert!(own * least < random, "{pattern}, {count}: {own}, random {random}");
        }
    }
}
