//! Which methods are worth going on with after a coarse pass, and which further counts answer a question. Input: the points
//! so far. Output: methods, and points to measure.
//!
//! A method's error at a time is interpolated between its points, both as logarithms. Beyond the last one it goes on by its
//! last two points: time along the line over the samples, error along that of the logarithms. Errors are without the reference's own, of which half is as good as none.

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
/// The first times of a method may be so much longer than later ones: it may still fit a time that is asked for.
const FIRST_TIMES: f64 = 1.5;
/// An error is told apart down to this part of the reference's own.
const LEAST_PART: f64 = 0.5;
/// At least and at most so many methods go on.
const GOING_ON: [usize; 2] = [2, 6];
/// The largest count of a coarse pass.
pub(super) const COARSE: u32 = 16;
/// Methods that get a point of their own for a question.
const CANDIDATES: usize = 3;
/// A point this near to what was asked needs no other beside it.
const NEAR: f64 = 0.8;
/// The slope of the RMSE of independent samples, where nothing better is known.
const INDEPENDENT: f64 = -0.5;
/// Left of a budget, as times vary.
const MARGIN: f64 = 0.95;
/// The largest count for a question, over the largest that was asked for: the reference has 64 times those.
const BEYOND: u32 = 4;

/// What counts as the time of a point.
type Time = fn(&PointRecord) -> f64;

/// The measured points of one method: (seconds, RMSE) in the order of time, and how it goes on beyond them.
struct Curve {
    points: Vec<(f64, f64)>,
    beyond: Option<Beyond>,
}

/// The continuation of a method by the two points with the most samples.
struct Beyond {
    count: f64,
    seconds: f64,
    rmse: f64,
    seconds_each: f64,
    /// Of the RMSE over the samples, both as logarithms; below 0.
    slope: f64,
}

impl Beyond {
    /// Two points in the order of their samples: (samples, seconds, RMSE).
    fn of([a, b]: [(f64, f64, f64); 2]) -> Option<Beyond> {
        let slope = (b.2 / a.2).ln() / (b.0 / a.0).ln();
        // Where noise hides what a sample costs, all of the time is that of samples.
        let each = (b.1 - a.1) / (b.0 - a.0);
        let seconds_each = if each > 0.0 { each } else { b.1 / b.0 };
        (slope < 0.0).then_some(Beyond { count: b.0, seconds: b.1, rmse: b.2, seconds_each, slope })
    }

    fn error_at(&self, seconds: f64) -> f64 {
        let count = self.count + (seconds - self.seconds).max(0.0) / self.seconds_each;
        self.rmse * (count / self.count).powf(self.slope)
    }

    fn time_to(&self, error: f64) -> f64 {
        let count = self.count * (error / self.rmse).powf(1.0 / self.slope);
        self.seconds + (count - self.count) * self.seconds_each
    }
}

impl Curve {
    fn of(record: &Record, method: &str, time: Time) -> Curve {
        let least = LEAST_PART * record.reference.rmse.unwrap_or(0.0);
        let points = record.points_of(method).map(|p| (f64::from(p.spp), time(p), p.own().rmse.max(least)));
        let points: Vec<(f64, f64, f64)> =
            points.filter(|p| p.1 > 0.0 && p.2 > 0.0 && p.2.is_finite()).collect();
        let last_two = points.last_chunk::<2>().copied();
        let mut points: Vec<(f64, f64)> = points.into_iter().map(|p| (p.1, p.2)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Curve { points, beyond: last_two.and_then(Beyond::of) }
    }

    /// Returns the expected error after `seconds`; infinite if the shortest point takes longer than `tolerance` times that.
    fn error_at(&self, seconds: f64, tolerance: f64) -> f64 {
        let points = &self.points;
        let after = points.iter().position(|p| p.0 > seconds);
        match (after, points.last()) {
            (None, Some(last)) => self.beyond.as_ref().map_or(last.1, |beyond| beyond.error_at(seconds)),
            (Some(0), _) if points[0].0 <= tolerance * seconds => points[0].1,
            (Some(0), _) | (None, None) => f64::INFINITY,
            (Some(i), _) => {
                let (a, b) = (points[i - 1], points[i]);
                a.1 * (b.1 / a.1).powf((seconds / a.0).ln() / (b.0 / a.0).ln())
            }
        }
    }

    /// Returns the expected time to an error; infinite if it is never reached.
    fn time_to(&self, error: f64) -> f64 {
        let measured = time_to(&self.points, error);
        let continued = || self.beyond.as_ref().map(|beyond| beyond.time_to(error));
        measured.or_else(continued).unwrap_or(f64::INFINITY)
    }
}

/// Returns the methods that were measured, the best first, with how many times as bad each is as the best one where it does
/// best; that is infinite where it does not fit a time that is asked for. `horizon`: the time in which the longest points
/// will be rendered; `tolerance`: by how much the shortest point may exceed a time. Methods whose pictures are all those of a
/// better one are left out.
fn scores(
    record: &Record,
    question: Option<Question>,
    horizon: f64,
    (time, tolerance): (Time, f64),
) -> Vec<(usize, f64)> {
    let curves: Vec<Curve> = record.methods.iter().map(|m| Curve::of(record, &m.name, time)).collect();
    let ratios = |values: Vec<f64>| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.into_iter().map(move |v| if v.is_finite() { v / least } else { f64::INFINITY })
    };
    let mut best = vec![f64::INFINITY; curves.len()];
    let mut learn = |values: Vec<f64>| best.iter_mut().zip(ratios(values)).for_each(|(b, v)| *b = b.min(v));
    let first = curves.iter().filter_map(|c| c.points.first()).map(|p| p.0).fold(f64::INFINITY, f64::min);
    match question {
        Some(Question::Error(error)) => learn(curves.iter().map(|c| c.time_to(error)).collect()),
        // Nothing is as short as that: the shortest is judged.
        Some(Question::Budget(seconds)) => {
            learn(curves.iter().map(|c| c.error_at(seconds.max(first), tolerance)).collect());
        }
        None => {
            let measured = curves.iter().flat_map(|c| &c.points).map(|p| p.0);
            for seconds in measured.chain(steps(first, horizon)) {
                learn(curves.iter().map(|c| c.error_at(seconds, tolerance)).collect());
            }
        }
    }
    let shortest = |i: usize| curves[i].points.first().map_or(f64::INFINITY, |p| p.0);
    let mut order: Vec<usize> = (0..curves.len()).filter(|i| shortest(*i).is_finite()).collect();
    order.sort_by(|a, b| best[*a].total_cmp(&best[*b]).then(shortest(*a).total_cmp(&shortest(*b))));
    let mut kept: Vec<(usize, f64)> = Vec::new();
    for i in order {
        let name = |i: usize| record.methods[i].name.as_str();
        if !kept.iter().any(|(other, _)| repeats(record, name(i), name(*other))) {
            kept.push((i, best[i]));
        }
    }
    kept
}

