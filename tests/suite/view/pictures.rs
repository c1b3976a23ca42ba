//! Pictures of the page are those of `moire render`, and follow the settings.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};
use tempfile::tempdir;

use super::{View, refined};
use crate::support::program;

const SIZE: &[&str] = &["--size", "40x30"];

fn pixels(png: &[u8]) -> Vec<u8> {
    image::load_from_memory(png).unwrap().to_rgb8().into_raw()
}

/// Runs a command of the page; returns the picture's pixels, and its file.
pub fn rendered(command: &str, folder: &Path) -> (Vec<u8>, Vec<u8>) {
    let rest = command.strip_prefix("moire ").unwrap();
    let out = folder.join("out.png");
    let line = format!("'{}' {rest} -q -o '{}'", program().canonicalize().unwrap().display(), out.display());
    let output = Command::new("bash").args(["-c", &line]).output().unwrap();
    assert!(output.status.success(), "{line}\n{}", String::from_utf8_lossy(&output.stderr));
    let file = std::fs::read(out).unwrap();
    (pixels(&file), file)
}

/// Returns the pixels of a side's picture.
pub fn picture(view: &View, side: &str) -> Vec<u8> {
    let reply = view.get(&format!("picture?tab=t&side={side}"));
    assert_eq!((reply.status, reply.head.contains("image/png")), (200, true));
    pixels(&reply.body)
}

#[test]
fn pictures_are_bit_for_bit_those_of_the_command() {
    let view = View::of("horizon", SIZE);
    let folder = tempdir().unwrap();
    let mut tab = view.tab("t");
    let spp = "16";
    for (options, set) in [
        (json!({ "spp": spp }), vec![]),
        (json!({ "spp": "9", "pattern": "stratified", "seed": "7" }), vec!["camera.vertical_fov=30"]),
        (
            json!({ "spp": spp, "pattern": "sobol-owen", "footprint": "differentials", "filter": "ewa" }),
            vec![],
        ),
        (json!({ "spp": "4", "footprint": "cone", "filter": "linear", "mip": "linear" }), vec![]),
        (
            json!({ "spp": "8", "pattern": "halton", "pixel-filter": "mitchell", "pixel-filter-radius": "1.5" }),
            vec![],
        ),
        (
            json!({ "spp": spp, "sampler.*.address": "mirrored-repeat", "size": "32x20" }),
            vec!["background.color=[0.1, 0.2, 0.9]"],
        ),
        // Settings of samples alone share what is on the device.
        (json!({ "spp": spp, "pattern": "sobol-owen", "seed": "5" }), vec![]),
        (json!({ "spp": spp, "pattern": "sobol-owen", "seed": "6" }), vec![]),
        (json!({ "spp": "9", "pattern": "stratified", "shared": "true" }), vec![]),
        (json!({ "pattern": "center" }), vec![]),
        (json!({ "algorithm": "cone" }), vec![]),
        (json!({ "spp": "4", "algorithm": "beam" }), vec![]),
        (
            json!({ "spp": "4", "exposure": "0.5", "tone-map": "agx", "white-balance": "4000" }),
            vec!["camera.vertical_fov=30"],
        ),
    ] {
        let mut options = options;
        if options["size"].is_null() {
            options["size"] = "40x30".into();
        }
        let side = refined(&view, &mut tab, 0, options, &set);
        assert!(side["failure"].is_null(), "{side}");
        let command = side["command"].as_str().unwrap();
        let (pixels, file) = rendered(command, folder.path());
        assert!(picture(&view, "a") == pixels, "{command}");
        // The file of the page says how it was made, as that of the command does.
        assert!(view.get("picture?tab=t&side=a&file=1").body == file, "{command}");
    }
}

#[test]
fn a_picture_that_the_page_saves_is_rendered_again_from_its_record() {
    let folder = tempdir().unwrap();
    for arguments in
        [&["--device", "oracle"][..], &["--exposure", "-0.5", "--set", "sampler.*.filter.mag=nearest"]]
    {
        let scene = std::path::absolute(crate::stage::path("horizon")).unwrap();
        let view = View::of_file(&scene, &[SIZE, &["--spp", "4"], arguments].concat());
        let mut tab = view.tab("t");
        tab.done();
        let page = folder.path().join("page.png");
        let saved = view.get("picture?tab=t&side=a&file=1").body;
        std::fs::write(&page, &saved).unwrap();
        let again = folder.path().join("again.png");
        let mut command = Command::new(program());
        command.args(["render", "--from"]).arg(&page).args(["-q", "-o"]).arg(&again);
        assert!(command.status().unwrap().success(), "{arguments:?}");
        assert!(std::fs::read(again).unwrap() == saved, "{arguments:?}");
        assert!(
            view.get("picture?tab=t&side=a").body.len() < saved.len(),
            "what is only shown carries a record"
        );
    }
}

