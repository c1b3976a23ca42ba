//! `moire render --watch` as a process: pictures follow the scene and its files, mistakes are told and mended, Ctrl-C ends it.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use moire::internal::core::film::Film;
use tempfile::tempdir;

use crate::child::{HANG, Running};
use crate::stage::device_name;
use crate::support::{data, moire, program};

const SCENE: &str = "
[camera]
eye = [0.0, 0.0, 1.0]
look_at = [0.0, 0.0, 0.0]
orthographic_height = 2.0

[image]
size = [16, 16]

[sampling]
spp = 4

[background]
color = [1.0, 0.0, 0.0]
";
const SHAPE: &str = "
[[texture]]
name = \"t\"
file = \"t.png\"

[[material]]
name = \"m\"
model = \"unlit\"
texture = \"t\"

[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 1.0, 0.0]
material = \"m\"
";

/// Returns the first pixel of a picture that is there.
fn pixel(path: &Path) -> Option<[f32; 3]> {
    path.exists().then(|| Film::open(path).unwrap().pixels[0])
}

fn wait_for_words(path: &Path, words: &str) {
    let start = std::time::Instant::now();
    while !fs::read_to_string(path).unwrap().contains(words) {
        assert!(start.elapsed() < HANG, "{}", fs::read_to_string(path).unwrap());
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

fn write_texture(folder: &Path, color: [f32; 3]) {
    let film = Film { width: 1, height: 1, pixels: vec![color], samples: 1 };
    film.save(folder.join("t.png")).unwrap();
}

#[test]
fn pictures_follow_the_scene_through_mistakes_and_renamed_files_until_ctrl_c() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("s.toml"), SCENE).unwrap();
    let told = fs::File::create(path("told")).unwrap();
    let mut command = Command::new(fs::canonicalize(program()).unwrap());
    command
        .current_dir(folder.path())
        .args(["render", "s.toml", "-o", "a.exr", "--watch", "--device", &device_name()])
        .stdout(Stdio::null())
        .stderr(told);
    let mut watching = Running::start(&mut command);
    let mut wait_for = |color: [f32; 3]| {
        watching.wait_until(|_| pixel(&path("a.exr")) == Some(color));
        assert_eq!(pixel(&path("a.exr")), Some(color), "{}", fs::read_to_string(path("told")).unwrap());
    };
    wait_for([1.0, 0.0, 0.0]);

    // An editor writes in place.
    fs::write(path("s.toml"), SCENE.replace("[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]")).unwrap();
    wait_for([0.0, 1.0, 0.0]);

    // An editor that writes slowly: half a file is no mistake.
    let blue = SCENE.replace("[1.0, 0.0, 0.0]", "[0.0, 0.0, 1.0]");
    fs::write(path("s.toml"), &blue[..blue.len() - 8]).unwrap();
    std::thread::sleep(std::time::Duration::from_millis(80));
    fs::write(path("s.toml"), &blue).unwrap();
    wait_for([0.0, 0.0, 1.0]);
    assert!(!fs::read_to_string(path("told")).unwrap().contains("TOML syntax"));
    fs::write(path("s.toml"), SCENE.replace("[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]")).unwrap();
    wait_for([0.0, 1.0, 0.0]);

    // A mistake is told, and mended by an editor that renames.
    fs::write(path("s.toml"), SCENE.replace("spp", "ssp")).unwrap();
    wait_for_words(&path("told"), "unknown key \"ssp\"");
    assert_eq!(pixel(&path("a.exr")), Some([0.0, 1.0, 0.0]), "the picture stays");
    write_texture(folder.path(), [0.0, 0.0, 1.0]);
    fs::write(path("s.new"), format!("{SCENE}{SHAPE}")).unwrap();
    fs::rename(path("s.new"), path("s.toml")).unwrap();
    wait_for([0.0, 0.0, 1.0]);

    // A file that could not be read has never been watched, and comes all the same.
    let with_mesh =
        format!("{SCENE}\n[[mesh]]\nfile = \"m.stl\"\n").replace("[1.0, 0.0, 0.0]", "[1.0, 1.0, 1.0]");
    fs::write(path("s.toml"), with_mesh).unwrap();
    wait_for_words(&path("told"), "cannot read mesh m.stl");
    let corners = "vertex 0 0 0\nvertex 0.1 0 0\nvertex 0 0.1 0";
    let facet = format!("facet normal 0 0 1\nouter loop\n{corners}\nendloop\nendfacet");
    fs::write(path("m.stl"), format!("solid m\n{facet}\nendsolid m\n")).unwrap();
    wait_for([1.0, 1.0, 1.0]);
    fs::write(path("s.toml"), format!("{SCENE}{SHAPE}")).unwrap();
    wait_for([0.0, 0.0, 1.0]);

    // A texture alone changes.
    write_texture(folder.path(), [1.0, 1.0, 0.0]);
    wait_for([1.0, 1.0, 0.0]);

    watching.interrupt();
    let output = watching.output(HANG);
    assert_eq!(output.status.code(), Some(130));
    let mut names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["a.exr", "m.stl", "s.toml", "t.png", "told"]);
    assert!(fs::read_to_string(path("told")).unwrap().contains("watching 1 file for changes; Ctrl-C ends"));
}

#[test]
fn what_no_change_can_mend_ends_at_once() {
    let scene = fs::canonicalize(data().join("scenes/quad.toml")).unwrap();
    let folder = tempdir().unwrap();
    for (arguments, said) in [
        (&["missing.toml"][..], "missing.toml: there is no such file"),
        (&["-"], "standard input is read once"),
        (&[scene.to_str().unwrap(), "-o", "-", "--format", "png"], "standard output takes one picture"),
        (&[scene.to_str().unwrap(), "-o", "none/a.png"], "create the folder first"),
        (&[scene.to_str().unwrap(), "--json"], "cannot be used with"),
        (&["@quda"], "did you mean \"@quad\"?"),
    ] {
        let output =
            moire().current_dir(folder.path()).args(["render", "--watch"]).args(arguments).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(told.contains(said), "{arguments:?}: {told}");
    }
}
