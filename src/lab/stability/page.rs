//! The report as one self-contained HTML page and as JSON: for each case a logarithmic plot of its
//! error over the swept parameter, with the bound as a line, the derivation of the bound, and the
//! data points.

use std::path::Path;

use super::report::{Row, StabilityReport, Verdict};
use super::text::{number, place, summary, swept};
use crate::core::error::{Error, Result};
use crate::lab::plot::chart::{Chart, Role, Series};
use crate::lab::plot::html::{Header, Html, document, html, long_table, scroll, section, table};
use crate::output;

/// The file that is written first.
pub const PAGE: &str = "stability.html";
pub const JSON: &str = "stability.json";

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
        section(group, &capital(group), rows.map(case).collect())
    };
    let sections: Html = groups.iter().map(|g| of_group(g)).collect();
    let facts = format!(
        "{} ({}), Vulkan {}, moire {}",
        report.device,
        report.driver,
        report.api_version,
        env!("CARGO_PKG_VERSION")
    );
    let header =
        Header { title: "Extreme cases", facts: &facts, lead: &summary(report), more: overview(report) };
    document(&header, &sections, "")
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn id(row: &Row) -> String {
    format!("{}-{}", row.group, row.name)
}

fn verdict(row: &Row) -> Html {
    let name = row.verdict.name();
    if row.verdict == Verdict::Broken {
        html!("<span class=\"broken\">{}</span>", name)
    } else {
        html!("{}", name)
    }
}

fn overview(report: &StabilityReport) -> Html {
    let line = |row: &Row| {
        vec![
            html!("<a href=\"#{}\">{}</a>", id(row), row.label()),
            html!("{}", swept(row)),
            html!("{} {}", number(row.worst.error), row.unit),
            html!("{}", number(row.bound)),
            html!("{}", place(row)),
            verdict(row),
        ]
    };
    let rows: Vec<Vec<Html>> = report.rows.iter().map(line).collect();
    table("All cases", &["case", "parameter", "worst error", "bound", "reached at", "verdict"], &rows)
}

fn case(row: &Row) -> Html {
    let label = row.label();
    let points = row.points.iter();
    let points = points
        .map(|p| vec![html!("{}", number(p.parameter)), html!("{}", number(p.error)), html!("{}", p.place)]);
    let rows: Vec<Vec<Html>> = points.collect();
    let what = if row.points.is_empty() {
        html!("<p>{}</p>\n", row.worst.place)
    } else {
        scroll(&format!("Error of {label}"), Html::trusted(chart(row)))
            + long_table(&format!("Points of {label}"), &[row.parameter, row.unit, "reached at"], &rows)
    };
    html!(
        "<h3 id=\"{}\">{}: {}</h3>\n<p>Bound {} {}: {}</p>\n{}",
        id(row),
        row.name,
        verdict(row),
        number(row.bound),
        row.unit,
        row.reason,
        what
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
            role: Role::Alone,
        }],
        level: Some((row.bound, "bound")),
        guides: Vec::new(),
    }
    .svg()
}
