//! docs/architecture.md against the code: the rooms with what each may use, and the crates of Cargo.toml.

use std::collections::BTreeSet;
use std::fs;

use super::table::{correct, rows};
use super::{judge, pages, root};
use crate::layering::ALLOWED;

const PAGE: &str = "docs/architecture.md";
/// The columns: room, what it may use, what it holds. The first two are generated.
const COLUMNS: usize = 3;

#[test]
fn the_rooms_and_what_they_may_use_are_those_of_the_layer_test() {
    let Some(page) = pages().into_iter().find(|page| page.name == PAGE) else { return };
    let row = |(room, used): &(&str, &[&str])| {
        let used: Vec<String> = used.iter().map(|used| format!("`{used}`")).collect();
        let used = if used.is_empty() { "nothing".into() } else { used.join(", ") };
        vec![format!("`{room}`"), used]
    };
    let wanted: Vec<Vec<String>> = ALLOWED.iter().map(row).collect();
    let (mut text, mut faults) = (page.text.clone(), Vec::new());
    correct(&mut text, "## Rooms", COLUMNS, &wanted, &mut faults);
    judge(PAGE, &faults, &text);
}

/// Returns what lies in backticks in the first cells.
fn named(rows: &[Vec<String>]) -> BTreeSet<String> {
    rows.iter().flat_map(|row| row[0].split('`').skip(1).step_by(2).map(String::from)).collect()
}

/// Returns the crates of all tables of dependencies in a manifest.
fn crates(manifest: &str) -> BTreeSet<String> {
    let table: toml::Table = manifest.parse().unwrap();
    let mut found = BTreeSet::new();
    let mut tables = vec![table];
    while let Some(table) = tables.pop() {
        for (key, value) in table {
            let toml::Value::Table(inner) = value else { continue };
            if key.ends_with("dependencies") {
                found.extend(inner.keys().cloned());
            } else {
                tables.push(inner);
            }
        }
    }
    found
}

#[test]
fn every_crate_has_its_reason() {
    let Some(root) = root() else { return };
    let page = pages().into_iter().find(|page| page.name == PAGE).expect("no docs/architecture.md");
    let manifest = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    assert_eq!(
        named(&rows(&page.text, "## Dependencies")),
        crates(&manifest),
        "left: {PAGE}, right: Cargo.toml"
    );
}

#[test]
fn crates_are_read_from_every_table_of_dependencies() {
    let manifest = "[dependencies]\na = \"1\"\n[target.'cfg(unix)'.dependencies]\nb = { version = \"1\" }\n[dev-dependencies]\nc = \"1\"\n[package]\nname = \"d\"\n";
    assert_eq!(crates(manifest), ["a", "b", "c"].map(String::from).into());
    assert_eq!(named(&[vec!["`a`, `b` (tests)".into()]]), ["a", "b"].map(String::from).into());
}
