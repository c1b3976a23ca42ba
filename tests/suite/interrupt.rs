//! Ctrl-C during a render: it ends within seconds with exit code 130 and no file. A failing test
//! leaves no render running.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, absolute};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use nix::errno::Errno;
use nix::sys::signal::kill;
use tempfile::tempdir;

use crate::child::Running;
use crate::stage::{device_name, path};
use crate::support::program;

/// A render that would take hours.
fn endless(folder: &Path, select: &str) -> Running {
    let mut command = Command::new(absolute(program()).unwrap());
    command
        .current_dir(folder)
        .arg("render")
        .arg(absolute(path("lecture")).unwrap())
        .args(["--size", "2048x2048", "--spp", "1048576", "--device", select])
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    Running::start(&mut command)
}

/// Interrupts it, and returns how it ended.
fn interrupted(select: &str) {
    let folder = tempdir().unwrap();
    let mut render = endless(folder.path(), select);
    // Past the start of the device, into the render.
    std::thread::sleep(Duration::from_millis(1500));
    assert_eq!(render.ended(), None, "it should still be rendering");
    let start = Instant::now();
    render.interrupt();
    let output = render.output(Duration::from_secs(20));
    let waited = start.elapsed();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{told}");
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

#[test]
fn a_render_that_a_failing_test_started_ends_with_it() {
    let folder = tempdir().unwrap();
    let render = endless(folder.path(), "oracle");
    let id = render.id();
    assert_eq!(kill(id, None), Ok(()));
    assert!(catch_unwind(AssertUnwindSafe(|| render.output(Duration::ZERO))).is_err());
    assert_eq!(kill(id, None), Err(Errno::ESRCH), "it still runs");
}
