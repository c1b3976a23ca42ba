//! What follows from the measured points. In: (rays, seconds, error) by method. Out: the slope of each
//! method's variance over its rays with 95 % intervals, the winner of each time budget and the recommended point
//! (`choice.rs`), the time to reach each error, and one sentence.

use super::advice::advice;
use super::bootstrap::interval;
pub use super::choice::{recommended, winners};
use super::fit::{Line, least_squares};
pub use super::fit::{median, time_to};
use super::record::{PointRecord, Record};
pub use super::results::{Analysis, MethodSlope, Reach, SampleDimension, Slope};
use super::student;
use crate::lab::plot::axis::steps;

/// Points nearer to the reference's own error than this many times bend towards it and count in no slope.
const ABOVE_FLOOR: f64 = 3.0;
/// Fewest points that have a slope.
const FEWEST: usize = 3;

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
            interval: noise_interval(&record.points_of(&m.name).collect::<Vec<_>>(), floor),
            theory: theory.to_vec(),
            theory_text: text.to_owned(),
        }
    };
    let slopes: Vec<MethodSlope> = record.methods.iter().map(slope).collect();
    let winners = winners(&record.points, &slopes);
    Analysis {
        recommendation: advice(record, &winners),
        recommended: recommended(&record.points, &winners).map(SampleDimension::of),
        slopes,
        winners,
        reach: reach(record),
    }
}

/// Of the variance over the number of samples: independent ones −1; one jittered sample in each of n strata
/// −1 where every stratum varies, −1.5 where edges cross √n of them, −2 where the picture is smooth (Mitchell
/// 1996); scrambled nets up to −3 (Owen 1997).
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

/// Of (rays, RMSE); the slope is that of the variance, RMSE².
pub fn slope(points: &[(f64, f64)], floor: f64) -> Option<Slope> {
    let logs: Vec<(f64, f64)> =
        points.iter().filter(|p| is_fair(p.1, floor)).map(|p| (p.0.ln(), 2.0 * p.1.ln())).collect();
    if logs.len() < FEWEST || logs.iter().all(|p| (p.0 - logs[0].0).abs() < 1e-5) {
        return None;
    }
    let Line { value, residual, sxx } = least_squares(&logs);
    let half_width = student::quantile(logs.len() - 2) * (residual / (logs.len() as f64 - 2.0) / sxx).sqrt();
    Some(Slope { value, half_width: (half_width > 1e-9).then_some(half_width), points: logs.len() })
}

/// Whether an error says something of the method, and not of the reference.
fn is_fair(rmse: f64, floor: f64) -> bool {
    rmse > ABOVE_FLOOR * floor && rmse > 0.0 && rmse.is_finite()
}

/// What the noise alone leaves open of a method's slope.
fn noise_interval(points: &[&PointRecord], floor: f64) -> Option<[f64; 2]> {
    let fair = points.iter().filter(|p| is_fair(p.errors.rmse, floor));
    let points: Vec<(f64, &[f32])> = fair.map(|p| (f64::from(p.samples), p.blocks.as_slice())).collect();
    interval(&points, 0.95)
}

fn reach(record: &Record) -> Reach {
    let errors = || record.points.iter().map(|p| p.errors.rmse).filter(|e| *e > 0.0 && e.is_finite());
    let mut levels = steps(errors().fold(f64::INFINITY, f64::min), errors().fold(0.0, f64::max));
    levels.reverse();
    let times = |m: &super::record::MethodRecord| {
        let curve: Vec<(f64, f64)> =
            record.points_of(&m.name).map(|p| (p.median_seconds(), p.errors.rmse)).collect();
        (m.name.clone(), levels.iter().map(|level| time_to(&curve, *level)).collect())
    };
    Reach { methods: record.methods.iter().map(times).collect(), errors: levels }
}
