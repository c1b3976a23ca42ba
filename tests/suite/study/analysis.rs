//! Slopes, winners and times to errors of synthetic points with known answers.

use moire::internal::lab::plot::axis::steps;
use moire::internal::lab::study::analysis::{
    MethodSlope, Slope, median, recommended, slope, time_to, winners,
};
use moire::internal::lab::study::choice::not_significantly_different;
use moire::internal::lab::study::record::{Errors, PointRecord, ReferenceRecord};
use moire::internal::oracle::rng::mix_bits;

/// A reference without error.
const EXACT: ReferenceRecord = ReferenceRecord {
    hash: String::new(),
    kind: String::new(),
    file: String::new(),
    samples: 0,
    seconds: 0.0,
    rmse: None,
    blocks: Vec::new(),
};

/// RMSE whose square falls with this slope, with a ripple of some per cent as measured points have.
fn curve(exponent: f64, ripple: f64) -> Vec<(f64, f64)> {
    let wave = [1.0, -0.7, 0.2, -1.0, 0.6];
    let one = |(i, n): (usize, &f64)| (*n, 0.3 * n.powf(0.5 * exponent) * (1.0 + ripple * wave[i]));
    [1.0, 4.0, 16.0, 64.0, 256.0].iter().enumerate().map(one).collect()
}

fn holds(slope: &Slope, value: f64) -> bool {
    (slope.value - value).abs() <= slope.half_width.unwrap_or(0.0) + 1e-9
}

#[test]
fn theoretical_slopes_are_recovered_within_their_intervals() {
    for exponent in [-1.0, -1.5, -2.0] {
        let exact = slope(&curve(exponent, 0.0), 0.0).unwrap();
        assert!((exact.value - exponent).abs() < 1e-9, "{exact:?}");
        assert_eq!((exact.half_width, exact.points), (None, 5));
        let rippled = slope(&curve(exponent, 0.04), 0.0).unwrap();
        assert!(holds(&rippled, exponent), "{exponent}: {rippled:?}");
        assert!(rippled.half_width.unwrap() < 0.1, "{rippled:?}");
    }
}

#[test]
fn planted_wrong_slopes_lie_outside_the_intervals() {
    for (planted, claimed) in [(-1.0, -1.5), (-1.5, -2.0), (-1.25, -1.0), (-2.0, -1.5)] {
        let fitted = slope(&curve(planted, 0.04), 0.0).unwrap();
        assert!(!holds(&fitted, claimed), "{planted} passes for {claimed}: {fitted:?}");
    }
}

#[test]
fn points_at_the_references_own_error_bend_no_slope() {
    let floor = 0.01;
    let bent = |(n, e): (f64, f64)| (n, e.hypot(floor));
    let points: Vec<(f64, f64)> = curve(-1.5, 0.0).into_iter().map(bent).collect();
    let blind = slope(&points, 0.0).unwrap();
    assert!(blind.value > -1.4, "the planted floor does not shape_operator: {blind:?}");
    let fitted = slope(&points, floor).unwrap();
    assert!(fitted.points < 5 && (fitted.value + 1.5).abs() < 0.05, "{fitted:?}");
}

#[test]
fn two_points_or_one_count_have_no_slope() {
    assert_eq!(slope(&curve(-1.0, 0.0)[..2], 0.0), None);
    assert_eq!(slope(&[(4.0, 0.1), (4.0, 0.2), (4.0, 0.3)], 0.0), None);
    assert_eq!(slope(&[(1.0, 0.0), (4.0, f64::NAN), (16.0, 0.1)], 0.0), None);
}

fn point(method: &str, spp: u32, seconds: f64, rmse: f64) -> PointRecord {
    PointRecord {
        method: method.into(),
        spp,
        samples: spp,
        seconds: vec![seconds * 3.0, seconds, seconds * 0.5],
        errors: Errors { rmse, ..Errors::default() },
        ..PointRecord::default()
    }
}

