//! The commands that a page states work, and mistakes are reported as by the other commands.

use std::fs;

use moire::internal::output::{WriteOptions, write};
use serde_json::Value;
use tempfile::tempdir;

use super::{points, studied, study, told};
use crate::stage::device_name;
use crate::support::{gradient, moire};

/// Splits a line into words as a POSIX shell does, for output of `moire::internal::lab::study::quote`.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let (mut quoted, mut letters) = (false, line.chars());
    while let Some(letter) = letters.next() {
        match letter {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            '\\' if !quoted => words.last_mut().unwrap().extend(letters.next()),
            _ => words.last_mut().unwrap().push(letter),
        }
    }
    words
}

#[test]
fn each_command_renders_its_point_again() {
    let folder = tempdir().unwrap();
    let out = folder.path().join("study");
    let methods = "center,random,random+differentials+ewa,stratified+cone";
    let record = studied(&out, &["--methods", methods, "--spp", "5", "--repeats", "1"]);
    let reference = out.join("reference.exr");
    assert_eq!(record["reference"]["file"], reference.display().to_string());
    assert_eq!(points(&record).len(), 4);
    for point in points(&record) {
        let command = point["command"].as_str().unwrap();
        let words = words(command);
        assert_eq!(words[0], "moire");
        let output = moire().current_dir(folder.path()).args(&words[1..]).output().unwrap();
        assert!(output.status.success(), "{command}: {}", told(&output));
        let compared = moire()
            .current_dir(folder.path())
            .args(["compare", "point.exr", "--json"])
            .arg(&reference)
            .output()
            .unwrap();
        let json: Value = serde_json::from_slice(&compared.stdout).unwrap();
        for metric in ["rmse", "relative_mse", "max", "over_1_255", "flip"] {
            let [then, now] = [&point["errors"][metric], &json[metric]].map(|v| v.as_f64().unwrap());
            // Sums over threads are the same; text keeps 17 digits.
            assert!((then - now).abs() <= 1e-12 * then.abs(), "{command}: {metric} {then}, again {now}");
        }
    }
}

#[test]
fn paths_with_spaces_are_quoted_in_commands() {
    assert_eq!(moire::internal::lab::study::quote("a/b-c.toml"), "a/b-c.toml");
    assert_eq!(moire::internal::lab::study::quote("my scene.toml"), "'my scene.toml'");
    assert_eq!(moire::internal::lab::study::quote("it's"), "'it'\\''s'");
    assert_eq!(moire::internal::lab::study::quote(""), "''");
    let texts = ["my scene.toml", "it's", "a/b-c.toml", "", "back\\slash ü"];
    assert_eq!(words(&texts.map(moire::internal::lab::study::quote).join(" ")), texts);
}

