//! Files that a command reads are never replaced by what it writes, whatever their paths: the same name, another way to
//! it, links of both kinds; pictures, layers beside them, pages, and files in folders.

use std::fs;
use std::path::Path;

use tempfile::{TempDir, tempdir};

use crate::layering::source_root;
use crate::stage::device_name;
use crate::support::{data, moire};

const SCENE: &str = "[camera]
eye = [0.0, 1.0, 3.0]
look_at = [0.0, 0.0, 0.0]
vertical_fov = 50.0
[image]
width = 24
height = 16
[[texture]]
name = \"own\"
file = \"FILE\"
color_space = \"srgb\"
[[sampler]]
name = \"s\"
[[material]]
name = \"m\"
model = \"unlit\"
texture = \"own\"
sampler = \"s\"
[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 0.0, -1.0]
material = \"m\"
";

/// A folder with a scene, `a.toml`, and its texture of this name.
fn stage(texture: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE.replace("FILE", texture)).unwrap();
    fs::copy(data().join("textures/grass.png"), folder.path().join(texture)).unwrap();
    folder
}

/// Runs a command that has to refuse, and returns what it says; no file has changed, and none was added.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let files = || {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut files: Vec<_> = entries.map(|path| (path.clone(), fs::read(path).ok())).collect();
        files.sort();
        files
    };
    let before = files();
    let output = moire().current_dir(folder).args(arguments).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    assert!(told.contains("would replace"), "{arguments:?}: {told}");
    assert!(before == files(), "{arguments:?}: a file has changed");
    told
}

#[test]
fn layers_beside_a_picture_replace_no_texture() {
    let folder = stage("a.albedo.png");
    let told = refused(folder.path(), &["render", "a.toml", "--spp=1", "--aov", "normal,albedo"]);
    assert!(told.contains("a.albedo.png: this is the file of texture \"own\""), "{told}");
    refused(folder.path(), &["render", "a.toml", "-o", "./a.albedo.png"]);
}

#[test]
fn a_difference_replaces_none_of_its_pictures() {
    let folder = stage("t.png");
    let place = folder.path();
    fs::copy(place.join("t.png"), place.join("u.png")).unwrap();
    fs::hard_link(place.join("t.png"), place.join("hard.png")).unwrap();
    for out in ["t.png", "u.png", "./t.png"] {
        refused(place, &["compare", "t.png", "u.png", "--diff", out]);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("u.png", place.join("soft.png")).unwrap();
        refused(place, &["compare", "t.png", "u.png", "--diff", "hard.png"]);
        refused(place, &["compare", "t.png", "u.png", "--diff", "soft.png"]);
        refused(place, &["compare", "t.png", "soft.png", "--diff", "u.png"]);
    }
    refused(place, &["texture", "t.png", "--out", "./t.png"]);
}

#[test]
fn a_sheet_replaces_neither_its_reference_nor_a_file_of_the_scene() {
    let folder = stage("t.png");
    let place = folder.path();
    fs::copy(place.join("t.png"), place.join("r.png")).unwrap();
    let sheet = |reference: &str, out: &str| {
        let size = "--size=256x256";
        refused(place, &["sheet", "a.toml", "--vary=spp=1,4", size, "--reference", reference, "-o", out])
    };
    assert!(sheet("r.png", "./r.png").contains("this is the reference"));
    assert!(sheet("none", "t.png").contains("the file of texture"));
}

#[test]
fn folders_of_results_replace_no_file_of_the_scene() {
    for texture in ["level.png", "albedo.png", "picture.png", "layers.exr"] {
        let folder = stage(texture);
        assert!(refused(folder.path(), &["inspect", "a.toml", "--out", "."]).contains(texture));
    }
    for texture in ["reference.exr", "study.csv"] {
        let folder = stage(texture);
        assert!(refused(folder.path(), &["study", "a.toml", "--out", "."]).contains(texture));
    }
    let folder = stage("t.png");
    fs::rename(folder.path().join("a.toml"), folder.path().join("index.html")).unwrap();
    refused(folder.path(), &["inspect", "index.html", "--out", "."]);
    refused(folder.path(), &["study", "index.html", "--out", "."]);
}

#[test]
fn a_picture_that_is_made_again_replaces_neither_itself_nor_a_texture() {
    let folder = stage("t.png");
    let device = device_name();
    let render = ["render", "a.toml", "-o", "a.png", "--spp=1", "-q", "--device", &device];
    moire().current_dir(folder.path()).args(render).assert().success();
    refused(folder.path(), &["render", "--from", "a.png", "-o", "./a.png"]);
    refused(folder.path(), &["render", "--from", "a.png", "-o", "t.png"]);
}

/// The door: no command asks the output itself, which knows of no inputs.
#[test]
fn all_commands_ask_whether_they_may_write_at_one_place() {
    let Some(root) = source_root() else { return };
    let mut folders = vec![root.join("src/cli")];
    let mut read = 0;
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = fs::read_to_string(&path).unwrap();
            read += 1;
            for word in ["output::check_writable", "check_file_writable", "OutputFolder::prepare"] {
                let is_door = path.ends_with("inputs.rs");
                assert!(is_door || !text.contains(word), "{}: {word}: ask Inputs", path.display());
            }
        }
    }
    assert!(read > 30);
}
