//! `moire render --aov` and `moire inspect` as commands: their files, and what they refuse.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use exr::prelude::read_all_flat_layers_from_file;
use moire::internal::lab::metrics::read_picture;

use super::{DOWN, stage};
use crate::support::moire;

/// Runs in a folder with a scene; returns the exit code and what stderr says, in one line.
pub fn run(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let output = moire().current_dir(folder).args(arguments).args(["--device", "oracle"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let told = told.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    (output.status.code().unwrap(), told)
}

fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = entries.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    names
}

/// Returns the first value of each channel of an EXR file, by its name.
fn channels(path: &Path) -> BTreeMap<String, f32> {
    let image = read_all_flat_layers_from_file(path).unwrap();
    let all = image.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
    all.map(|channel| (channel.name.to_string(), channel.sample_data.values_as_f32().next().unwrap()))
        .collect()
}

#[test]
fn an_exr_file_holds_the_picture_and_the_layers_by_name() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path(), DOWN);
    let (code, told) = run(
        folder.path(),
        &["render", "scene.toml", "-q", "--aov", "level,texels,uv,normal,depth", "-o", "x.exr"],
    );
    assert_eq!((code, told.as_str()), (0, ""));
    let found = channels(&folder.path().join("x.exr"));
    let names: Vec<&str> = found.keys().map(String::as_str).collect();
    let wanted = [
        "B",
        "G",
        "R",
        "depth.Z",
        "level.Y",
        "normal.X",
        "normal.Y",
        "normal.Z",
        "texels.major",
        "texels.minor",
        "uv.U",
        "uv.V",
    ];
    assert_eq!(names, wanted);
    assert_eq!(
        [found["level.Y"], found["texels.minor"], found["depth.Z"], found["normal.Y"]],
        [2.0, 2.0, 5.0, 1.0]
    );
    // Programs that want a picture read the colours.
    assert_eq!(read_picture(&folder.path().join("x.exr")).unwrap().width, 16);
}

#[test]
fn false_colours_lie_beside_a_png_and_without_beauty_alone() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path(), DOWN);
    let (code, _) =
        run(folder.path(), &["render", "scene.toml", "-q", "--aov", "level,uv,level", "-o", "x.png"]);
    assert_eq!(code, 0);
    assert_eq!(files(folder.path()), ["scene.toml", "t.png", "x.level.png", "x.png", "x.uv.png"]);
    let legend = read_picture(&folder.path().join("x.level.png")).unwrap();
    assert!(legend.width >= 256 && legend.height > 16, "{}×{}", legend.width, legend.height);
    let options =
        ["render", "scene.toml", "-q", "--aov", "depth", "--no-beauty", "-o", "y.png", "-o", "y.exr"];
    assert_eq!(run(folder.path(), &options).0, 0);
    assert!(!folder.path().join("y.png").exists() && folder.path().join("y.depth.png").exists());
    let names: Vec<String> = channels(&folder.path().join("y.exr")).into_keys().collect();
    assert_eq!(names, ["depth.Z"]);
}

#[test]
fn what_cannot_be_written_is_refused_before_anything_is() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path(), DOWN);
    for (options, expected) in [
        (vec!["--aov", "levels", "-o", "x.png"], vec!["levels", "texels", "magnification", "albedo"]),
        (vec!["--aov", "level", "-o", "x.hdr"], vec!["x.hdr", "Radiance HDR holds no layers", ".exr"]),
        (vec!["--aov", "level", "-o", "-", "--format", "exr"], vec!["standard output takes one picture"]),
        (vec!["--aov", "error", "--pattern", "grid", "-o", "x.exr"], vec!["pattern \"grid\"", "sobol-owen"]),
        (vec!["--no-beauty", "-o", "x.exr"], vec!["--aov"]),
    ] {
        let (code, told) = run(folder.path(), &[&["render", "scene.toml"], &options[..]].concat());
        assert_eq!(code, 2, "{options:?}: {told}");
        expected.iter().for_each(|part| assert!(told.contains(part), "{options:?}: {told}"));
    }
    assert_eq!(files(folder.path()), ["scene.toml", "t.png"]);
}

