//! Standard input and output in place of files, paths in the notation of other systems, messages
//! without a terminal, and a limit on the size of files.

use std::fs;
use std::path::{Path, absolute};
use std::process::Output;

use image::{GrayImage, Luma};
use tempfile::{TempDir, tempdir};

use crate::stage::device_name;
use crate::support::{moire, program};

const SCENE: &str = r#"
camera = { eye = [0.0, 0.0, 1.0], look_at = [0.0, 0.0, 0.0], vertical_fov = 40.0 }
image = { width = 8, height = 6 }
sampling = { spp = 1 }
[[texture]]
name = "t"
file = "folder/t.png"
[[material]]
name = "m"
model = "unlit"
texture = "t"
[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 1.0, 0.0]
material = "m"
"#;

/// A folder with the scene's texture.
fn place() -> TempDir {
    let folder = tempdir().unwrap();
    fs::create_dir(folder.path().join("folder")).unwrap();
    GrayImage::from_pixel(4, 4, Luma([100])).save(folder.path().join("folder/t.png")).unwrap();
    folder
}

fn run(folder: &TempDir, input: &str, arguments: &[&str]) -> Output {
    let mut command = moire();
    command.current_dir(folder.path()).args(arguments).write_stdin(input);
    if arguments[0] == "render" {
        command.args(["--device", &device_name()]);
    }
    command.output().unwrap()
}

fn told(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).unwrap()
}

