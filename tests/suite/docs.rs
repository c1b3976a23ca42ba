//! README.md and docs: every command works, every link leads somewhere, the scene format and the command line
//! are those of the code, and every formula has its functions and its test. In: the pages beside the data.
//! `MOIRE_UPDATE_DOCS=1` rewrites what is generated in them and still fails: read the change, then test again.

mod architecture;
pub mod cli;
mod commands;
mod examples;
mod formulas;
mod links;
mod probe;
mod recipes;
mod scene_format;
mod synonyms;
mod table;

use std::fs;
use std::path::PathBuf;

use crate::layering::files_under;
use crate::support::{data, untested};

/// Bounds the README, which leads to the docs and does not hold them.
const MOST_README_LINES: usize = 250;

pub struct Page {
    /// The path, relative to the root of the repository: `docs/cli.md`.
    pub name: String,
    pub text: String,
}

/// Returns the root of the repository; `None` where only binaries and data were carried.
pub fn root() -> Option<PathBuf> {
    let root = data().join("..");
    let there = root.join("README.md").is_file() && root.join("docs").is_dir();
    if !there {
        untested("README.md and docs: they are not beside the data");
    }
    there.then_some(root)
}

/// Returns README.md and then the files of `docs`, ordered by name.
pub fn pages() -> Vec<Page> {
    let Some(root) = root() else { return Vec::new() };
    let mut files = Vec::new();
    files_under(&root.join("docs"), &mut files);
    files.retain(|file| file.extension().is_some_and(|e| e == "md"));
    files.sort();
    files.insert(0, root.join("README.md"));
    let page = |file: PathBuf| Page {
        name: file.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/"),
        text: fs::read_to_string(&file).unwrap(),
    };
    files.into_iter().map(page).collect()
}

/// Returns a page's paragraphs, rows of tables and headings, each as one line, without its blocks of code.
pub fn prose(text: &str) -> Vec<String> {
    let mut inside = false;
    let mut found = vec![String::new()];
    for line in text.lines() {
        let fence = line.trim_start().starts_with("```");
        inside ^= fence;
        if inside || fence || line.trim().is_empty() {
            found.push(String::new());
        } else if line.starts_with(['|', '#', '-']) || found.last().is_none_or(|p| p.starts_with(['|', '#']))
        {
            found.push(line.to_string());
        } else if let Some(paragraph) = found.last_mut() {
            *paragraph += &format!(" {}", line.trim());
        }
    }
    found.retain(|paragraph| !paragraph.is_empty());
    found
}

/// Returns what stands in backticks in a paragraph.
pub fn spans(paragraph: &str) -> impl Iterator<Item = &str> {
    paragraph.split('`').skip(1).step_by(2)
}

/// Fails with the faults of a page. Where `MOIRE_UPDATE_DOCS` is set the page becomes `right` first.
pub fn judge(page: &str, faults: &[String], right: &str) {
    if faults.is_empty() {
        return;
    }
    let update = std::env::var_os("MOIRE_UPDATE_DOCS").is_some();
    if update {
        fs::write(data().join("..").join(page), right).unwrap();
    }
    let next = if update {
        "rewritten: read the change, fill in what is marked \"?\", then test again without MOIRE_UPDATE_DOCS"
    } else {
        "MOIRE_UPDATE_DOCS=1 rewrites what is generated"
    };
    panic!("{page}:\n{}\n{next}", faults.join("\n"));
}

#[test]
fn the_readme_is_short() {
    let Some(readme) = pages().into_iter().next() else { return };
    let lines = readme.text.lines().count();
    assert!(lines <= MOST_README_LINES, "README.md has {lines} lines, more than {MOST_README_LINES}");
}

#[test]
fn paragraphs_are_joined_and_code_is_left_out() {
    let text = "# A\nB\n`c\nd` e\n```sh\nf\n```\n- g\n  h\n- i\n| j |\n| k |\nl\n";
    assert_eq!(prose(text), ["# A", "B `c d` e", "- g h", "- i", "| j |", "| k |", "l"]);
    assert_eq!(spans("B `c d` e `f`").collect::<Vec<_>>(), ["c d", "f"]);
}