fn law(method: &str, value: f64, theory: &[f64]) -> MethodSlope {
    MethodSlope {
        method: method.into(),
        fitted: Some(Slope { value, half_width: None, points: 3 }),
        interval: None,
        theory: theory.to_vec(),
        theory_text: String::new(),
    }
}

#[test]
fn each_budget_is_won_by_the_least_error_that_fits_into_it() {
    let points = [
        point("fast", 1, 0.001, 0.2),
        point("fast", 4, 0.004, 0.15),
        point("good", 1, 0.003, 0.1),
        point("good", 4, 0.012, 0.05),
    ];
    let table: Vec<(f64, String, u32)> =
        winners(&points, &[], &EXACT).into_iter().map(|w| (w.budget, w.method, w.spp)).collect();
    let expected =
        [(0.001, "fast", 1), (0.002, "fast", 1), (0.005, "good", 1), (0.01, "good", 1), (0.02, "good", 4)];
    assert_eq!(table.len(), expected.len(), "{table:?}");
    for ((budget, method, spp), (b, m, s)) in table.iter().zip(expected) {
        assert!((budget / b - 1.0).abs() < 1e-9 && method == m && *spp == s, "{table:?}");
    }
}

#[test]
fn slow_method_does_not_win_the_times_in_which_nothing_else_was_measured() {
    let points =
        [point("fast", 16, 0.01, 0.02), point("fast", 64, 0.04, 0.01), point("slow", 64, 1.0, 0.009)];
    let last = |slopes: &[MethodSlope]| winners(&points, slopes, &EXACT).pop().unwrap();
    assert_eq!(last(&[]).method, "slow");
    let found = last(&[law("fast", -1.0, &[-1.0])]);
    // Of 25 times the time no more than four times are believed: half of the error.
    assert!(found.method == "fast" && found.estimated && (found.rmse - 0.005).abs() < 1e-4, "{found:?}");
    assert!((255..=256).contains(&found.spp) && (found.seconds - 0.16).abs() < 1e-3, "{found:?}");
    // Without a law there is no extrapolation.
    assert_eq!(last(&[law("fast", -1.0, &[])]).method, "slow");
}

#[test]
fn no_measured_point_beats_the_recommended_one_in_both_error_and_time() {
    let random = |seed: u32, k: u32| f64::from(mix_bits(mix_bits(seed) ^ k)) / f64::from(u32::MAX);
    for seed in 0..300 {
        let methods = ["random", "stratified", "adaptive", "cone"];
        let points: Vec<PointRecord> = (0..12)
            .map(|i| {
                let [time, error] = [random(seed, 2 * i), random(seed, 2 * i + 1)];
                let method = methods[(random(seed, 100 + i) * 3.999) as usize];
                point(method, 4 + i, 1e-3 * 1e3f64.powf(time), 1e-3 * 1e2f64.powf(error))
            })
            .collect();
        // Steep laws: most of the longer times are won by extrapolated points.
        let slopes =
            ["random", "stratified", "adaptive"].map(|m| law(m, -1.0 - 2.0 * random(seed, 7), &[-1.0]));
        for slopes in [&[][..], &slopes] {
            let best = recommended(&points, &winners(&points, slopes, &EXACT)).unwrap();
            let beats = |p: &&PointRecord| {
                p.median_seconds() < best.median_seconds() && p.errors.rmse < best.errors.rmse
            };
            assert_eq!(points.iter().find(beats), None, "{seed}: beats {best:?}");
        }
    }
}

#[test]
fn method_that_wins_only_beyond_what_was_measured_is_not_recommended_with_a_beaten_point() {
    let points = [
        point("sobol-owen", 256, 0.1, 0.01),
        point("adaptive", 64, 0.1 - 1e-6, 0.0025),
        point("adaptive", 256, 0.4, 0.0009),
    ];
    let best = recommended(&points, &winners(&points, &[law("sobol-owen", -6.0, &[-3.0])], &EXACT)).unwrap();
    assert_eq!((best.method.as_str(), best.spp), ("adaptive", 256));
}

