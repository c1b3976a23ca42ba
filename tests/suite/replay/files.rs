//! The files of a recorded scene: they are known by their checksums, and looked for beside the picture first; what has
//! changed is refused, and what cannot be known is told.

use std::fs;
use std::path::Path;

use serde_json::json;
use tempfile::tempdir;

use super::{SCENE, record_of, refused, rendered, stage};
use crate::stage::device_name;
use crate::support::{data, moire};

fn copy(from: &str, to: &Path) {
    fs::copy(data().join(from), to).unwrap();
}

fn checksum(path: &Path) -> serde_json::Value {
    let bytes = fs::read(path).unwrap();
    json!({ "bytes": bytes.len(), "crc32": crc32fast::hash(&bytes) })
}

/// Two folders with a file of the same name, which is not the same file.
#[test]
fn files_are_taken_from_the_folder_of_the_picture_and_not_from_the_current_one() {
    let folder = tempdir().unwrap();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    for (place, texture) in [(&a, "poster"), (&b, "grass")] {
        fs::create_dir_all(place.join("textures")).unwrap();
        copy(&format!("textures/{texture}.png"), &place.join("textures/grass.png"));
    }
    fs::write(a.join("s.toml"), SCENE).unwrap();
    for scene in ["s.toml", "./s.toml"] {
        rendered(&a, &[scene, "-o", "out.png"]);
        rendered(&b, &["--from", "../a/out.png", "-o", "again.png"]);
        assert!(fs::read(a.join("out.png")).unwrap() == fs::read(b.join("again.png")).unwrap());
    }
    // The picture alone is moved: the other file is noticed, and another one can be named.
    fs::rename(a.join("out.png"), b.join("out.png")).unwrap();
    let told = refused(&b, &["--from", "out.png", "-o", "y.png"]);
    for what in
        ["textures/grass.png is not the file that was rendered", "the current folder", "texture \"grass\""]
    {
        assert!(told.contains(what), "{told}");
    }
    assert!(!told.contains("and the current folder"), "it is named once: {told}");
    rendered(&b, &["--from", "out.png", "-o", "y.png", "--set", "texture.grass.file=textures/grass.png"]);
    assert!(b.join("y.png").is_file());
}

/// A path of a recorded setting is relative to the folder in which it was typed.
#[test]
fn files_of_recorded_settings_are_those_of_their_time() {
    let folder = tempdir().unwrap();
    let (a, b) = (folder.path().join("a"), folder.path().join("b"));
    for (place, texture) in [(&a, "poster"), (&b, "grass")] {
        fs::create_dir_all(place).unwrap();
        copy(&format!("textures/{texture}.png"), &place.join("own.png"));
    }
    fs::write(a.join("s.toml"), SCENE).unwrap();
    rendered(&a, &["s.toml", "-o", "out.png", "--set", "texture.grass.file=own.png"]);
    rendered(&b, &["--from", "../a/out.png", "-o", "again.png"]);
    assert!(fs::read(a.join("out.png")).unwrap() == fs::read(b.join("again.png")).unwrap());
}

#[test]
fn a_changed_texture_is_refused_also_one_of_the_same_length() {
    let folder = stage();
    let texture = folder.path().join("scenes/textures/grass.png");
    rendered(folder.path(), &["scenes/floor.toml", "-o", "a.png"]);
    let files = record_of(&folder.path().join("a.png")).unwrap()["files"].clone();
    let mut own = checksum(&texture);
    own["path"] = json!("scenes/textures/grass.png");
    assert_eq!(files, json!([own]));
    let mut bytes = fs::read(&texture).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&texture, bytes).unwrap();
    let told = refused(folder.path(), &["--from", "a.png", "-o", "b.png"]);
    assert!(told.contains("grass.png is not the file that was rendered: it has changed"), "{told}");
}