#[test]
fn a_picture_refines_through_counts_and_its_error_falls() {
    let view = View::of("horizon", &[SIZE, &["--pattern", "random", "--spp", "64"]].concat());
    let state = view.tab("t").done();
    let points = state["sides"][0]["points"].as_array().unwrap();
    let counts: Vec<u64> = points.iter().map(|point| point["spp"].as_u64().unwrap()).collect();
    assert_eq!(counts, [1, 2, 4, 8, 16, 32, 64]);
    let errors: Vec<f64> = points.iter().filter_map(|point| point["rmse"].as_f64()).collect();
    assert_eq!(errors.len(), 6, "the last one is the reference");
    assert!(errors[0] > 2.0 * errors[3] && errors.iter().all(|error| *error > 0.0), "{errors:?}");
    assert!(points.iter().all(|point| point["seconds"].as_f64().unwrap() > 0.0));
    assert_eq!(
        (&state["difference"], &state["sides"][0]["number"]),
        (&Value::Null, &state["sides"][1]["number"])
    );
}

#[test]
fn counts_are_those_that_the_pattern_takes() {
    let view = View::of("horizon", &[SIZE, &["--spp", "1"]].concat());
    let mut tab = view.tab("t");
    for (options, wanted) in [
        (json!({ "size": "8x8", "pattern": "grid", "spp": "36" }), vec![1, 4, 16, 36]),
        (json!({ "size": "8x8", "pattern": "center", "spp": "5" }), vec![1]),
        (json!({ "size": "8x8", "pattern": "blue-noise", "spp": "8" }), vec![1, 2, 4, 8]),
        (json!({ "size": "8x8", "pattern": "halton", "spp": "5" }), vec![1, 2, 4, 5]),
    ] {
        let side = refined(&view, &mut tab, 0, options.clone(), &[]);
        let points = side["points"].as_array().unwrap();
        let counts: Vec<u64> = points.iter().map(|point| point["spp"].as_u64().unwrap()).collect();
        assert_eq!(counts, wanted, "{options}");
    }
}

#[test]
fn adaptive_pictures_tell_their_own_estimates() {
    let view = View::of("horizon", &[SIZE, &["--algorithm", "adaptive", "--spp", "16"]].concat());
    let state = view.tab("t").done();
    let last = state["sides"][0]["points"].as_array().unwrap().last().unwrap().clone();
    assert!(last["estimate"].as_f64().unwrap() > 0.0, "{last}");
    assert!(last["samples"].as_f64().unwrap() > 0.0, "{last}");
}

#[test]
fn sides_and_tabs_have_settings_of_their_own() {
    let view = View::of("horizon", &[SIZE, &["--spp", "4"]].concat());
    let [mut one, mut two] = ["t", "u"].map(|name| view.tab(name));
    let [first, other] = [one.done(), two.done()];
    let before = picture(&view, "a");
    assert!(before == picture(&view, "b"));
    let options = json!({ "spp": "4", "filter": "nearest", "size": "40x30" });
    refined(&view, &mut one, 1, options, &["camera.vertical_fov=20"]);
    let state = one.last.clone();
    assert_eq!(state["sides"][0]["number"], first["sides"][0]["number"]);
    assert!(state["difference"].as_f64().unwrap() > 0.0, "{state}");
    assert!(before == picture(&view, "a") && before != picture(&view, "b"));
    let reply = view.get("picture?tab=u&side=b");
    assert!(pixels(&reply.body) == before, "another tab has changed");
    assert_ne!(other["sides"][0]["number"], first["sides"][0]["number"]);
    // Equal settings are one picture again.
    assert_eq!(view.set("t", "b", json!({ "spp": "4", "size": "40x30" }), &[]), None);
    one.until(|state| state["sides"][0]["number"] == state["sides"][1]["number"]);
}

#[test]
fn a_wrong_setting_is_told_in_the_programs_words_and_changes_nothing() {
    let view = View::of("horizon", &[SIZE, &["--spp", "1"]].concat());
    let mut tab = view.tab("t");
    let number = tab.done()["sides"][0]["number"].clone();
    for (options, set, wanted) in [
        (json!({}), "camera.vertical_fo=40", "vertical_fov"),
        (json!({}), "sampling.spp", "there is no ="),
        (json!({ "pattern": "jitter" }), "camera.vertical_fov=40", "expected one of center, grid"),
        (json!({ "spp": "7", "pattern": "grid" }), "camera.vertical_fov=40", "--spp"),
        (json!({ "colour": "red" }), "camera.vertical_fov=40", "there is no option \"colour\""),
        (json!({ "spp": "0" }), "camera.vertical_fov=40", "spp"),
        (json!({ "size": "0x7" }), "camera.vertical_fov=40", "WIDTHxHEIGHT"),
        (json!({ "method": "hardware", "filter": "ewa" }), "camera.vertical_fov=40", "own sampler"),
    ] {
        let told = view.set("t", "a", options, &[set]).expect("it is refused");
        assert!(told.contains(wanted), "{told}");
    }
    assert!(view.set("t", "c", json!({}), &[]).unwrap().contains("side=a"));
    assert_eq!(view.set("t", "b", json!({ "spp": "1", "size": "8x8" }), &[]), None);
    let state = tab.until(|state| state["sides"][1]["width"] == 8);
    assert_eq!(state["sides"][0]["number"], number);
}

