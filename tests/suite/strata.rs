//! Sample positions: the device's against the oracle's and both against the formula, bit for bit;
//! one sample in every stratum; sets that pixels share or not; and the randomness of their jitter.

use moire::internal::lab::probe::{self, Positions};
use moire::internal::oracle::patterns::{pixel_points, sample_point};
use moire::internal::oracle::rng::{pixel_key, sample_bits};
use moire::internal::oracle::strata::stratum_position;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Pattern;
use moire::internal::schema::layout::Header;

use crate::stage::device;

const WIDTH: u32 = 5;

fn log2_ceil(side: u32) -> u32 {
    side.next_power_of_two().trailing_zeros()
}

fn scene(pattern: Pattern, side: u32, shared: bool, seed: u32, samples: u32) -> PackedScene {
    let header =
        Header { pattern, strata_side: side, samples, seed, shares_pattern: shared, ..Default::default() };
    PackedScene { header, samples, ..Default::default() }
}

/// floor(((s << B) + j) · 2²⁴ / (n << B)), B = 24 − ⌈log2 n⌉, in integers that nothing overflows.
fn by_formula(cell: u32, jitter: u32, side: u32) -> u32 {
    let bits = 24 - log2_ceil(side);
    let above = ((u128::from(cell) << bits) + u128::from(jitter)) << 24;
    u32::try_from(above / (u128::from(side) << bits)).unwrap()
}

fn expected(pattern: Pattern, key: [u32; 2], s: u32, side: u32) -> [u32; 2] {
    let bits = 24 - log2_ceil(side);
    match pattern {
        Pattern::Random => sample_bits(key, s).map(|b| b >> 8),
        Pattern::Stratified => {
            let [x, y] = sample_bits(key, s).map(|b| b >> (32 - bits));
            [by_formula(s % side, x, side), by_formula(s / side, y, side)]
        }
        // floor((2c + 1) · 2²³ / n): the centre of the stratum.
        Pattern::Grid | Pattern::Center => [s % side, s / side]
            .map(|c| u32::try_from(((2 * u128::from(c) + 1) << 23) / u128::from(side)).unwrap()),
        other => panic!("{other} has no such formula"),
    }
}

#[test]
fn the_oracles_strata_follow_the_formula_for_every_side() {
    for side in 1..=4096 {
        let most = (1 << (24 - log2_ceil(side))) - 1;
        for cell in [0, 1 % side, side / 3, side / 2, side - 1] {
            for jitter in [0, 1, most / 3, most / 2, most - 1, most] {
                let position = stratum_position(cell, jitter, side, log2_ceil(side));
                assert_eq!(position, by_formula(cell, jitter, side), "n = {side}, s = {cell}, j = {jitter}");
                assert!(position < 1 << 24);
            }
        }
    }
}

/// All samples of pair 0.
fn positions(scene: &PackedScene, keep: bool, width: u32, pixels: u32) -> Vec<[u32; 2]> {
    let which = Positions { pair: 0, width, pixels, first: 0, samples: scene.samples };
    probe::positions(&device(), scene, keep, &which).unwrap()
}

/// Device, oracle and formula on the first `samples` samples of `pixels` pixels.
fn agree(pattern: Pattern, side: u32, shared: bool, seed: u32, keep: bool, samples: u32, pixels: u32) {
    let scene = scene(pattern, side, shared, seed, samples);
    let device = positions(&scene, keep, WIDTH, pixels);
    for (i, &position) in device.iter().enumerate() {
        let (pixel, s) = (i as u32 / samples, i as u32 % samples);
        let place = [pixel % WIDTH, pixel / WIDTH];
        let key = pixel_key(place, seed, shared);
        let what = || {
            format!(
                "{pattern}, n = {side}, shared {shared}, seed {seed}, keep {keep}, pixel {pixel}, sample {s}"
            )
        };
        assert_eq!(position, sample_point(&pixel_points(&scene.header, place, key), s), "oracle: {}", what());
        assert_eq!(position, expected(pattern, key, s, side), "formula: {}", what());
    }
}

#[test]
fn device_and_oracle_agree_bit_for_bit() {
    for (pattern, sides) in [
        (Pattern::Center, &[1][..]),
        (Pattern::Random, &[1]),
        (Pattern::Grid, &[1, 2, 3, 5, 16, 31, 100]),
        (Pattern::Stratified, &[1, 2, 3, 4, 5, 7, 8, 12, 15, 16, 17, 31, 32, 33, 63, 100, 127]),
    ] {
        for (i, &side) in sides.iter().enumerate() {
            let samples = if pattern == Pattern::Random { 100 } else { (side * side).min(1024) };
            let seed = [1, 0, u32::MAX, 0x8000_0001][i % 4];
            let shared = i % 3 == 2;
            agree(pattern, side, shared, seed, i % 2 == 0, samples, 13);
            if side <= 5 {
                agree(pattern, side, !shared, seed ^ 77, i % 2 != 0, samples, 13);
            }
        }
    }
}

