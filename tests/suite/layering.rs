//! The uses between rooms, by the sources, with an allow-list: Vulkan and `unsafe` in `gpu` only, the oracle separate
//! from the code that it checks, every file with its doc comment and of readable size. The checker itself is tested
//! with planted violations.

use std::fs;
use std::path::{Path, PathBuf};

use crate::sources::{crate_paths, tokens, undocumented_unsafe};
use crate::support;

/// Longer files should be split.
const MAX_LINES: usize = 330;

/// (room, everything in the crate that it may use beside itself), lowest first. A room is a folder of `src`, or of one
/// that [`SPLIT`] names; anything that is not listed is forbidden, so that a new room has to be entered here.
pub const ALLOWED: &[(&str, &[&str])] = &[
    ("core", &[]),
    ("schema", &["core"]),
    ("texture", &["core", "schema"]),
    ("mesh", &["core"]),
    ("tree", &["schema::constants"]),
    ("scene", &["core", "texture", "schema", "mesh"]),
    ("pack", &["core", "texture", "scene", "schema", "tree"]),
    ("sampling", &["core", "schema", "pack::filtered_mean"]),
    ("oracle", &["core", "texture", "scene", "schema", "pack", "sampling"]),
    ("gpu", &["core::error", "core::named", "texture::sampler_spec", "schema"]),
    ("integrators", &["core", "schema", "sampling"]),
    ("render", &["core", "texture", "scene", "schema", "pack", "sampling", "gpu", "oracle", "integrators"]),
    ("output", &["core"]),
    ("lab::plot", &["core"]),
    (
        "lab::inspect",
        &["core", "texture", "scene", "schema", "pack", "oracle", "render", "output", "lab::plot"],
    ),
    ("lab::metrics", &["core", "texture"]),
    ("lab::pattern", &["core", "scene", "schema", "oracle"]),
    ("lab::probe", &["core", "texture", "schema", "pack", "gpu", "render"]),
    ("lab::verify", &["core", "texture", "scene", "schema", "pack", "gpu", "oracle", "lab::probe"]),
    (
        "lab::stability",
        &[
            "core",
            "texture",
            "scene",
            "schema",
            "pack",
            "gpu",
            "oracle",
            "integrators",
            "render",
            "output",
            "lab::probe",
            "lab::verify",
            "lab::plot",
        ],
    ),
    (
        "lab::study",
        &[
            "core",
            "texture",
            "scene",
            "pack",
            "gpu",
            "oracle",
            "render",
            "output",
            "lab::metrics",
            "lab::plot",
        ],
    ),
    (
        "lab::sheet",
        &[
            "core",
            "texture",
            "scene",
            "pack",
            "gpu",
            "integrators",
            "render",
            "output",
            "lab::metrics",
            "lab::plot",
            "lab::study",
        ],
    ),
    (
        "lab::view",
        &["core", "texture", "scene", "schema", "pack", "gpu", "oracle", "render", "output", "lab::inspect"],
    ),
    ("face", &["core", "texture", "scene", "gpu", "integrators", "render", "output", "lab::metrics"]),
    (
        "cli",
        &[
            "core",
            "texture",
            "scene",
            "pack",
            "gpu",
            "oracle",
            "integrators",
            "render",
            "output",
            "lab::inspect",
            "lab::metrics",
            "lab::pattern",
            "lab::sheet",
            "lab::stability",
            "lab::study",
            "lab::verify",
            "lab::view",
        ],
    ),
];

/// Folders whose own folders are the rooms.
const SPLIT: &[&str] = &["lab"];

/// Returns the room of a file below `src`, or of a path into the crate.
fn room_of(parts: &[&str]) -> String {
    match parts {
        [first, second, ..] if SPLIT.contains(first) => format!("{first}::{second}"),
        [first, ..] => (*first).to_string(),
        [] => String::new(),
    }
}

/// Returns true if a room may use a path of the crate. The crate's own files, `lib.rs`, `main.rs` and the files that
/// they declare, belong to no room.
fn may_use(room: &str, used: &str) -> bool {
    let parts: Vec<&str> = used.split("::").collect();
    if room_of(&parts) == room || ["lib", "main", "internal", "model"].contains(&room) {
        return true;
    }
    let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == room) else { return false };
    allowed.iter().any(|a| used == *a || used.strip_prefix(a).is_some_and(|rest| rest.starts_with("::")))
}

const DEVICE_WORDS: &[&str] = &["ash", "vk", "gpu_allocator", "unsafe"];
const UNFINISHED: &[&str] = &["TODO", "FIXME", "XXX", "dbg!", "todo!", "unimplemented!"];

