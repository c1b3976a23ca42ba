//! Points are uniform, and those of different pixels, dimension pairs and seeds are independent.

use moire::internal::scene::model::Pattern;

use super::{SCATTERED, set, unit};
use crate::strata::assert_uniform;

const COUNT: u32 = 16;

/// The points of 4096 independent sets: another seed each.
fn of_seeds(pattern: Pattern, pair: u32) -> Vec<Vec<[f64; 2]>> {
    (0..4096).map(|seed| unit(&set(pattern, COUNT, seed, [1, 2], pair))).collect()
}

#[test]
fn every_sample_is_uniform_over_the_pixel() {
    for pattern in SCATTERED {
        // The stratum is determined by the sample's index.
        let fixed = matches!(pattern, Pattern::Stratified);
        let rows_fixed = fixed || matches!(pattern, Pattern::MultiJittered | Pattern::NRooks);
        for pair in [0, 1] {
            let sets = of_seeds(pattern, pair);
            for s in [0, 3, 15] {
                let of_sample = |axis: usize| sets.iter().map(move |set| set[s][axis]);
                let what = |axis: &str| format!("{pattern}, pair {pair}, sample {s}, {axis}");
                if !fixed || pair > 0 {
                    assert_uniform(&what("x"), of_sample(0).map(|x| (x * 64.0) as usize), 64);
                }
                if !rows_fixed || pair > 0 {
                    assert_uniform(&what("y"), of_sample(1).map(|x| (x * 64.0) as usize), 64);
                    let square =
                        sets.iter().map(|set| (set[s][0] * 8.0) as usize * 8 + (set[s][1] * 8.0) as usize);
                    assert_uniform(&what("square"), square, 64);
                }
                for axis in [0, 1] {
                    // The lowest six of 24 bits.
                    let low = of_sample(axis).map(|x| (x * 16_777_216.0) as usize % 64);
                    assert_uniform(&what("low bits"), low, 64);
                }
            }
        }
    }
}

/// Returns the mean over its sigma, estimated from the values, and their variance.
fn mean_in_sigmas(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean / (variance / n).sqrt(), variance)
}

/// Blue noise is the exception, by design.
#[test]
fn neighbouring_pixels_and_seeds_are_uncorrelated() {
    for pattern in SCATTERED {
        for (what, next) in [("right", [1, 0]), ("below", [0, 1]), ("seed", [0, 0])] {
            if pattern == Pattern::BlueNoise && what != "seed" {
                continue;
            }
            let mut sums = [vec![], vec![]];
            for i in 0..4096 {
                let pixel = [2 * (i % 64), 2 * (i / 64)];
                let (seed, other) = if what == "seed" { (2 * i, 2 * i + 1) } else { (1, 1) };
                let here = unit(&set(pattern, 4, seed, pixel, 0));
                let there = unit(&set(pattern, 4, other, [pixel[0] + next[0], pixel[1] + next[1]], 0));
                // The position in the stratum, if the stratum is fixed.
                let fixed = pattern == Pattern::Stratified;
                let centred = |x: f64| if fixed { (2.0 * x).fract() - 0.5 } else { x - 0.5 };
                let product = |s: usize, t: usize| centred(here[s][0]) * centred(there[t][0]);
                sums[0].push((0..4).map(|s| product(s, s)).sum::<f64>());
                sums[1].push((0..4).map(|s| product(s, 3 - s)).sum::<f64>());
            }
            for (of, sums) in [("same", &sums[0]), ("other", &sums[1])] {
                let (sigmas, _) = mean_in_sigmas(sums);
                assert!(sigmas.abs() < 5.0, "{pattern}, {what}, {of} sample: {sigmas} sigma"); // p = 6e-7 each
            }
        }
    }
}

/// Σ (a - ½)(b - ½) over a set's samples has mean 0 over seeds, and is as small as for random pairs.
#[test]
fn pairs_are_uncorrelated() {
    for pattern in SCATTERED {
        let pairs = [0, 1, 2].map(|pair| of_seeds(pattern, pair));
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            for (a, b) in [(0, 0), (1, 1), (0, 1), (1, 0)] {
                let product = |(p, q): (&[f64; 2], &[f64; 2])| (p[a] - 0.5) * (q[b] - 0.5);
                let sums: Vec<f64> = pairs[i]
                    .iter()
                    .zip(&pairs[j])
                    .map(|(p, q)| p.iter().zip(q).map(product).sum::<f64>())
                    .collect();
                let (sigmas, variance) = mean_in_sigmas(&sums);
                let what = format!("{pattern}, pairs {i} {j}, axes {a} {b}");
                assert!(sigmas.abs() < 5.0, "{what}: {sigmas} sigma"); // p = 6e-7 each
                // Of independent pairs 16 · (1/12)²; twice that is 60 of its sigmas away.
                let ratio = variance / (f64::from(COUNT) / 144.0);
                assert!(ratio < 2.0, "{what}: {ratio} times the variance of random pairs");
            }
        }
    }
}
