//! The report as one self-contained HTML page and as JSON: for each case a logarithmic plot of its
//! error over the swept parameter, with the bound as a line, the derivation of the bound, and the
//! data points.

use std::path::Path;

use super::report::{Row, StabilityReport, Verdict};
use super::text::{number, place, summary, swept};
use crate::core::error::{Error, Result};
use crate::lab::plot::chart::{Chart, Series};
use crate::lab::plot::html::{Header, document, long_table, scroll, section, table};
use crate::lab::plot::svg::escape;
use crate::output;

/// The file that is written first.
pub const PAGE: &str = "stability.html";
const JSON: &str = "stability.json";

pub fn json(report: &StabilityReport) -> Result<String> {
    serde_json::to_string_pretty(report).map_err(|e| Error::new(format!("the report as JSON: {e}")))
}

/// Writes both files; each appears complete or not at all.
pub fn write(folder: &Path, report: &StabilityReport) -> Result<()> {
    output::write_file(&folder.join(PAGE), html(report).as_bytes())?;
    output::write_file(&folder.join(JSON), json(report)?.as_bytes())
}

pub fn html(report: &StabilityReport) -> String {
    let mut groups: Vec<&str> = Vec::new();
    for row in report.rows.iter().filter(|r| groups.last() != Some(&r.group)).collect::<Vec<_>>() {
        if !groups.contains(&row.group) {
            groups.push(row.group);
        }
    }
    let of_group = |group: &str| {
        let rows = report.rows.iter().filter(|r| r.group == group);
        section(group, &escape(&capital(group)), &rows.map(case).collect::<String>())
    };
    let sections: String = groups.iter().map(|g| of_group(g)).collect();
    let facts = format!(
        "{} ({}), Vulkan {}, moire {}",
        escape(&report.device),
        escape(&report.driver),
        escape(&report.api_version),
        env!("CARGO_PKG_VERSION")
    );
    let header =
        Header { title: "Extreme cases", facts: &facts, lead: &summary(report), more: &overview(report) };
    document(&header, &sections, "")
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn id(row: &Row) -> String {
    format!("{}-{}", row.group, row.name)
}

fn verdict(row: &Row) -> String {
    let name = row.verdict.name();
    if row.verdict == Verdict::Broken { format!("<span class=\"broken\">{name}</span>") } else { name.into() }
}

fn overview(report: &StabilityReport) -> String {
    let line = |row: &Row| {
        vec![
            format!("<a href=\"#{}\">{}</a>", id(row), escape(&row.label())),
            escape(&swept(row)),
            escape(&format!("{} {}", number(row.worst.error), row.unit)),
            number(row.bound),
            escape(&place(row)),
            verdict(row),
        ]
    };
    let rows: Vec<Vec<String>> = report.rows.iter().map(line).collect();
    table("All cases", &["case", "parameter", "worst error", "bound", "reached at", "verdict"], &rows)
}

fn case(row: &Row) -> String {
    let label = row.label();
    let points = row.points.iter().map(|p| vec![number(p.parameter), number(p.error), escape(&p.place)]);
    let rows: Vec<Vec<String>> = points.collect();
    let what = if row.points.is_empty() {
        format!("<p>{}</p>\n", escape(&row.worst.place))
    } else {
        scroll(&format!("Error of {label}"), &chart(row))
            + &long_table(&format!("Points of {label}"), &[row.parameter, row.unit, "reached at"], &rows)
    };
    format!(
        "<h3 id=\"{}\">{}: {}</h3>\n<p>Bound {} {}: {}</p>\n{what}",
        id(row),
        escape(row.name),
        verdict(row),
        number(row.bound),
        escape(row.unit),
        escape(row.reason)
    )
}

/// Draws the plot of a case. Zero is at the bottom of the plot, NaN and infinity at its top.
fn chart(row: &Row) -> String {
    let title = |p: &super::case::Point| {
        format!("{} {}: {} {}, {}", row.parameter, number(p.parameter), number(p.error), row.unit, p.place)
    };
    let description = format!(
        "Error ({}) over {}, both logarithmic. The worst is {} at {}; the bound is {}.",
        row.unit,
        swept(row),
        number(row.worst.error),
        place(row),
        number(row.bound)
    );
    Chart {
        id: &format!("plot-{}", id(row)),
        title: format!("Error of {}", row.label()),
        description,
        x_label: row.parameter,
        y_label: row.unit,
        series: vec![Series {
            name: row.label(),
            points: row.points.iter().map(|p| [p.parameter, p.error]).collect(),
            titles: row.points.iter().map(title).collect(),
            dashed: false,
        }],
        level: Some((row.bound, "bound")),
        guides: Vec::new(),
    }
    .svg()
}