#[test]
fn device_and_oracle_agree_on_very_fine_strata() {
    // 65535 workgroups of 64 bound one dispatch (Vulkan 1.3, maxComputeWorkGroupCount).
    for (side, keep) in
        [(255, true), (1000, false), (1023, true), (2047, false), (3000, true), (4095, false), (4096, true)]
    {
        let samples = (side * side).min(1 << 21);
        agree(Pattern::Stratified, side, false, side, keep, samples, 1);
    }
    agree(Pattern::Grid, 4095, false, 1, false, 10_000, 1);
    agree(Pattern::Random, 1, false, 1, true, 1 << 20, 1);
}

#[test]
fn each_stratum_holds_exactly_one_sample() {
    for side in [1u32, 2, 3, 5, 7, 16, 31, 100] {
        let samples = side * side;
        let scene = scene(Pattern::Stratified, side, false, 3, samples);
        let positions = positions(&scene, false, WIDTH, 4);
        for (pixel, of_pixel) in positions.chunks(samples as usize).enumerate() {
            let mut count = vec![0; samples as usize];
            // Stratum c begins at floor(c · 2²⁴ / n).
            let cell =
                |p: u32| (0..side).rfind(|&c| ((u64::from(c) << 24) / u64::from(side)) as u32 <= p).unwrap();
            for p in of_pixel {
                count[(cell(p[1]) * side + cell(p[0])) as usize] += 1;
            }
            assert!(count.iter().all(|&c| c == 1), "n = {side}, pixel {pixel}: {count:?}");
        }
    }
}

#[test]
fn shared_sets_are_one_for_all_pixels_and_another_for_another_seed() {
    let set = |shared, seed| {
        let scene = scene(Pattern::Stratified, 4, shared, seed, 16);
        positions(&scene, false, WIDTH, 20)
    };
    let shared = set(true, 1);
    assert!(shared.chunks(16).all(|pixel| pixel == &shared[..16]));
    let own = set(false, 1);
    let pixels: Vec<&[[u32; 2]]> = own.chunks(16).collect();
    assert!((0..20).all(|i| (0..i).all(|j| pixels[i] != pixels[j])), "two pixels have one set");
    for seed in [0, 2, 3, u32::MAX] {
        assert_ne!(shared[..16], set(true, seed)[..16], "seed {seed}");
        assert_ne!(own, set(false, seed), "seed {seed}");
    }
}

/// χ² of counts against equal expectation, and its quantile at the given normal deviate (Wilson &
/// Hilferty 1931).
fn chi_square(values: impl Iterator<Item = usize>, bins: usize) -> (f64, f64, f64) {
    let mut counts = vec![0.0f64; bins];
    values.for_each(|v| counts[v] += 1.0);
    let mean = counts.iter().sum::<f64>() / bins as f64;
    let statistic = counts.iter().map(|c| (c - mean).powi(2) / mean).sum();
    let df = (bins - 1) as f64;
    let quantile = |z: f64| df * (1.0 - 2.0 / (9.0 * df) + z * (2.0 / (9.0 * df)).sqrt()).powi(3);
    (statistic, quantile(-4.75), quantile(4.75)) // p = 1e-6 on either side
}

pub fn assert_uniform(what: &str, values: impl Iterator<Item = usize>, bins: usize) {
    let (statistic, low, high) = chi_square(values, bins);
    assert!(
        statistic > low && statistic < high,
        "{what}: chi square {statistic}, not in {low}..{high} (p = 1e-6)"
    );
}

/// Correlation of two equally long lists of numbers, as a multiple of its sigma 1/√N.
fn correlation_sigmas(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
    let (ma, mb) = (mean(a), mean(b));
    let cov: f64 = a.iter().zip(b).map(|(x, y)| (x - ma) * (y - mb)).sum();
    let var = |v: &[f64], m: f64| v.iter().map(|x| (x - m).powi(2)).sum::<f64>();
    cov / (var(a, ma) * var(b, mb)).sqrt() * n.sqrt()
}

/// Jitter in [0, 1) of each sample of `pixels` pixels, 512 wide, on both axes: 4 × 4 strata.
fn jitter(pixels: u32, pattern: Pattern) -> Vec<[f64; 2]> {
    let scene = scene(pattern, 4, false, 9, 16);
    let positions = positions(&scene, false, 512, pixels);
    let cells = if pattern == Pattern::Random { 1.0 } else { 4.0 };
    positions.iter().map(|p| p.map(|x| (f64::from(x) * cells / f64::from(1 << 24)).fract())).collect()
}

