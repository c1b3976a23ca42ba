//! Resuming a study from its folder: the same points as in one run, none measured twice, and none
//! reused that belongs to another study.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;
use tempfile::tempdir;

use super::{points, scene, studied};
use crate::child::{HANG, Running};
use crate::stage::device_name;
use crate::support::program;

const METHODS: &str = "random,stratified";

/// Returns a point without the fields that differ from run to run.
fn timeless(point: &Value, keep: &[&str]) -> Value {
    let mut point = point.clone();
    for key in ["seconds", "device_seconds", "stages"].iter().filter(|k| !keep.contains(k)) {
        point.as_object_mut().unwrap().remove(*key);
    }
    point
}

#[test]
fn resumed_study_equals_one_in_one_go_and_keeps_what_was_measured() {
    let folder = tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let all = ["--methods", METHODS, "--spp", "1,4"];
    let once = studied(&whole, &[&all[..], &["--repeats", "2"]].concat());
    // Fewer repeats, as after an interruption in the second round.
    let first = studied(&parts, &[&all[..], &["--repeats", "1"]].concat());
    let second = studied(&parts, &[&all[..], &["--repeats", "2"]].concat());
    assert_eq!(points(&once).len(), 4);
    for ((once, first), second) in points(&once).iter().zip(points(&first)).zip(points(&second)) {
        let hash = |p: &Value| p["hash"].clone();
        assert_eq!((timeless(once, &[]), hash(once)), (timeless(second, &[]), hash(second)));
        let times = |p: &Value| p["seconds"].as_array().unwrap().clone();
        assert_eq!((times(first).len(), times(second).len()), (1, 2));
        assert_eq!(times(first)[0], times(second)[0], "the first render was kept");
    }
    assert_eq!(timeless(&once["reference"], &[])["rmse"], second["reference"]["rmse"]);
    // Nothing left to do: all times are the same.
    let third = studied(&parts, &[&all[..], &["--repeats", "2"]].concat());
    assert_eq!(points(&third), points(&second));
}

#[test]
fn points_of_another_scene_size_or_reference_are_measured_anew() {
    let folder = tempdir().unwrap();
    let options = ["--methods", "random", "--spp", "1,4", "--repeats", "1"];
    let text = fs::read_to_string(scene()).unwrap();
    let textures = scene().parent().unwrap().join("../../textures").canonicalize().unwrap();
    let text = text.replace("../../textures", textures.to_str().unwrap());
    let own = folder.path().join("own.toml");
    let out = folder.path().join("out");
    let run = |text: &str, options: &[&str]| -> Value {
        fs::write(&own, text).unwrap();
        let mut command = crate::support::moire();
        command.arg("study").arg(&own).arg("--out").arg(&out).args(["--json", "-q"]);
        if !options.contains(&"--size") {
            command.args(["--size", super::SIZE]);
        }
        let output = command.args(["--device", &device_name()]).args(options).output().unwrap();
        assert!(output.status.success(), "{}", super::told(&output));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let first = run(&text, &options);
    let hashes =
        |record: &Value| -> Vec<String> { points(record).iter().map(|p| p["hash"].to_string()).collect() };
    assert_eq!(points(&run(&text, &options)), points(&first), "the same again is kept");
    let sized = run(&text, &[&options[..], &["--size", "40x30"]].concat());
    let moved = run(&text.replace("eye = [0.0, 1.0, 0.0]", "eye = [0.0, 1.5, 0.0]"), &options);
    let judged = run(&text, &[&options[..], &["--reference", "oracle"]].concat());
    for other in [&sized, &moved, &judged] {
        assert!(hashes(other).iter().all(|h| !hashes(&first).contains(h)), "a foreign point was kept");
    }
    fs::write(out.join("study.json"), "{ not what it was").unwrap();
    assert_eq!(points(&run(&text, &options)).len(), 2, "a damaged record is measured anew");
}

fn interrupt(out: &Path) -> std::process::Output {
    let mut command = Command::new(std::path::absolute(program()).unwrap());
    command
        .arg("study")
        .arg(scene())
        .arg("--out")
        .arg(out)
        .args(["--size", "160x120", "--methods", METHODS, "--spp", "1,4,16", "--repeats", "1000"])
        .args(["--device", &device_name()])
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut study = Running::start(&mut command);
    study.wait_until(|_| out.join("study.json").is_file());
    assert_eq!(study.ended(), None, "it should still be measuring");
    study.interrupt();
    study.output(HANG)
}

#[test]
fn ctrl_c_leaves_a_folder_that_goes_on() {
    let folder = tempdir().unwrap();
    let output = interrupt(folder.path());
    let told = super::told(&output);
    assert_eq!(output.status.code(), Some(130), "{told}");
    let kept: Value = serde_json::from_slice(&fs::read(folder.path().join("study.json")).unwrap()).unwrap();
    let said = format!("{} points are in", points(&kept).len());
    assert!(!points(&kept).is_empty() && told.contains(&said), "{told}");
    assert!(told.contains("goes on from there"), "{told}");
    assert!(!folder.path().join("index.html").exists(), "a page of half a study");
    let options = ["--methods", METHODS, "--spp", "1,4,16", "--repeats", "1", "--size", "160x120"];
    let mut command = crate::support::moire();
    command.arg("study").arg(scene()).arg("--out").arg(folder.path()).args(["--json", "-q"]);
    let output = command.args(["--device", &device_name()]).args(options).output().unwrap();
    let record: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(points(&record).len(), 6);
    points(&kept).iter().for_each(|p| assert!(points(&record).contains(p), "measured again: {p}"));
    assert!(folder.path().join("index.html").is_file());
    let parts = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name());
    assert!(!parts.into_iter().any(|n| n.to_string_lossy().ends_with(".part")), "temporary files were left");
}
