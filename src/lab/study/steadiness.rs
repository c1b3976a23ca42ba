//! Whether the machine was quiet enough to tell the recommended method from its neighbour. Input: the points with all
//! their times. Output: how far repeats of one point spread, and how far the neighbour is away.
//!
//! The neighbour is the other method that comes to the recommended point's error in the time that is nearest to it,
//! interpolated between its points. Both cannot be told apart if the repeats of either spread (longest − shortest, over
//! the median) further than that.

use super::choice::chosen;
use super::fit::time_to;
use super::format::percent;
use super::record::{PointRecord, Record};
use super::results::Steadiness;

impl Steadiness {
    /// Returns `None` if nothing was measured twice, or if no other method comes to that error.
    pub fn of(record: &Record, best: &PointRecord) -> Option<Steadiness> {
        let time = best.median_seconds();
        let own = spread(best)?;
        let distance = |seconds: f64| (seconds / time - 1.0).abs();
        let others = record.methods.iter().filter(|m| m.name != best.method);
        // Methods that make the same picture are one and the same.
        let alike = |p: &PointRecord| !p.picture.is_empty() && p.picture == best.picture;
        let others = others.filter(|m| !record.points_of(&m.name).any(alike));
        let reached = others.filter_map(|m| {
            let curve: Vec<(f64, f64)> =
                record.points_of(&m.name).map(|p| (p.median_seconds(), p.errors.rmse)).collect();
            Some((m.name.as_str(), time_to(&curve, best.errors.rmse)?))
        });
        let (next, next_seconds) = reached.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)))?;
        let near = record.points_of(next).filter(|p| p.seconds.len() > 1).min_by(|a, b| {
            let apart = |p: &PointRecord| (p.median_seconds() / next_seconds).ln().abs();
            apart(a).total_cmp(&apart(b))
        });
        let spread = own.max(near.and_then(spread).unwrap_or(0.0));
        let difference = distance(next_seconds);
        let next = next.to_owned();
        Some(Steadiness { next, next_seconds, difference, spread, tells_apart: spread <= difference })
    }
}

/// Returns a sentence if the recommended method cannot be told from its neighbour.
pub fn note(record: &Record) -> Option<String> {
    let analysis = record.analysis.as_ref()?;
    let best = chosen(record, &analysis.winners)?;
    let found = analysis.steadiness.as_ref().filter(|found| !found.tells_apart)?;
    Some(format!(
        "the machine is too busy to tell {} from {} by time: renders of one point differ by up to {}, \
         and both methods by {} at this error; study again on an idle machine, or with more --repeats",
        record.label(&best.method),
        record.label(&found.next),
        percent(found.spread),
        percent(found.difference)
    ))
}

/// Returns how far the times of a point spread; `None` if there is one.
fn spread(point: &PointRecord) -> Option<f64> {
    let least = point.seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let most = point.seconds.iter().copied().fold(0.0, f64::max);
    (point.seconds.len() > 1).then(|| (most - least) / point.median_seconds())
}
