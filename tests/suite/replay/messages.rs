//! What is said about records: by which device they ask to be rendered, where a mistake in their text is, and nothing that
//! a terminal obeys, whatever a record or a scene holds.

use std::fs;

use serde_json::json;

use super::hostile::{honest, picture, told_of};
use super::{SCENE, refused, stage};
use crate::support::moire;
use moire::internal::output::Format;

/// Moves the cursor, changes colors, by one and by two bytes; turns the direction of writing.
const OBEYED: &str = "\u{1b}[31m\u{9b}2J\u{202e}\u{7}";

fn check_plain(told: &[u8]) {
    let told = String::from_utf8_lossy(told);
    assert!(!told.contains(|c: char| c.is_control() && c != '\n') && !told.contains('\u{202e}'), "{told:?}");
}

#[test]
fn nothing_that_a_record_holds_moves_the_terminal() {
    let folder = stage();
    let set = |key: &[&str], value: serde_json::Value| {
        let mut record = honest();
        let mut at = &mut record;
        for key in key {
            at = &mut at[*key];
        }
        *at = value;
        let text = record.to_string();
        fs::write(folder.path().join("x.png"), picture(Format::Png, &text)).unwrap();
        let mut command = moire();
        command.current_dir(folder.path()).args(["render", "--from", "x.png", "-o", "y.png"]);
        let output = command.output().unwrap();
        check_plain(&output.stderr);
        output.stderr
    };
    let text = |at: &str| json!(format!("{at}{OBEYED}"));
    assert!(String::from_utf8_lossy(&set(&["version"], text("9"))).contains("moire 9\\u001b[31m"));
    set(&["device"], text("gpu"));
    set(&["driver"], text("driver"));
    set(&["program"], text("moire"));
    set(&["options"], json!([format!("--spp={OBEYED}")]));
    set(&["options"], json!([OBEYED]));
    set(&["scene", "path"], text("s.toml"));
    set(&["scene"], json!({ "path": format!("{OBEYED}.toml"), "bytes": 1, "crc32": 1, "note": OBEYED }));
    for old in ["vertical_fov", "\"unlit\"", "textures/", "# Grün"] {
        let scene = SCENE.replace(old, &format!("{old}{OBEYED}"));
        set(&["scene"], json!({ "path": "s.toml", "bytes": scene.len(), "text": scene }));
    }
}

#[test]
fn nothing_that_a_scene_file_holds_moves_the_terminal() {
    let folder = stage();
    let lone = "\r";
    for (old, new) in [
        ("vertical_fov", format!("\"{OBEYED}\"")),
        ("[camera]", format!("[camera] # {OBEYED}")),
        ("model = \"unlit\"", format!("model = '{OBEYED}'")),
        ("model = \"unlit\"", "model = \"\\u001b[31m\"".into()),
        ("textures/grass.png", "\\u001b[31m.png".into()),
        ("vertical_fov = 50.0", format!("vertical_fog = 50.0 # {lone}x")),
    ] {
        fs::write(folder.path().join("s.toml"), SCENE.replacen(old, &new, 1)).unwrap();
        let told = refused(folder.path(), &["s.toml", "-o", "y.png"]);
        check_plain(told.as_bytes());
    }
}

#[test]
fn a_device_that_is_missing_is_told_as_the_wish_of_the_record() {
    let folder = stage();
    let mut record = honest();
    record["options"] = json!(["--device=no such device", "--spp=1"]);
    let told = told_of(folder.path(), &record.to_string());
    for what in
        ["x.png: its record asks for --device=no such device", "--without device", "--device beside --from"]
    {
        assert!(told.contains(what), "{told}");
    }
    // One that is typed is not the record's.
    let told = refused(folder.path(), &["--from", "x.png", "-o", "y.png", "--device", "another such"]);
    assert!(told.contains("another such") && !told.contains("its record asks"), "{told}");
}

#[test]
fn mistakes_in_a_recorded_text_are_told_as_those_of_the_record() {
    let folder = stage();
    let mut record = honest();
    let broken = SCENE.replacen("[camera]", "[camera", 1);
    record["scene"] = json!({ "path": "scenes/floor.toml", "bytes": broken.len(), "text": broken });
    let told = told_of(folder.path(), &record.to_string());
    assert!(told.contains("the record of x.png: scenes/floor.toml:2:"), "{told}");
    assert!(!told.contains("looked for"), "it is no matter of files: {told}");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_at_once() {
    let folder = stage();
    let pipe = folder.path().join("p.png");
    nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::S_IRWXU).unwrap();
    assert!(refused(folder.path(), &["--from", "p.png"]).contains("not a regular file"));
}

#[test]
fn the_usage_says_that_a_picture_stands_in_place_of_a_scene() {
    let output = moire().args(["render", "--help"]).output().unwrap();
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(told.contains("moire render [OPTIONS] <SCENE>\n"), "{told}");
    assert!(told.contains("moire render [OPTIONS] --from <PICTURE>\n"), "{told}");
}
