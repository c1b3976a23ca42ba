//! `moire study`: the evaluation of synthetic points; names and plans; the command with its files,
//! its resumption and its page in a browser.

mod analysis;
mod browser;
mod command;
mod files;
mod halves;
mod methods;
mod own;
mod question;
#[cfg(unix)]
mod resume;
mod session;

use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use crate::stage::{device_name, path};
use crate::support::moire;

/// A study scene with the smallest picture that shows anything.
const SCENE: &str = "s1a";
const SIZE: &str = "48x36";

fn scene() -> PathBuf {
    std::path::absolute(path(SCENE)).unwrap()
}

/// `moire study` on the scene, into `out`.
fn study(out: &Path, options: &[&str]) -> Output {
    let mut command = moire();
    command.env("MOIRE_VALIDATION", "1").arg("study").arg(scene()).arg("--out").arg(out);
    command.args(["--size", SIZE, "--device", &device_name()]);
    let output = command.args(options).output().unwrap();
    assert!(!text(&output.stderr).contains("validation:"), "{}", text(&output.stderr));
    output
}

/// The object on stdout of a study that succeeds.
fn studied(out: &Path, options: &[&str]) -> Value {
    let output = study(out, &[options, &["--json", "-q"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The message without the frame that wraps long lines.
fn told(output: &Output) -> String {
    text(&output.stderr).split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ")
}

fn points(record: &Value) -> &Vec<Value> {
    record["points"].as_array().unwrap()
}