/// The module that a file of `src` is: `src/a/b.rs` and `src/a/b/mod.rs` are `a::b`.
pub fn module_of(path: &str) -> Vec<&str> {
    let path = path.trim_start_matches("src/").trim_end_matches(".rs");
    path.split('/').filter(|part| *part != "mod").collect()
}

/// Returns the violations of one source file; `path` is relative to the folder of `src` and `glsl`.
fn violations(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut complain = |line: usize, what: String| found.push(format!("{path}:{line}: {what}"));
    let lines = text.lines().count();
    if lines > MAX_LINES {
        complain(lines, format!("{lines} lines, more than {MAX_LINES}"));
    }
    for (i, line) in text.lines().enumerate() {
        for word in UNFINISHED.iter().filter(|word| line.contains(**word)) {
            complain(i + 1, format!("{word} left behind"));
        }
    }
    let opening = match path.rsplit('.').next() {
        Some("rs") => "//! ",
        Some("css") => "/* ",
        Some("html") => "<!-- ",
        _ => "// ",
    };
    if !path.ends_with(".comp") && !text.starts_with(opening) {
        complain(1, format!("does not open with {opening}"));
    }
    if !path.ends_with(".rs") {
        for (i, _) in text.lines().enumerate().filter(|(_, line)| line.contains("/ sqrt(")) {
            complain(i + 1, "1 / sqrt is not the same in every pipeline; use inversesqrt".into());
        }
        return found;
    }
    let tokens = match tokens(text) {
        Ok(tokens) => tokens,
        Err(fault) => return vec![format!("{path}: {fault}")],
    };
    let module = module_of(path);
    let room = room_of(&module);
    if room != "gpu" {
        for token in tokens.iter().filter(|t| DEVICE_WORDS.contains(&t.text.as_str())) {
            complain(token.line, format!("`{}` outside `gpu`", token.text));
        }
    }
    for (line, used) in crate_paths(&tokens, &module).into_iter().filter(|(_, used)| !may_use(&room, used)) {
        complain(line, format!("{room} uses `{used}`"));
    }
    for line in undocumented_unsafe(text, &tokens) {
        complain(line, "unsafe without // SAFETY:".into());
    }
    found
}

/// `src` and `glsl` beside the folder `data`; `None` where only binaries were carried.
pub fn source_root() -> Option<PathBuf> {
    let root = support::data().join("..");
    let there = root.join("src").is_dir() && root.join("glsl").is_dir();
    if !there {
        support::untested("rules of the sources: they are not beside the data");
    }
    there.then_some(root)
}

pub fn files_under(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files_under(&path, found);
        } else {
            found.push(path);
        }
    }
}

