//! The report as a text table: one line for the variants that differ in min, mip or address and
//! have equal results, then known faults of drivers, then failures.

use std::fmt::Write as _;

use super::groups::{Line, lines};
use super::report::{ConformanceReport, Limits, Row, Verdict};
use crate::core::counted::counted;

/// The number of failing variants that are listed individually.
const MAX_LISTED: usize = 20;

pub fn text(report: &ConformanceReport) -> String {
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
    line(table_line(
        ["reader", "texture", "scale", "filter", "mip", "texels", "address"],
        ["variants", "look-ups", "wrong", "error", "beyond", "bits"],
        "verdict",
    ));
    for group in lines(&report.rows) {
        line(group_line(&group));
    }
    line(String::new());
    let summary = &report.summary;
    line(format!(
        "{}, {}, {:.1} s: {} within, {} with a known fault, {} outside, {} not offered",
        counted(summary.variants, "variant"),
        counted(summary.look_ups, "look-up"),
        report.seconds,
        summary.within,
        summary.known_faults,
        summary.outside,
        summary.not_offered
    ));
    if let Some(text) = anisotropies(&report.rows) {
        line(text);
    }
    for (fault, count) in faults(&report.rows) {
        line(format!("known fault ({}): {fault}", counted(count, "variant")));
    }
    let failing: Vec<&Row> = report.rows.iter().filter(|r| r.verdict == Verdict::Outside).collect();
    for row in failing.iter().take(MAX_LISTED) {
        line(format!("outside: {}: {}", row.variant.label(), reason(row, limits)));
    }
    if failing.len() > MAX_LISTED {
        line(format!("and {} more outside; --json lists all", failing.len() - MAX_LISTED));
    }
    out
}

fn reason(row: &Row, limits: &Limits) -> String {
    let mut reasons = Vec::new();
    if row.wrong > 0 {
        reasons.push(format!("{} of {} wrong, worst {}", row.wrong, row.look_ups, number(row.worst_beyond)));
    }
    for (what, weights, declared) in [
        ("weights", row.weights, limits.sub_texel_bits),
        ("weights of levels", row.level_weights, limits.mip_bits),
    ] {
        if let Some(bits) = weights.filter(|w| w.bits < declared) {
            reasons.push(format!("{what} of {bits} bits, {declared} declared"));
        }
    }
    reasons.extend(row.example.as_ref().map(|example| format!("first: {example}")));
    reasons.join("; ")
}

fn table_line(left: [&str; 7], right: [&str; 6], verdict: &str) -> String {
    let [a, b, c, d, e, f, g] = left;
    let [h, i, j, k, l, m] = right;
    format!(
        "{a:<14} {b:<7} {c:<6} {d:<11} {e:<7} {f:<7} {g:<22} {h:>8} {i:>8} {j:>6} {k:>7} {l:>7} {m:>4}  {verdict}"
    )
}

fn group_line(line: &Line) -> String {
    table_line(
        [
            line.reader.name(),
            line.dimension.name(),
            line.scale.name(),
            line.filter.name(),
            line.mip.map_or("-", |m| m.name()),
            line.class.map_or("all", |c| c.name()),
            &line.address,
        ],
        [
            &line.variants.to_string(),
            &line.look_ups.to_string(),
            &line.wrong.to_string(),
            &number(line.error),
            &number(line.beyond),
            &line.weights.map_or("-".into(), |w| w.to_string()),
        ],
        line.verdict.name(),
    )
}

/// Returns the largest resolved anisotropy for each limit of the sampler; if levels are wrong it is
/// meaningless.
fn anisotropies(rows: &[Row]) -> Option<String> {
    let mut limits: Vec<u32> = rows.iter().filter_map(|r| r.max_anisotropy).collect();
    limits.sort();
    limits.dedup();
    let followed = |limit: &u32| {
        let of = rows.iter().filter(|r| r.max_anisotropy == Some(*limit) && r.verdict == Verdict::Within);
        let most = of.filter_map(|r| r.anisotropy).reduce(f64::max);
        format!("{limit}: {}", most.map_or("-".into(), |m| format!("{m:.1}")))
    };
    let list: Vec<String> = limits.iter().map(followed).collect();
    (!list.is_empty()).then(|| format!("anisotropy asked for and followed: {}", list.join(", ")))
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