#[test]
fn a_changed_model_or_buffer_is_refused_and_the_right_one_is_found_beside_the_picture() {
    let folder = tempdir().unwrap();
    let place = folder.path();
    let beside = place.join("beside");
    fs::create_dir(&beside).unwrap();
    copy("models/knot.ply", &place.join("knot.ply"));
    let options = ["--size=16x12", "--spp=1"];
    rendered(place, &[&["knot.ply", "-o", "a.png"], &options[..]].concat());
    let record = record_of(&place.join("a.png")).unwrap();
    let known = checksum(&place.join("knot.ply"));
    assert_eq!((&record["scene"]["crc32"], &record["scene"]["bytes"]), (&known["crc32"], &known["bytes"]));
    for name in ["a.png", "knot.ply"] {
        fs::rename(place.join(name), beside.join(name)).unwrap();
    }
    // The first file of this name is another one.
    let other = [&fs::read(beside.join("knot.ply")).unwrap()[..], b"\n"].concat();
    fs::write(place.join("knot.ply"), &other).unwrap();
    rendered(place, &["--from", "beside/a.png", "-o", "b.png"]);
    assert!(fs::read(beside.join("a.png")).unwrap() == fs::read(place.join("b.png")).unwrap());
    fs::write(beside.join("knot.ply"), &other).unwrap();
    let told = refused(place, &["--from", "beside/a.png", "-o", "c.png"]);
    assert!(told.contains("knot.ply is not the file that was rendered"), "{told}");
}

#[test]
fn meshes_of_a_scene_and_files_that_they_name_are_recorded() {
    let folder = tempdir().unwrap();
    let place = folder.path();
    fs::write(place.join("m.obj"), "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n").unwrap();
    fs::write(place.join("m.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let scene = "[camera]\neye = [0.3, 0.3, 3.0]\nlook_at = [0.3, 0.3, 0.0]\nvertical_fov = 40.0\n[image]\nwidth = 8\n\
                 height = 8\n[[mesh]]\nfile = \"m.obj\"\n";
    fs::write(place.join("s.toml"), scene).unwrap();
    rendered(place, &["s.toml", "-o", "a.png", "--spp=1"]);
    let files = record_of(&place.join("a.png")).unwrap()["files"].clone();
    let names: Vec<&str> =
        files.as_array().unwrap().iter().filter_map(|file| file["path"].as_str()).collect();
    assert_eq!(names, ["m.obj", "m.mtl"]);
    for name in names {
        let kept = fs::read(place.join(name)).unwrap();
        fs::write(place.join(name), [&kept[..], b"# x\n"].concat()).unwrap();
        let told = refused(place, &["--from", "a.png", "-o", "b.png"]);
        assert!(told.contains(&format!("{name} is not the file that was rendered")), "{told}");
        fs::write(place.join(name), kept).unwrap();
    }
    rendered(place, &["--from", "a.png", "-o", "b.png"]);
}

#[test]
fn other_drivers_and_commits_are_told_as_devices_are() {
    let folder = stage();
    let output = moire()
        .current_dir(folder.path())
        .args([
            "render",
            "scenes/floor.toml",
            "-o",
            "a.exr",
            "--size=8x8",
            "--spp=1",
            "--device",
            &device_name(),
        ])
        .output()
        .unwrap();
    assert!(output.status.success());
    let path = folder.path().join("a.exr");
    let record = record_of(&path).unwrap();
    assert!(record["driver"].as_str().is_some_and(|driver| !driver.is_empty()), "{record}");
    // A changed record of the same length: the file stays well-formed.
    let bytes = fs::read(&path).unwrap();
    let changed = |from: &str| {
        let at = bytes.windows(from.len()).position(|own| own == from.as_bytes()).unwrap() + from.len();
        let mut changed = bytes.clone();
        changed[at] = if changed[at] == b'q' { b'r' } else { b'q' };
        fs::write(&path, changed).unwrap();
        let again = render_loudly(folder.path(), &["--from", "a.exr", "-o", "b.exr"]);
        assert!(again.contains("now it is"), "{from}: {again}");
        again
    };
    assert!(changed("\"driver\":\"").contains("rendered by driver "));
    assert!(changed("\"version\":\"").contains("rendered by moire "));
    if !record["commit"].is_null() {
        assert!(changed("\"commit\":\"").contains("rendered by moire "));
    }
    fs::write(&path, &bytes).unwrap();
    assert!(!render_loudly(folder.path(), &["--from", "a.exr", "-o", "b.exr"]).contains("now it is"));
}

fn render_loudly(folder: &Path, options: &[&str]) -> String {
    let output = moire().current_dir(folder).arg("render").args(options).output().unwrap();
    String::from_utf8(output.stderr).unwrap()
}
