//! A report → a table for people: one line for the variants that differ in min, mip or address and fared
//! alike, then the faults that drivers are known for, then what fails.

use std::fmt::Write as _;

use super::groups::{Line, lines};
use super::report::{Report, Row, Verdict};

/// Failing variants that are listed one by one.
const MOST_LISTED: usize = 20;

pub fn text(report: &Report) -> String {
    let mut out = String::new();
    let limits = &report.limits;
    let mut line = |text: String| {
        let _ = writeln!(out, "{}", text.trim_end());
    };
    line(format!("{} ({}, Vulkan {})", report.device, report.driver, report.api_version));
    line(format!(
        "declared: {} sub-texel bits, {} mip bits; errors in parts of 1, of floats in parts of their range",
        limits.sub_texel_bits, limits.mip_bits
    ));
    line(String::new());
    line(format!(
        "{:<14} {:<5} {:<7} {:<7} {:<22} {:>8} {:>8} {:>6} {:>7} {:>7} {:>4}  verdict",
        "reader",
        "scale",
        "filter",
        "texels",
        "address",
        "variants",
        "look-ups",
        "wrong",
        "error",
        "beyond",
        "bits"
    ));
    for group in lines(&report.rows) {
        line(table_line(&group));
    }
    line(String::new());
    let summary = &report.summary;
    line(format!(
        "{} variants, {} look-ups, {:.1} s: {} within, {} with a known fault, {} outside, {} not offered",
        summary.variants,
        summary.look_ups,
        report.seconds,
        summary.within,
        summary.known_faults,
        summary.outside,
        summary.not_offered
    ));
    for (fault, count) in faults(&report.rows) {
        line(format!("known fault ({count} variants): {fault}"));
    }
    let failing: Vec<&Row> = report.rows.iter().filter(|r| r.verdict == Verdict::Outside).collect();
    for row in failing.iter().take(MOST_LISTED) {
        line(format!("outside: {}: {}", row.variant.label(), reason(row, limits.sub_texel_bits)));
    }
    if failing.len() > MOST_LISTED {
        line(format!("and {} more outside; --json lists all", failing.len() - MOST_LISTED));
    }
    out
}

fn reason(row: &Row, declared: u32) -> String {
    let mut reasons = Vec::new();
    if row.wrong > 0 {
        reasons.push(format!("{} of {} wrong, worst {}", row.wrong, row.look_ups, number(row.worst_beyond)));
    }
    if let Some(bits) = row.weights.filter(|w| w.bits < declared) {
        reasons.push(format!("weights of {bits} bits, {declared} declared"));
    }
    reasons.extend(row.example.as_ref().map(|example| format!("first: {example}")));
    reasons.join("; ")
}

fn table_line(line: &Line) -> String {
    format!(
        "{:<14} {:<5} {:<7} {:<7} {:<22} {:>8} {:>8} {:>6} {:>7} {:>7} {:>4}  {}",
        line.reader.name(),
        line.scale.name(),
        line.filter.name(),
        line.class.name(),
        line.address,
        line.variants,
        line.look_ups,
        line.wrong,
        number(line.error),
        number(line.beyond),
        line.weights.map_or("-".into(), |w| w.to_string()),
        line.verdict.name(),
    )
}

fn faults(rows: &[Row]) -> Vec<(&'static str, usize)> {
    let mut found: Vec<(&'static str, usize)> = Vec::new();
    for fault in rows.iter().filter_map(|r| r.fault) {
        match found.iter_mut().find(|(name, _)| *name == fault) {
            Some((_, count)) => *count += 1,
            None => found.push((fault, 1)),
        }
    }
    found
}

fn number(x: f64) -> String {
    if x == 0.0 { "0".into() } else { format!("{x:.1e}") }
}