#[test]
fn jitter_is_uniform_on_each_axis_and_in_the_square() {
    for pattern in [Pattern::Stratified, Pattern::Random] {
        let all = jitter(512 * 32, pattern);
        for axis in [0, 1] {
            let bins = |v: f64| (v * 64.0) as usize;
            assert_uniform(&format!("{pattern} axis {axis}"), all.iter().map(|j| bins(j[axis])), 64);
            // One sample of every pixel: the key must be well distributed by itself.
            assert_uniform(
                &format!("{pattern} sample 0, axis {axis}"),
                all.iter().step_by(16).map(|j| bins(j[axis])),
                64,
            );
            // Low bits too: deep zooms magnify pixels to them.
            let low = |v: f64| (v * 16_777_216.0 / 4.0) as usize % 64;
            assert_uniform(&format!("{pattern} low bits, axis {axis}"), all.iter().map(|j| low(j[axis])), 64);
        }
        let square = all.iter().map(|j| (j[0] * 16.0) as usize * 16 + (j[1] * 16.0) as usize);
        assert_uniform(&format!("{pattern} in the square"), square, 256);
    }
    // Many samples of one pixel.
    let many = scene(Pattern::Random, 1, false, 4, 1 << 18);
    let positions = positions(&many, false, 1, 1);
    for axis in [0, 1] {
        assert_uniform("one pixel", positions.iter().map(|p| (p[axis] >> 18) as usize), 64);
    }
}

#[test]
fn neighbouring_samples_pixels_rows_and_axes_are_uncorrelated() {
    let all = jitter(512 * 32, Pattern::Stratified);
    let axis = |a: usize| -> Vec<f64> { all.iter().map(|j| j[a]).collect() };
    let (x, y) = (axis(0), axis(1));
    // (what, distance in the list)
    let distances =
        [("samples", 1), ("strata rows", 4), ("pixels", 16), ("second pixels", 32), ("rows", 512 * 16)];
    let mut found = vec![("axes".to_string(), correlation_sigmas(&x, &y))];
    for (what, distance) in distances {
        let n = x.len() - distance;
        for (name, a, b) in [("x x", &x, &x), ("y y", &y, &y), ("x y", &x, &y), ("y x", &y, &x)] {
            found.push((format!("{what} {name}"), correlation_sigmas(&a[..n], &b[distance..])));
        }
    }
    for (what, sigmas) in found {
        assert!(sigmas.abs() < 5.0, "{what}: {sigmas} sigma"); // p = 6e-7 each
    }
}

#[test]
fn the_statistical_testers_find_what_they_look_for() {
    let ramp: Vec<f64> = (0..10_000).map(|i| f64::from(i % 100) / 100.0).collect();
    assert!(correlation_sigmas(&ramp[1..], &ramp[..9_999]) > 5.0);
    let noise: Vec<f64> =
        (0..10_000).map(|i| f64::from(sample_bits([7, 9], i)[0] >> 8) / 16_777_216.0).collect();
    assert!(correlation_sigmas(&noise[1..], &noise[..9_999]).abs() < 5.0);
    let (statistic, _, high) = chi_square(noise.iter().map(|v| (v * v * 64.0) as usize), 64);
    assert!(statistic > high, "squares pass for uniform");
    let (statistic, low, _) = chi_square((0..6_400).map(|i| i % 64), 64);
    assert!(statistic < low, "a comb passes for random");
}

/// The variance of the mean of N independent numbers is theirs / N: sums of N consecutive samples over many
/// pixels, of each coordinate and of the first frequency of each.
#[test]
fn means_of_random_samples_spread_as_those_of_independent_numbers() {
    const PIXELS: u32 = 4096;
    for n in [16, 64, 256, 1024] {
        let mut squares = [0.0; 4];
        for pixel in 0..PIXELS {
            let key = pixel_key([pixel % 64, pixel / 64], 1, false);
            let mut sums = [0.0; 4];
            for s in 0..n {
                let [x, y] = sample_bits(key, s).map(|b| f64::from(b) / 4_294_967_296.0);
                let wave = |x: f64| (std::f64::consts::TAU * x).cos();
                let deviates = [(x - 0.5) * 12f64.sqrt(), (y - 0.5) * 12f64.sqrt(), wave(x), wave(y)];
                sums.iter_mut().zip(deviates).for_each(|(sum, d)| *sum += d);
            }
            squares.iter_mut().zip(sums).for_each(|(square, sum)| *square += sum * sum / f64::from(n));
        }
        for (what, square, variance) in [
            ("x", squares[0], 1.0),
            ("y", squares[1], 1.0),
            ("cos x", squares[2], 0.5),
            ("cos y", squares[3], 0.5),
        ] {
            // A square of a normal deviate varies by 2: 5 sigma.
            let ratio = square / f64::from(PIXELS) / variance;
            let sigma = (2.0 / f64::from(PIXELS)).sqrt();
            assert!((ratio - 1.0).abs() < 5.0 * sigma, "{what} of {n}: {ratio} of what is independent");
        }
    }
}
