//! The report as a text table with one line per case, a summary, and the derivations of bounds that
//! are exceeded. The HTML page shares its number formats.

use std::fmt::Write as _;

use super::report::{Row, StabilityReport};
use crate::core::counted::counted;

const HEAD: [&str; 6] = ["case", "parameter", "worst error", "bound", "reached at", "verdict"];
/// The length to which positions are shortened in the table.
const MAX_PLACE_LENGTH: usize = 44;

pub fn text(report: &StabilityReport) -> String {
    let mut out = String::new();
    let mut line = |text: &str| {
        let _ = writeln!(out, "{}", text.trim_end());
    };
    line(&format!("{} ({}, Vulkan {})", report.device, report.driver, report.api_version));
    line("");
    let lines: Vec<[String; 6]> =
        std::iter::once(HEAD.map(String::from)).chain(report.rows.iter().map(cells)).collect();
    let widths: [usize; 6] =
        std::array::from_fn(|c| lines.iter().map(|l| l[c].chars().count()).max().unwrap_or(0));
    for cells in &lines {
        let padded: Vec<String> =
            cells.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        line(&padded.join("  "));
    }
    line("");
    line(&summary(report));
    for row in report.broken() {
        line(&format!(
            "broken: {}: {} {} at {}; the bound is {}: {}",
            row.label(),
            number(row.worst.error),
            row.unit,
            place(row),
            number(row.bound),
            row.reason
        ));
    }
    out
}

/// Returns `9 cases, 120 points, 31.4 s: 9 within, 0 broken`.
pub fn summary(report: &StabilityReport) -> String {
    let s = &report.summary;
    format!(
        "{}, {}, {:.1} s: {} within, {} broken",
        counted(s.cases, "case"),
        counted(s.points, "point"),
        report.seconds,
        s.within,
        s.broken
    )
}

fn cells(row: &Row) -> [String; 6] {
    [
        row.label(),
        swept(row),
        format!("{} {}", number(row.worst.error), row.unit),
        number(row.bound),
        shortened(&place(row)),
        row.verdict.name().into(),
    ]
}

/// Returns `samples, 256 to 1.68e7`.
pub fn swept(row: &Row) -> String {
    match row.range() {
        Some([from, to]) if from < to => format!("{}, {} to {}", row.parameter, number(from), number(to)),
        Some([only, _]) => format!("{}, {}", row.parameter, number(only)),
        None => row.parameter.into(),
    }
}

/// Returns the parameter's value with the location of the error.
pub fn place(row: &Row) -> String {
    let worst = &row.worst;
    if worst.parameter.is_nan() {
        worst.place.clone()
    } else {
        format!("{}, {}", number(worst.parameter), worst.place)
    }
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= MAX_PLACE_LENGTH {
        return text.into();
    }
    text.chars().take(MAX_PLACE_LENGTH - 1).chain(['…']).collect()
}

/// Formats a number with three digits; short integers stay exact.
pub fn number(x: f64) -> String {
    if x.is_infinite() {
        return if x > 0.0 { "∞" } else { "-∞" }.into();
    }
    if x.fract() == 0.0 && x.abs() < 1e5 {
        return format!("{x}");
    }
    if (0.01..1e4).contains(&x.abs()) {
        let text = format!("{x:.3}");
        return text.trim_end_matches('0').into();
    }
    let text = format!("{x:.2e}");
    match text.split_once('e') {
        Some((digits, exponent)) => {
            format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'))
        }
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_three_digits_at_most_and_whole_ones_none_behind_the_point() {
        let written = [0.0, 16384.0, 16777216.0, 1e-6, 1.234e-8, 0.5, 89.999, f64::INFINITY].map(number);
        assert_eq!(written, ["0", "16384", "1.68e7", "1e-6", "1.23e-8", "0.5", "89.999", "∞"]);
    }
}
