//! The scene of a record: its text in place of its file, files beside the picture, scenes that are too long, and models.

use std::fs;

use tempfile::tempdir;

use super::{FORMATS, SCENE, record_of, refused, rendered, stage};
use crate::stage::device_name;
use crate::support::{data, moire};

#[test]
fn the_scene_may_be_gone_and_its_textures_lie_beside_the_picture() {
    let folder = stage();
    let place = folder.path();
    rendered(place, &["scenes/floor.toml", "-o", "a.png"]);
    let wanted = fs::read(place.join("a.png")).unwrap();
    let pictures = |part: &str| place.join("pictures").join(part);
    fs::create_dir_all(pictures("textures")).unwrap();
    fs::rename(place.join("a.png"), pictures("a.png")).unwrap();
    let again = || {
        rendered(place, &["--from", "pictures/a.png", "-o", "b.png"]);
        assert!(fs::read(place.join("b.png")).unwrap() == wanted);
        fs::remove_file(place.join("b.png")).unwrap();
    };
    fs::remove_file(place.join("scenes/floor.toml")).unwrap();
    again();
    // In the same folder there.
    fs::rename(place.join("scenes/textures/grass.png"), pictures("textures/grass.png")).unwrap();
    again();
    // In none.
    fs::rename(pictures("textures/grass.png"), pictures("grass.png")).unwrap();
    again();
    fs::remove_file(pictures("grass.png")).unwrap();
    let told = refused(place, &["--from", "pictures/a.png", "-o", "b.png"]);
    for what in ["scenes/textures/grass.png is missing", "looked for in pictures and the current folder"] {
        assert!(told.contains(what), "{told}");
    }
    assert!(!place.join("b.png").exists());
}

#[test]
fn a_scene_of_standard_input_is_made_again_from_its_text() {
    let folder = stage();
    let scene = SCENE.replace("textures/", "scenes/textures/");
    let output = moire()
        .current_dir(folder.path())
        .args(["render", "-", "-o", "a.png", "-q", "--device", &device_name()])
        .write_stdin(scene)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    rendered(folder.path(), &["--from", "a.png", "-o", "b.png"]);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.png") == read("b.png"));
}

#[test]
fn of_a_long_scene_its_name_and_checksum_are_recorded_and_it_must_be_the_same_file() {
    let folder = stage();
    let file = folder.path().join("scenes/floor.toml");
    let long = format!("{SCENE}# {}\n", "x".repeat(300 << 10));
    fs::write(&file, &long).unwrap();
    rendered(folder.path(), &["scenes/floor.toml", "-o", "a.png"]);
    let record = record_of(&folder.path().join("a.png")).unwrap();
    assert!(record["scene"]["text"].is_null());
    assert!(record["scene"]["note"].as_str().unwrap().contains("more than the 256 KiB"), "{record}");
    assert!(fs::metadata(folder.path().join("a.png")).unwrap().len() < 20_000);
    rendered(folder.path(), &["--from", "a.png", "-o", "b.png"]);
    fs::write(&file, long.replace("50.0", "51.0")).unwrap();
    let told = refused(folder.path(), &["--from", "a.png", "-o", "b.png"]);
    assert!(told.contains("it has changed"), "{told}");
    fs::remove_file(&file).unwrap();
    let told = refused(folder.path(), &["--from", "a.png", "-o", "b.png"]);
    assert!(told.contains("floor.toml is missing") && told.contains("300 KiB"), "{told}");
}

/// A record of more than a comment of JPEG holds.
#[test]
fn a_record_of_several_parts_is_joined() {
    let folder = stage();
    let file = folder.path().join("scenes/floor.toml");
    fs::write(&file, format!("{SCENE}# {}\n", "é\t".repeat(40 << 10))).unwrap();
    for format in FORMATS {
        let picture = format!("a.{format}");
        rendered(folder.path(), &["scenes/floor.toml", "-o", &picture]);
        let record = record_of(&folder.path().join(&picture)).unwrap();
        assert_eq!(record["scene"]["text"], fs::read_to_string(&file).unwrap(), "{format}");
    }
}

#[test]
fn a_model_is_recorded_by_its_name() {
    let folder = tempdir().unwrap();
    let model = data().join("gallery").canonicalize().unwrap().join("cameras.gltf");
    let model = model.to_str().unwrap();
    rendered(folder.path(), &[model, "-o", "a.png", "--camera", "above", "--size", "16x12", "--spp", "1"]);
    rendered(folder.path(), &["--from", "a.png", "-o", "b.png"]);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.png") == read("b.png"));
}
