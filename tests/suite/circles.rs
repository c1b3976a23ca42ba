//! Imports between source files: no two rooms, and no two files with different jobs, may import each other
//! along any path. Exceptions are listed with their reasons.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::layering::{ALLOWED, files_under, module_of, source_root};
use crate::sources::tokens;

type Module = Vec<String>;
type Graph = BTreeMap<Module, BTreeSet<Module>>;

/// Circles of files that do one job together: (a folder, or files separated by dots, reason).
const ONE_JOB: &[(&[&str], &str)] = &[
    (&["gpu"], "objects of a device know the device, which makes them"),
    (&["texture"], "a file's reader is chosen by its content, and readers ask for the limits of all files"),
    (
        &["scene.formats.toml"],
        "a table names the section that a stray key belongs to, by the sections' own lists",
    ),
    (
        &["scene.bsdf", "scene.geometry", "scene.limits", "scene.material", "scene.model", "scene.refusal"],
        "types of a scene, and the limits of their values",
    ),
    (&["scene.builder", "scene.whole"], "a scene and its builder name each other"),
    (&["integrators.adaptive.audit", "integrators.adaptive.draws"], "the pixels drawn for an audit"),
    (&["oracle.filter"], "a kernel reads levels, and levels are read by kernels"),
    (&["oracle.backend", "oracle.render"], "the oracle as a backend, and the picture that it makes alone"),
    (&["render.backend", "render.session"], "a session's renders, and the backend that they are"),
    (&["pack.geometry", "pack.precision"], "how shapes are packed depends on the numbers that they need"),
    (&["render.layer_samples", "render.layers"], "layers, and the samples that some of them count"),
    (&["cli.render", "cli.watch"], "a render, and the same again when files change"),
    (&["lab.inspect"], "the page of a folder"),
    (&["lab.verify"], "a report names the place and the variant that it judges"),
];

/// Returns the paths of the crate that the code of module `of` names, including grouped and nested imports.
fn references(code: &str, of: &[&str]) -> Vec<Vec<String>> {
    let code = code.split("#[cfg(test)]").next().unwrap_or_default();
    let tokens = tokens(code).unwrap();
    let words: Vec<&str> = tokens.iter().map(|token| token.text.as_str()).collect();
    let mut found = Vec::new();
    for i in 0..words.len() {
        let begins = i == 0 || words[i - 1] != "::";
        if !begins || words.get(i + 1) != Some(&"::") {
            continue;
        }
        let (mut at, mut base) = (i + 2, Vec::new());
        match words[i] {
            "crate" => {}
            "super" => {
                let mut climbs = 1;
                while words.get(at) == Some(&"super") {
                    (at, climbs) = (at + 2, climbs + 1);
                }
                base = of[..of.len().saturating_sub(climbs)].iter().map(|name| (*name).to_owned()).collect();
            }
            _ => continue,
        }
        collect(&words, &mut at, base, &mut found);
    }
    found
}

/// Returns the path at `at`, or all paths of a group.
fn collect(words: &[&str], at: &mut usize, mut path: Vec<String>, found: &mut Vec<Vec<String>>) {
    let is_name = |word: &str| word.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    loop {
        match words.get(*at) {
            Some(&"{") => {
                *at += 1;
                while words.get(*at).is_some_and(|word| *word != "}") {
                    let before = *at;
                    collect(words, at, path.clone(), found);
                    if words.get(*at) == Some(&",") || *at == before {
                        *at += 1;
                    }
                }
                *at += 1;
                return;
            }
            Some(word) if is_name(word) => path.push((*word).to_owned()),
            _ => {}
        }
        *at += 1;
        if words.get(*at) != Some(&"::") {
            found.push(path);
            return;
        }
        *at += 1;
    }
}

/// Returns the imports of each file's module, without its own folder's `mod.rs`, which re-exports.
fn graph(files: &BTreeMap<String, String>) -> Graph {
    let owned = |path: &str| -> Module { module_of(path).into_iter().map(str::to_owned).collect() };
    let modules: BTreeSet<Module> = files.keys().map(|path| owned(path)).collect();
    let mut graph = Graph::new();
    for (path, text) in files {
        let (of, own) = (module_of(path), owned(path));
        let imports = references(text, &of).into_iter().filter_map(|mut path| {
            while !path.is_empty() && !modules.contains(&path) {
                path.pop();
            }
            (!path.is_empty() && path != own && path[..] != own[..own.len() - 1]).then_some(path)
        });
        graph.insert(own.clone(), imports.collect());
    }
    graph
}

