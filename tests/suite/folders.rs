//! Folders for results: their default names, what of them stays when nothing came into them, and what an interrupted command
//! leaves. In: commands in an empty folder. Out: the files that are there afterwards.

use std::fs;
use std::path::{Path, absolute};
use std::process::{Command, Output, Stdio};

use moire::internal::output::{OutputFolder, check_file_writable};
use tempfile::tempdir;

use crate::child::{HANG, Running};
use crate::stage::{device_name, path};
use crate::support::{moire, program};

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn run(folder: &Path, command: &str, more: &[&str]) -> Output {
    let small = ["--size", "16x12", "--device", &device_name(), "-q"];
    let scene = absolute(path("quad")).unwrap();
    moire().current_dir(folder).arg(command).arg(scene).args(small).args(more).output().unwrap()
}

#[test]
fn a_study_and_an_inspection_name_their_folder_after_the_scene() {
    let folder = tempdir().unwrap();
    let study = ["--methods", "random", "--spp", "1,4", "--repeats", "1"];
    for (command, more, own) in [("study", &study[..], "study.json"), ("inspect", &[], "layers.exr")] {
        let place = folder.path().join(format!("quad-{command}"));
        // A second run takes the folder of the first.
        for _ in 0..2 {
            let output = run(folder.path(), command, more);
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            assert!(place.join(own).is_file(), "{command}");
        }
        fs::remove_dir_all(&place).unwrap();
        fs::create_dir(&place).unwrap();
        fs::write(place.join("index.html"), "mine").unwrap();
        let output = run(folder.path(), command, more);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("--out") && told.contains(&format!("quad-{command}")), "{told}");
        assert_eq!(names(&place), ["index.html"]);
    }
}

#[test]
fn a_new_folder_without_files_goes_again_and_any_other_stays() {
    let folder = tempdir().unwrap();
    let own = folder.path().join("own");
    drop(OutputFolder::prepare(&own, "a.html").unwrap());
    assert_eq!(names(folder.path()), [""; 0]);
    let kept = OutputFolder::prepare(&own, "a.html").unwrap();
    fs::write(own.join("a.html"), "a").unwrap();
    drop(kept);
    assert_eq!(names(&own), ["a.html"]);
    fs::remove_file(own.join("a.html")).unwrap();
    drop(OutputFolder::prepare(&own, "a.html").unwrap());
    assert_eq!(names(folder.path()), ["own"], "it was there before");
    assert!(OutputFolder::prepare(&folder.path().join("none/own"), "a").is_err());
    check_file_writable(&own.join("b")).unwrap();
    assert_eq!(names(&own), [""; 0]);
}

#[test]
fn a_command_without_progress_ends_at_once_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    let mut command = Command::new(absolute(program()).unwrap());
    command.current_dir(folder.path()).args(["pattern", "sobol-owen", "--spp", "4096", "-o", "p.png"]);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    let mut running = Running::start(&mut command);
    running.wait_until(|own| own.handles_interrupts().unwrap_or(true));
    running.interrupt();
    let output = running.output(HANG);
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(names(folder.path()), [""; 0]);
}

/// Interrupts a command that would take long as soon as its folder is there.
fn interrupted(arguments: &[&str], own: &str) {
    let folder = tempdir().unwrap();
    let mut command = Command::new(absolute(program()).unwrap());
    let scene = absolute(path("lecture")).unwrap();
    command.current_dir(folder.path()).arg(arguments[0]).arg(scene).args(&arguments[1..]);
    command.args(["--device", &device_name()]).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut running = Running::start(&mut command);
    let place = folder.path().join(own);
    running.wait_until(|_| place.is_dir());
    running.interrupt();
    let output = running.output(HANG);
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(names(folder.path()), [""; 0], "{arguments:?}");
}

#[test]
fn an_interrupted_inspection_leaves_no_folder() {
    interrupted(&["inspect", "--size", "2048x2048", "--spp", "1024"], "lecture-inspect");
}

#[test]
fn an_interrupted_study_without_a_point_leaves_no_folder() {
    interrupted(&["study", "--size", "2048x2048", "--spp", "1024"], "lecture-study");
}