fn files(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Expects exit code 2, each part in the message, nothing on stdout and no file.
fn refused(folder: &TempDir, input: &str, arguments: &[&str], wanted: &[&str]) {
    let before = files(folder);
    let output = run(folder, input, arguments);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {}", told(&output));
    for part in wanted {
        assert!(told(&output).contains(part), "{part:?} not in: {}", told(&output));
    }
    assert_eq!(files(folder), before, "{arguments:?}");
}

#[test]
fn a_scene_from_standard_input_has_its_paths_here_and_a_name_of_its_own() {
    let folder = place();
    let output = run(&folder, SCENE, &["render", "-", "-q"]);
    assert_eq!((output.status.code(), told(&output)), (Some(0), ""));
    assert_eq!(files(&folder), ["folder", "scene.png"]);
    let output = run(&folder, SCENE, &["render", "-", "--json", "-o", "a.exr"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["options"]["scene"], "<stdin>");
    refused(&folder, "camera = 1", &["render", "-"], &["<stdin>:1:10:", "camera"]);
    refused(&folder, "", &["render", "-"], &["<stdin>", "[camera]"]);
    refused(&folder, SCENE, &["study", "-", "--out", "study"], &["needs a scene file"]);
}

#[test]
fn a_picture_on_standard_output_is_the_bytes_of_the_file() {
    let folder = place();
    fs::write(folder.path().join("s.toml"), SCENE).unwrap();
    for format in ["png", "exr", "hdr", "jpg", "tif"] {
        let file = format!("a.{format}");
        let options = ["render", "s.toml", "-o", &file, "-o", "-", "--format", format];
        let output = run(&folder, "", &options);
        assert_eq!(output.status.code(), Some(0), "{}", told(&output));
        assert_eq!(output.stdout, fs::read(folder.path().join(&file)).unwrap(), "{format}");
        assert!(told(&output).contains("standard output"), "{}", told(&output));
    }
    let output =
        run(&folder, SCENE, &["render", "-", "-q", "-o", "-", "--format", "png", "--crop", "1,1,3,2"]);
    let picture = image::load_from_memory(&output.stdout).unwrap();
    assert_eq!((picture.width(), picture.height()), (3, 2));
}

#[test]
fn what_standard_output_cannot_be_is_refused_before_the_render() {
    let folder = place();
    let scene = |options: &[&'static str]| {
        [&["render", "-", "--size", "16384x16384", "--spp", "16777216"], options].concat()
    };
    refused(&folder, SCENE, &scene(&["-o", "-"]), &["--format", "exr"]);
    refused(&folder, SCENE, &scene(&["-o", "-", "--format", "gif"]), &["gif", "exr, hdr, png"]);
    refused(
        &folder,
        SCENE,
        &scene(&["-o", "-", "--format", "png", "--json"]),
        &["--json", "standard output"],
    );
    refused(&folder, SCENE, &scene(&["-o", "-", "-o", "-", "--format", "png"]), &["twice"]);
    refused(&folder, SCENE, &scene(&["--format", "png"]), &["--format", "-o -"]);
}

#[test]
fn backslashes_in_paths_are_answered_with_what_to_write() {
    let folder = place();
    let with = |written: &str| SCENE.replace("\"folder/t.png\"", written);
    for (written, wanted) in [
        (r#""folder\qt.png""#, &["<stdin>:7:", "single quotes"][..]),
        (r#""folder\t.png""#, &[r"folder\t.png", "control character", "single quotes"]),
        (r"'folder\t.png'", &[r"folder\t.png", "folders are divided by /", "folder/t.png"]),
    ] {
        if cfg!(windows) && written.starts_with('\'') {
            continue;
        }
        refused(&folder, &with(written), &["render", "-"], wanted);
    }
    let missing = r"scenes\a.toml";
    refused(&folder, "", &["render", missing], &[missing, "scenes/a.toml"]);
    refused(&folder, "", &["compare", r"a\b.png", "c.png"], &["a/b.png"]);
}

#[test]
fn messages_keep_paths_whole_where_stderr_is_no_terminal() {
    let folder = place();
    let long = format!("{}/a-long-name with spaces/and more of it.png", "folder-of-a-long-name/".repeat(12));
    refused(&folder, "", &["compare", &long, "c.png"], &[&long]);
    let scene = SCENE.replace("folder/t.png", &long);
    refused(&folder, &scene, &["render", "-"], &[&long]);
}

#[test]
fn a_key_in_the_wrong_table_is_sent_to_the_right_one() {
    let folder = place();
    for (table, line, wanted) in [
        ("[[material]]", "scale = [2, 2]", "mapping = { … }"),
        ("[[material]]", "rotate = 90", "mapping = { … }"),
        ("[[material]]", "address = 'repeat'", "[[sampler]]"),
        ("[[texture]]", "filter = 'linear'", "[[sampler]]"),
        ("[[plane]]", "texture = 't'", "[[material]]"),
        ("[[material]]", "flip_v = true", "[[texture]]"),
    ] {
        let scene = SCENE.replacen(table, &format!("{table}\n{line}"), 1);
        refused(&folder, &scene, &["render", "-"], &["it belongs into", wanted]);
    }
}

/// A limit applies to a whole process and its successors: the test starts itself once more, which becomes the program.
#[cfg(unix)]
#[test]
fn a_limit_on_the_size_of_files_is_an_error_that_leaves_none() {
    use std::os::unix::process::CommandExt;
    use std::process::Command;

    use nix::sys::resource::{Resource, setrlimit};

    const OWN: &str = "streams::a_limit_on_the_size_of_files_is_an_error_that_leaves_none";
    const AGAIN: &str = "MOIRE_TEST_LIMITED";
    if std::env::var_os(AGAIN).is_some() {
        setrlimit(Resource::RLIMIT_FSIZE, 1024, 1024).unwrap();
        let options = ["render", "s.toml", "--size", "64x64", "-q", "-o", "a.exr", "-o", "b.png"];
        panic!("{}", Command::new(program()).args(options).args(["--device", "oracle"]).exec());
    }
    let folder = place();
    fs::write(folder.path().join("s.toml"), SCENE).unwrap();
    let output = Command::new(std::env::current_exe().unwrap())
        .args([OWN, "--exact", "--nocapture"])
        .current_dir(folder.path())
        .envs([(AGAIN, Path::new("1")), ("MOIRE_BIN", &absolute(program()).unwrap())])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", told(&output));
    assert!(told(&output).contains("a.exr"), "{}", told(&output));
    assert_eq!(files(&folder), ["folder", "s.toml"]);
}
