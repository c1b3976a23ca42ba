//! Records in pictures, and `moire render --from`, which makes a picture again: the same bytes in every format, options
//! that override the recorded ones, textures that are found or told, and records that nobody should obey.

mod files;
mod hostile;
mod messages;
mod precedence;
mod scenes;

use std::fs;
use std::path::Path;
use std::process::Output;

use moire::internal::output::record;
use serde_json::{Value, json};
use tempfile::{TempDir, tempdir};

use crate::stage::device_name;
use crate::support::{data, moire};

pub const FORMATS: [&str; 5] = ["png", "jpg", "tif", "exr", "hdr"];

pub const SCENE: &str = "# Grün: \"é\" \\ 🂡
[camera]
eye = [0.0, 1.0, 3.0]
look_at = [0.0, 0.0, 0.0]
vertical_fov = 50.0
[image]
width = 24
height = 16
[[texture]]
name = \"grass\"
file = \"textures/grass.png\"
color_space = \"srgb\"
[[sampler]]
name = \"s\"
[[material]]
name = \"m\"
model = \"unlit\"
texture = \"grass\"
sampler = \"s\"
[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 0.0, -1.0]
material = \"m\"
";

/// A folder with `scenes/floor.toml` and its texture.
pub fn stage() -> TempDir {
    let folder = tempdir().unwrap();
    fs::create_dir_all(folder.path().join("scenes/textures")).unwrap();
    fs::write(folder.path().join("scenes/floor.toml"), SCENE).unwrap();
    fs::copy(data().join("textures/grass.png"), folder.path().join("scenes/textures/grass.png")).unwrap();
    folder
}

/// Runs `moire render` there, on the device under test.
pub fn render(folder: &Path, options: &[&str]) -> Output {
    let mut command = moire();
    command.current_dir(folder).arg("render").args(options).arg("-q");
    if !options.iter().any(|option| option.starts_with("--from")) {
        command.args(["--device", &device_name()]);
    }
    command.output().unwrap()
}

