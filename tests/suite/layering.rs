//! Which layer may use which, read off the sources: Vulkan and `unsafe` in the device layer only,
//! the oracle apart from what it checks, every file with its one doc comment and of a size that can
//! be read. The checker itself is shown planted violations.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support;

/// More lines than this want a second file.
const MOST_LINES: usize = 330;

/// (layers, crate modules that they may not use)
const FORBIDDEN: &[(&[&str], &[&str])] = &[
    (&["oracle"], &["gpu", "render", "probe", "shaders", "verify", "study", "cli", "output"]),
    (&["pattern"], &["gpu", "render", "probe", "shaders", "verify", "study", "cli", "output", "metrics"]),
    (&["verify"], &["render", "shaders", "features", "study", "cli", "output", "metrics"]),
    (&["stability"], &["shaders", "cli"]),
    (&["plot"], &["gpu", "render", "oracle", "verify", "study", "stability", "cli", "output"]),
    (&["study"], &["probe", "shaders", "features", "layout", "verify", "cli"]),
    (
        &["scene", "texture", "pack", "film", "output", "metrics", "layout", "color", "named", "error"],
        &["gpu", "render", "probe", "shaders", "oracle", "verify", "study", "cli"],
    ),
    (
        &["adaptive"],
        &["gpu", "render", "probe", "shaders", "oracle", "verify", "study", "cli", "output", "metrics"],
    ),
    (&["features", "render", "probe"], &["oracle", "verify", "study", "cli", "output", "metrics"]),
];

/// All that the device layer may use of the crate.
const ALLOWED_IN_GPU: &[&str] = &["error", "named", "gpu", "texture::sampler_spec"];

const DEVICE_WORDS: &[&str] = &["ash", "vk", "gpu_allocator", "unsafe"];
const UNFINISHED: &[&str] = &["TODO", "FIXME", "XXX", "dbg!", "todo!", "unimplemented!"];

/// The source with comments and the content of literals blanked, line by line as it was.
fn code_of(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    let blank =
        |out: &mut String, part: &str| out.extend(part.chars().map(|c| if c == '\n' { c } else { ' ' }));
    while let Some(c) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(hashes) = raw_string_hashes(rest, out.chars().last()) {
            let close = format!("\"{}", "#".repeat(hashes));
            let open = hashes + 2;
            rest[open..].find(&close).map_or(rest.len(), |end| open + end + close.len())
        } else if c == '"' {
            quoted_length(rest, '"')
        } else if c == '\'' && is_char_literal(rest) {
            quoted_length(rest, '\'')
        } else {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        blank(&mut out, &rest[..length]);
        rest = &rest[length..];
    }
    out
}

fn raw_string_hashes(rest: &str, before: Option<char>) -> Option<usize> {
    if before.is_some_and(is_word) {
        return None;
    }
    let after = rest.strip_prefix('r')?;
    let hashes = after.chars().take_while(|&c| c == '#').count();
    after[hashes..].starts_with('"').then_some(hashes)
}

