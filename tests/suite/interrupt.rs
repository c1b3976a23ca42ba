//! Ctrl-C during a render: it ends after little more work, with exit code 130 and no file. A failing test
//! leaves no render running.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, absolute};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use nix::errno::Errno;
use nix::sys::signal::kill;
use tempfile::tempdir;

use crate::child::{HANG, Running};
use crate::stage::{device_name, path};
use crate::support::{program, untested};

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

/// The CPU time in which a process is past the start of its device, and into the render.
const STARTED: f64 = 2.0;
/// The same in wall-clock seconds, where the CPU waits for a GPU or its time is not known. A render that has not begun
/// by then ends in the same way.
const STARTED_WALL: Duration = Duration::from_secs(5);

/// The most CPU time of each core after Ctrl-C: one slice is at most half a second.
const CORE_SECONDS: f64 = 3.0;

/// Interrupts it, and checks how it ended.
fn interrupted(select: &str) {
    let folder = tempdir().unwrap();
    let mut render = endless(folder.path(), select);
    let start = Instant::now();
    render.wait_until(|render| {
        let started = render.cpu_seconds().is_some_and(|seconds| seconds > STARTED);
        render.handles_interrupts().unwrap_or(true) && (started || start.elapsed() > STARTED_WALL)
    });
    assert_eq!(render.ended(), None, "it should still be rendering");
    let before = render.cpu_seconds();
    render.interrupt();
    let mut after = before;
    render.wait_until(|render| {
        after = render.cpu_seconds().or(after);
        false
    });
    let output = render.output(HANG);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains("interrupted: nothing was written"), "{told}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "files were left");
    let (Some(before), Some(after)) = (before, after) else {
        untested("how soon Ctrl-C ends a render: there is no /proc");
        return;
    };
    let cores = std::thread::available_parallelism().unwrap().get() as f64;
    assert!(after - before < CORE_SECONDS * cores, "{} s on {cores} cores after Ctrl-C", after - before);
}

#[test]
fn ctrl_c_ends_a_render_on_the_device_soon_and_without_a_file() {
    interrupted(&device_name());
}

#[test]
fn ctrl_c_ends_a_render_on_the_oracle_soon_and_without_a_file() {
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