/// Returns true if all pictures of a method are those of another one.
fn repeats(record: &Record, method: &str, other: &str) -> bool {
    let same = |p: &PointRecord| {
        record.points_of(other).any(|q| q.spp == p.spp && !p.picture.is_empty() && q.picture == p.picture)
    };
    record.points_of(method).all(same)
}

/// Returns the indices of the methods to go on with, in the order of the study.
pub fn promising(record: &Record, question: Option<Question>, growth: f64) -> Vec<usize> {
    // The same again when the study is resumed, with more repeats of some.
    let first: Time = |p| p.seconds.first().copied().unwrap_or(f64::NAN);
    let longest = record.points.iter().map(first).fold(0.0, f64::max);
    let order = scores(record, question, longest * growth, (first, FIRST_TIMES));
    let near = order.iter().filter(|(_, score)| *score <= PROMISING).count();
    let chosen = order.iter().take(near.clamp(GOING_ON[0], GOING_ON[1]));
    let mut chosen: Vec<usize> = chosen.map(|(method, _)| *method).collect();
    chosen.sort_unstable();
    chosen
}

/// Returns points that come nearer to what was asked than those measured: of the most promising methods that take another
/// count, with the one that is expected to fill the time, or to reach the error.
pub fn toward(
    question: Question,
    record: &Record,
    methods: &[Method],
    scene: &Scene,
    largest: u32,
) -> Result<Vec<Point>> {
    let order = scores(record, Some(question), f64::INFINITY, (PointRecord::median_seconds, 1.0));
    let mut points = Vec::new();
    // One count alone does not tell when an error is reached.
    let may_answer = |score: f64| score.is_finite() || matches!(question, Question::Error(_));
    for (method, _) in order.into_iter().filter(|(_, score)| may_answer(*score)) {
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
        if points.len() < CANDIDATES && !own.iter().any(|p| p.spp == spp || p.samples == samples) {
            points.push(Point { method, spp, samples });
        }
    }
    Ok(points)
}

/// Returns the count of samples that is expected to answer, along the line through the two points of a method that are
/// next to what was asked; `None` where a point is near already.
fn count(question: Question, own: &[&PointRecord]) -> Option<u32> {
    let near = |p: &&PointRecord| match question {
        Question::Budget(seconds) => p.median_seconds() >= NEAR * seconds && p.median_seconds() <= seconds,
        Question::Error(error) => p.own().rmse >= NEAR * error && p.own().rmse <= error,
    };
    if own.iter().any(near) {
        return None;
    }
    let first_beyond = own.iter().position(|p| match question {
        Question::Budget(seconds) => p.median_seconds() > MARGIN * seconds,
        Question::Error(error) => p.own().rmse <= MARGIN * error,
    });
    let after = first_beyond.unwrap_or(own.len()).clamp(1, own.len().saturating_sub(1).max(1));
    let (before, after) = (own.get(after - 1)?, own.get(after));
    let few = f64::from(before.spp);
    let wanted = match question {
        Question::Budget(seconds) => {
            let each = after.map(|after| {
                (after.median_seconds() - before.median_seconds()) / (f64::from(after.spp) - few)
            });
            // Of one point, and where noise hides what a sample costs, all the time is counted as that of samples.
            let each = each.filter(|each| *each > 0.0).unwrap_or(before.median_seconds() / few);
            few + (MARGIN * seconds - before.median_seconds()) / each
        }
        Question::Error(error) => {
            let slope = after.map_or(INDEPENDENT, |after| {
                (after.own().rmse / before.own().rmse).ln() / (f64::from(after.spp) / few).ln()
            });
            few * (MARGIN * error / before.own().rmse).powf(1.0 / slope)
        }
    };
    (wanted.is_finite() && wanted >= 1.0).then(|| wanted.min(f64::from(MAX_SPP)) as u32)
}