#[test]
fn every_source_keeps_to_its_room() {
    let Some(root) = source_root() else { return };
    let mut files = Vec::new();
    files_under(&root.join("src"), &mut files);
    files_under(&root.join("glsl"), &mut files);
    let mut found = Vec::new();
    let mut rust_files = 0;
    for file in files {
        let relative = file.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
        rust_files += usize::from(relative.ends_with(".rs"));
        found.extend(violations(&relative, &fs::read_to_string(&file).unwrap()));
    }
    assert!(rust_files > 50, "only {rust_files} Rust files were found");
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn planted_violations_are_found_and_look_alikes_are_not() {
    let doc = "//! What it is.\n";
    let bad: &[(&str, &str, &str)] = &[
        ("src/core/film.rs", "use ash::vk;", "`ash` outside"),
        ("src/core/film.rs", "fn f(x: vk::Image) {}", "`vk` outside"),
        ("src/render/mod.rs", "// SAFETY: none.\nunsafe { f() }", "`unsafe` outside"),
        ("src/pack/mod.rs", "use gpu_allocator::MemoryLocation;", "`gpu_allocator` outside"),
        ("src/oracle/shade.rs", "use crate::gpu::Gpu;", "oracle uses `gpu::Gpu`"),
        (
            "src/oracle/shade.rs",
            "use crate::{core::error::Error, render::Tuning};",
            "oracle uses `render::Tuning`",
        ),
        ("src/oracle/shade.rs", "fn f() { crate::render::render() }", "oracle uses `render::render`"),
        ("src/oracle/shade.rs", "use super::super::gpu::Gpu;", "oracle uses `gpu::Gpu`"),
        ("src/oracle/a/b.rs", "use super::super::super::gpu::Gpu;", "oracle uses `gpu::Gpu`"),
        ("src/gpu/image.rs", "use crate::scene::model::Scene;", "gpu uses `scene::model::Scene`"),
        ("src/gpu/image.rs", "use crate::texture::data::TextureData;", "gpu uses `texture::data"),
        (
            "src/gpu/image.rs",
            "use crate::{\n    core::error::Error, \n    oracle, \n};",
            ":4: gpu uses `oracle`",
        ),
        ("src/gpu/image.rs", "use crate::core::film::Film;", "gpu uses `core::film"),
        ("src/gpu/image.rs", "fn f() {\n    a();\n    unsafe { b() }\n}", ":4: unsafe without"),
        ("src/gpu/image.rs", "// SAFETY: a is.\nlet a = 1;\nunsafe { b() }", ":4: unsafe without"),
        ("src/lab/metrics/mod.rs", "use crate::cli;", "lab::metrics uses `cli`"),
        ("src/lab/metrics/mod.rs", "use super::plot::Chart;", "lab::metrics uses `lab::plot::Chart`"),
        ("src/lab/verify/run.rs", "use crate::render::Resources;", "lab::verify uses `render::Resources`"),
        ("src/lab/probe.rs", "use crate::lab::verify::judge::Judge;", "lab::probe uses `lab::verify::judge`"),
        ("src/lab/probe.rs", "use super::verify::judge::Judge;", "lab::probe uses `lab::verify::judge`"),
        ("src/lab/study/plan.rs", "use crate::cli::render;", "lab::study uses `cli::render`"),
        ("src/render/mod.rs", "use crate::lab::study::Options;", "render uses `lab::study::Options`"),
        ("src/lab/plot/html.rs", "use crate::lab::study::record;", "lab::plot uses `lab::study::record`"),
        ("src/newcomer.rs", "use crate::core::film::Film;", "newcomer uses `core::film::Film`"),
        ("src/lab/newcomer/a.rs", "use crate::lab::plot::svg;", "lab::newcomer uses `lab::plot::svg`"),
        ("src/core/film.rs", "// TODO: more", "TODO left"),
        ("src/core/film.rs", "fn f() { dbg!(1); }", "dbg! left"),
    ];
    for (path, code, expected) in bad {
        let found = violations(path, &format!("{doc}{code}\n"));
        assert!(found.iter().any(|f| f.contains(expected)), "{path}: {code:?} gave {found:?}");
    }
    let good: &[(&str, &str)] = &[
        ("src/core/film.rs", "/// Not unsafe, no ash::vk.\nconst A: &str = \"unsafe { vk }\"; // vk"),
        (
            "src/core/film.rs",
            "const A: &str = r#\"ash \"vk\" unsafe\"#;\nfn f<'a>(x: &'a str) -> char { '\"' }",
        ),
        ("src/core/film.rs", "fn splash(unsafe_count: u32, vkx: u32) {}"),
        ("src/gpu/image.rs", "// SAFETY: it lives.\nlet x =\n    unsafe { f() };"),
        (
            "src/gpu/image.rs",
            "use crate::{core::error::Error, texture::sampler_spec::Filter};\nuse super::memory::Block;",
        ),
        ("src/oracle/shade.rs", "use crate::pack::PackedScene;\nuse super::render::pixel;"),
        ("src/texture/tiff/color.rs", "use super::super::scalar::{Kind, Scalar};"),
        ("src/lab/study/plan.rs", "use super::super::metrics::compare;\nuse crate::lab::plot::svg;"),
        ("src/main.rs", "use crate::cli::run;"),
    ];
    for (path, code) in good {
        let found = violations(path, &format!("{doc}{code}\n"));
        assert!(found.is_empty(), "{path}: {code:?} gave {found:?}");
    }
    assert!(violations("src/core/film.rs", "use std::fs;\n")[0].contains("does not open with //!"));
    assert!(violations("src/a/a.css", "body {}\n")[0].contains("does not open with /*"));
    assert!(violations("src/a/a.html", "<!doctype html>\n")[0].contains("does not open with <!--"));
    assert!(violations("glsl/shared/a.glsl", "#ifndef A\n")[0].contains("does not open with //"));
    assert!(violations("glsl/shared/a.glsl", "// A.\nfloat x = y / sqrt(z);\n")[0].contains(":2: 1 / sqrt"));
    let long = format!("{doc}{}", "\n".repeat(MAX_LINES));
    assert!(violations("src/core/film.rs", &long)[0].contains("lines, more than"));
}
