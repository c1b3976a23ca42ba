//! `--camera`: the cameras of a glTF file by number and by name, where a file is rendered, inspected and studied; and what
//! is said of numbers and names that there are not.

use std::fs;
use std::path::{Path, PathBuf};

use moire::internal::lab::metrics::read_picture;
use moire::internal::scene::load_seen_by;
use moire::internal::scene::model::Projection;
use serde_json::{Value, json};
use tempfile::tempdir;

use super::made::document::Document;
use super::made::shapes;
use crate::stage::{assert_same_bits, device_name};
use crate::support::{data, moire, told};

fn file(name: &str) -> PathBuf {
    std::path::absolute(data().join(name)).unwrap()
}

/// Returns the exit code and what stderr says, in one line.
fn run(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = moire().current_dir(folder).args(arguments).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let told = told.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    (output.status.code().unwrap(), told)
}

#[test]
fn cameras_are_chosen_by_number_and_by_name() {
    let cameras = file("gallery/cameras.gltf");
    let seen = |camera| load_seen_by(&cameras, camera).unwrap();
    assert!(matches!(seen(None).camera.projection, Projection::VerticalFov(_)));
    assert_eq!(seen(Some("0")).camera.eye, seen(None).camera.eye);
    for chosen in ["1", "above"] {
        let scene = seen(Some(chosen));
        assert_eq!(scene.camera.projection, Projection::Orthographic(10.0));
        assert_eq!((scene.width, scene.height), (512, 512));
    }
}

#[test]
fn render_shows_what_the_chosen_camera_sees() {
    let folder = tempdir().unwrap();
    let cameras = file("gallery/cameras.gltf");
    let film = |options: &[&str]| {
        let arguments = ["render", cameras.to_str().unwrap(), "-q", "-o", "a.exr", "--device", "oracle"];
        let small = ["--size", "24x16", "--spp", "1"];
        let (code, told) = run(folder.path(), &[&arguments[..], &small, options].concat());
        assert_eq!((code, told.as_str()), (0, ""));
        read_picture(&folder.path().join("a.exr")).unwrap()
    };
    let [none, first, second, named] =
        [&[][..], &["--camera", "0"], &["--camera", "1"], &["--camera", "above"]].map(film);
    assert_same_bits(&none, &first, "the first camera");
    assert_same_bits(&second, &named, "the second camera");
    assert!(first != second, "both cameras see the same");
}

#[test]
fn inspect_takes_a_camera() {
    let folder = tempdir().unwrap();
    let cameras = file("gallery/cameras.gltf");
    let arguments = ["inspect", cameras.to_str().unwrap(), "--out", "seen", "--device", "oracle", "-q"];
    let more = |camera| [&arguments[..], &["--size", "16x16", "--spp", "1", "--camera", camera]].concat();
    assert_eq!(run(folder.path(), &more("above")), (0, String::new()));
    let (code, told) = run(folder.path(), &more("below"));
    assert!(code == 2 && told.contains("\"below\"") && told.contains("0, 1 \"above\""), "{told}");
}

/// Its commands name the camera, and a folder of one camera is measured anew with the other.
#[test]
fn a_study_is_one_of_its_camera() {
    let folder = tempdir().unwrap();
    let cameras = file("gallery/cameras.gltf");
    let run = |camera: &str| -> Value {
        let arguments = ["study", cameras.to_str().unwrap(), "--out", "studied", "--json", "-q"];
        let small = ["--size", "16x16", "--methods", "random", "--spp", "1", "--repeats", "1"];
        let mut command = moire();
        command.current_dir(folder.path()).args(arguments).args(small).args(["--device", &device_name()]);
        let output = command.args(["--camera", camera]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let (first, second) = (run("0"), run("above"));
    let point = |record: &Value, key: &str| record["points"][0][key].to_string();
    assert!(point(&second, "command").contains("--camera above"), "{second}");
    assert_ne!(point(&first, "hash"), point(&second, "hash"));
}

#[test]
fn cameras_that_there_are_not_are_refused_with_those_that_there_are() {
    let folder = tempdir().unwrap();
    let [cameras, none, model, scene] =
        ["gallery/cameras.gltf", "models/sign.glb", "models/crate.obj", "scenes/quad.toml"].map(file);
    for (file, camera, parts) in [
        (&cameras, "2", &["--camera", "cameras.gltf", "found \"2\"", "2 cameras: 0, 1 \"above\""][..]),
        (&cameras, "-1", &["found \"-1\"", "2 cameras"]),
        (&cameras, "beside", &["number or the name", "found \"beside\"", "1 \"above\""]),
        (&cameras, "", &["found \"\""]),
        (&none, "0", &["sign.glb", "it has no cameras"]),
        (&model, "0", &["crate.obj", "only glTF files have cameras"]),
        (&scene, "0", &["quad.toml", "scene file", "[camera]"]),
    ] {
        let (code, told) =
            run(folder.path(), &["render", file.to_str().unwrap(), "--camera", camera, "-o", "a.png"]);
        assert!(code == 2 && parts.iter().all(|part| told.contains(part)), "{camera}: {told}");
    }
    let (code, told) = run(folder.path(), &["render", "-", "--camera", "0", "-o", "a.png"]);
    assert!(code == 2 && told.contains("<stdin>") && told.contains("--camera"), "{told}");
    let scene = scene.to_str().unwrap();
    let (code, told) = run(folder.path(), &["study", scene, "--out", "s", "--camera", "0"]);
    assert!(code == 2 && told.contains("quad.toml") && told.contains("[camera]"), "{told}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "files were left");
}

/// Names of nodes stand for cameras without one; several of a name are no choice; long lists are cut.
#[test]
fn cameras_without_a_name_have_that_of_their_node() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    let lens = json!({ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } });
    let written = |nodes: &[Value]| {
        let mut document = Document::default();
        let camera = document.push("cameras", lens.clone());
        let square = shapes::square(&mut document);
        let material = document.push("materials", json!({}));
        square.stand(&mut document, material, json!({}));
        for node in nodes {
            let mut node = node.clone();
            node["camera"] = json!(camera);
            document.stand(node);
        }
        fs::write(&path, document.text()).unwrap();
    };
    written(&[
        json!({ "name": "left", "translation": [-1, 0, 5] }),
        json!({ "name": "right", "translation": [1, 0, 5] }),
        json!({ "name": "right", "translation": [2, 0, 5] }),
    ]);
    let eye = |camera| load_seen_by(&path, Some(camera)).unwrap().camera.eye.x;
    assert_eq!([eye("left"), eye("0"), eye("2")], [-1.0, -1.0, 2.0]);
    let said = told(load_seen_by(&path, Some("right")));
    assert!(
        said.contains("several") && said.contains("3 cameras: 0 \"left\", 1 \"right\", 2 \"right\""),
        "{said}"
    );
    written(&vec![json!({}); 40]);
    let said = told(load_seen_by(&path, Some("40")));
    assert!(said.contains("40 cameras: 0, 1, 2") && said.contains(", 11, …"), "{said}");
}