#[test]
fn a_texture_that_cannot_be_read_is_a_failure_of_its_side_alone() {
    let folder = tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[camera]\neye = [0.0, 0.0, 3.0]\nlook_at = [0.0, 0.0, 0.0]\nvertical_fov = 40.0\n[image]\nwidth = 8\nheight = 8\n\
                [[texture]]\nname = \"t\"\nfile = \"t.png\"\n[[material]]\nname = \"m\"\nmodel = \"unlit\"\ntexture = \"t\"\n\
                [[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\nmaterial = \"m\"\n";
    std::fs::write(&scene, text).unwrap();
    image::RgbImage::new(2, 2).save(folder.path().join("t.png")).unwrap();
    let view = View::of_file(&scene, &["--device", &crate::stage::device_name(), "--spp", "1"]);
    let mut tab = view.tab("t");
    tab.done();
    std::fs::write(folder.path().join("t.png"), "no picture").unwrap();
    assert_eq!(view.set("t", "b", json!({ "spp": "1", "seed": "3" }), &[]), None);
    let state = tab.until(|state| !state["sides"][1]["failure"].is_null());
    assert!(state["sides"][1]["failure"].as_str().unwrap().contains("t.png"), "{state}");
    assert!(state["sides"][0]["failure"].is_null());
    assert_eq!(view.set("t", "b", json!({ "spp": "1" }), &["texture.t.file=nowhere.png"]), None);
    tab.until(|state| state["sides"][1]["failure"].as_str().is_some_and(|told| told.contains("nowhere.png")));
}

#[test]
fn a_scene_file_that_goes_or_changes_is_told_and_what_is_shown_stays_itself() {
    let folder = tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[camera]\neye = [0.0, 0.0, 3.0]\nlook_at = [0.0, 0.0, 0.0]\nvertical_fov = 40.0\n[image]\nwidth = 8\nheight = 8\n\
                [[material]]\nname = \"first\"\nmodel = \"unlit\"\n[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\nmaterial = \"first\"\n";
    std::fs::write(&scene, text).unwrap();
    let view = View::of_file(&scene, &["--device", &crate::stage::device_name(), "--spp", "1"]);
    let mut tab = view.tab("t");
    tab.done();
    std::fs::remove_file(&scene).unwrap();
    let told = view.set("t", "b", json!({ "spp": "1", "seed": "3" }), &[]).expect("it is refused");
    assert!(told.contains("scene.toml"), "{told}");
    // Another display of the film needs no file.
    assert_eq!(view.set("t", "b", json!({ "spp": "1", "exposure": "-1" }), &[]), None);
    tab.until(|state| state["sides"][1]["display"] == "--exposure -1");
    assert_eq!(view.get("picture?tab=t&side=b").status, 200);
    let reply = view.get("events?tab=other");
    assert_eq!((reply.status, reply.text().contains("scene.toml")), (503, true));
    std::fs::write(&scene, text.replace("first", "another")).unwrap();
    let material = |side: &str| {
        view.get(&format!("pixel?tab=t&side={side}&x=4&y=4")).json()["surface"]["material"].clone()
    };
    assert_eq!(material("a"), "first", "the picture is of the file as it was");
    refined(&view, &mut tab, 1, json!({ "spp": "1", "seed": "3" }), &[]);
    assert_eq!(material("b"), "another");
}

#[test]
fn settings_of_the_page_name_no_file_outside_the_scenes_folder() {
    let folder = tempdir().unwrap();
    let own = folder.path().join("own.png");
    image::RgbImage::new(2, 2).save(&own).unwrap();
    let view = View::of("lecture", &["--size", "8x8", "--spp", "1"]);
    let _tab = view.tab("t");
    let other = folder.path().join("other.png");
    std::fs::copy(&own, &other).unwrap();
    for file in [other.display().to_string(), "/etc/passwd".into()] {
        let told =
            view.set("t", "a", json!({}), &[&format!("texture.0.file={file}")]).expect("it is refused");
        assert!(told.contains("outside the scene's folder"), "{told}");
    }
}
