//! The words of other programs in the reference of scenes. In: the page and the table of the code, whose every
//! word is answered as it says. Out: the page with that table between its markers.

use std::fs;
use std::path::PathBuf;

use moire::internal::scene::synonyms::meant;

use super::root;
use crate::layering::files_under;

const BEGIN: &str = "<!-- synonyms: generated -->";
const END: &str = "<!-- end of synonyms -->";

/// Returns (what it is a word for, the word elsewhere, the word here), line by line of the table in the code.
fn table(source: &str) -> Vec<(String, String, String)> {
    let rows = source.split("SYNONYMS: &[").nth(1).and_then(|rest| rest.split("\n];").next()).unwrap_or("");
    let mut group = String::new();
    let mut found = Vec::new();
    for line in rows.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix("// ") {
            group = name.trim_end_matches('.').to_string();
        } else if let Some(row) = line.strip_prefix("(\"") {
            let words: Vec<&str> = row.split('"').collect();
            found.push((group.clone(), words[0].to_string(), words[2].to_string()));
        }
    }
    found
}

/// Returns a line for each group: `here` (`elsewhere`, `elsewhere`).
fn generated(rows: &[(String, String, String)]) -> String {
    let mut text = String::from("| of | called here (elsewhere) |\n| --- | --- |\n");
    let mut groups: Vec<&String> = rows.iter().map(|row| &row.0).collect();
    groups.dedup();
    for group in groups {
        let own: Vec<_> = rows.iter().filter(|row| row.0 == *group).collect();
        let mut names: Vec<&String> = Vec::new();
        own.iter().for_each(|row| {
            if !names.contains(&&row.2) {
                names.push(&row.2)
            }
        });
        let entry = |name: &&String| {
            let others = own.iter().filter(|row| row.2 == **name).map(|row| format!("`{}`", row.1));
            format!("`{name}` ({})", others.collect::<Vec<_>>().join(", "))
        };
        let entries: Vec<String> = names.iter().map(entry).collect();
        text += &format!("| {} | {} |\n", group.to_lowercase(), entries.join("; "));
    }
    text
}

fn source() -> Option<String> {
    let mut files: Vec<PathBuf> = Vec::new();
    files_under(&root()?.join("src"), &mut files);
    let file = files.into_iter().find(|file| file.ends_with("synonyms.rs")).expect("no synonyms.rs in src");
    Some(fs::read_to_string(file).unwrap())
}

/// Holds the words of the page against the table of the code, and corrects them.
pub fn correct(page: &mut String, faults: &mut Vec<String>) {
    let Some(source) = source() else { return };
    let rows = table(&source);
    assert!(rows.len() > 50, "only {} words were found", rows.len());
    for (_, word, name) in &rows {
        let (here, _) = meant(word, [name.as_str()]).unwrap_or_else(|| panic!("{word} means nothing"));
        assert_eq!(here, name);
    }
    let (before, rest) = page.split_once(BEGIN).expect("no marker of the synonyms");
    let (found, after) = rest.split_once(END).expect("no marker of the synonyms' end");
    let right = format!("\n{}", generated(&rows));
    if found != right {
        faults.push("the words of other programs differ".into());
        *page = format!("{before}{BEGIN}{right}{END}{after}");
    }
}

#[test]
fn the_table_of_the_code_is_read_line_by_line() {
    let source = "const SYNONYMS: &[Synonym] = &[\n    // Patterns.\n    (\"a\", \"b\", None),\n    (\"c\", \"b\", M),\n];";
    let rows = table(source);
    assert_eq!(rows[1], ("Patterns".into(), "c".into(), "b".into()));
    assert!(generated(&rows).ends_with("| patterns | `b` (`a`, `c`) |\n"));
}
