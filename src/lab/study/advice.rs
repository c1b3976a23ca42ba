//! The sentence that recommends a setting. In: the measured points and the winners. Out: the recommended point, and who
//! is better with less and with more time.

use super::choice::{chosen, not_significantly_different};
use super::fit::time_to;
use super::format::{asked_error, asked_seconds, error, names, samples_taken, seconds, significant};
use super::record::{PointRecord, Question, Record};
use super::results::Winner;

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
        error(best.errors.rmse),
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
    text + "."
}

/// Returns the sentence that answers a question.
fn answer(record: &Record, question: Question, best: &PointRecord) -> String {
    let what = |p: &PointRecord| {
        let (rmse, time) = (error(p.errors.rmse), seconds(p.median_seconds()));
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
    format!("{opening} {}{next}.", what(best))
}

/// Returns, in brackets, the methods whose points with as many samples err the same.
fn equals(record: &Record, best: &PointRecord) -> String {
    let mut equals: Vec<&str> = Vec::new();
    for point in record.points.iter().filter(|p| p.method != best.method && p.spp == best.spp) {
        let label = record.label(&point.method);
        if not_significantly_different(point, best) && !equals.contains(&label) {
            equals.push(label);
        }
    }
    match equals.is_empty() {
        true => String::new(),
        false => format!(" ({} errs the same but for noise)", equals.join(" or ")),
    }
}

fn setting(record: &Record, winner: &Winner) -> String {
    let about = if winner.estimated { "about " } else { "" };
    format!("{} with {} (RMSE {about}{})", names(record, winner), winner.taken, error(winner.rmse))
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
