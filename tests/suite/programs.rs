//! External programs: the tests start none that `setup.sh` does not install, and `setup.sh` none
//! that a minimal Debian lacks.

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::tempdir;

use crate::layering::{files_under, source_root};
use crate::support::{data, untested};

/// The programs that the sources may start: the program under test, the tests themselves, `setup.sh` by the shell for
/// which it is written, programs without which a test is skipped, and those without which a build calls its commit or
/// compiler unknown.
const STARTED: &[&str] = &[
    "program()",
    "current_exe()",
    "\"bash\"",
    "\"chromium\"",
    "\"spirv-val\"",
    "\"groff\"",
    "\"git\"",
    "rustc",
];
/// The essential programs of Debian that `setup.sh` uses.
const ESSENTIAL: &[&str] = &[
    "bash", "cut", "dirname", "env", "find", "grep", "head", "id", "mkdir", "mktemp", "mv", "rm", "sort",
    "uname",
];

/// Returns the text in the parentheses that open at the start.
fn argument(text: &str) -> &str {
    let mut depth = 1;
    let closes = |&(_, c): &(usize, char)| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth == 0
    };
    &text[..text.char_indices().find(closes).map_or(text.len(), |(end, _)| end)]
}

/// Returns the programs of a source that are on no list, and children that nothing ends.
fn strangers(text: &str, is_guard: bool) -> Vec<String> {
    let known = |argument: &&str| STARTED.iter().any(|name| argument.contains(name));
    let calls = text.split("Command::new(").skip(1).map(argument);
    let mut found: Vec<String> = calls.filter(|call| !known(call)).map(str::to_owned).collect();
    if !is_guard && text.contains(".spawn()") {
        found.push("a child without a guard: see child.rs".into());
    }
    found
}

#[test]
fn sources_start_known_programs_only() {
    let Some(root) = source_root() else { return };
    let mut files = vec![root.join("build.rs")];
    for folder in ["src", "tests", "benches", "examples", "build"] {
        files_under(&root.join(folder), &mut files);
    }
    let own = Path::new(file!()).file_name();
    for file in files.iter().filter(|f| f.extension().is_some_and(|e| e == "rs") && f.file_name() != own) {
        let text = fs::read_to_string(file).unwrap();
        let found = strangers(&text, file.ends_with("child.rs"));
        assert!(found.is_empty(), "{}: {found:?}", file.display());
    }
}

#[test]
fn planted_strangers_are_found() {
    assert_eq!(strangers("Command::new(absolute(program()).unwrap()).output()", false), [""; 0]);
    assert_eq!(strangers("Command::new(\"kill\").args([])", false), ["\"kill\""]);
    assert_eq!(strangers("Command::new(program()).spawn()", false).len(), 1);
    assert_eq!(strangers("command.spawn()", true), [""; 0]);
}

fn script(path: &Path, lines: &str) {
    fs::write(path, format!("#!/bin/sh\n{lines}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

fn found_in_path(name: &str) -> Option<PathBuf> {
    let path: OsString = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Runs `setup.sh` in a folder of its own with only the essential programs and stand-ins for those that it installs;
/// `dpkg` is the answer of dpkg-query. `None` if the script or an essential program is missing.
fn set_up(dpkg: &str, options: &[(&str, &str)]) -> Option<Output> {
    let original = data().join("../setup.sh");
    let essential: Option<Vec<PathBuf>> = ESSENTIAL.iter().map(|name| found_in_path(name)).collect();
    let (true, Some(essential)) = (original.is_file(), essential) else {
        untested("setup.sh: it is not beside the data, or this is no Linux that it knows");
        return None;
    };
    let folder = tempdir().unwrap();
    let [bin, checkout] = ["bin", "Prüf stand"].map(|name| folder.path().join(name));
    fs::create_dir(&bin).unwrap();
    fs::create_dir(&checkout).unwrap();
    fs::copy(original, checkout.join("setup.sh")).unwrap();
    for (name, path) in ESSENTIAL.iter().zip(essential) {
        std::os::unix::fs::symlink(path, bin.join(name)).unwrap();
    }
    script(&bin.join("cargo"), "echo cargo 1.99.0");
    script(&bin.join("sudo"), "exec \"$@\"");
    script(&bin.join("apt-get"), "echo \"apt-get $*\" >&2");
    script(&bin.join("dpkg-query"), dpkg);
    // Like the real one it takes names up to the first blank.
    script(&bin.join("ar"), "read -r create name rest\n[ -z \"$rest\" ] && : >\"$name\"");
    script(&bin.join("g++"), "while read -r line; do :; done");
    // rustup's files expect a home; a path into it would find programs that happen to be there.
    script(&checkout.join("env"), ": \"$HOME\"");
    let output = Command::new("bash")
        .arg(checkout.join("setup.sh"))
        .env_clear()
        .env("PATH", &bin)
        .env("CARGO_HOME", &checkout)
        .env("TMPDIR", &checkout)
        .envs(options.iter().copied())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(!told.contains("not found") && !told.contains("unbound"), "{told}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "");
    Some(output)
}

const MISSING: &str = "exit 1";
const INSTALLED: &str = "echo install ok installed";

#[test]
fn setup_without_a_home_in_a_folder_with_a_blank_says_what_it_would_install() {
    let Some(output) = set_up(MISSING, &[("MOIRE_SETUP_DRY_RUN", "1")]) else { return };
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.starts_with("setup: would install: libvulkan1 ") && told.lines().count() == 1, "{told}");
}

#[test]
fn setup_installs_what_is_missing_with_essential_programs_alone() {
    let Some(output) = set_up(MISSING, &[]) else { return };
    let told = String::from_utf8_lossy(&output.stderr);
    for package in ["libvulkan1", "mesa-vulkan-drivers", "vulkan-validationlayers", "g++", "libshaderc-dev"] {
        assert!(
            told.lines().any(|line| line.starts_with("apt-get install") && line.contains(package)),
            "{told}"
        );
    }
}

#[test]
fn setup_installs_nothing_twice() {
    let Some(output) = set_up(INSTALLED, &[("HOME", "/")]) else { return };
    assert!(!String::from_utf8_lossy(&output.stderr).contains("apt-get"));
}
