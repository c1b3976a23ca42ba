//! Evaluation of the measured points (rays, seconds, error) of all methods: the slope of each
//! method's variance over its rays with 95 % intervals, the winner of each time budget and the
//! recommended point (`choice.rs`), the time to each error, and a summary.

use super::advice::advice;
use super::bootstrap::interval;
use super::choice::chosen;
pub use super::choice::{recommended, winners};
use super::fit::{Line, least_squares};
pub use super::fit::{median, time_to};
use super::record::{PointRecord, Record, ReferenceRecord};
use super::results::Steadiness;
pub use super::results::{Analysis, MethodSlope, Reach, RecommendedPoint, Slope};
use super::student;
use crate::lab::plot::axis::steps;

/// Points whose error, without the reference's own, is less than this multiple of it are excluded from slopes.
const FLOOR_MARGIN: f64 = 1.0;
/// The smallest number of points that define a slope.
const MIN_SLOPE_POINTS: usize = 3;

pub fn analyse(record: &Record) -> Analysis {
    let floor = record.reference.rmse.unwrap_or(0.0);
    let slope = |m: &super::record::MethodRecord| {
        let points: Vec<(f64, f64)> =
            record.points_of(&m.name).map(|p| (f64::from(p.samples), p.errors.rmse)).collect();
        let filtered = m.footprint != "none";
        let (theory, text) = theory(&m.pattern, filtered);
        MethodSlope {
            method: m.name.clone(),
            fitted: slope(&points, floor),
            interval: noise_interval(&record.points_of(&m.name).collect::<Vec<_>>(), &record.reference),
            theory: theory.to_vec(),
            theory_text: text.to_owned(),
        }
    };
    let slopes: Vec<MethodSlope> = record.methods.iter().map(slope).collect();
    let winners = winners(&record.points, &slopes, &record.reference);
    let best = chosen(record, &winners);
    Analysis {
        recommendation: advice(record, &winners),
        recommended: best.map(RecommendedPoint::of),
        steadiness: best.and_then(|best| Steadiness::of(record, best)),
        slopes,
        winners,
        reach: reach(record),
    }
}

/// Returns the slope of the variance over the number of samples: independent ones −1; one jittered
/// sample in each of n strata −1 if every stratum has variance, −1.5 if edges cross √n of them, −2
/// if the picture is smooth (Mitchell 1996); scrambled nets up to −3 (Owen 1997).
fn theory(pattern: &str, filtered: bool) -> (&'static [f64], &'static str) {
    match pattern {
        _ if filtered => (&[], "levels off where the filter blurs"),
        "center" => (&[], "none: one place, whatever the count"),
        "grid" => (&[], "none: aliases, as regular patterns do"),
        "random" => (&[-1.0], "−1"),
        "n-rooks" => (&[-1.0], "−1, less along the axes"),
        "sobol-owen" | "blue-noise" | "halton" => {
            (&[-1.0, -1.5, -2.0, -3.0], "−1 busy, −1.5 one edge, −2 to −3 smooth")
        }
        _ => (&[-1.0, -1.5, -2.0], "−1 busy, −1.5 one edge, −2 smooth"),
    }
}

/// Fits (rays, RMSE); the slope is that of the variance, RMSE², without that of the reference, whose RMSE is `floor`.
pub fn slope(points: &[(f64, f64)], floor: f64) -> Option<Slope> {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|p| is_above_floor(p.1, floor))
        .map(|p| (p.0.ln(), (p.1 * p.1 - floor * floor).ln()))
        .collect();
    if logs.len() < MIN_SLOPE_POINTS || logs.iter().all(|p| (p.0 - logs[0].0).abs() < 1e-5) {
        return None;
    }
    let Line { value, residual, sxx } = least_squares(&logs);
    let half_width = student::quantile(logs.len() - 2) * (residual / (logs.len() as f64 - 2.0) / sxx).sqrt();
    Some(Slope { value, half_width: (half_width > 1e-9).then_some(half_width), points: logs.len() })
}

/// Returns true if an error is due to the method more than to the reference.
fn is_above_floor(rmse: f64, floor: f64) -> bool {
    rmse * rmse > (1.0 + FLOOR_MARGIN * FLOOR_MARGIN) * floor * floor && rmse > 0.0 && rmse.is_finite()
}

/// Returns the uncertainty of a method's slope due to noise alone.
fn noise_interval(points: &[&PointRecord], reference: &ReferenceRecord) -> Option<[f64; 2]> {
    let floor = reference.rmse.unwrap_or(0.0);
    let fair = points.iter().filter(|p| is_above_floor(p.errors.rmse, floor));
    let points: Vec<(f64, Vec<f32>)> =
        fair.map(|p| (f64::from(p.samples), p.own_blocks(reference))).collect();
    let points: Vec<(f64, &[f32])> = points.iter().map(|(n, blocks)| (*n, blocks.as_slice())).collect();
    interval(&points, 0.95)
}

/// Returns the times to errors that tell methods apart: below what each method's first point errs by, and not below the
/// reference's own error.
fn reach(record: &Record) -> Reach {
    let floor = record.reference.rmse.unwrap_or(0.0);
    let usable = |p: &&PointRecord| p.errors.rmse > 0.0 && p.errors.rmse.is_finite();
    let least = record.points.iter().filter(usable).map(|p| p.own().rmse.max(floor));
    let least = least.filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min);
    let first = record.methods.iter().filter_map(|m| record.points_of(&m.name).find(usable));
    let most = first.map(|p| p.own().rmse).fold(0.0, f64::max);
    let mut levels = steps(least, most);
    levels.retain(|level| *level < most);
    levels.reverse();
    let times = |m: &super::record::MethodRecord| {
        let curve: Vec<(f64, f64)> =
            record.points_of(&m.name).map(|p| (p.median_seconds(), p.own().rmse)).collect();
        (m.name.clone(), levels.iter().map(|level| time_to(&curve, *level)).collect())
    };
    Reach { methods: record.methods.iter().map(times).collect(), errors: levels }
}
