//! Errors without the reference's own: what is recovered of a planted error, and that no method wins by the noise of the
//! reference or by an extrapolation that is less certain than its lead.

use moire::internal::core::film::Film;
use moire::internal::lab::study::analysis::{MethodSlope, Slope, winners};
use moire::internal::lab::study::bootstrap::blocks;
use moire::internal::lab::study::record::{Errors, PointRecord, ReferenceRecord};
use moire::internal::lab::study::results::OwnError;
use moire::internal::oracle::rng::mix_bits;

const SIZE: [u32; 2] = [96, 64];

/// A picture of grey with uniform noise of this standard deviation, another one for each seed.
fn noisy(deviation: f64, seed: u32) -> Film {
    let mut film = Film::new(SIZE[0], SIZE[1], 1);
    let draw = |i: u32| f64::from(mix_bits(mix_bits(seed) ^ i)) / f64::from(u32::MAX) - 0.5;
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let of = |c: u32| (0.5 + deviation * 12f64.sqrt() * draw(3 * i as u32 + c)) as f32;
        *pixel = [0, 1, 2].map(of);
    }
    film
}

fn rmse(parts: &[f32]) -> f64 {
    (parts.iter().map(|p| f64::from(*p)).sum::<f64>() / f64::from(3 * SIZE[0] * SIZE[1])).sqrt()
}

/// A reference of two halves with this noise each, as a picture and as a record.
fn reference(deviation: f64) -> (Film, ReferenceRecord) {
    let [a, b] = [11, 12].map(|seed| noisy(deviation, seed));
    let mut mean = a.clone();
    for (pixel, other) in mean.pixels.iter_mut().zip(&b.pixels) {
        (0..3).for_each(|c| pixel[c] = 0.5 * (pixel[c] + other[c]));
    }
    let parts: Vec<f32> = blocks(&a, &b).into_iter().map(|sum| 0.25 * sum).collect();
    (mean, ReferenceRecord { rmse: Some(rmse(&parts)), blocks: parts, ..ReferenceRecord::default() })
}

/// A point with a picture that errs by this noise.
fn point(
    method: &str,
    spp: u32,
    seconds: f64,
    deviation: f64,
    against: &(Film, ReferenceRecord),
) -> PointRecord {
    let parts = blocks(&noisy(deviation, spp + 100 * method.len() as u32), &against.0);
    let rmse = rmse(&parts);
    PointRecord {
        method: method.into(),
        spp,
        samples: spp,
        picture: format!("{method} {spp}"),
        seconds: vec![seconds],
        errors: Errors { rmse, ..Errors::default() },
        own: Some(OwnError::of(rmse, &parts, &against.1)),
        blocks: parts,
        ..PointRecord::default()
    }
}

fn law(method: &str, value: f64, half_width: f64) -> MethodSlope {
    MethodSlope {
        method: method.into(),
        fitted: Some(Slope { value, half_width: Some(half_width), points: 3 }),
        interval: None,
        theory: vec![-1.0],
        theory_text: String::new(),
    }
}

#[test]
fn an_error_is_recovered_from_under_the_noise_of_the_reference() {
    // Halves that err by 0.02 have a mean that errs by 0.014.
    let against = reference(0.02);
    for planted in [0.05, 0.014, 0.005] {
        let found = point("random", 4, 1.0, planted, &against);
        let own = found.own();
        assert!(
            (found.errors.rmse - planted.hypot(0.02 / 2f64.sqrt())).abs() < 3e-4,
            "{}",
            found.errors.rmse
        );
        assert!(own.low <= planted && planted <= own.high, "{planted}: {own:?}");
        assert!(own.is_known() && own.high - own.low < 0.5 * planted, "{planted}: {own:?}");
        assert!(found.errors.rmse > own.high || planted > 0.04, "the noise of the reference is in {own:?}");
    }
    let none = point("beam", 1, 1.0, 0.0, &against).own();
    assert!(!none.is_known() && none.high < 0.003, "a picture without error errs by {none:?}");
}

#[test]
fn nothing_wins_by_the_noise_of_the_reference() {
    let against = reference(0.02);
    // What is without error errs, with the noise, by 0.014; the other one's line goes on far below that.
    let points = [
        point("random", 4, 0.05, 0.08, &against),
        point("random", 16, 0.2, 0.04, &against),
        point("random", 64, 0.8, 0.02, &against),
        point("beam", 1, 2.0, 0.0, &against),
    ];
    let laws = [law("random", -1.0, 0.01)];
    let last = |points: &[PointRecord]| winners(points, &laws, &against.1).pop().unwrap();
    let found = last(&points);
    assert!(found.method == "beam" && !found.estimated, "{found:?}");
    assert!(found.interval[0] == 0.0 && found.interval[1] < 0.003, "{found:?}");
    // No estimate is below the reference's own error, however steep the line.
    let worse = [&points[..3], &[point("cone", 1, 2.0, 0.06, &against)]].concat();
    let steep = winners(&worse, &[law("random", -3.0, 0.01)], &against.1).pop().unwrap();
    assert!(steep.estimated && steep.rmse >= against.1.rmse.unwrap() * 0.999, "{steep:?}");
    // A point at the reference's own error is no end of a line.
    let ended = [&points[..2], &[point("random", 64, 0.8, 0.004, &against), points[3].clone()]].concat();
    assert!(winners(&ended, &laws, &against.1).iter().all(|w| !w.estimated || w.budget < 0.8));
}

#[test]
fn an_extrapolation_wins_only_by_more_than_its_uncertainty() {
    let against = reference(0.001);
    let points = [
        point("random", 4, 0.1, 0.08, &against),
        point("random", 16, 0.4, 0.04, &against),
        point("cone", 1, 1.0, 0.03, &against),
    ];
    // With 32 samples of a second 0.028 is expected: 0.0265 to 0.030, or 0.02 to 0.04.
    let at = |half_width: f64| {
        let laws = [law("random", -1.0, half_width)];
        winners(&points, &laws, &against.1).into_iter().find(|w| (w.budget - 1.0).abs() < 1e-9).unwrap()
    };
    assert!(at(0.01).estimated && at(0.01).method == "random", "{:?}", at(0.01));
    assert!(at(0.01).interval[0] < at(0.01).rmse && at(0.01).rmse < at(0.01).interval[1]);
    assert!(!at(0.8).estimated && at(0.8).method == "cone", "{:?}", at(0.8));
    // Two lines that lead alike are named together.
    let twins =
        [&points[..], &[point("halton", 4, 0.1, 0.08, &against), point("halton", 16, 0.4, 0.04, &against)]];
    let laws = [law("random", -1.0, 0.05), law("halton", -1.0, 0.05)];
    let found = winners(&twins.concat(), &laws, &against.1);
    let found = found.iter().find(|w| (w.budget - 1.0).abs() < 1e-9).unwrap();
    assert!(found.is_or_ties("random") && found.is_or_ties("halton"), "{found:?}");
}
