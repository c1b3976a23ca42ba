//! Filtered lookups against the mean of many points of the footprint: exact for axis-aligned boxes,
//! close for oblique ones, the overall mean for infinite ones, the fraction before any difference
//! far from the origin; and a checker up to the horizon.

use glam::DVec3;
use moire::internal::oracle::procedural::{box_attenuation, figure_share, pulse_mean};
use moire::internal::schema::layout;
use moire::internal::texture::procedural::ProceduralKind::{self, *};

use super::{HARD_EDGED, default_record, mean_of_points, share_at};
use crate::lookup::bench::{Rng, Vectors};

/// The integral of the pulse train from 0 to x, by its definition.
fn integral(x: f64, duty: f64) -> f64 {
    let s = x + 0.5 * duty;
    s.floor() * duty + (s - s.floor()).min(duty)
}

#[test]
fn a_box_over_pulses_is_the_difference_of_their_integral() {
    let mut rng = Rng::new(1);
    for _ in 0..20_000 {
        let (x, w) = (rng.between(-5.0, 5.0), 10f64.powf(rng.between(-3.0, 2.0)));
        for duty in [0.0, 0.1, 0.5, 0.93, 1.0] {
            let expected = (integral(x + 0.5 * w, duty) - integral(x - 0.5 * w, duty)) / w;
            let found = pulse_mean(x, w, duty);
            // Differences of numbers up to 55, in f64, over 10⁻³.
            assert!((found - expected).abs() < 1e-10, "x {x}, w {w}, duty {duty}: {found}, {expected}");
        }
    }
}

#[test]
fn boxes_along_the_axes_are_exact() {
    let mut rng = Rng::new(2);
    for kind in HARD_EDGED {
        for _ in 0..12 {
            let at = rng.vector(5.0);
            let (dx, dy) = (rng.between(0.1, 4.0) * DVec3::X, rng.between(0.1, 4.0) * DVec3::Y);
            let what = default_record(kind);
            let points = mean_of_points(&what, at, dx, dy, 250, &mut rng);
            // An edge passes 250 of the 62 500 cells, whose points lie on either side by chance: with
            // 10 edges the deviation is √2500 / 2 / 62500 = 4e-4.
            let found = figure_share(&what, at, dx, dy);
            assert!((found - points).abs() < 2.5e-3, "{kind}: {found}, {points} at {at}, {dx}, {dy}");
        }
    }
}

/// (RMS error of the filter, of the point in the middle)
fn errors(what: &layout::Procedural, anisotropy: f64, size: f64, side: u32) -> (f64, f64) {
    let mut rng = Rng::new(3);
    let (mut filtered, mut plain) = (0.0, 0.0);
    let n = 120;
    for _ in 0..n {
        let at = rng.vector(9.0) * DVec3::new(1.0, 1.0, 0.0);
        let (sine, cosine) = rng.between(0.0, std::f64::consts::TAU).sin_cos();
        let shear = rng.between(-0.5, 0.5);
        let along = size * DVec3::new(cosine, sine, 0.0);
        let across = size / anisotropy * DVec3::new(-sine, cosine, 0.0);
        let (dx, dy) = (along + shear * across, across);
        let mean = mean_of_points(what, at, dx, dy, side, &mut rng);
        filtered += (figure_share(what, at, dx, dy) - mean).powi(2);
        plain += (share_at(what, at) - mean).powi(2);
    }
    ((filtered / f64::from(n)).sqrt(), (plain / f64::from(n)).sqrt())
}

/// Random footprints, up to 16 times as long as wide. Boxes along the axes approximate oblique parts: the
/// bounds are the error of that, measured as 0.05, 0.05 and 0.024 for the checker, where points are off by
/// 0.5.
#[test]
fn oblique_footprints_are_close_to_the_mean_of_their_points() {
    for kind in HARD_EDGED {
        for (anisotropy, size, bound) in
            [(1.0, 0.3, 0.04), (1.0, 2.0, 0.06), (4.0, 4.0, 0.06), (16.0, 8.0, 0.03)]
        {
            let (filtered, plain) = errors(&default_record(kind), anisotropy, size, 80);
            let told = format!("{kind}, {anisotropy} : 1, {size} long: {filtered}, unfiltered {plain}");
            assert!(filtered < bound && filtered < plain / 8.0, "{told}");
        }
    }
}

#[test]
fn noise_fades_towards_the_mean_of_its_footprint() {
    for kind in [Noise, Fbm, Turbulence, Marble, Wood, Cellular] {
        for size in [0.25, 0.5, 1.0, 2.0, 4.0] {
            let (filtered, plain) = errors(&default_record(kind), 1.0, size, 24);
            let most = if size < 1.0 { 0.9 } else { 0.6 };
            assert!(filtered < most * plain, "{kind}, {size} long: {filtered}, unfiltered {plain}");
        }
    }
}

