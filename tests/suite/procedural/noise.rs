//! Noise: zero at lattice points, in range, of known mean, smooth across cells everywhere, different
//! by seed; the statistics that its filter relies on.

use glam::DVec3;
use moire::internal::oracle::noise::{
    FOLDED_MEAN, FOLDED_VARIANCE, NOISE_VARIANCE, cell_distance, cell_mean, gradient_noise,
};
use moire::internal::texture::procedural::ProceduralKind::{self, *};

use super::{HARD_EDGED, default_record, record, share_at};
use crate::lookup::bench::{Rng, Vectors};

const SMOOTH: [ProceduralKind; 6] = [Noise, Fbm, Turbulence, Marble, Wood, Cellular];

#[test]
fn noise_is_zero_at_lattice_points() {
    let what = default_record(Noise);
    for p in [[0, 0, 0], [1, -5, 3], [1_000_000, -1_000_000, 7]] {
        let p = DVec3::from_array(p.map(f64::from));
        assert_eq!(share_at(&what, p), 0.5, "{p}");
    }
}

#[test]
fn every_smooth_pattern_stays_in_range_and_uses_most_of_it() {
    for kind in SMOOTH {
        let what = default_record(kind);
        let mut rng = Rng::new(10 + kind as u64);
        let values: Vec<f64> = (0..20_000).map(|_| share_at(&what, rng.vector(50.0))).collect();
        let low = values.iter().copied().fold(1.0, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        assert!(low >= 0.0 && high <= 1.0, "{kind}: {low} to {high}");
        assert!(high - low > 0.5, "{kind} is flat: {low} to {high}");
    }
}

#[test]
fn statistics_of_noise_are_those_that_its_filter_fades_to() {
    let mut rng = Rng::new(20);
    let n = 200_000;
    let values: Vec<f64> = (0..n).map(|_| gradient_noise(rng.vector(300.0), [7, 8, 9])).collect();
    let mean = |f: &dyn Fn(f64) -> f64| values.iter().map(|v| f(*v)).sum::<f64>() / f64::from(n);
    // 5 standard deviations of the mean of 2·10⁵ values: 0.27, 0.11 and 0.156 over √n.
    let deviation = |x: f64| 5.0 * x / f64::from(n).sqrt();
    assert!(mean(&|v| v).abs() < deviation(0.27), "mean {}", mean(&|v| v));
    assert!((mean(&|v| v * v) - NOISE_VARIANCE).abs() < deviation(0.11), "{}", mean(&|v| v * v));
    let folded = mean(&f64::abs);
    assert!((folded - FOLDED_MEAN).abs() < deviation(0.156), "{folded}");
    let variance = mean(&|v| (v.abs() - folded).powi(2));
    assert!((variance - FOLDED_VARIANCE).abs() < deviation(0.05), "{variance}");
}

/// In the volume, and on planes through and between the points of the lattice.
#[test]
fn mean_distance_of_cells_is_that_of_its_polynomial() {
    for jitter in [0.0, 0.5, 1.0] {
        for plane in [None, Some(0.0), Some(0.25), Some(0.5)] {
            let mut rng = Rng::new(30);
            let n = 40_000;
            let mut sum = 0.0;
            for _ in 0..n {
                let p = rng.vector(300.0);
                sum += cell_distance(DVec3::new(p.x, p.y, plane.unwrap_or(p.z)), 3, jitter);
            }
            let reach = DVec3::new(9.0, 9.0, if plane.is_some() { 0.0 } else { 9.0 });
            let expected = cell_mean(DVec3::new(0.1, 0.2, plane.unwrap_or(0.3)), reach, jitter);
            let found = sum / f64::from(n);
            // The polynomial's own error, and 4 standard deviations of a mean, 4 · 0.17 / √n.
            assert!((found - expected).abs() < 0.015, "{jitter}, {plane:?}: {found}, expected {expected}");
        }
    }
}

/// 1e-4 over a step of 2e-6 is a slope of 50; marble's is the steepest, π · (1 + 4 · 2.5) = 35 where all
/// five octaves of its turbulence rise by one a cell.
#[test]
fn smooth_patterns_have_no_seams() {
    for kind in SMOOTH {
        let what = default_record(kind);
        let mut rng = Rng::new(40 + kind as u64);
        for i in 0..6000 {
            let far = [1.0, 30.0, 1e6][i % 3];
            let mut p = rng.vector(far).floor() * if i % 2 == 0 { 1.0 } else { 0.5 };
            let axis = i % 3;
            p[(axis + 1) % 3] += rng.unit();
            p[(axis + 2) % 3] += rng.unit();
            let step = 1e-6 * DVec3::AXES[axis];
            let (before, after) = (share_at(&what, p - step), share_at(&what, p + step));
            assert!((before - after).abs() < 1e-4, "{kind} steps from {before} to {after} at {p}");
        }
    }
}

#[test]
fn seeds_differ_and_repeat() {
    for kind in SMOOTH {
        let [a, b, c] = [1, 2, 1].map(|seed| record(kind, |t| t.seed = seed));
        let mut rng = Rng::new(50);
        let points: Vec<DVec3> = (0..100).map(|_| rng.vector(20.0)).collect();
        let values = |what| points.iter().map(|p| share_at(what, *p)).collect::<Vec<_>>();
        assert_eq!(values(&a), values(&c), "{kind}");
        let same = values(&a).iter().zip(values(&b)).filter(|(x, y)| *x == y).count();
        assert!(same < 3, "{kind}: {same} of 100 values do not depend on the seed");
    }
}

/// Values computed once: the pattern of a seed never changes.
#[test]
fn a_seed_means_the_same_lattice_for_ever() {
    let p = DVec3::new(0.3, -1.7, 5.2);
    let found = [Noise, Fbm, Turbulence, Marble, Wood, Cellular]
        .map(|kind| share_at(&record(kind, |t| t.seed = 42), p));
    let expected = [
        0.502_351_584_847,
        0.465_138_779_201,
        0.091_078_448_466,
        0.070_730_364_675,
        0.693_187_741_081,
        0.446_039_772_451,
    ];
    for ((found, expected), kind) in found.iter().zip(expected).zip(SMOOTH) {
        assert!((found - expected).abs() < 1e-9, "{kind}: {found}");
    }
}

#[test]
fn hard_edged_patterns_are_not_random() {
    for kind in HARD_EDGED {
        let [a, b] = [1, 2].map(|seed| record(kind, |t| t.seed = seed));
        let mut rng = Rng::new(60);
        assert!((0..100).map(|_| rng.vector(20.0)).all(|p| share_at(&a, p) == share_at(&b, p)), "{kind}");
    }
}
