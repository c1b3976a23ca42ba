//! What `moire --version` says of the build: the commit, the compilers, the target. Out: variables of the environment in
//! which the program is compiled. None of it can fail a build.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Sets the variables. The commit is looked up again when sources have changed, as then the program is compiled anyway: a
/// commit alone compiles nothing. So a program may name the commit before its own, with changes.
pub fn set() {
    // All but the program's own first file, which compiles in a moment; a file that is missing would let this run each time.
    let sources = fs::read_dir("src").into_iter().flatten().flatten().map(|entry| entry.path());
    let inputs = sources.chain(["Cargo.lock".into()]).filter(|input| input.exists());
    for input in inputs.filter(|input| !input.ends_with("main.rs")) {
        println!("cargo:rerun-if-changed={}", input.display());
    }
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let known = |value: Option<String>| value.unwrap_or_else(|| "unknown".into());
    println!("cargo:rustc-env=MOIRE_RUSTC={}", known(first_line(Command::new(rustc).arg("--version"))));
    println!("cargo:rustc-env=MOIRE_TARGET={}", known(env::var("TARGET").ok()));
    println!("cargo:rustc-env=MOIRE_SHADERC={}", known(version_of("shaderc")));
    if let Some(commit) = commit() {
        println!("cargo:rustc-env=MOIRE_COMMIT={commit}");
    }
}

/// Returns the commit of a checkout, and whether files differ from it; `None` where there is no git, or the sources lie
/// within the checkout of something else, as those of an archive may.
fn commit() -> Option<String> {
    let top = git(&["rev-parse", "--show-toplevel"])?;
    let own = fs::canonicalize(env::var("CARGO_MANIFEST_DIR").ok()?).ok()?;
    if fs::canonicalize(Path::new(&top)).ok()? != own {
        return None;
    }
    let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
    let changes = git(&["status", "--porcelain", "--untracked-files=no"]);
    Some(if changes.is_some() { format!("{commit}, with changes") } else { commit })
}

fn git(arguments: &[&str]) -> Option<String> {
    first_line(Command::new("git").args(arguments))
}

/// Returns the first line that a program prints; `None` if it fails or prints nothing.
fn first_line(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    text.lines().next().map(|line| line.trim().to_owned())
}

/// Returns the version of a crate by the lock file.
fn version_of(name: &str) -> Option<String> {
    let lock = fs::read_to_string("Cargo.lock").ok()?;
    let (_, rest) = lock.split_once(&format!("name = \"{name}\"\nversion = \""))?;
    rest.split('"').next().map(String::from)
}
