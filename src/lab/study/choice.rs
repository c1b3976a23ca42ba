//! The choice of a point: the smallest error within each time, with the methods that are not
//! significantly different; and one recommended point, which no other beats in both error and time.

use super::bootstrap::ratio;
use super::extrapolation::Estimate;
use super::format::samples_taken;
use super::record::{PointRecord, Record, ReferenceRecord};
use super::results::{MethodSlope, RecommendedPoint, Winner};
use crate::lab::plot::axis::steps;

/// The ratio above which errors differ significantly in any case.
const SIGNIFICANT_RATIO: f64 = 2.0;

/// A median time up to this multiple of a budget may be one of the budget's, if repeats overlap.
const NEARLY: f64 = 1.25;

impl RecommendedPoint {
    pub fn of(point: &PointRecord) -> RecommendedPoint {
        let (method, seconds) = (point.method.clone(), point.median_seconds());
        RecommendedPoint { method, spp: point.spp, seconds, rmse: point.own().rmse }
    }
}

fn usable(points: &[PointRecord]) -> impl Iterator<Item = &PointRecord> {
    points.iter().filter(|p| p.median_seconds() > 0.0 && p.errors.rmse.is_finite())
}

/// Returns the method with the least error within each time. What is extrapolated wins only where its lead over all that
/// was measured is larger than the uncertainty of both.
pub fn winners(points: &[PointRecord], slopes: &[MethodSlope], reference: &ReferenceRecord) -> Vec<Winner> {
    let usable: Vec<&PointRecord> = usable(points).collect();
    let times = || usable.iter().map(|p| p.median_seconds());
    let budgets = steps(times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    let winner = |budget: f64| {
        let fitting = usable.iter().copied().filter(|p| p.median_seconds() <= budget);
        let least = fitting.min_by(|a, b| a.errors.rmse.total_cmp(&b.errors.rmse))?;
        let estimated = slopes.iter().filter_map(|slope| Estimate::of(&usable, slope, budget, reference));
        let leading: Vec<Estimate<'_>> = estimated.filter(|e| e.beats(least, reference)).collect();
        let best = leading.iter().min_by(|a, b| a.rmse.total_cmp(&b.rmse));
        Some(match best {
            Some(best) => extrapolated(best, &leading, budget, reference),
            None => measured(least, &usable, budget),
        })
    };
    budgets.into_iter().filter_map(winner).collect()
}

fn measured(least: &PointRecord, all: &[&PointRecord], budget: f64) -> Winner {
    let own = least.own();
    Winner {
        budget,
        method: least.method.clone(),
        ties: ties(least, all, budget),
        spp: least.spp,
        taken: samples_taken(least),
        seconds: least.median_seconds(),
        rmse: own.rmse,
        interval: [own.low, own.high],
        estimated: false,
    }
}

fn extrapolated(
    best: &Estimate<'_>,
    all: &[Estimate<'_>],
    budget: f64,
    reference: &ReferenceRecord,
) -> Winner {
    let others = all.iter().filter(|e| e.last.method != best.last.method);
    let ties = others.filter(|e| e.ties(best, reference)).map(|e| e.last.method.clone()).collect();
    let taken = PointRecord { spp: best.spp, samples: best.spp, ..best.last.clone() };
    Winner {
        budget,
        method: best.last.method.clone(),
        ties,
        spp: best.spp,
        taken: format!("about {}", samples_taken(&taken)),
        seconds: best.seconds,
        rmse: best.rmse,
        interval: best.interval(),
        estimated: true,
    }
}

/// Returns the methods that reach the same error in the same time within the uncertainty. A time as
/// long as the point's in some repeat fits the budget like the point's own.
fn ties(point: &PointRecord, all: &[&PointRecord], budget: f64) -> Vec<String> {
    let longest = point.seconds.iter().copied().fold(0.0, f64::max);
    let shortest = |p: &PointRecord| p.seconds.iter().copied().fold(f64::INFINITY, f64::min);
    // A stall of one repeat makes no room for what takes several times as long, unless it is the same picture.
    let alike = |p: &PointRecord| !p.picture.is_empty() && p.picture == point.picture;
    let near = |p: &PointRecord| alike(p) || p.median_seconds() <= NEARLY * budget;
    let nearly = |p: &PointRecord| near(p) && shortest(p) <= longest;
    let fits = |p: &PointRecord| p.median_seconds() <= budget || nearly(p);
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
/// that wins most budgets with what was measured of it.
pub fn recommended<'a>(points: &'a [PointRecord], winners: &[Winner]) -> Option<&'a PointRecord> {
    let beats = |q: &PointRecord, p: &PointRecord| {
        q.median_seconds() < p.median_seconds() && q.errors.rmse < p.errors.rmse
    };
    let front: Vec<&PointRecord> = usable(points).filter(|p| !usable(points).any(|q| beats(q, p))).collect();
    let best = |such: &dyn Fn(&PointRecord) -> bool| {
        let own = || front.iter().copied().filter(|p| such(p));
        let least = own().min_by(|a, b| a.errors.rmse.total_cmp(&b.errors.rmse))?;
        // More samples that are not known to err less are not worth their time.
        let equal = own().filter(|p| p.method == least.method && not_significantly_different(p, least));
        equal.min_by(|a, b| a.median_seconds().total_cmp(&b.median_seconds())).or(Some(least))
    };
    let measured = || winners.iter().filter(|w| !w.estimated);
    let won = |name: &str| measured().filter(|w| w.is_or_ties(name)).count();
    let on_front = measured().filter(|w| front.iter().any(|p| p.method == w.method));
    // The last among equals was measured for the longer times.
    match on_front.max_by_key(|w| won(&w.method)) {
        Some(winner) => best(&|p| p.method == winner.method),
        None => best(&|_| true),
    }
}