fn quoted_length(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            _ if c == quote => return i + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Not a lifetime: `'x'` or an escape.
fn is_char_literal(rest: &str) -> bool {
    let mut chars = rest.chars().skip(1);
    match chars.next() {
        Some('\\') => true,
        Some(_) => chars.next() == Some('\''),
        None => false,
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Identifiers, `::`, braces and commas of blanked code, each with its line.
fn tokens(code: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    for (number, line) in code.lines().enumerate() {
        let mut rest = line;
        while let Some(c) = rest.chars().next() {
            let length = if is_word(c) {
                rest.find(|c| !is_word(c)).unwrap_or(rest.len())
            } else if rest.starts_with("::") {
                2
            } else {
                c.len_utf8()
            };
            if !c.is_whitespace() {
                found.push((number + 1, &rest[..length]));
            }
            rest = &rest[length..];
        }
    }
    found
}

/// Paths into the crate as `module` or `module::item`, also those of a grouped `use`. Two `super` in
/// a row lead from a layer's file to the crate.
fn crate_paths(code: &str) -> Vec<(usize, String)> {
    let tokens = tokens(code);
    let word = |i: usize| tokens.get(i).map_or("", |t| t.1);
    let path = |i: usize| match word(i + 1) {
        "::" => (tokens[i].0, format!("{}::{}", word(i), word(i + 2))),
        _ => (tokens[i].0, word(i).to_string()),
    };
    let mut found = Vec::new();
    for i in 0..tokens.len() {
        let to_crate = word(i) == "crate" || (word(i) == "super" && i > 1 && word(i - 2) == "super");
        if !to_crate || word(i + 1) != "::" {
            continue;
        }
        if word(i + 2) != "{" {
            found.push(path(i + 2));
            continue;
        }
        let mut depth = 0;
        for j in i + 2..tokens.len() {
            match word(j) {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ if depth == 1 && ["{", ","].contains(&word(j - 1)) => found.push(path(j)),
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    found
}

/// What is wrong with one source file; `path` is relative to the folder of `src` and `glsl`.
fn violations(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut complain = |line: usize, what: String| found.push(format!("{path}:{line}: {what}"));
    let lines = text.lines().count();
    if lines > MOST_LINES {
        complain(lines, format!("{lines} lines, more than {MOST_LINES}"));
    }
    for (i, line) in text.lines().enumerate() {
        for word in UNFINISHED.iter().filter(|word| line.contains(**word)) {
            complain(i + 1, format!("{word} left behind"));
        }
    }
    let opening = match path.rsplit('.').next() {
        Some("rs") => "//! ",
        Some("css") => "/* ",
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
    let code = code_of(text);
    let layer = path.trim_start_matches("src/").split(['/', '.']).next().unwrap_or("");
    if layer != "gpu" {
        for (line, word) in tokens(&code).into_iter().filter(|(_, w)| DEVICE_WORDS.contains(w)) {
            complain(line, format!("`{word}` outside the device layer"));
        }
    }
    for (line, used) in crate_paths(&code) {
        let module = used.split("::").next().unwrap_or("");
        let allowed = ALLOWED_IN_GPU.iter().any(|a| used == *a || module == *a);
        if layer == "gpu" && !allowed {
            complain(line, format!("the device layer uses `{used}`"));
        }
        if FORBIDDEN.iter().any(|(layers, others)| layers.contains(&layer) && others.contains(&module)) {
            complain(line, format!("layer {layer} uses `{used}`"));
        }
    }
    for line in undocumented_unsafe(text, &code) {
        complain(line, "unsafe without // SAFETY:".into());
    }
    found
}

/// Lines with an unsafe block or impl whose statement has no `SAFETY:` comment on it or right above it.
fn undocumented_unsafe(text: &str, code: &str) -> Vec<usize> {
    let text: Vec<&str> = text.lines().collect();
    let code: Vec<&str> = code.lines().collect();
    let is_unsafe = |i: usize| {
        let words: Vec<&str> = tokens(code[i]).iter().map(|t| t.1).collect();
        let declares = |next: Option<&&str>| matches!(next, Some(&"fn" | &"extern"));
        (0..words.len()).any(|w| words[w] == "unsafe" && !declares(words.get(w + 1)))
    };
    let documented = |i: usize| {
        let above = (0..i).rev().take_while(|&j| !code[j].trim_end().ends_with([';', '}']));
        std::iter::once(i).chain(above).any(|j| text[j].contains("SAFETY:"))
    };
    (0..code.len()).filter(|&i| is_unsafe(i) && !documented(i)).map(|i| i + 1).collect()
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
fn every_source_keeps_to_its_layer() {
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
        ("src/film.rs", "use ash::vk;", "`ash` outside"),
        ("src/film.rs", "fn f(x: vk::Image) {}", "`vk` outside"),
        ("src/render/mod.rs", "// SAFETY: none.\nunsafe { f() }", "`unsafe` outside"),
        ("src/pack/mod.rs", "use gpu_allocator::MemoryLocation;", "`gpu_allocator` outside"),
        ("src/oracle/shade.rs", "use crate::gpu::Gpu;", "layer oracle uses `gpu::Gpu`"),
        (
            "src/oracle/shade.rs",
            "use crate::{core::error::Error, render::Tuning};",
            "layer oracle uses `render::Tuning`",
        ),
        ("src/oracle/shade.rs", "fn f() { crate::render::render() }", "layer oracle uses"),
        ("src/oracle/shade.rs", "use super::super::gpu::Gpu;", "layer oracle uses"),
        ("src/gpu/image.rs", "use crate::scene::model::Scene;", "the device layer uses `scene::model`"),
        (
            "src/gpu/image.rs",
            "use crate::texture::data::TextureData;",
            "the device layer uses `texture::data`",
        ),
        (
            "src/gpu/image.rs",
            "use crate::{\n    error::Error, \n    oracle, \n};",
            "the device layer uses `oracle`",
        ),
        ("src/gpu/image.rs", "fn f() {\n    a();\n    unsafe { b() }\n}", ":4: unsafe without"),
        ("src/gpu/image.rs", "// SAFETY: a is.\nlet a = 1;\nunsafe { b() }", ":4: unsafe without"),
        ("src/metrics/mod.rs", "use crate::cli;", "layer metrics uses `cli`"),
        ("src/verify/run.rs", "use crate::render::Resources;", "layer verify uses `render::Resources`"),
        ("src/probe.rs", "use crate::lab::verify::judge::Judge;", "layer probe uses `verify::judge`"),
        ("src/study/plan.rs", "use crate::cli::render;", "layer study uses `cli::render`"),
        ("src/study/plan.rs", "use crate::gpu::shaders::Shader;", "layer study uses `shaders::Shader`"),
        ("src/render/mod.rs", "use crate::lab::study::Options;", "layer render uses `study::Options`"),
        ("src/stability/sums.rs", "use crate::cli::verify;", "layer stability uses `cli::verify`"),
        ("src/plot/html.rs", "use crate::lab::study::record;", "layer plot uses `study::record`"),
        ("src/film.rs", "// TODO: more", "TODO left"),
        ("src/film.rs", "fn f() { dbg!(1); }", "dbg! left"),
    ];
    for (path, code, expected) in bad {
        let found = violations(path, &format!("{doc}{code}\n"));
        assert!(found.iter().any(|f| f.contains(expected)), "{path}: {code:?} gave {found:?}");
    }
    let good: &[(&str, &str)] = &[
        ("src/film.rs", "/// Not unsafe, no ash::vk.\nconst A: &str = \"unsafe { vk }\"; // vk"),
        ("src/film.rs", "const A: &str = r#\"ash \"vk\" unsafe\"#;\nfn f<'a>(x: &'a str) -> char { '\"' }"),
        ("src/film.rs", "fn splash(unsafe_count: u32, vkx: u32) {}"),
        ("src/gpu/image.rs", "// SAFETY: it lives.\nlet x =\n    unsafe { f() };"),
        (
            "src/gpu/image.rs",
            "use crate::{core::error::Error, texture::sampler_spec::Filter};\nuse super::memory::Block;",
        ),
        ("src/oracle/shade.rs", "use crate::pack::PackedScene;\nuse super::render::pixel;"),
    ];
    for (path, code) in good {
        let found = violations(path, &format!("{doc}{code}\n"));
        assert!(found.is_empty(), "{path}: {code:?} gave {found:?}");
    }
    assert!(violations("src/film.rs", "use std::fs;\n")[0].contains("does not open with //!"));
    assert!(violations("src/a/a.css", "body {}\n")[0].contains("does not open with /*"));
    assert!(violations("glsl/shared/a.glsl", "#ifndef A\n")[0].contains("does not open with //"));
    assert!(violations("glsl/shared/a.glsl", "// A.\nfloat x = y / sqrt(z);\n")[0].contains(":2: 1 / sqrt"));
    let long = format!("{doc}{}", "\n".repeat(MOST_LINES));
    assert!(violations("src/film.rs", &long)[0].contains("lines, more than"));
}