#[test]
fn equal_pictures_and_errors_that_noise_explains_are_named_together() {
    let with = |method: &str, seconds: f64, picture: &str, blocks: &[f32]| PointRecord {
        picture: picture.into(),
        blocks: blocks.to_vec(),
        ..point(method, 1, seconds, f64::from(blocks.iter().sum::<f32>()).sqrt())
    };
    let a = [1.0, 2.0, 3.0, 4.0, 2.0, 1.0, 3.0, 2.0f32];
    let nearly = [1.1, 1.9, 3.2, 3.7, 2.1, 1.0, 2.9, 2.2];
    let more = a.map(|b| b * 2.0);
    let points = [
        with("center", 0.010, "p", &a),
        with("grid", 0.011, "p", &a),
        with("random", 0.009, "q", &more),
        with("halton", 0.009, "r", &nearly),
        with("slow", 0.05, "t", &nearly),
    ];
    assert!(
        not_significantly_different(&points[0], &points[1])
            && not_significantly_different(&points[0], &points[3])
    );
    assert!(
        !not_significantly_different(&points[0], &points[2])
            && !not_significantly_different(&points[2], &points[3])
    );
    // In 10 ms grid does not fit by its median, but it took as long as centre in some repeat.
    for winner in winners(&points, &[], &EXACT).iter().filter(|w| w.budget > 0.0099) {
        for method in ["center", "grid", "halton"] {
            assert!(winner.is_or_ties(method), "{method} in {winner:?}");
        }
        assert!(!winner.is_or_ties("random"), "{winner:?}");
        // Five times as long is no tie, though its shortest repeat is shorter than the longest of centre.
        assert_eq!(winner.is_or_ties("slow"), winner.budget > 0.049, "{winner:?}");
    }
    // A part whose error is a hundred times that of the others masks nothing.
    let skewed = |factor: f32| -> Vec<f32> {
        a.iter().enumerate().map(|(i, b)| b * factor * if i == 3 { 100.0 } else { 1.0 }).collect()
    };
    assert!(!not_significantly_different(
        &with("a", 0.01, "s", &skewed(1.0)),
        &with("b", 0.01, "t", &skewed(1.5))
    ));
    let unknown = point("old", 1, 0.01, 0.1);
    assert!(!not_significantly_different(&unknown, &unknown), "without parts and picture nothing is known");
}

#[test]
fn time_to_an_error_lies_on_the_line_between_the_logarithms() {
    let curve = [(1.0, 0.1), (100.0, 0.01), (1000.0, 0.02)];
    assert!((time_to(&curve, 0.1_f64.powf(1.5)).unwrap() - 10.0).abs() < 1e-9);
    assert_eq!(time_to(&curve, 0.5), Some(1.0));
    assert_eq!(time_to(&curve, 0.001), None);
    assert_eq!(time_to(&[], 0.1), None);
}

#[test]
fn steps_are_1_2_5_and_cover_the_range() {
    let close = |found: &[f64], expected: &[f64]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(f, e)| (f / e - 1.0).abs() < 1e-9)
    };
    assert!(close(&steps(0.003, 0.07), &[0.005, 0.01, 0.02, 0.05, 0.1]), "{:?}", steps(0.003, 0.07));
    assert!(close(&steps(1.0, 10.0), &[1.0, 2.0, 5.0, 10.0]));
    assert!(steps(f64::INFINITY, 0.0).is_empty() && steps(0.0, 1.0).is_empty());
}

#[test]
fn median_is_the_middle_of_any_number() {
    assert_eq!([&[3.0, 1.0, 2.0][..], &[4.0, 1.0], &[5.0]].map(median), [2.0, 2.5, 5.0]);
    assert!(median(&[]).is_nan());
}
