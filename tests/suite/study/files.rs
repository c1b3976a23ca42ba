//! The files of a study are well-formed and consistent with each other.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::tempdir;

use super::{points, studied};

const OPTIONS: [&str; 6] =
    ["--methods", "center,random,stratified,stratified+cone+linear", "--spp", "1,4,16", "--repeats", "2"];

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// Returns the page's text without markup.
fn markup(page: &str) -> String {
    let mut text = page.replacen("<!doctype html>", "", 1);
    for tag in ["script", "style"] {
        while let Some(start) = text.find(&format!("<{tag}>")) {
            let close = format!("</{tag}>");
            let end = start + text[start..].find(&close).expect("the element ends") + close.len();
            text.replace_range(start..end, "");
        }
    }
    text
}

#[test]
fn folder_holds_well_formed_tables_plots_and_a_page() {
    let folder = tempdir().unwrap();
    let record = studied(folder.path(), &OPTIONS);
    let json: Value = serde_json::from_str(&read(folder.path(), "study.json")).unwrap();
    assert_eq!(json, record, "--json prints the file");
    check_csv(&read(folder.path(), "study.csv"), &record);
    for name in ["error-time.svg", "error-rays.svg", "stages.svg"] {
        let text = read(folder.path(), name);
        let svg = roxmltree::Document::parse(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let root = svg.root_element();
        assert_eq!(root.tag_name().name(), "svg");
        for part in ["title", "desc"] {
            let found = root.children().find(|n| n.has_tag_name(("http://www.w3.org/2000/svg", part)));
            assert!(found.and_then(|n| n.text()).is_some_and(|t| !t.is_empty()), "{name} has no {part}");
        }
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}: a place is no number");
    }
    let page = read(folder.path(), "index.html");
    for remote in ["http://", "https://", "src=\"/", "@import", "url("] {
        let found = page.matches(remote).count();
        let names = page.matches("http://www.w3.org/2000/svg").count();
        assert_eq!(found, if remote == "http://" { names } else { 0 }, "the page asks for {remote}");
    }
    check_page(&markup(&page), &record);
}

fn check_csv(csv: &str, record: &Value) {
    let head: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|h| *h == name).unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().skip(1).map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len(), points(record).len());
    for (row, point) in rows.iter().zip(points(record)) {
        assert_eq!(row.len(), head.len(), "{row:?}");
        assert_eq!(row[column("method")], point["method"]);
        let rmse: f64 = row[column("rmse")].parse().unwrap();
        assert!((rmse / point["errors"]["rmse"].as_f64().unwrap() - 1.0).abs() < 1e-5, "{row:?}");
        let [own, low, high] = ["own_rmse", "own_rmse_low", "own_rmse_high"].map(|name| row[column(name)]);
        let [own, low, high] = [own, low, high].map(|text| text.parse::<f64>().unwrap());
        assert!(low <= own && own <= high && own < rmse, "{own} of {rmse}, {low} to {high}");
        let reference = record["reference"]["rmse"].as_f64().unwrap();
        assert!((own.hypot(reference) / rmse - 1.0).abs() < 1e-5, "{own}, {reference} and {rmse}");
        assert!(row[column("render_seconds")].parse::<f64>().unwrap() > 0.0, "{row:?}");
    }
}

fn check_page(markup: &str, record: &Value) {
    let page = roxmltree::Document::parse(markup).unwrap();
    let all = |tag: &'static str| page.descendants().filter(move |n| n.tag_name().name() == tag);
    assert!(all("img").count() >= 10, "the pictures are missing");
    for img in all("img") {
        assert!(img.attribute("alt").is_some_and(|alt| alt.len() > 10), "a picture without words");
        assert!(img.attribute("src").is_some_and(|src| src.starts_with("data:image/")));
    }
    assert_eq!(all("svg").count(), 6, "three charts, wide and narrow");
    assert!(all("caption").count() == all("table").count() && all("table").count() >= 5);
    let said = page.root_element().descendants().filter_map(|n| n.text()).collect::<Vec<_>>().join(" ");
    let sentence = record["analysis"]["recommendation"].as_str().unwrap();
    assert!(said.contains(sentence), "the page does not open with: {sentence}");
    for point in points(record) {
        assert!(said.contains(point["command"].as_str().unwrap()), "a command is missing: {point}");
    }
    for heading in ["Jaggies", "Regular patterns", "Noise", "Stratified jitter", "Filtering"] {
        assert!(said.contains(heading), "{heading} is not shown");
    }
}

#[test]
fn record_says_where_and_against_what_it_was_measured() {
    let folder = tempdir().unwrap();
    let record = studied(folder.path(), &OPTIONS);
    assert!(record["device"]["name"].as_str().is_some_and(|n| !n.is_empty()));
    assert!(record["device"]["limits"]["sub_texel_bits"].is_u64());
    let reference = record["reference"]["rmse"].as_f64().unwrap();
    let best = points(&record).iter().map(|p| p["errors"]["rmse"].as_f64().unwrap()).fold(1.0, f64::min);
    assert!(reference > 0.0 && reference < 0.5 * best, "{reference} for {best}");
    // centre at one count, three methods at three.
    assert_eq!(points(&record).len(), 10);
    for point in points(&record) {
        assert_eq!(point["seconds"].as_array().unwrap().len(), 2, "{point}");
        for metric in ["rmse", "relative_mse", "max", "over_1_255", "flip"] {
            assert!(point["errors"][metric].as_f64().is_some_and(|e| e > 0.0), "{metric}: {point}");
        }
        let blocks = point["blocks"].as_array().unwrap().iter().map(|b| b.as_f64().unwrap());
        let size = record["size"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).product::<f64>();
        let mse = blocks.sum::<f64>() / (3.0 * size);
        assert!((mse.sqrt() / point["errors"]["rmse"].as_f64().unwrap() - 1.0).abs() < 1e-6, "{point}");
    }
    let slope = |method: &str| {
        let all = record["analysis"]["slopes"].as_array().unwrap();
        all.iter().find(|s| s["method"] == method).unwrap()["fitted"]["value"].as_f64().unwrap_or(0.0)
    };
    let random = record["analysis"]["slopes"].as_array().unwrap().iter().find(|s| s["method"] == "random");
    let [low, high] = [0, 1].map(|i| random.unwrap()["interval"][i].as_f64().unwrap());
    assert!(low < slope("random") && slope("random") < high && high - low < 0.5, "{low} to {high}");
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("<th scope=\"col\">noise leaves</th>"));
    // Three counts of a small picture with a checker: independent samples come near −1, jittered ones below.
    assert!((slope("random") + 1.0).abs() < 0.3, "{}", slope("random"));
    assert!(slope("stratified") < slope("random"), "{} {}", slope("stratified"), slope("random"));
}
