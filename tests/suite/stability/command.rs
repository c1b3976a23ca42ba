//! `moire stability` on the device under test: its output, its files and its exit code.

use std::fs;

use serde_json::Value;
use tempfile::tempdir;

use crate::stage::device_name;
use crate::support::moire;

/// A case that takes a second.
const FAST: &str = "sums/noise";

#[test]
fn a_fast_case_is_within_and_is_printed_as_a_table_and_as_json_and_written_as_a_page() {
    let folder = tempdir().unwrap();
    let out = folder.path().join("new");
    let run = |options: &[&str]| {
        let output = moire()
            .env("MOIRE_VALIDATION", "1")
            .args(["stability", "--device", &device_name(), "--only", FAST])
            .args(options)
            .output()
            .unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "nothing belongs on stderr");
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap()
    };
    let text = run(&[]);
    assert!(text.contains(FAST) && text.contains("1 within, 0 broken"), "{text}");
    let json = run(&["--json", "-q", "--out", out.to_str().unwrap()]);
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["cases"].as_array().unwrap().len(), 1);
    assert!(report["cases"][0]["points"].as_array().unwrap().len() > 3);
    assert_eq!(fs::read_to_string(out.join("stability.json")).unwrap().trim_end(), json.trim_end());
    assert!(fs::read_to_string(out.join("stability.html")).unwrap().contains(FAST));
}

#[test]
fn what_cannot_be_asked_is_exit_2_and_says_what_to_do() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let file = file.to_str().unwrap();
    let device = device_name();
    for (arguments, expected) in [
        (vec!["--device", "oracle"], vec!["the oracle itself is no device", "moire devices"]),
        (vec!["--device", "voodoo"], vec!["voodoo"]),
        (vec!["--device", &device, "--only", "squares"], vec!["\"squares\"", FAST]),
        (vec!["--device", &device, "--out", file], vec!["not a folder"]),
    ] {
        let output = moire().arg("stability").args(&arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
        let told = String::from_utf8_lossy(&output.stderr);
        let told = told.split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ");
        for part in expected {
            assert!(told.contains(part), "{arguments:?}: {told}");
        }
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "files were left");
}