/// Returns every module reachable from this one.
fn reached(graph: &Graph, from: &Module) -> BTreeSet<Module> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from.clone()]);
    while let Some(module) = open.pop() {
        for next in graph.get(&module).into_iter().flatten() {
            if seen.insert(next.clone()) {
                open.push(next.clone());
            }
        }
    }
    seen
}

/// Returns the sets of modules each of which reaches all others.
fn circles(graph: &Graph) -> BTreeSet<BTreeSet<Module>> {
    let reach: BTreeMap<&Module, BTreeSet<Module>> = graph.keys().map(|m| (m, reached(graph, m))).collect();
    let circle = |module: &Module| -> BTreeSet<Module> {
        reach[module]
            .iter()
            .filter(|other| reach.get(other).is_some_and(|r| r.contains(module)))
            .cloned()
            .collect()
    };
    graph.keys().map(circle).filter(|circle| circle.len() > 1).collect()
}

fn is_of_one_job(circle: &BTreeSet<Module>) -> bool {
    ONE_JOB.iter().any(|(places, _)| {
        circle.iter().all(|module| {
            let name = module.join(".");
            places.iter().any(|place| {
                name.strip_prefix(place).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            })
        })
    })
}

fn sources() -> Option<BTreeMap<String, String>> {
    let root = source_root()?;
    let mut paths = Vec::new();
    files_under(&root.join("src"), &mut paths);
    let crate_root = ["src/lib.rs", "src/main.rs", "src/internal.rs", "src/model.rs"];
    let read = |path: std::path::PathBuf| {
        let name = path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
        (name.ends_with(".rs") && !crate_root.contains(&name.as_str()))
            .then(|| (name, fs::read_to_string(path).unwrap()))
    };
    Some(paths.into_iter().filter_map(read).collect())
}

#[test]
fn files_of_different_jobs_import_each_other_by_no_way_round() {
    let Some(files) = sources() else { return };
    let graph = graph(&files);
    assert!(graph.values().map(BTreeSet::len).sum::<usize>() > 500, "imports are not found");
    let circles = circles(&graph);
    let told: Vec<String> = circles
        .iter()
        .filter(|circle| !is_of_one_job(circle))
        .map(|circle| circle.iter().map(|module| module.join("::")).collect::<Vec<_>>().join(" ⇄ "))
        .collect();
    assert!(told.is_empty(), "{}", told.join("\n"));
    for (places, reason) in ONE_JOB {
        let first = places[0].replace('.', "/");
        assert!(
            files.keys().any(|f| f.starts_with(&format!("src/{first}"))),
            "{places:?} is gone ({reason})"
        );
    }
}

#[test]
fn rooms_that_may_use_each_other_do_not_exist() {
    let room = |path: &str| {
        let mut known: Vec<&str> = ALLOWED.iter().map(|(room, _)| *room).collect();
        known.sort_by_key(|room| std::cmp::Reverse(room.len()));
        known
            .into_iter()
            .find(|room| path == *room || path.starts_with(&format!("{room}::")))
            .map(|r| vec![r.to_owned()])
    };
    let graph: Graph = ALLOWED
        .iter()
        .map(|(of, used)| (vec![(*of).to_owned()], used.iter().filter_map(|path| room(path)).collect()))
        .collect();
    assert_eq!(circles(&graph), BTreeSet::new());
}

#[test]
fn a_planted_circle_is_found_through_groups_and_climbing() {
    let files = [
        ("src/a/mod.rs", "pub use x::X;"),
        ("src/a/x.rs", "use crate::{b::{y::{Y, Z}, w}, c};\nuse super::X;"),
        ("src/b/mod.rs", ""),
        ("src/b/w.rs", ""),
        ("src/b/y.rs", "fn f() { super::super::a::x::g() }"),
        ("src/c.rs", "#[cfg(test)]\nuse crate::a::x;"),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), text.to_owned())).into_iter().collect();
    let found = circles(&graph(&files));
    let names = |circle: &BTreeSet<Module>| circle.iter().map(|m| m.join("::")).collect::<Vec<_>>();
    assert_eq!(found.iter().map(names).collect::<Vec<_>>(), [["a::x", "b::y"]]);
    assert!(!found.iter().any(is_of_one_job));
}
