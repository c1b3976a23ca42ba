//! The JSON object and the page agree with the report; the page is well-formed and self-contained.

use std::fs;

use moire::internal::lab::stability::page::{html, json, write};
use roxmltree::{Document, Node};
use serde_json::Value;
use tempfile::tempdir;

use super::{report, row};
use moire::internal::lab::stability::report::{Row, StabilityReport};

fn planted() -> StabilityReport {
    let mut other = row("zeros", &[0.0, 0.0]);
    other.group = "second";
    report(vec![
        row("sound", &[1e-4, 0.0, 5e-4]),
        row("off", &[1e-4, f64::NAN, 0.25]),
        row("void", &[]),
        other,
    ])
}

#[test]
fn the_json_object_has_every_point_and_null_for_an_error_that_is_no_number() {
    let value: Value = serde_json::from_str(&json(&planted()).unwrap()).unwrap();
    assert_eq!(value["device"], "made up");
    assert_eq!(value["driver"], "of paper <1>");
    assert_eq!(value["api_version"], "1.3.0");
    assert_eq!(value["seconds"], 12.34);
    assert_eq!(value["summary"], serde_json::json!({"cases": 4, "points": 8, "within": 2, "broken": 2}));
    let cases = value["cases"].as_array().unwrap();
    let first = &cases[0];
    for (key, expected) in [
        ("group", "planted"),
        ("name", "sound"),
        ("parameter", "distance in metres"),
        ("unit", "pixels"),
        ("reason", "half an ulp & no more"),
        ("verdict", "within"),
    ] {
        assert_eq!(first[key], expected);
    }
    assert_eq!((&first["bound"], &first["seconds"]), (&Value::from(1e-3), &Value::from(0.5)));
    assert_eq!(first["worst"], first["points"][2]);
    assert_eq!(
        first["points"][2],
        serde_json::json!({"parameter": 100.0, "error": 5e-4, "place": "pixel (2, 0)"})
    );
    assert_eq!(cases[1]["worst"]["error"], Value::Null);
    assert_eq!(cases[1]["worst"]["place"], "pixel (1, 0)");
    assert_eq!(cases[2]["worst"]["place"], "no value was measured");
    assert_eq!(cases[2]["verdict"], "broken");
}

/// Returns the page's text without markup.
fn markup(page: &str) -> String {
    let mut text = page.replacen("<!doctype html>", "", 1);
    while let Some(start) = text.find("<style>") {
        let end = start + text[start..].find("</style>").unwrap() + "</style>".len();
        text.replace_range(start..end, "");
    }
    text
}

fn all<'a>(page: &'a Document<'a>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'a>> {
    page.descendants().filter(move |n| n.tag_name().name() == tag)
}

fn said(node: Node<'_, '_>) -> String {
    node.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_page_has_a_section_a_group_and_of_each_case_a_plot_its_reason_and_its_points() {
    let page = html(&planted());
    for remote in ["https://", "src=", "@import", "url(", "<script"] {
        assert!(!page.contains(remote), "the page has {remote}");
    }
    assert_eq!(page.matches("http://").count(), page.matches("http://www.w3.org/2000/svg").count());
    assert!(page.contains("prefers-color-scheme: dark"));
    let markup = markup(&page);
    let page = Document::parse(&markup).unwrap();
    let headings: Vec<String> = all(&page, "h2").map(said).collect();
    assert_eq!(headings, ["Planted", "Second"]);
    let cases: Vec<String> = all(&page, "h3").map(said).collect();
    assert_eq!(cases.len(), 4);
    assert!(cases[1].starts_with("off:") && cases[1].contains("broken"), "{cases:?}");
    let plots: Vec<Node<'_, '_>> = all(&page, "svg").collect();
    assert_eq!(plots.len(), 3, "a case without points has no plot");
    for plot in plots {
        let marks =
            plot.descendants().filter(|n| n.attribute("class").is_some_and(|c| c.starts_with("mark")));
        let expected = if said(plot).contains("zeros") { 2 } else { 3 };
        assert_eq!(marks.count(), expected, "every point has a mark, also 0 and what is no number");
        assert!(plot.descendants().any(|n| n.attribute("class") == Some("level")), "the bound is missing");
        assert!(said(plot).contains("half an ulp") || said(plot).contains("bound"));
    }
    assert_eq!(all(&page, "caption").count(), all(&page, "table").count());
    assert_eq!(all(&page, "table").count(), 1 + 3);
    let ids: Vec<&str> = page.descendants().filter_map(|n| n.attribute("id")).collect();
    let mut distinct = ids.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), ids.len(), "{ids:?}");
    for link in all(&page, "a") {
        assert!(ids.contains(&link.attribute("href").unwrap().trim_start_matches('#')));
    }
    let text = said(page.root_element());
    assert_eq!(text.matches("half an ulp & no more").count(), 4);
    assert!(text.contains("4 cases, 8 points, 12.3 s: 2 within, 2 broken") && text.contains("of paper <1>"));
}

fn plot(row: Row) -> String {
    let page = html(&report(vec![row]));
    let svg = &page[page.find("<svg").unwrap()..page.find("</svg>").unwrap()];
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "a place is no number: {svg}");
    svg.to_string()
}

#[test]
fn a_zero_is_marked_at_the_floor_of_the_plot_and_no_number_at_its_top() {
    let plain = plot(row("plain", &[1e-6, 1e-5]));
    assert!(!plain.contains(">0</text>") && !plain.contains(">∞</text>"), "{plain}");
    let zero = plot(row("zero", &[1e-6, 0.0]));
    assert!(zero.contains(">0</text>") && !zero.contains(">∞</text>"), "{zero}");
    let broken = plot(row("broken", &[1e-6, f64::NAN]));
    assert!(!broken.contains(">0</text>") && broken.contains(">∞</text>"), "{broken}");
    let mut exact = row("exact", &[0.0, 0.0]);
    exact.bound = 0.0;
    exact.points[0].parameter = 0.0;
    assert_eq!(plot(exact).matches(">0</text>").count(), 2, "on both axes");
}

#[test]
fn plots_over_many_decades_number_some_of_them() {
    let mut wide = row("wide", &[1e-300, 1e-7, 1e300]);
    wide.points[0].parameter = 1e-30;
    let svg = plot(wide);
    let numbers = svg.matches("</text>").count();
    assert!((8..40).contains(&numbers), "{numbers} texts");
}

#[test]
fn both_files_are_written_whole() {
    let folder = tempdir().unwrap();
    write(folder.path(), &planted()).unwrap();
    let mut names: Vec<String> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["stability.html", "stability.json"]);
    let text = fs::read_to_string(folder.path().join("stability.json")).unwrap();
    assert_eq!(text, json(&planted()).unwrap());
}
