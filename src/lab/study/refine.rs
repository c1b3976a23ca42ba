//! Which methods are worth going on with after a coarse pass, and which further counts answer a question. Input: the points
//! so far. Output: methods, and points to measure.
//!
//! A method's error at a time is interpolated between its points, both as logarithms, and beyond the last one continued
//! along the line through the first and the last.

use super::fit::time_to;
use super::method::Method;
use super::plan::{Point, next_count};
use super::record::{PointRecord, Question, Record};
use crate::core::error::Result;
use crate::lab::plot::axis::steps;
use crate::scene::model::{Algorithm, Scene};
use crate::scene::{MAX_SPP, check_spp};

/// A method goes on if its error comes within this factor of the least one, at some time.
const PROMISING: f64 = 1.25;
/// At least and at most so many methods go on.
const GOING_ON: [usize; 2] = [2, 6];
/// Methods that get a point of their own for a question.
const CANDIDATES: usize = 3;
/// A point this near to what was asked needs no other beside it.
const NEAR: f64 = 0.8;
/// Left of a budget, as times vary.
const MARGIN: f64 = 0.95;
/// The largest count for a question, over the largest that was asked for: the reference has 64 times those.
const BEYOND: u32 = 4;

/// What counts as the time of a point.
type Time = fn(&PointRecord) -> f64;

/// The measured points of one method: (seconds, RMSE), in the order of time.
struct Curve(Vec<(f64, f64)>);

impl Curve {
    fn of(record: &Record, method: &str, time: Time) -> Curve {
        let points = record.points_of(method).map(|p| (time(p), p.errors.rmse));
        let mut points: Vec<(f64, f64)> =
            points.filter(|p| p.0 > 0.0 && p.1 > 0.0 && p.1.is_finite()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Curve(points)
    }

    /// Returns the slope from the first point to the last, at most 0.
    fn slope(&self) -> f64 {
        match (self.0.first(), self.0.last()) {
            (Some(a), Some(b)) if b.0 > a.0 => ((b.1 / a.1).ln() / (b.0 / a.0).ln()).min(0.0),
            _ => 0.0,
        }
    }

    /// Returns the expected error after `seconds`; infinite if the shortest point takes longer.
    fn error_at(&self, seconds: f64) -> f64 {
        let after = self.0.iter().position(|p| p.0 > seconds);
        match (after, self.0.last()) {
            (None, Some(last)) => last.1 * (seconds / last.0).powf(self.slope()),
            (Some(0), _) | (None, None) => f64::INFINITY,
            (Some(i), _) => {
                let (a, b) = (self.0[i - 1], self.0[i]);
                a.1 * (b.1 / a.1).powf((seconds / a.0).ln() / (b.0 / a.0).ln())
            }
        }
    }

    /// Returns the expected time to an error; infinite if it is never reached.
    fn time_to(&self, error: f64) -> f64 {
        let measured = time_to(&self.0, error);
        let continued = || {
            let last = self.0.last()?;
            let slope = self.slope();
            (slope < 0.0).then(|| last.0 * (error / last.1).powf(1.0 / slope))
        };
        measured.or_else(continued).unwrap_or(f64::INFINITY)
    }
}

/// Returns how many times as bad each method is as the best one where it does best; infinite if it was not measured.
/// `horizon`: the time in which the longest points will be rendered.
fn scores(record: &Record, question: Option<Question>, horizon: f64, time: Time) -> Vec<f64> {
    let curves: Vec<Curve> = record.methods.iter().map(|m| Curve::of(record, &m.name, time)).collect();
    let ratios = |values: Vec<f64>| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.into_iter().map(move |v| if v.is_finite() { v / least } else { f64::INFINITY })
    };
    let mut best = vec![f64::INFINITY; curves.len()];
    let mut learn = |values: Vec<f64>| best.iter_mut().zip(ratios(values)).for_each(|(b, v)| *b = b.min(v));
    let first = curves.iter().filter_map(|c| c.0.first()).map(|p| p.0).fold(f64::INFINITY, f64::min);
    match question {
        Some(Question::Error(error)) => learn(curves.iter().map(|c| c.time_to(error)).collect()),
        // Nothing is as short as that: the shortest is judged.
        Some(Question::Budget(seconds)) => {
            learn(curves.iter().map(|c| c.error_at(seconds.max(first))).collect());
        }
        None => {
            let measured = curves.iter().flat_map(|c| &c.0).map(|p| p.0);
            for seconds in measured.chain(steps(first, horizon)) {
                learn(curves.iter().map(|c| c.error_at(seconds)).collect());
            }
        }
    }
    best
}

