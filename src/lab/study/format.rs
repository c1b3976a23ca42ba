//! Numbers as words: how times, errors and counts are written in sentences and on the page.

use super::method::Method;
use super::record::{PointRecord, Record};
use super::results::Winner;
use crate::core::counted::counted;
use crate::scene::model::Algorithm;

/// Returns the winning method, or all that tie.
pub fn names(record: &Record, winner: &Winner) -> String {
    let all = std::iter::once(&winner.method).chain(&winner.ties);
    listed(&all.map(|name| record.label(name)).collect::<Vec<_>>(), "or")
}

/// Returns names joined by commas and a word; in quotation marks where commas within names would run them together.
pub fn listed(names: &[&str], word: &str) -> String {
    let quoted = names.iter().any(|name| name.contains(','));
    let one = |name: &&str| if quoted { format!("“{name}”") } else { String::from(*name) };
    let all: Vec<String> = names.iter().map(one).collect();
    match all.split_last() {
        Some((last, first)) if !first.is_empty() => format!("{} {word} {last}", first.join(", ")),
        _ => all.concat(),
    }
}

/// Returns the samples per pixel of a point as text.
pub fn samples_taken(point: &PointRecord) -> String {
    let algorithm = Method::parse(&point.method).map_or(Algorithm::Samples, |method| method.algorithm);
    let count = if algorithm == Algorithm::Beam { point.spp } else { point.samples };
    samples_taken_by(algorithm, count, point.sampled)
}

/// Returns the samples per pixel of an algorithm with `count` samples as text; `sampled` is the
/// fraction of the pixels in which beams were sampled.
pub fn samples_taken_by(algorithm: Algorithm, count: u32, sampled: Option<f64>) -> String {
    match (algorithm, sampled.unwrap_or(0.0)) {
        (Algorithm::Cone, _) => "one cone a pixel".into(),
        (Algorithm::Beam, 0.0) => "one beam a pixel".into(),
        (Algorithm::Beam, 1.0) => format!("{} in every pixel, as beams suit none", samples(count)),
        (Algorithm::Beam, part) => {
            format!("one beam a pixel, and {} in {} of them", samples(count), percent(part))
        }
        (Algorithm::Adaptive, _) => format!("{} on average", samples(count)),
        _ => samples(count),
    }
}

pub fn samples(spp: u32) -> String {
    counted(spp, "sample")
}

pub fn seconds(seconds: f64) -> String {
    match seconds {
        s if !s.is_finite() => "–".into(),
        s if s >= 0.9995 => format!("{} s", significant(s)),
        s if s >= 0.999_5e-3 => format!("{} ms", significant(s * 1e3)),
        s => format!("{} µs", significant(s * 1e6)),
    }
}

/// Formats an error with three digits, with an exponent where errors of pictures need one.
pub fn error(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 || value >= 0.1 {
        return format!("{value:.3}");
    }
    format!("{value:.2e}").replace('-', "−")
}

/// Formats an error without the reference's own: a bound where it cannot be told from none.
pub fn own_error(rmse: f64, [low, high]: [f64; 2]) -> String {
    if low > 0.0 || high <= 0.0 { error(rmse) } else { format!("under {}", error(high)) }
}

/// Formats the error of a point without the reference's own.
pub fn own_error_of(point: &PointRecord) -> String {
    let own = point.own();
    own_error(own.rmse, [own.low, own.high])
}

pub(super) fn significant(value: f64) -> String {
    match value {
        v if v >= 99.5 => format!("{v:.0}"),
        v if v >= 9.95 => format!("{v:.1}"),
        v => format!("{v:.2}"),
    }
}

pub fn percent(share: f64) -> String {
    format!("{} %", significant(share * 100.0))
}

/// Formats a time as it was asked for: 50 ms.
pub fn asked_seconds(seconds: f64) -> String {
    let rounded = |value: f64| format!("{}", (value * 1e6).round() / 1e6);
    match seconds {
        s if s >= 1.0 => format!("{} s", rounded(s)),
        s if s >= 1e-3 => format!("{} ms", rounded(s * 1e3)),
        s => format!("{} µs", rounded(s * 1e6)),
    }
}

/// Formats an error as it was asked for: 0.001.
pub fn asked_error(rmse: f64) -> String {
    if rmse >= 1e-4 { format!("{rmse}") } else { format!("{rmse:e}").replace('-', "−") }
}

/// Returns the median time of a point and the spread of its repeats.
pub fn times(point: &PointRecord) -> String {
    let least = point.seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let most = point.seconds.iter().copied().fold(0.0, f64::max);
    let median = seconds(point.median_seconds());
    if point.seconds.len() < 2 {
        median
    } else {
        format!("{median} ({} to {})", seconds(least), seconds(most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_are_told_apart() {
        assert_eq!(listed(&["random"], "or"), "random");
        assert_eq!(listed(&["random", "Halton", "grid"], "or"), "random, Halton or grid");
        let names = ["EWA, cone footprint", "adaptive"];
        assert_eq!(listed(&names, "and"), "“EWA, cone footprint” and “adaptive”");
    }

    #[test]
    fn an_error_that_noise_may_have_made_is_written_as_a_bound() {
        assert_eq!(own_error(0.01, [0.009, 0.011]), "1.00e−2");
        assert_eq!(own_error(0.001, [0.0, 0.002]), "under 2.00e−3");
        assert_eq!(own_error(0.0, [0.0, 0.0]), "0.000");
    }

    #[test]
    fn numbers_are_written_with_three_digits_and_a_unit() {
        let written = [12.34, 1.0, 0.9996, 0.5, 0.001, 2.5e-5].map(seconds);
        assert_eq!(written, ["12.3 s", "1.00 s", "1.00 s", "500 ms", "1.00 ms", "25.0 µs"]);
        assert_eq!([0.25, 0.0123, 0.0].map(error), ["0.250", "1.23e−2", "0.000"]);
        assert_eq!(percent(0.1234), "12.3 %");
        assert_eq!([0.05, 2.5, 2e-4].map(asked_seconds), ["50 ms", "2.5 s", "200 µs"]);
        assert_eq!([1e-3, 2.5e-5].map(asked_error), ["0.001", "2.5e−5"]);
    }
}