/// Along every plane of the axes and in general position.
#[test]
fn endless_footprints_give_the_mean() {
    for kind in ProceduralKind::ALL {
        let what = default_record(*kind);
        for (at, dx, dy) in [
            (DVec3::new(0.3, 0.4, 0.0), DVec3::X, DVec3::Y),
            (DVec3::new(0.0, 0.4, 0.2), DVec3::Z, DVec3::Y),
            (DVec3::new(0.3, 0.7, 0.2), DVec3::new(0.5, 0.6, -0.7), DVec3::new(-0.8, 0.5, 0.3)),
        ] {
            // Brick and wood have no z; their mean along it is that of a line.
            if dx == DVec3::Z && matches!(kind, Brick | Wood | Grid | Stripes | Checker | Marble) {
                continue;
            }
            let mut rng = Rng::new(5);
            let points = mean_of_points(&what, at, 300.0 * dx, 300.0 * dy, 200, &mut rng);
            for size in [300.0, 1e4, 1e8] {
                let found = figure_share(&what, at, size * dx, size * dy);
                // 5 deviations of a mean of 4·10⁴ points, 0.5 each, and 0.007 of the noise's means on planes.
                assert!((found - points).abs() < 0.02, "{kind}, {dx}, {size}: {found}, {points}");
            }
        }
    }
}

#[test]
fn hard_edged_patterns_reach_their_exact_mean() {
    let shares = [(Checker, 0.5), (Stripes, 0.5), (Grid, 1.0 - 0.9 * 0.9), (Brick, 0.9 * (1.0 - 0.1 / 2.0))];
    for (kind, mean) in shares {
        let what = default_record(kind);
        for size in [1e4, 1e6, 1e8, 1e30] {
            let found = figure_share(&what, DVec3::new(0.2, 0.3, 0.0), size * DVec3::X, size * DVec3::Y);
            // The remainder of the last period, and the parameters' f32.
            assert!((found - mean).abs() < 1.0 / size + 1e-7, "{kind}, {size}: {found}, {mean}");
        }
    }
}

#[test]
fn a_sine_over_a_box_is_a_sinc() {
    for w in [0.0, 1e-4, 0.3, 0.5, 1.0, 1.5, 7.25] {
        let n = 20_000;
        let at = |i: i32| ((f64::from(i) + 0.5) / f64::from(n) - 0.5) * w + 0.25;
        let mean = (0..n).map(|i| (std::f64::consts::TAU * at(i)).sin()).sum::<f64>() / f64::from(n);
        // Below 10⁻³ the attenuation counts as 1: 1 − sinc is 1.6e-6 there.
        assert!((box_attenuation(w) - mean).abs() < 2e-6, "{w}: {}, {mean}", box_attenuation(w));
    }
}

/// Pixels below the horizon of a plane at height 1 under a pinhole: the point, and a pixel's footprint.
fn ground(x: u32, y: u32, sx: f64, sy: f64) -> (DVec3, DVec3, DVec3) {
    let (column, row) = (f64::from(x) + sx - 64.0, f64::from(y) + sy + 0.25);
    let depth = 60.0 / row;
    let at = DVec3::new(depth * column / 60.0 + 0.13, depth + 0.29, 0.0);
    let dx = DVec3::new(depth / 60.0, 0.0, 0.0);
    let dy = DVec3::new(-depth * column / 60.0 / row, -depth / row, 0.0);
    (at, dx, dy)
}

/// Boxes along the axes alone have errors 5 times lower than points; parts along the major axis had 12 times
/// lower ones.
#[test]
fn a_checker_to_the_horizon_loses_its_error_by_filtering() {
    let what = default_record(Checker);
    let mut rng = Rng::new(6);
    let (mut filtered, mut plain, mut pixels) = (0.0, 0.0, 0.0);
    for (x, y) in (0..64).flat_map(|y| (0..128).map(move |x| (x, y))) {
        let mut truth = 0.0;
        for i in 0..256 {
            let jitter = [f64::from(i % 16), f64::from(i / 16)].map(|c| (c + rng.unit()) / 16.0);
            truth += share_at(&what, ground(x, y, jitter[0], jitter[1]).0) / 256.0;
        }
        let (at, dx, dy) = ground(x, y, 0.5, 0.5);
        filtered += (figure_share(&what, at, dx, dy) - truth).powi(2);
        plain += (share_at(&what, at) - truth).powi(2);
        pixels += 1.0;
    }
    let [filtered, plain] = [filtered, plain].map(|sum: f64| (sum / pixels).sqrt());
    assert!(plain > 10.0 * filtered, "filtered {filtered}, unfiltered {plain}");
}
