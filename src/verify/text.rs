//! A report → a table for people: one line a group of variants (address, filter, class of formats; all
//! minification filters and mip modes together, since level 0 reads neither), then what fails.

use std::fmt::Write as _;

use super::report::{Group, Report, Row, Verdict};

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
        "declared: {} sub-texel bits, {} mip bits; errors in parts of the texels' range",
        limits.sub_texel_bits, limits.mip_bits
    ));
    line(String::new());
    line(format!(
        "{:<15} {:<21} {:<8} {:<8} {:>8} {:>8} {:>6} {:>8} {:>8} {:>6}  verdict",
        "reader", "address", "filter", "texels", "variants", "look-ups", "wrong", "error", "beyond", "bits"
    ));
    for (group, rows) in groups(&report.rows) {
        line(group_line(&group, &rows));
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
    let wrong = format!("{} of {} wrong, worst {}", row.wrong, row.look_ups, number(row.worst_beyond));
    match (&row.example, &row.weights) {
        (Some(example), _) => format!("{wrong}; first: {example}"),
        (None, Some(bits)) => format!("weights of {bits} bits, {declared} declared"),
        (None, None) => wrong,
    }
}

/// Groups in the order of their first rows.
fn groups(rows: &[Row]) -> Vec<(Group, Vec<&Row>)> {
    let mut found: Vec<(Group, Vec<&Row>)> = Vec::new();
    for row in rows {
        let group = Group::of(row);
        match found.iter_mut().find(|(g, _)| *g == group) {
            Some((_, rows)) => rows.push(row),
            None => found.push((group, vec![row])),
        }
    }
    found.sort_by_key(|(group, _)| (group.reader, group.address.is_none()));
    found
}

fn group_line(group: &Group, rows: &[&Row]) -> String {
    let sum = |of: fn(&Row) -> usize| rows.iter().map(|r| of(r)).sum::<usize>();
    let worst = |of: fn(&Row) -> f64| rows.iter().map(|r| of(r)).fold(0.0, f64::max);
    let bits = rows.iter().filter_map(|r| r.weights);
    let bits = match (bits.clone().min(), bits.max()) {
        (Some(least), Some(most)) if least != most => format!("{}–{most}", least.bits),
        (Some(least), _) => least.to_string(),
        _ => "-".into(),
    };
    let verdict = rows.iter().map(|r| r.verdict).max().unwrap_or(Verdict::Within);
    let number_of = rows.iter().filter(|r| r.verdict == verdict).count();
    let verdict = match verdict {
        Verdict::Within => verdict.to_string(),
        _ => format!("{verdict} ({number_of} variants)"),
    };
    format!(
        "{:<15} {:<21} {:<8} {:<8} {:>8} {:>8} {:>6} {:>8} {:>8} {:>6}  {verdict}",
        group.reader.name(),
        group.address.unwrap_or("two modes"),
        group.filter,
        group.class,
        rows.len(),
        sum(|r| r.look_ups),
        sum(|r| r.wrong),
        number(worst(|r| r.worst_error)),
        number(worst(|r| r.worst_beyond)),
        bits,
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
