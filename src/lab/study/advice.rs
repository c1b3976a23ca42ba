//! The sentence that recommends a setting. In: the measured points and the winners. Out: the recommended point, and who
//! is better with less and with more time.

use super::choice::{not_significantly_different, recommended};
use super::fit::time_to;
use super::format::{error, names, samples_taken, seconds, significant};
use super::record::{PointRecord, Record};
use super::results::Winner;

/// Returns the recommendation, and the better methods for less and for more time.
pub fn advice(record: &Record, winners: &[Winner]) -> String {
    let Some(best) = recommended(&record.points, winners) else {
        return "Nothing was measured.".into();
    };
    let method = best.method.as_str();
    let mut equals: Vec<&str> = Vec::new();
    for point in record.points.iter().filter(|p| p.method != method && p.spp == best.spp) {
        if not_significantly_different(point, best) && !equals.contains(&point.method.as_str()) {
            equals.push(&point.method);
        }
    }
    let equals = match equals.is_empty() {
        true => String::new(),
        false => format!(" ({} errs the same but for noise)", equals.join(" or ")),
    };
    let mut text = format!(
        "Use {method} with {}{equals}: RMSE {} in {}",
        samples_taken(best),
        error(best.errors.rmse),
        seconds(best.median_seconds())
    );
    if let Some(times) = saved(record, best) {
        text += &format!(", {times} times as fast as random samples come to that error");
    }
    let mut others = Vec::new();
    if let Some(first) = winners.first().filter(|w| !w.is_or_ties(method)) {
        others.push(format!("if there is time for {} only, {}", seconds(first.budget), setting(first)));
    }
    if let Some(last) = winners.last().filter(|w| !w.is_or_ties(method)) {
        others.push(format!("with {}, {}", seconds(last.budget), setting(last)));
    }
    others.iter().for_each(|other| text += &format!("; {other}"));
    text + "."
}

fn setting(winner: &Winner) -> String {
    let about = if winner.estimated { "about " } else { "" };
    format!("{} with {} (RMSE {about}{})", names(winner), winner.taken, error(winner.rmse))
}

/// Returns how many times as long random samples take to the same error.
fn saved(record: &Record, best: &PointRecord) -> Option<String> {
    let curve: Vec<(f64, f64)> =
        record.points_of("random").map(|p| (p.median_seconds(), p.errors.rmse)).collect();
    if best.method == "random" {
        return None;
    }
    let (time, at_least) = match time_to(&curve, best.errors.rmse) {
        Some(time) => (time, ""),
        // Independent samples halve their error with four times the number.
        None => {
            let (time, rmse) = *curve.last()?;
            (time * (rmse / best.errors.rmse).powi(2), "about ")
        }
    };
    let ratio = time / best.median_seconds();
    (ratio.is_finite() && ratio >= 1.05).then(|| format!("{at_least}{}", significant(ratio)))
}
