//! What a shell and a reader of manuals get of the program: completions, manual pages, the long version.

use std::fs;
use std::path::Path;
use std::process::Command;

use moire::internal::output::{ENDING_NAMES, ToneMap};
use moire::internal::scene::model::Pattern;
use moire::internal::texture::sampler_spec::Filter;

use crate::docs::cli::{command_names, help};
use crate::support::{moire, untested};

fn printed(arguments: &[&str]) -> String {
    let output = moire().args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Returns what bash offers for the last word of a line, by the function that the script registers.
fn completed(line: &[&str]) -> Vec<String> {
    let script = printed(&["completions", "bash"]);
    let words: Vec<String> = line.iter().map(|word| format!("'{word}'")).collect();
    let [.., before, last] = line else { panic!("{line:?}") };
    let ask = format!(
        "{script}\ncomplete -p moire > /dev/null || exit 1\nCOMP_WORDS=({})\nCOMP_CWORD={}\n\
         \"$(complete -p moire | sed 's/.*-F \\([^ ]*\\).*/\\1/')\" moire '{last}' '{before}'\n\
         printf '%s\\n' \"${{COMPREPLY[@]}}\"\n",
        words.join(" "),
        line.len() - 1
    );
    let output = Command::new("bash").args(["--norc", "-c", &ask]).output().unwrap();
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().lines().map(String::from).filter(|l| !l.is_empty()).collect()
}

#[test]
fn bash_completes_commands_options_and_words() {
    assert_eq!(completed(&["moire", "re"]), ["render"]);
    assert_eq!(completed(&["moire", "render", "--filter", "l"]), ["linear", "lanczos-2", "lanczos-3"]);
    assert_eq!(completed(&["moire", "render", "--filter", ""]), Filter::NAMES);
    assert_eq!(completed(&["moire", "render", "--pattern", ""]), Pattern::NAMES);
    assert_eq!(completed(&["moire", "render", "--tone-map", ""]), ToneMap::NAMES);
    assert_eq!(completed(&["moire", "render", "--tone-map", "ac"]), ["aces", "aces-narkowicz"]);
    assert_eq!(completed(&["moire", "render", "--format", ""]), ENDING_NAMES);
    assert_eq!(completed(&["moire", "render", "--target"]), ["--target-error"]);
    assert_eq!(completed(&["moire", "completions", "z"]), ["zsh"]);
}

#[test]
fn bash_completes_scenes_keys_lists_and_words_behind_a_sign() {
    assert_eq!(completed(&["moire", "render", "@lec"]), ["@lecture"]);
    assert_eq!(completed(&["moire", "render", "--set", "camera.ey"]), ["camera.eye="]);
    assert_eq!(completed(&["moire", "render", "--set", "sampler.*.fi"]), ["sampler.*.filter="]);
    assert_eq!(completed(&["moire", "render", "--aov", "level,de"]), ["level,depth"]);
    // Bash takes the sign for a word of its own.
    assert_eq!(completed(&["moire", "render", "--filter", "=", "ew"]), ["ewa"]);
}

#[test]
fn each_shell_has_a_script_that_knows_commands_and_words() {
    for (shell, sign) in [
        ("bash", "complete -F"),
        ("zsh", "#compdef moire"),
        ("fish", "complete -c moire"),
        ("powershell", "Register-ArgumentCompleter"),
        ("elvish", "edit:completion:arg-completer[moire]"),
    ] {
        let script = printed(&["completions", shell]);
        assert!(script.contains(sign) || shell == "bash", "{shell}");
        for word in ["render", "compare", "tone-map"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
        // Their generators list no values.
        if !["powershell", "elvish"].contains(&shell) {
            for word in ["aces-narkowicz", "@lecture", "camera.eye"] {
                assert!(script.contains(word), "{shell}: {word}");
            }
        }
    }
    let output = moire().args(["completions", "tcsh"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

/// Lets groff format a page; without it, looks at the page's structure.
fn check(page: &str, name: &str) {
    for part in [".TH ", ".SH NAME", ".SH SYNOPSIS", ".SH DESCRIPTION"] {
        assert!(page.contains(part), "{name}: {part}");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    fs::write(&file, page).unwrap();
    let Ok(output) = Command::new("groff").args(["-man", "-ww", "-Tutf8", "-z"]).arg(&file).output() else {
        untested("manual pages by groff: it is not installed");
        return;
    };
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn the_manual_has_a_page_for_each_command() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("man");
    printed(&["man", "--out", pages.to_str().unwrap()]);
    let mut wanted: Vec<String> =
        command_names(&help(&[])).iter().map(|name| format!("moire-{name}.1")).collect();
    wanted.push("moire.1".into());
    wanted.sort();
    let mut found: Vec<String> =
        fs::read_dir(&pages).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    found.sort();
    assert_eq!(found, wanted);
    let read = |name: &str| fs::read_to_string(pages.join(name)).unwrap();
    found.iter().for_each(|name| check(&read(name), name));
    assert!(
        read("moire-render.1").contains("tone\\-map") && read("moire-render.1").contains("aces\\-narkowicz")
    );
    assert_eq!(printed(&["man"]), read("moire.1"));
    let output = moire().args(["man", "--out"]).arg(Path::new("/none/man")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn the_long_version_says_what_was_built_and_the_short_one_is_a_line() {
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(printed(&["-V"]), format!("moire {version}\n"));
    let long = printed(&["--version"]);
    let lines: Vec<&str> = long.lines().collect();
    assert_eq!(lines[0], format!("moire {version}"));
    let value = |key: &str| {
        let own = lines.iter().find_map(|line| line.strip_prefix(&format!("{key}: ")));
        own.unwrap_or_else(|| panic!("no {key} in {long}"))
    };
    assert!(value("built by").starts_with("rustc 1.") && value("built by").contains(std::env::consts::ARCH));
    assert!(value("shaders").contains("shaderc 0.") && value("devices").contains("Vulkan 1.2"));
    assert!(value("scenes").contains(".toml") && value("scenes").contains(".gltf"));
    assert!(value("textures").contains(".ktx2") && value("pictures").contains(".exr"));
    let commit = value("commit").split(',').next().unwrap();
    let is_commit = commit.len() == 12 && commit.bytes().all(|b| b.is_ascii_hexdigit());
    assert!(is_commit || commit == "unknown", "{commit}");
}
