//! Ctrl-C during a render: an end within seconds, exit code 130, no file.

use std::path::absolute;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::tempdir;

use crate::stage::{device_name, path};
use crate::support::program;

/// Starts a render that would take hours, interrupts it, and tells how it ended.
fn interrupted(select: &str) {
    let folder = tempdir().unwrap();
    let mut child = Command::new(absolute(program()).unwrap())
        .current_dir(folder.path())
        .arg("render")
        .arg(absolute(path("lecture")).unwrap())
        .args(["--size", "2048x2048", "--spp", "1048576", "--device", select])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // Past the start of the device, into the render.
    std::thread::sleep(Duration::from_millis(1500));
    assert_eq!(child.try_wait().unwrap(), None, "it should still be rendering");
    let start = Instant::now();
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > Duration::from_secs(20) {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!("still running 20 s after Ctrl-C");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let waited = start.elapsed();
    let mut told = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().unwrap(), &mut told).unwrap();
    assert_eq!(status.code(), Some(130), "{told}");
    assert!(told.contains("interrupted: nothing was written"), "{told}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "files were left");
    // One slice is at most half a second; other tests share the cores.
    assert!(waited < Duration::from_secs(3), "{waited:?} after Ctrl-C");
}

#[test]
fn ctrl_c_ends_a_render_on_the_device_within_seconds_without_a_file() {
    interrupted(&device_name());
}

#[test]
fn ctrl_c_ends_a_render_on_the_oracle_within_seconds_without_a_file() {
    interrupted("oracle");
}
