//! docs/formulas.md: each formula of the lecture has its function in the shaders, its twin in the oracle and its
//! test, and all of them exist. In: the rows of the page's tables. Out: what is not there.
//! `MOIRE_UPDATE_DOCS=1` sets the files of functions that have moved.

use std::fs;
use std::path::{Path, PathBuf};

use super::table::cells;
use super::{judge, pages, root};
use crate::layering::files_under;

const PAGE: &str = "docs/formulas.md";
/// The columns: formula, shader, oracle, test.
const COLUMNS: usize = 4;

/// The folders in which the functions of each column are looked for.
const FOLDERS: [&str; 3] = ["glsl", "src", "tests"];

/// Tells whether this source defines a function of that name: `fn name`, or in GLSL `type name(`.
fn defines(path: &Path, source: &str, name: &str) -> bool {
    if path.extension().is_some_and(|e| e == "rs") {
        return [format!("fn {name}("), format!("fn {name}<")].iter().any(|start| source.contains(start));
    }
    let call = format!(" {name}(");
    source.lines().any(|line| {
        let before = line.split(&call).next().filter(|before| before.len() < line.len());
        before.is_some_and(|b| {
            !b.is_empty() && b.trim_start().chars().all(|c| c.is_alphanumeric()) && b.trim() != "return"
        })
    })
}

/// Tells whether that function of a test file runs as a test.
fn is_test(source: &str, name: &str) -> bool {
    let Some(at) = source.find(&format!("fn {name}(")) else { return false };
    source[..at].trim_end().ends_with("#[test]")
}

/// Returns the links of a cell, `[name](../file)`.
fn links(cell: &str) -> Vec<(&str, &str)> {
    let link = |part: &'_ str| -> Option<(usize, usize)> { Some((part.find("](")?, part.find(')')?)) };
    cell.split('[')
        .skip(1)
        .filter_map(|part| {
            let (middle, end) = link(part)?;
            Some((part[..middle].trim_matches('`'), part.get(middle + 2..end)?))
        })
        .collect()
}

/// Returns the one file below a folder that defines a function.
fn home(root: &Path, folder: &str, name: &str) -> Option<String> {
    let mut files: Vec<PathBuf> = Vec::new();
    files_under(&root.join(folder), &mut files);
    let found: Vec<&PathBuf> =
        files.iter().filter(|f| fs::read_to_string(f).is_ok_and(|text| defines(f, &text, name))).collect();
    let [file] = found.as_slice() else { return None };
    Some(format!("../{}", file.strip_prefix(root).ok()?.to_string_lossy().replace('\\', "/")))
}

/// Returns what is wrong with one row, and the row with the files that its functions have moved to.
fn faults(root: &Path, line: &str) -> (Vec<String>, String) {
    let (cells, mut right) = (cells(line), line.to_string());
    if cells.len() != COLUMNS || cells.iter().any(String::is_empty) {
        return (vec![format!("a row has {COLUMNS} cells, none of them empty: {line}")], right);
    }
    let mut found = Vec::new();
    for (cell, folder) in cells[1..].iter().zip(FOLDERS) {
        let links = links(cell);
        if links.is_empty() {
            found.push(format!("\"{}\": nothing in {folder}", cells[0]));
        }
        for (name, target) in links {
            let path = root.join("docs").join(target);
            let source = fs::read_to_string(&path).unwrap_or_default();
            let there = target.starts_with(&format!("../{folder}/")) && defines(&path, &source, name);
            if there && (folder != "tests" || is_test(&source, name)) {
                continue;
            }
            found.push(format!("\"{}\": {target} has no {name}", cells[0]));
            if let Some(home) = home(root, folder, name) {
                right = right.replace(&format!("[`{name}`]({target})"), &format!("[`{name}`]({home})"));
            }
        }
    }
    (found, right)
}

/// Tells whether a line is a row of a table, and not its head.
fn is_row(lines: &[&str], at: usize) -> bool {
    let is_rule = |i: usize| lines.get(i).is_some_and(|line| line.starts_with("| ---"));
    lines[at].starts_with('|') && !is_rule(at) && !is_rule(at + 1)
}

#[test]
fn every_formula_has_its_functions_and_its_test() {
    let Some(root) = root() else { return };
    let page = pages().into_iter().find(|page| page.name == PAGE).expect("no docs/formulas.md");
    let lines: Vec<&str> = page.text.lines().collect();
    let (mut told, mut right, mut rows) = (Vec::new(), Vec::new(), 0);
    for (at, line) in lines.iter().enumerate() {
        if is_row(&lines, at) {
            let (found, row) = faults(&root, line);
            told.extend(found);
            right.push(row);
            rows += 1;
        } else {
            right.push(line.to_string());
        }
    }
    assert!(rows >= 25, "only {rows} formulas");
    judge(PAGE, &told, &(right.join("\n") + "\n"));
}

#[test]
fn planted_rows_are_found() {
    let Some(root) = root() else { return };
    let page = pages().into_iter().find(|page| page.name == PAGE).expect("no docs/formulas.md");
    let lines: Vec<&str> = page.text.lines().collect();
    let good = lines[(0..lines.len()).find(|&at| is_row(&lines, at)).unwrap()];
    let cells = cells(good);
    assert_eq!(faults(&root, good).0, [""; 0]);
    for cell in &cells[1..] {
        let (name, target) = links(cell)[0];
        let wrong = [
            good.replacen(name, &format!("no_{name}"), 1),
            good.replacen(target, "../glsl/shared/none.glsl", 1),
            good.replacen(cell.as_str(), "none", 1),
        ];
        for line in wrong {
            assert_eq!(faults(&root, &line).0.len(), 1, "{line}");
        }
    }
    // A function that is no test does not count as one.
    let helper = good.replacen(&cells[3], "[`unit_sphere`](../tests/suite/lecture.rs)", 1);
    assert_eq!(faults(&root, &helper).0.len(), 1, "{helper}");
    // What has moved is found again.
    let moved = good.replacen(links(&cells[2])[0].1, "../src/oracle/none.rs", 1);
    assert_eq!(faults(&root, &moved).1, good);
}
