//! Pages in headless Chromium, where `chromium` is installed: what a probe finds in them, and that the console is silent.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tempfile::tempdir;

use crate::support::untested;

/// Returns true if there is a browser, and says so if there is none.
pub fn is_installed() -> bool {
    let is_installed = Command::new("chromium").arg("--version").output().is_ok();
    if !is_installed {
        untested("a page in a browser: chromium is not installed");
    }
    is_installed
}

/// Opens a page beside those of a folder; returns what it writes as JSON into an element `report`.
pub fn probed(folder: &Path, probe: &str, dark: bool) -> Value {
    fs::write(folder.join("probe.html"), probe).unwrap();
    let scheme = if dark { 0 } else { 1 };
    let profile = tempdir().unwrap();
    let output = Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--enable-logging=stderr",
        ])
        .args(["--allow-file-access-from-files", "--virtual-time-budget=4000", "--window-size=1400,900"])
        .arg(format!("--blink-settings=preferredColorScheme={scheme}"))
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg("--dump-dom")
        .arg(format!("file://{}", folder.join("probe.html").display()))
        .output()
        .unwrap();
    let console: Vec<String> = String::from_utf8_lossy(&output.stderr)
        .lines()
        .filter(|l| l.contains("CONSOLE"))
        .map(str::to_owned)
        .collect();
    assert!(console.is_empty(), "the console says {console:#?}");
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let report = dom.split("<pre id=\"report\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let report = report
        .unwrap_or_else(|| panic!("no report; the browser said {}", String::from_utf8_lossy(&output.stderr)));
    serde_json::from_str(report).unwrap()
}

/// Returns the sum of red, green and blue of a colour of CSS.
pub fn brightness(color: &Value) -> u32 {
    let digits = color.as_str().unwrap().split(|c: char| !c.is_ascii_digit());
    digits.filter_map(|d| d.parse::<u32>().ok()).take(3).sum()
}