#[test]
fn mistakes_end_with_exit_code_2_and_leave_no_folder() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "text").unwrap();
    let small = folder.path().join("small.exr");
    write(&gradient(3, 3), &small, &WriteOptions::default()).unwrap();
    let new = folder.path().join("new");
    let nowhere = folder.path().join("none/new");
    let small = small.to_str().unwrap();
    for (out, options, what) in [
        (&new, vec!["--methods", "jitter"], "patterns: center, grid, random, stratified"),
        (&new, vec!["--spp", "0"], "0 is not in 1..=16777216"),
        (&new, vec!["--repeats", "0"], "--repeats"),
        (&new, vec!["--seconds", "-1"], "--seconds"),
        (&new, vec!["--reference"], "--reference"),
        (&file, vec![], "not a folder"),
        (&nowhere, vec![], "cannot be created"),
    ] {
        let output = study(out, &options);
        assert_eq!(output.status.code(), Some(2), "{what}");
        assert!(told(&output).contains(what), "{what} not in: {}", told(&output));
        assert!(!new.exists(), "{what}");
    }
    let output = study(&new, &["--reference", small]);
    assert_eq!(output.status.code(), Some(2));
    assert!(told(&output).contains("3×3") && told(&output).contains("48×36"), "{}", told(&output));
    let output = study(&new, &["--seconds", "0.000001", "--spp", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(told(&output).contains("no time for a single point"), "{}", told(&output));
}

#[test]
fn one_sample_in_the_centre_ties_with_a_grid_of_one() {
    let folder = tempdir().unwrap();
    let record = studied(folder.path(), &["--methods", "center,grid,random", "--spp", "1", "--repeats", "3"]);
    let points = points(&record);
    assert_eq!(points[0]["picture"], points[1]["picture"]);
    assert_ne!(points[0]["picture"], points[2]["picture"]);
    for winner in record["analysis"]["winners"].as_array().unwrap() {
        let names = [&winner["method"], &winner["ties"][0]].map(|n| n.as_str().unwrap_or_default());
        if names.iter().any(|n| ["center", "grid"].contains(n)) {
            assert!(names.contains(&"center") && names.contains(&"grid"), "{winner}");
        }
    }
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    let both = "<span title=\"center\">pixel centres</span> = <span title=\"grid\">regular grid</span>";
    assert!(page.contains(both), "the page does not name both");
}

#[test]
fn beams_are_labelled_by_what_they_did() {
    let folder = tempdir().unwrap();
    let scene = |name: &str| std::path::absolute(crate::stage::path(name)).unwrap();
    let studied = |name: &str| {
        let out = folder.path().join(name);
        let mut command = moire();
        command
            .arg("study")
            .arg(scene(name))
            .arg("--out")
            .arg(&out)
            .args(["--size", "32x24", "--json", "-q"]);
        command.args([
            "--methods",
            "beam,center,cone",
            "--spp",
            "4,16",
            "--repeats",
            "1",
            "--device",
            &device_name(),
        ]);
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", told(&output));
        let page = fs::read_to_string(out.join("index.html")).unwrap();
        (serde_json::from_slice::<Value>(&output.stdout).unwrap(), page)
    };
    // Through a lens no pixel is a square seen from one place.
    let (record, page) = studied("lens");
    let beam = points(&record).iter().find(|p| p["method"] == "beam").unwrap();
    assert_eq!((&beam["sampled"], &beam["samples"]), (&1.0.into(), &16.into()), "{beam}");
    assert!(page.contains("beams, 16 samples in every pixel, as beams suit none"));
    assert!(page.contains("No pixel of this scene can be resolved by a beam"));
    assert!(!page.contains("beams, 1 sample"));
    let (record, page) = studied("s1a");
    let beam = points(&record).iter().find(|p| p["method"] == "beam").unwrap();
    assert_eq!((&beam["sampled"], &beam["samples"]), (&0.0.into(), &1.into()), "{beam}");
    assert!(page.contains("beams, one beam a pixel") && page.contains("one cone a pixel"));
}

#[test]
fn pictures_of_the_page_are_points_of_its_tables_with_true_captions() {
    let folder = tempdir().unwrap();
    let options = ["--methods", "adaptive+sobol-owen,beam,cone", "--spp", "4,16,64", "--repeats", "1"];
    let record = studied(folder.path(), &options);
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(!page.contains("not sampled at points alone"));
    let adaptive =
        points(&record).iter().find(|p| p["method"] == "adaptive+sobol-owen" && p["spp"] == 16).unwrap();
    let taken = format!("{} samples on average", adaptive["samples"]);
    assert!(page.matches(&format!("adaptive, {taken}")).count() >= 1, "no picture took {taken}");
    assert!(page.contains(&format!("<span class=\"fit\">{taken}</span>")), "the table does not say {taken}");
    for caption in [
        "More samples where the first ones differ",
        "Each pixel is one region of rays, cut by the shapes that it meets: no samples",
        "Each pixel is one cone",
    ] {
        assert!(page.contains(caption), "{caption}");
    }
}

#[test]
fn oracle_makes_references_but_is_no_device() {
    let folder = tempdir().unwrap();
    let options = ["--methods", "random", "--spp", "1,2,4", "--repeats", "1", "--reference", "oracle"];
    let record = studied(folder.path(), &options);
    assert!(record["reference"]["kind"].as_str().unwrap().contains("oracle"), "{}", record["reference"]);
    let refused = moire().args(["study", "x.toml", "--out", "x", "--device", "oracle"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(told(&refused).contains("no device"), "{}", told(&refused));
}

#[test]
fn given_reference_is_what_errors_are_measured_against() {
    let folder = tempdir().unwrap();
    let picture = folder.path().join("grey.exr");
    let mut film = gradient(48, 36);
    film.pixels.fill([0.5; 3]);
    write(&film, &picture, &WriteOptions::default()).unwrap();
    let file = picture.to_str().unwrap();
    let out = folder.path().join("out");
    let record = studied(&out, &["--methods", "center", "--spp", "1", "--reference", file]);
    assert!(record["reference"]["rmse"].is_null(), "a file's own error is not known");
    assert!(points(&record)[0]["errors"]["rmse"].as_f64().unwrap() > 0.1);
}

/// The point that would take hours: 2^24 samples.
const HOURS: &str = "random with 16777216 samples was left out";

/// Two minutes are enough for the others on any machine: the reference is given.
#[test]
fn longest_points_are_left_out_where_time_does_not_suffice() {
    if device_name() != "cpu" {
        // A GPU takes 2^24 samples of so few pixels in a second.
        return;
    }
    let folder = tempdir().unwrap();
    let reference = folder.path().join("grey.exr");
    write(&gradient(48, 36), &reference, &WriteOptions::default()).unwrap();
    let options = ["--methods", "random,stratified", "--spp", "1,4,16777216", "--seconds", "120"];
    let given = ["--reference", reference.to_str().unwrap()];
    let record = studied(&folder.path().join("out"), &[&options[..], &given].concat());
    let counts: Vec<u64> = points(&record).iter().map(|p| p["spp"].as_u64().unwrap()).collect();
    assert_eq!(counts, [1, 4, 1, 4]);
    let notes = record["notes"].to_string();
    assert!(notes.contains(HOURS), "{notes}");
}

/// A busy machine may not have rendered one point in the first of these times, or measured it as often as it should.
#[test]
fn a_reference_takes_no_more_samples_than_a_part_of_the_time_allows() {
    if device_name() != "cpu" {
        return;
    }
    let folder = tempdir().unwrap();
    let options = ["--methods", "random", "--spp", "1,16777216", "--json", "-q", "--seconds"];
    for seconds in ["3", "30", "300"] {
        let output = study(folder.path(), &[&options[..], &[seconds]].concat());
        if told(&output).contains("no time for a single point") {
            continue;
        }
        assert_eq!(output.status.code(), Some(0), "{}", told(&output));
        let record: Value = serde_json::from_slice(&output.stdout).unwrap();
        let (samples, notes) = (&record["reference"]["samples"], record["notes"].to_string());
        assert!(samples.as_u64().is_some_and(|n| n < 1 << 24), "all samples in {seconds} s: {samples}");
        assert!(points(&record).len() == 1 && notes.contains(HOURS), "{notes}");
        let said = format!("the reference has {samples} samples a pixel instead of 33554432: no room within");
        assert!(notes.contains(&said), "{said}: {notes}");
        return;
    }
    panic!("300 s are no time for one point");
}