#[test]
fn inspect_writes_every_layer_their_numbers_and_a_page() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path(), DOWN);
    let output = moire()
        .current_dir(folder.path())
        .args(["inspect", "scene.toml", "--out", "seen", "--device", "oracle"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(said.contains("Use filter linear") && said.contains("4 samples a pixel"), "{said}");
    assert!(
        said.lines().any(|line| line.starts_with("texture \"") && line.contains(" this view needs")),
        "{said}"
    );
    let found = files(&folder.path().join("seen"));
    let layers = moire::internal::render::layers::Aov::NAMES;
    assert_eq!(found.len(), layers.len() + 3, "{found:?}");
    layers.iter().for_each(|name| assert!(found.contains(&format!("{name}.png")), "{name}"));
    let page = fs::read_to_string(folder.path().join("seen/index.html")).unwrap();
    for part in [
        "64 × 64",
        "Larger than this view needs",
        "16 × 16",
        "Never read",
        "--filter linear --mip linear",
        "level.png",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(channels(&folder.path().join("seen/layers.exr")).len(), 3 + 2 + 2 + 3 + 3 + 9);
}

#[test]
fn the_page_has_legends_as_text_names_for_pictures_and_a_command_that_runs() {
    let folder = tempfile::tempdir().unwrap();
    fs::rename(stage(folder.path(), DOWN), folder.path().join("it's one.toml")).unwrap();
    let options = ["inspect", "it's one.toml", "--out", "seen", "--size", "24x20"];
    assert_eq!(run(folder.path(), &options).0, 0);
    let page = fs::read_to_string(folder.path().join("seen/index.html")).unwrap();
    let pictures: Vec<&str> =
        page.split("<img ").skip(1).map(|rest| rest.split("/>").next().unwrap()).collect();
    assert_eq!(pictures.len(), moire::internal::render::layers::Aov::NAMES.len() + 1);
    assert!(pictures.iter().all(|img| !img.contains("alt=\"\"") && img.contains("alt=\"")), "{pictures:?}");
    for part in
        ["<li><span style=\"background: #", "</span>m</li>", "linear-gradient(", "colour of m (480 pixels)"]
    {
        assert!(page.contains(part), "{part}");
    }
    // Legends are text, so that the pictures are the pixels.
    let level = read_picture(&folder.path().join("seen/level.png")).unwrap();
    assert_eq!((level.width, level.height), (24, 20));
    let command = page.split("<pre><code>moire ").nth(1).unwrap().split("</code>").next().unwrap();
    assert!(command.starts_with("render 'it'\\''s one.toml' --size 24x20 --filter "), "{command}");
    let options: Vec<&str> = command.split(" --size").nth(1).unwrap().split_whitespace().collect();
    let options = [&["render", "it's one.toml", "-q", "-o", "x.png", "--size"], &options[..]].concat();
    assert_eq!(run(folder.path(), &options), (0, String::new()));
    let found = read_picture(&folder.path().join("x.png")).unwrap();
    assert_eq!((found.width, found.height), (24, 20));
}

#[test]
fn inspect_leaves_out_what_cannot_be_measured_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path(), DOWN);
    let (code, told) = run(folder.path(), &["inspect", "scene.toml", "--out", "seen", "--pattern", "grid"]);
    assert_eq!(code, 0, "{told}");
    assert!(told.contains("left out: layer error"), "{told}");
    assert!(!folder.path().join("seen/error.png").exists());
    assert!(fs::read_to_string(folder.path().join("seen/index.html")).unwrap().contains("Left out"));
    let (code, told) = run(folder.path(), &["inspect", "scene.toml", "--out", "no/such"]);
    assert_eq!(code, 2);
    assert!(told.contains("no/such"), "{told}");
}
