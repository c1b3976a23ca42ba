//! Links and pictures of README.md and docs: each relative one names a file, each anchor a heading of it, and no
//! picture of data/readme is shown nowhere. Planted faults are found.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use super::{Page, pages, prose, root, spans};

/// Returns what `](…)` leads to, beside `` `code` ``.
fn targets(text: &str) -> Vec<String> {
    let without_code =
        |line: &String| -> String { line.split('`').step_by(2).collect::<Vec<_>>().join("code") };
    let lines: Vec<String> = prose(text).iter().map(without_code).collect();
    let text = lines.join(" ");
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).map(String::from).collect()
}

/// Returns the anchors of a page's headings, as GitHub names them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let prose = prose(text);
    let headings = prose.iter().filter(|line| line.starts_with('#'));
    let slug = |heading: &str| {
        let words = heading.trim_start_matches('#').trim().to_lowercase();
        let kept = words.chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>()
    };
    let mut found = BTreeSet::new();
    for slug in headings.map(|heading| slug(heading)) {
        let count = seen.entry(slug.clone()).or_default();
        found.insert(if *count == 0 { slug } else { format!("{slug}-{count}") });
        *count += 1;
    }
    found
}

/// Resolves a link from a page: `docs/guide/../cli.md` is `docs/cli.md`.
fn resolved(page: &str, target: &str) -> String {
    let mut path = PathBuf::new();
    for part in Path::new(page).parent().unwrap().join(target).components() {
        match part {
            Component::ParentDir => assert!(path.pop(), "{page}: {target} leads out of the repository"),
            other => path.push(other),
        }
    }
    path.to_string_lossy().replace('\\', "/")
}

/// Returns paths of the repository that stand as code in sentences: `src/scene/load.rs`.
fn paths(text: &str) -> Vec<String> {
    const FOLDERS: [&str; 7] = ["src/", "glsl/", "tests/", "data/", "docs/", "benches/", "examples/"];
    let is_path = |span: &&str| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
        FOLDERS.iter().any(|folder| span.starts_with(folder)) && span.chars().all(plain)
    };
    let prose = prose(text);
    prose
        .iter()
        .flat_map(|paragraph| spans(paragraph))
        .filter(is_path)
        .filter(|span| !span.contains("NAME"))
        .map(String::from)
        .collect()
}

/// Returns what is wrong with the links of the pages; `exists` tells of any other file.
fn faults(pages: &[Page], exists: impl Fn(&str) -> bool) -> Vec<String> {
    let anchors_of = |name: &str| pages.iter().find(|p| p.name == name).map(|p| anchors(&p.text));
    let mut found = Vec::new();
    for page in pages {
        let strange = paths(&page.text).into_iter().filter(|path| !exists(path.trim_end_matches('/')));
        found.extend(strange.map(|path| format!("{}: there is no {path}", page.name)));
        for target in targets(&page.text).iter().filter(|t| !t.contains("://")) {
            let (path, anchor) =
                target.split_once('#').map_or((target.as_str(), None), |(p, a)| (p, Some(a)));
            let name = if path.is_empty() { page.name.clone() } else { resolved(&page.name, path) };
            if !exists(&name) {
                found.push(format!("{}: {target} leads to no file", page.name));
            } else if let Some(anchor) = anchor
                && !anchors_of(&name).is_some_and(|anchors| anchors.contains(anchor))
            {
                found.push(format!("{}: {name} has no heading \"{anchor}\"", page.name));
            }
        }
    }
    found
}

#[test]
fn every_link_leads_somewhere() {
    let Some(root) = root() else { return };
    let pages = pages();
    let links: usize = pages.iter().map(|page| targets(&page.text).len()).sum();
    assert!(links > 100, "only {links} links were found");
    let faults = faults(&pages, |name| root.join(name).exists());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_picture_is_shown_and_every_page_is_reached() {
    let Some(root) = root() else { return };
    let pages = pages();
    let all = pages.iter().flat_map(|page| {
        let local = |t: &String| !t.contains("://") && !t.starts_with('#');
        let targets = targets(&page.text).into_iter().filter(local);
        targets.map(|t| resolved(&page.name, t.split('#').next().unwrap())).collect::<Vec<_>>()
    });
    let shown: BTreeSet<String> = all.collect();
    for entry in fs::read_dir(root.join("data/readme")).unwrap() {
        let name = format!("data/readme/{}", entry.unwrap().file_name().to_string_lossy());
        assert!(shown.contains(&name), "{name} is shown on no page");
    }
    for page in &pages[1..] {
        assert!(shown.contains(&page.name), "no link leads to {}", page.name);
    }
}

#[test]
fn planted_faults_are_found() {
    let page = |name: &str, text: &str| Page { name: name.into(), text: text.into() };
    let other = || {
        page(
            "docs/b.md",
            "# One page\n\n## `[[a]]` of `b`, twice\n\n## Twice\n\n## Twice\n```\n# no heading\n```\n",
        )
    };
    let told = |text: &str| faults(&[page("docs/a.md", text), other()], |name| name.starts_with("docs/"));
    let good = "[b](b.md) [b](../docs/b.md#one-page) [c](b.md#a-of-b-twice) [d](b.md#twice-1) [e](https://x.y)\n\
                # Own\n[f](#own) `[no](link.md)`\n```\n[no](../link)\n```\n";
    assert_eq!(told(good), [""; 0]);
    assert_eq!(told("![a](../data/none.jpg)"), ["docs/a.md: ../data/none.jpg leads to no file"]);
    for anchor in ["b.md#no-heading", "b.md#twice-2", "b.md#none", "#own"] {
        assert_eq!(told(&format!("[x]({anchor})")).len(), 1, "{anchor}");
    }
    assert_eq!(told("As `src/none.rs` says."), ["docs/a.md: there is no src/none.rs"]);
    assert_eq!(told("As `docs/b.md` says, not `src/….rs`, `data/a NAME` or `src/*.rs`."), [""; 0]);
}
