//! `moire sheet`: the numbers of cells against `render` and `compare`, the pixels of the picture, how they are shown, the
//! noise of references, cells that cannot be rendered or are alike, views, mistakes, and the page.

mod browser;
mod cells;
mod display;
mod mistakes;
mod picture;
mod ranges;
mod reference;
mod same;
mod views;

use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;

use crate::stage::{device_name, path};
use crate::support::moire;

const SIZE: [&str; 2] = ["--size", "32x24"];

fn scene() -> PathBuf {
    std::path::absolute(path("horizon")).unwrap()
}

/// `moire sheet` on the scene in a folder, on the device under test.
fn sheet(folder: &Path, options: &[&str]) -> Output {
    let mut command = moire();
    command.current_dir(folder).env("MOIRE_VALIDATION", "1").arg("sheet").arg(scene());
    let output = command.args(["--device", &device_name()]).args(options).output().unwrap();
    assert!(!text(&output.stderr).contains("validation:"), "{}", text(&output.stderr));
    output
}

/// The object on stdout of a sheet that succeeds.
fn record(folder: &Path, options: &[&str]) -> Value {
    let output = sheet(folder, &[options, &["--json", "-q"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn cells(record: &Value) -> &Vec<Value> {
    record["cells"].as_array().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The message without the frame that wraps long lines.
fn told(output: &Output) -> String {
    text(&output.stderr).split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ")
}
