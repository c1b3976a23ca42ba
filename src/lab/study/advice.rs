//! The sentence that recommends a setting. In: the measured points and the winners. Out: the recommended point, and who
//! is better with less and with more time.

use super::choice::{chosen, not_significantly_different};
use super::fit::time_to;
use super::format::{
    asked_error, asked_seconds, error, listed, names, own_error, own_error_of, samples_taken, seconds,
    significant,
};
use super::record::{PointRecord, Question, Record};
use super::results::Winner;
use crate::core::counted::verb;

/// Below this multiple of the reference's own error it is said that there is one.
const NEAR_FLOOR: f64 = 3.0;
/// So many methods that err the same are named.
const NAMED_EQUALS: usize = 3;

/// Returns the recommendation, and the better methods for less and for more time.
pub fn advice(record: &Record, winners: &[Winner]) -> String {
    let Some(best) = chosen(record, winners) else {
        return "Nothing was measured.".into();
    };
    if let Some(question) = record.conditions.question {
        return answer(record, question, best);
    }
    let method = best.method.as_str();
    let equals = equals(record, best);
    let mut text = format!(
        "Use {} with {}{equals}: RMSE {} in {}",
        record.label(method),
        samples_taken(best),
        own_error_of(best),
        seconds(best.median_seconds())
    );
    if let Some(times) = saved(record, best) {
        text += &format!(", {times} times as fast as random samples come to that error");
    }
    let mut others = Vec::new();
    if let Some(first) = winners.first().filter(|w| !w.is_or_ties(method)) {
        others.push(format!(
            "if there is time for {} only, {}",
            seconds(first.budget),
            setting(record, first)
        ));
    }
    if let Some(last) = winners.last().filter(|w| !w.is_or_ties(method)) {
        others.push(format!("with {}, {}", seconds(last.budget), setting(record, last)));
    }
    others.iter().for_each(|other| text += &format!("; {other}"));
    text + "." + &said_of_reference(record, best)
}

/// Returns a sentence where the reference's own error is near that of the recommended point.
fn said_of_reference(record: &Record, best: &PointRecord) -> String {
    match record.reference.rmse {
        Some(own) if best.errors.rmse < NEAR_FLOOR * own => {
            format!(" The reference itself errs by {}, which is subtracted.", error(own))
        }
        _ => String::new(),
    }
}

/// Returns the sentence that answers a question.
fn answer(record: &Record, question: Question, best: &PointRecord) -> String {
    let what = |p: &PointRecord| {
        let (rmse, time) = (own_error_of(p), seconds(p.median_seconds()));
        let label = record.label(&p.method);
        let same = if p.method == best.method { equals(record, p) } else { String::new() };
        match question {
            Question::Budget(_) => format!("{label} with {}{same}: RMSE {rmse} in {time}", samples_taken(p)),
            Question::Error(_) => {
                format!("{label} with {}{same}: {time} to an RMSE of {rmse}", samples_taken(p))
            }
        }
    };
    let opening = match (question, question.is_met_by(best)) {
        (Question::Budget(limit), true) => format!("In {} use", asked_seconds(limit)),
        (Question::Budget(limit), false) => {
            format!("Nothing that was measured takes as little as {}; the shortest is", asked_seconds(limit))
        }
        (Question::Error(limit), true) => format!("Fastest to an RMSE of {} is", asked_error(limit)),
        (Question::Error(limit), false) => format!(
            "Nothing that was measured errs as little as {}, which more samples with --spp may; the least error has",
            asked_error(limit)
        ),
    };
    let ranking = question.ranking(&record.points);
    let other = |p: &&&PointRecord| !not_significantly_different(p, best) && question.is_met_by(p);
    let next = ranking.iter().skip(1).find(other);
    let next = next.map_or(String::new(), |p| format!("; next comes {}", what(p)));
    format!("{opening} {}{next}.", what(best)) + &said_of_reference(record, best)
}

/// Returns, in brackets, the methods whose points with as many samples err the same and keep what was asked, in no longer
/// time where no time was asked for.
fn equals(record: &Record, best: &PointRecord) -> String {
    let longest = best.seconds.iter().copied().fold(0.0, f64::max);
    let keeps = |p: &PointRecord| match record.conditions.question {
        Some(question @ Question::Budget(_)) => question.is_met_by(p),
        _ => p.seconds.iter().copied().fold(f64::INFINITY, f64::min) <= longest,
    };
    let mut equals: Vec<&str> = Vec::new();
    for point in record.points.iter().filter(|p| p.method != best.method && p.spp == best.spp && keeps(p)) {
        let label = record.label(&point.method);
        if not_significantly_different(point, best) && !equals.contains(&label) {
            equals.push(label);
        }
    }
    match equals.len() {
        0 => String::new(),
        n if n <= NAMED_EQUALS => {
            format!(" ({} {} the same but for noise)", listed(&equals, "and"), verb(n, "errs", "err"))
        }
        n => format!(" ({n} others err the same but for noise)"),
    }
}

fn setting(record: &Record, winner: &Winner) -> String {
    let about = if winner.estimated { "about " } else { "" };
    let rmse = own_error(winner.rmse, winner.interval);
    format!("{} with {} (RMSE {about}{rmse})", names(record, winner), winner.taken)
}

/// Returns how many times as long random samples take to the same error; nothing where that error is a bound.
fn saved(record: &Record, best: &PointRecord) -> Option<String> {
    let curve: Vec<(f64, f64)> =
        record.points_of("random").map(|p| (p.median_seconds(), p.own().rmse)).collect();
    let rmse = best.own().rmse;
    if best.method == "random" || !best.own().is_known() {
        return None;
    }
    let (time, at_least) = match time_to(&curve, rmse) {
        Some(time) => (time, ""),
        // Independent samples halve their error with four times the number.
        None => {
            let (time, own) = *curve.last()?;
            (time * (own / rmse).powi(2), "about ")
        }
    };
    let ratio = time / best.median_seconds();
    (ratio.is_finite() && ratio >= 1.05).then(|| format!("{at_least}{}", significant(ratio)))
}
