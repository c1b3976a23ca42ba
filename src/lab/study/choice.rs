//! The choice of a point: the smallest error within each time, with the methods that are not
//! significantly different; and one recommended point, which no other beats in both error and time.

use super::bootstrap::ratio;
use super::format::samples_taken;
use super::record::{PointRecord, Record};
use super::results::{MethodSlope, RecommendedPoint, Winner};
use crate::lab::plot::axis::steps;

/// The ratio above which errors differ significantly in any case.
const SIGNIFICANT_RATIO: f64 = 2.0;

impl RecommendedPoint {
    pub fn of(point: &PointRecord) -> RecommendedPoint {
        let (method, seconds) = (point.method.clone(), point.median_seconds());
        RecommendedPoint { method, spp: point.spp, seconds, rmse: point.errors.rmse }
    }
}

fn usable(points: &[PointRecord]) -> impl Iterator<Item = &PointRecord> {
    points.iter().filter(|p| p.median_seconds() > 0.0 && p.errors.rmse.is_finite())
}

pub fn winners(points: &[PointRecord], slopes: &[MethodSlope]) -> Vec<Winner> {
    let usable: Vec<&PointRecord> = usable(points).collect();
    let times = || usable.iter().map(|p| p.median_seconds());
    let budgets = steps(times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    let winner = |budget: f64| {
        let fitting = usable.iter().filter(|p| p.median_seconds() <= budget);
        let least = fitting.min_by(|a, b| a.errors.rmse.total_cmp(&b.errors.rmse))?;
        let estimated = slopes.iter().filter_map(|slope| extrapolated(&usable, slope, budget));
        let estimated = estimated.min_by(|a, b| a.rmse.total_cmp(&b.rmse));
        Some(estimated.filter(|e| e.rmse < least.errors.rmse).unwrap_or_else(|| Winner {
            budget,
            method: least.method.clone(),
            ties: ties(least, &usable, budget),
            spp: least.spp,
            taken: samples_taken(least),
            seconds: least.median_seconds(),
            rmse: least.errors.rmse,
            estimated: false,
        }))
    };
    budgets.into_iter().filter_map(winner).collect()
}

/// Returns the methods that reach the same error in the same time within the uncertainty. A time as
/// long as the point's in some repeat fits the budget like the point's own.
fn ties(point: &PointRecord, all: &[&PointRecord], budget: f64) -> Vec<String> {
    let longest = point.seconds.iter().copied().fold(0.0, f64::max);
    let shortest = |p: &PointRecord| p.seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let fits = |p: &PointRecord| p.median_seconds() <= budget || shortest(p) <= longest;
    let mut methods: Vec<String> = Vec::new();
    for other in
        all.iter().filter(|p| p.method != point.method && fits(p) && not_significantly_different(p, point))
    {
        if !methods.contains(&other.method) {
            methods.push(other.method.clone());
        }
    }
    methods
}

/// Returns true if two points have one picture, or if the 95 % bootstrap interval of the ratio of
/// their errors contains 1.
pub fn not_significantly_different(a: &PointRecord, b: &PointRecord) -> bool {
    if !a.picture.is_empty() && a.picture == b.picture {
        return true;
    }
    // Noise cannot explain a larger ratio, and the bootstrap is slow.
    let near = a.errors.rmse.max(b.errors.rmse) <= SIGNIFICANT_RATIO * a.errors.rmse.min(b.errors.rmse);
    near && ratio(&a.blocks, &b.blocks, 0.95).is_some_and(|[low, high]| low <= 1.0 && high >= 1.0)
}

/// Extrapolates a method with a known slope to a time longer than it was measured for.
fn extrapolated(points: &[&PointRecord], slope: &MethodSlope, budget: f64) -> Option<Winner> {
    let own = points.iter().filter(|p| p.method == slope.method);
    let last = own.max_by(|a, b| a.median_seconds().total_cmp(&b.median_seconds()))?;
    let longer = budget / last.median_seconds();
    let law = slope.fitted.filter(|f| !slope.theory.is_empty() && f.value < 0.0)?;
    let spp = (f64::from(last.spp) * longer) as u32;
    (longer > 1.0).then(|| Winner {
        budget,
        method: slope.method.clone(),
        ties: Vec::new(),
        spp,
        taken: format!("about {}", samples_taken(&PointRecord { spp, samples: spp, ..(*last).clone() })),
        seconds: budget,
        rmse: last.errors.rmse * longer.powf(0.5 * law.value),
        estimated: true,
    })
}

/// Returns the point that is recommended: what answers the question of the study, or else [`recommended`].
pub fn chosen<'a>(record: &'a Record, winners: &[Winner]) -> Option<&'a PointRecord> {
    match record.conditions.question {
        Some(question) => question.answer(&record.points),
        None => recommended(&record.points, winners),
    }
}

/// Returns the methods that a plot singles out, at most `most`: the recommended one, then those that win most times.
pub fn leaders(record: &Record, most: usize) -> Vec<String> {
    let Some(analysis) = &record.analysis else { return Vec::new() };
    let winners = &analysis.winners;
    let mut leaders: Vec<String> = chosen(record, winners).map(|p| p.method.clone()).into_iter().collect();
    let won = |name: &str| winners.iter().filter(|w| w.method == name).count();
    let mut others: Vec<&str> = winners.iter().map(|w| w.method.as_str()).collect();
    others.sort_by_key(|name| std::cmp::Reverse(won(name)));
    for name in others {
        if leaders.len() < most && !leaders.iter().any(|leader| leader == name) {
            leaders.push(name.to_owned());
        }
    }
    leaders
}

/// Returns, among the points that no other beats in both error and time, the best one of the method
/// that wins most budgets.
pub fn recommended<'a>(points: &'a [PointRecord], winners: &[Winner]) -> Option<&'a PointRecord> {
    let beats = |q: &PointRecord, p: &PointRecord| {
        q.median_seconds() < p.median_seconds() && q.errors.rmse < p.errors.rmse
    };
    let front: Vec<&PointRecord> = usable(points).filter(|p| !usable(points).any(|q| beats(q, p))).collect();
    let best = |such: &dyn Fn(&PointRecord) -> bool| {
        let own = front.iter().copied().filter(|p| such(p));
        own.min_by(|a, b| a.errors.rmse.total_cmp(&b.errors.rmse))
    };
    let won = |name: &str| winners.iter().filter(|w| w.is_or_ties(name)).count();
    let on_front = winners.iter().filter(|w| front.iter().any(|p| p.method == w.method));
    // The last among equals was measured for the longer times.
    match on_front.max_by_key(|w| won(&w.method)) {
        Some(winner) => best(&|p| p.method == winner.method),
        None => best(&|_| true),
    }
}
