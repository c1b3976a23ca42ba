//! What is typed beside `--from` prevails: over options that say what a setting says, over goals, and `--without` leaves
//! recorded options out. What was in force is recorded.

use std::fs;

use serde_json::{Value, json};

use super::{record_of, refused, rendered, stage};
use crate::stage::device_name;
use crate::support::moire;

const SMALL: [&str; 3] = ["--size=12x8", "--seed=3", "--no-metadata"];

#[test]
fn a_typed_setting_prevails_over_a_recorded_option_of_the_same_meaning() {
    let folder = stage();
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for (recorded, typed, same) in [
        ("--filter=ewa", "sampler.*.filter=nearest", "--filter=nearest"),
        ("--filter=ewa", "sampler.s.filter=nearest", "--filter=nearest"),
        ("--spp=4", "sampling.spp=9", "--spp=9"),
        ("--pattern=random", "sampling.pattern=center", "--pattern=center"),
        ("--size=20x10", "image.width=16", "--size=16x10"),
    ] {
        rendered(folder.path(), &["scenes/floor.toml", "-o", "a.exr", recorded]);
        rendered(folder.path(), &["--from", "a.exr", "-o", "b.exr", "--set", typed, "--no-metadata"]);
        rendered(folder.path(), &["scenes/floor.toml", "-o", "c.exr", same, "--no-metadata"]);
        assert!(read("b.exr") == read("c.exr"), "{recorded} {typed}");
    }
    // Another setting of the section leaves the option as it is.
    rendered(folder.path(), &["scenes/floor.toml", "-o", "a.exr", "--filter=ewa"]);
    rendered(
        folder.path(),
        &["--from", "a.exr", "-o", "b.exr", "--set", "sampler.s.address=repeat", "--no-metadata"],
    );
    rendered(
        folder.path(),
        &[
            "scenes/floor.toml",
            "-o",
            "c.exr",
            "--filter=ewa",
            "--set",
            "sampler.s.address=repeat",
            "--no-metadata",
        ],
    );
    assert!(read("b.exr") == read("c.exr"));
}

#[test]
fn a_recorded_goal_can_be_left_for_a_number_of_samples_and_the_other_way_round() {
    let folder = stage();
    rendered(
        folder.path(),
        &["scenes/floor.toml", "-o", "goal.exr", "--size=12x8", "--seed=3", "--target-error=0.5"],
    );
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    for typed in [&["--spp=9"][..], &["--algorithm=samples", "--spp=9"], &["--set=sampling.spp=9"]] {
        let again = [&["--from", "goal.exr", "-o", "b.exr", "--no-metadata"], typed].concat();
        let output = moire().current_dir(folder.path()).arg("render").args(&again).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && !told.contains("no effect"), "{typed:?}: {told}");
        rendered(folder.path(), &[&["scenes/floor.toml", "-o", "c.exr", "--spp=9"], &SMALL[..]].concat());
        assert!(read("b.exr") == read("c.exr"), "{typed:?}");
    }
    rendered(
        folder.path(),
        &["scenes/floor.toml", "-o", "a.exr", "--size=12x8", "--algorithm=samples", "--spp=9"],
    );
    rendered(folder.path(), &["--from", "a.exr", "-o", "b.exr", "--target-error=0.5"]);
    let record = record_of(&folder.path().join("b.exr")).unwrap();
    assert_eq!(record["settings"]["algorithm"], "auto", "{record}");
    assert!(!record["options"].to_string().contains("spp"), "{record}");
}

#[test]
fn recorded_options_are_left_out_by_their_names() {
    let folder = stage();
    let whole = ["scenes/floor.toml", "--size=12x8", "--spp=1"];
    let more = ["-o", "a.png", "--crop=1,1,4,4", "--white-balance=3000", "--allow-nonfinite"];
    rendered(folder.path(), &[&whole[..], &more].concat());
    rendered(
        folder.path(),
        &["--from", "a.png", "-o", "b.png", "--without", "crop,white-balance,allow-nonfinite"],
    );
    rendered(folder.path(), &[&whole[..], &["-o", "c.png"]].concat());
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("b.png") == read("c.png"), "records, too");
    let told = refused(folder.path(), &["--from", "a.png", "--without", "corp"]);
    assert!(told.contains("did you mean \"crop\"?"), "{told}");
    for name in ["output", "json", "from"] {
        refused(folder.path(), &["--from", "a.png", "--without", name]);
    }
    let told = refused(folder.path(), &["scenes/floor.toml", "--without", "crop"]);
    assert!(told.contains("--from PICTURE"), "{told}");
}

#[test]
fn settings_of_record_and_report_say_what_was_in_force() {
    let folder = stage();
    let render = |options: &[&str]| -> (Value, Value) {
        let mut command = moire();
        command.current_dir(folder.path()).args(["render", "scenes/floor.toml", "-o", "a.png", "--json"]);
        command.args(["--size=12x8", "--device", &device_name()]).args(options);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let report = serde_json::from_slice(&output.stdout).unwrap();
        (report, record_of(&folder.path().join("a.png")).unwrap()["settings"].clone())
    };
    let display =
        ["--exposure=1", "--white-balance=3000", "--tone-map=agx", "--gamut=display-p3", "--png-bits=16"];
    let (report, settings) = render(&[&display[..], &["--jpeg-quality=80", "--spp=4"]].concat());
    for own in [&report["options"], &settings] {
        let names = ["exposure", "white_balance", "tone_map", "gamut", "png_bits", "jpeg_quality", "spp"];
        let values = names.map(|name| own[name].clone());
        let wanted =
            [json!(1.0), json!(3000.0), json!("agx"), json!("display-p3"), json!(16), json!(80), json!(4)];
        assert_eq!(values, wanted);
    }
    assert_eq!(settings["samples"], 4);
    let (report, settings) = render(&["--target-error=0.01"]);
    assert!(settings["spp"].is_null() && settings["target_error"] == 0.01, "{settings}");
    assert_eq!(settings["chosen"], report["reached"]["chosen"]);
    assert_eq!(settings["samples"], report["reached"]["mean_samples"]);
    assert!(report["options"]["spp"].is_null() && report["options"]["target_error"] == 0.01);
}