/// Returns the indices of the methods to go on with, in the order of the study.
pub fn promising(record: &Record, question: Option<Question>, growth: f64) -> Vec<usize> {
    // The same again when the study is resumed, with more repeats of some.
    let first: Time = |p| p.seconds.first().copied().unwrap_or(f64::NAN);
    let longest = record.points.iter().map(first).fold(0.0, f64::max);
    let scores = scores(record, question, longest * growth, first);
    let mut order: Vec<usize> = (0..scores.len()).filter(|i| scores[*i].is_finite()).collect();
    order.sort_by(|a, b| scores[*a].total_cmp(&scores[*b]));
    let near = order.iter().filter(|i| scores[**i] <= PROMISING).count();
    order.truncate(near.clamp(GOING_ON[0], GOING_ON[1]));
    order.sort_unstable();
    order
}

/// Returns points that come nearer to what was asked than those measured: of the most promising methods, with the count
/// that is expected to fill the time, or to reach the error.
pub fn toward(
    question: Question,
    record: &Record,
    methods: &[Method],
    scene: &Scene,
    largest: u32,
) -> Result<Vec<Point>> {
    let scores = scores(record, Some(question), f64::INFINITY, PointRecord::median_seconds);
    let mut order: Vec<usize> = (0..methods.len()).filter(|i| scores[*i].is_finite()).collect();
    order.sort_by(|a, b| scores[*a].total_cmp(&scores[*b]));
    let mut points = Vec::new();
    for &method in order.iter().take(CANDIDATES) {
        let how = &methods[method];
        // One beam or cone a pixel has no other count.
        if matches!(how.algorithm, Algorithm::Beam | Algorithm::Cone) {
            continue;
        }
        let own: Vec<&PointRecord> = record.points_of(&record.methods[method].name).collect();
        let Some(wanted) = count(question, &own).map(|n| n.min(largest.saturating_mul(BEYOND))) else {
            continue;
        };
        let pattern = how.pattern_in(scene);
        let fitting = match question {
            Question::Budget(_) => (1..=wanted).rev().find(|&n| check_spp(pattern, n).is_ok()),
            Question::Error(_) => next_count(pattern, wanted),
        };
        let Some(spp) = fitting else { continue };
        let samples = how.apply(scene, spp)?.sampling.samples();
        if !own.iter().any(|p| p.spp == spp || p.samples == samples) {
            points.push(Point { method, spp, samples });
        }
    }
    Ok(points)
}

/// Returns the count of samples that is expected to answer; `None` where a point is near already.
fn count(question: Question, own: &[&PointRecord]) -> Option<u32> {
    let near = |p: &&&PointRecord| match question {
        Question::Budget(seconds) => p.median_seconds() >= NEAR * seconds && p.median_seconds() <= seconds,
        Question::Error(error) => p.errors.rmse >= NEAR * error && p.errors.rmse <= error,
    };
    let (first, last) = (own.first()?, own.last()?);
    if own.iter().any(|p| near(&p)) || first.spp == last.spp {
        return None;
    }
    let [few, many] = [first, last].map(|p| f64::from(p.spp));
    let wanted = match question {
        Question::Budget(seconds) => {
            let each = (last.median_seconds() - first.median_seconds()) / (many - few);
            first.spp as f64 + (MARGIN * seconds - first.median_seconds()) / each
        }
        Question::Error(error) => {
            let slope = (last.errors.rmse / first.errors.rmse).ln() / (many / few).ln();
            many * (MARGIN * error / last.errors.rmse).powf(1.0 / slope)
        }
    };
    (wanted.is_finite() && wanted >= 1.0).then(|| wanted.min(f64::from(MAX_SPP)) as u32)
}