pub fn rendered(folder: &Path, options: &[&str]) -> Vec<u8> {
    let output = render(folder, options);
    assert!(output.status.success(), "{options:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

/// Runs it, and returns what it says as it fails with code 2.
pub fn refused(folder: &Path, options: &[&str]) -> String {
    let output = render(folder, options);
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{options:?}: {told}");
    assert!(!told.contains("panicked"), "{told}");
    told
}

/// Returns the record of a picture.
pub fn record_of(picture: &Path) -> Option<Value> {
    record::read(picture).unwrap().map(|text| serde_json::from_str(&text).unwrap())
}

const OPTIONS: [&str; 10] = [
    "--spp",
    "4",
    "--seed",
    "9",
    "--exposure=-0.5",
    "--tone-map",
    "agx",
    "--png-bits",
    "16",
    "--crop=3,2,17,11",
];

#[test]
fn a_picture_of_every_format_is_made_again_byte_for_byte() {
    let folder = stage();
    for format in FORMATS {
        let [first, again] = ["a", "b"].map(|name| format!("{name}.{format}"));
        rendered(folder.path(), &[&["scenes/floor.toml", "-o", &first], &OPTIONS[..]].concat());
        rendered(folder.path(), &["--from", &first, "-o", &again]);
        let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
        assert!(read(&first) == read(&again), "{format}");
    }
}

#[test]
fn the_record_says_what_was_rendered_how_and_by_what() {
    let folder = stage();
    for format in FORMATS {
        let picture = format!("a.{format}");
        rendered(folder.path(), &[&["scenes/floor.toml", "-o", &picture], &OPTIONS[..]].concat());
        let record = record_of(&folder.path().join(&picture)).unwrap();
        assert_eq!(record["program"], "moire");
        assert_eq!(record["version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(record["scene"]["path"], "scenes/floor.toml", "as typed, not absolute");
        assert_eq!(record["scene"]["text"], SCENE);
        assert_eq!(record["scene"]["crc32"], crc32fast::hash(SCENE.as_bytes()));
        assert_eq!(record["settings"]["seed"], 9);
        assert!(record["device"].as_str().is_some_and(|device| !device.is_empty()), "{record}");
        let wanted =
            ["--spp=4", "--seed=9", "--exposure=-0.5", "--tone-map=agx", "--png-bits=16", "--crop=3,2,17,11"];
        let options = record["options"].as_array().unwrap();
        for option in
            wanted.iter().map(|option| json!(option)).chain([json!(format!("--device={}", device_name()))])
        {
            assert!(options.contains(&option), "{option} is not among {options:?}");
        }
        assert_eq!(options.len(), wanted.len() + 1, "{options:?}");
    }
}

/// As other programs see it: keys, comments and descriptions that each format has for it.
#[test]
fn other_readers_find_the_text() {
    let folder = stage();
    FORMATS.iter().for_each(|format| {
        rendered(folder.path(), &["scenes/floor.toml", "-o", &format!("a.{format}")]);
    });
    let bytes = |format: &str| fs::read(folder.path().join(format!("a.{format}"))).unwrap();
    let has = |format: &str, text: &str| bytes(format).windows(text.len()).any(|w| w == text.as_bytes());
    let png = png::Decoder::new(std::io::Cursor::new(bytes("png"))).read_info().unwrap();
    let texts = &png.info().uncompressed_latin1_text;
    let keys: Vec<&str> = texts.iter().map(|text| text.keyword.as_str()).collect();
    assert_eq!(keys, ["Software", "moire"]);
    let exr = exr::meta::MetaData::read_from_file(folder.path().join("a.exr"), false).unwrap();
    let own = &exr.headers[0].own_attributes;
    assert_eq!(own.software_name.as_ref().unwrap().to_string(), concat!("moire ", env!("CARGO_PKG_VERSION")));
    assert!(own.other.contains_key(b"moire".as_slice()));
    assert!(has("hdr", "#?RADIANCE\nSOFTWARE=moire ") && has("hdr", "\n# moire {\"program\""));
    assert!(has("jpg", "moire record 1 of 1\n{\"program\""));
    assert!(has("tif", "{\"program\":\"moire\""));
    for format in FORMATS {
        assert!(image::load_from_memory(&bytes(format)).is_ok(), "{format}");
    }
}

#[test]
fn without_metadata_nothing_of_the_scene_is_left() {
    let folder = stage();
    for format in FORMATS {
        let picture = format!("a.{format}");
        rendered(folder.path(), &["scenes/floor.toml", "-o", &picture, "--no-metadata"]);
        let path = folder.path().join(&picture);
        assert_eq!(record_of(&path), None);
        let bytes = fs::read(&path).unwrap();
        for word in ["moire", "floor", "grass", "vertical_fov"] {
            assert!(!bytes.windows(word.len()).any(|w| w == word.as_bytes()), "{format}: {word}");
        }
        let told = refused(folder.path(), &["--from", &picture, "-o", "b.png"]);
        assert!(told.contains("does not say how it was made") && told.contains("--no-metadata"), "{told}");
    }
    assert!(!folder.path().join("b.png").exists());
}

#[test]
fn options_of_the_command_line_override_those_of_the_record() {
    let folder = stage();
    let again = |options: &[&str]| rendered(folder.path(), options);
    again(&["scenes/floor.toml", "-o", "a.exr", "--spp", "4", "--seed", "9", "--target-error", "0.5"]);
    // A budget excludes the recorded goal.
    again(&["--from", "a.exr", "-o", "b.exr", "--budget", "0.01", "--size=20x10"]);
    let options = record_of(&folder.path().join("b.exr")).unwrap()["options"].clone();
    let has = |option: &str| options.as_array().unwrap().contains(&json!(option));
    assert!(has("--budget=0.01") && has("--size=20x10") && has("--seed=9"), "{options}");
    assert!(!options.to_string().contains("target-error"), "{options}");

    again(&["scenes/floor.toml", "-o", "c.exr", "--spp", "4", "--seed", "9"]);
    again(&["--from", "c.exr", "-o", "d.exr", "--spp", "1", "--no-metadata"]);
    again(&["scenes/floor.toml", "-o", "e.exr", "--spp", "1", "--seed", "9", "--no-metadata"]);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("d.exr") == read("e.exr"));
}

#[test]
fn without_an_output_the_picture_gets_another_name_and_itself_is_kept() {
    let folder = stage();
    rendered(folder.path(), &["scenes/floor.toml", "-o", "a.jpg"]);
    rendered(folder.path(), &["--from", "a.jpg"]);
    assert!(folder.path().join("a-again.jpg").is_file());
    let told = refused(folder.path(), &["--from", "a.jpg", "-o", "a.jpg"]);
    assert!(told.contains("the picture of --from"), "{told}");
    let told = refused(folder.path(), &["scenes/floor.toml", "--from", "a.jpg"]);
    assert!(told.contains("cannot be used with"), "{told}");
    let told = refused(folder.path(), &[]);
    assert!(told.contains("SCENE"), "{told}");
}

#[test]
fn another_device_is_told() {
    let folder = stage();
    rendered(folder.path(), &["scenes/floor.toml", "-o", "a.png", "--size=8x8", "--spp=1"]);
    let output = moire()
        .current_dir(folder.path())
        .args(["render", "--from", "a.png", "-o", "b.png", "--device", "oracle"])
        .output()
        .unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && told.contains("now it is oracle"), "{told}");
}

#[test]
fn options_for_screens_are_told_where_no_output_is_for_one() {
    let folder = stage();
    let told = |outputs: &[&str]| {
        let mut command = moire();
        command.current_dir(folder.path()).args(["render", "scenes/floor.toml", "--size=8x8", "--spp=1"]);
        command.args(["--tone-map", "aces", "--gamut=srgb", "--device", &device_name()]).args(outputs);
        String::from_utf8(command.output().unwrap().stderr).unwrap()
    };
    let warning = "--tone-map, --gamut have no effect";
    assert!(told(&["-o", "a.exr", "-o", "a.hdr"]).contains(warning));
    assert!(!told(&["-o", "a.exr", "-o", "a.png"]).contains(warning));
}

/// False colours stand for numbers.
#[test]
fn layers_keep_their_colors_whatever_the_display() {
    let folder = stage();
    rendered(folder.path(), &["scenes/floor.toml", "-o", "a.png", "--aov=level", "--no-metadata"]);
    let changed = ["--exposure=3", "--tone-map=agx", "--gamut=display-p3", "--white-balance=3000"];
    rendered(
        folder.path(),
        &[&["scenes/floor.toml", "-o", "b.png", "--aov=level", "--no-metadata"], &changed[..]].concat(),
    );
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(read("a.level.png") == read("b.level.png"));
    assert!(read("a.png") != read("b.png"));
    rendered(folder.path(), &["scenes/floor.toml", "-o", "c.png", "--aov=level"]);
    assert_eq!(
        record_of(&folder.path().join("c.level.png")),
        None,
        "it would make the picture, not the layer"
    );
}
