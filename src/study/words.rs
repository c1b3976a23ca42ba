//! Numbers as words: the sentence that recommends a setting, and how times, errors and counts are written on
//! the page.

use super::analysis::{Winner, time_to};
use super::record::{PointRecord, Record};

/// Who wins how much of the time axis: neighbouring budgets of one method, as (method, first, last).
fn stretches(winners: &[Winner]) -> Vec<(&str, &Winner, &Winner)> {
    let mut stretches: Vec<(&str, &Winner, &Winner)> = Vec::new();
    for winner in winners {
        match stretches.last_mut() {
            Some((method, _, last)) if *method == winner.method => *last = winner,
            _ => stretches.push((&winner.method, winner, winner)),
        }
    }
    stretches
}

/// The method that wins with the most time, its best count, what it saves, and who is better with less time.
pub fn advice(record: &Record, winners: &[Winner]) -> String {
    let Some((_, first, last)) = stretches(winners).last().copied() else {
        return "Nothing was measured.".into();
    };
    let mut text = format!(
        "Use {} with {}: RMSE {} in {}",
        last.method,
        samples(last.spp),
        error(last.rmse),
        seconds(last.seconds)
    );
    if let Some(times) = saved(record, last) {
        text += &format!(", {times} times as fast as random samples come to that error");
    }
    if first.budget < last.budget {
        text += &format!("; it has the least error from {} on", seconds(first.seconds));
    }
    let stretches = stretches(winners);
    // Two at most, those that hold longest: a sentence is no table.
    let mut before: Vec<_> = stretches[..stretches.len() - 1].iter().collect();
    before.sort_by(|a, b| (b.2.budget / b.1.budget).total_cmp(&(a.2.budget / a.1.budget)));
    before.truncate(2);
    before.sort_by(|a, b| a.1.budget.total_cmp(&b.1.budget));
    let shorter: Vec<String> = before
        .iter()
        .map(|(method, _, last)| {
            format!(
                "with {} {method} with {} (RMSE {})",
                seconds(last.budget),
                samples(last.spp),
                error(last.rmse)
            )
        })
        .collect();
    if !shorter.is_empty() {
        text += &format!("; {}", shorter.join(", "));
    }
    text + "."
}

fn saved(record: &Record, winner: &Winner) -> Option<String> {
    let curve: Vec<(f64, f64)> =
        record.points_of("random").map(|p| (p.median_seconds(), p.errors.rmse)).collect();
    if winner.method == "random" {
        return None;
    }
    let (time, at_least) = match time_to(&curve, winner.rmse) {
        Some(time) => (time, ""),
        // Independent samples halve their error with four times the number.
        None => {
            let (time, rmse) = *curve.last()?;
            (time * (rmse / winner.rmse).powi(2), "about ")
        }
    };
    let ratio = time / winner.seconds;
    (ratio.is_finite() && ratio >= 1.05).then(|| format!("{at_least}{}", significant(ratio)))
}

pub fn samples(spp: u32) -> String {
    if spp == 1 { "1 sample".into() } else { format!("{spp} samples") }
}

pub fn seconds(seconds: f64) -> String {
    match seconds {
        s if !s.is_finite() => "–".into(),
        s if s >= 0.9995 => format!("{} s", significant(s)),
        s if s >= 0.999_5e-3 => format!("{} ms", significant(s * 1e3)),
        s => format!("{} µs", significant(s * 1e6)),
    }
}

/// Three digits, with an exponent where a picture's errors have one.
pub fn error(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 || value >= 0.1 {
        return format!("{value:.3}");
    }
    format!("{value:.2e}").replace('-', "−")
}

fn significant(value: f64) -> String {
    match value {
        v if v >= 99.5 => format!("{v:.0}"),
        v if v >= 9.95 => format!("{v:.1}"),
        v => format!("{v:.2}"),
    }
}

pub fn percent(share: f64) -> String {
    format!("{} %", significant(share * 100.0))
}

/// Times of one point: median, and the spread of its repeats.
pub fn times(point: &PointRecord) -> String {
    let least = point.seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let most = point.seconds.iter().copied().fold(0.0, f64::max);
    format!("{} ({} to {})", seconds(point.median_seconds()), seconds(least), seconds(most))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_with_three_digits_and_a_unit() {
        let written = [12.34, 1.0, 0.9996, 0.5, 0.001, 2.5e-5].map(seconds);
        assert_eq!(written, ["12.3 s", "1.00 s", "1.00 s", "500 ms", "1.00 ms", "25.0 µs"]);
        assert_eq!([0.25, 0.0123, 0.0].map(error), ["0.250", "1.23e−2", "0.000"]);
        assert_eq!(percent(0.1234), "12.3 %");
    }
}
