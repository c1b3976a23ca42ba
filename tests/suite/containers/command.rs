//! `moire texture` on files with levels: formats by name, what the file says of its values, means and alpha coverage of
//! each level, cubes, and normal maps.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use tempfile::tempdir;

use super::write::{DXGI_RGBA8, Dds, solid_levels};
use crate::support::moire;

fn run(file: &[u8], options: &[&str]) -> String {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("a.dds"), file).unwrap();
    let args = [&["texture", "a.dds"], options].concat();
    let output = moire().current_dir(folder.path()).args(args).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*told), (Some(0), ""), "{options:?}");
    assert_eq!(folder.path().join("b.png").exists(), options.contains(&"b.png"));
    if options.contains(&"b.png") {
        assert_eq!(image::image_dimensions(folder.path().join(Path::new("b.png"))).unwrap(), (4, 4));
    }
    String::from_utf8(output.stdout).unwrap()
}

fn report(file: &[u8], options: &[&str]) -> Value {
    serde_json::from_str(&run(file, &[&["--json"], options].concat())).unwrap()
}

fn chain(format: u32, count: u32, colors: &[[u8; 4]]) -> Dds {
    let data = solid_levels(4, |side| side * side, colors).concat();
    Dds { levels: count, ..Dds::flat(format, [4, 4], &data) }
}

#[test]
fn levels_are_described_with_their_means_and_alpha_coverage() {
    let file = chain(DXGI_RGBA8, 2, &[[255, 0, 0, 255], [0, 51, 0, 0]]).bytes();
    let told = report(&file, &[]);
    assert_eq!(
        (&told["encoding"], &told["stated_color_space"]),
        (&json!("DDS, R8G8B8A8_UNORM"), &Value::Null)
    );
    assert_eq!(
        told["levels"][0],
        json!({ "size": [4, 4, 1], "means": [1.0, 0.0, 0.0, 1.0], "alpha_coverage": 1.0 })
    );
    assert_eq!(
        told["levels"][1],
        json!({ "size": [2, 2, 1], "means": [0.0, 0.2, 0.0, 0.0], "alpha_coverage": 0.0 })
    );
    let table = run(&file, &[]);
    for line in [
        "encoding    DDS, R8G8B8A8_UNORM; says nothing of its color space",
        "levels      2 stored, of 3",
        "level 0     4×4, mean red 1.000000, green 0.000000, blue 0.000000, alpha 1.000000; alpha covers 100.0 %",
        "level 1     2×2, mean red 0.000000, green 0.200000, blue 0.000000, alpha 0.000000; alpha covers 0.0 %",
    ] {
        assert!(table.contains(line), "{line}\n{table}");
    }
}

#[test]
fn values_are_read_as_the_file_says_unless_an_option_does() {
    let file = chain(29, 1, &[[188, 0, 0, 255]]).bytes();
    let told = report(&file, &[]);
    assert_eq!((&told["stated_color_space"], &told["color_space"]), (&json!("srgb"), &json!("srgb")));
    assert!((told["channels"][0]["mean"].as_f64().unwrap() - 0.503).abs() < 1e-3, "{told}");
    assert_eq!(report(&file, &["--color-space", "linear"])["color_space"], json!("linear"));
}

#[test]
fn normal_maps_are_recognised() {
    let flat = chain(DXGI_RGBA8, 1, &[[128, 128, 255, 255]]).bytes();
    assert_eq!(report(&flat, &[])["normals"]["is_normal_map"], json!(true));
    let table = run(&flat, &["--color-space", "srgb"]);
    assert!(table.contains("normals     a normal map: mean (0.004, 0.004, 1.000)"), "{table}");
    assert!(table.contains("read as srgb they are bent"), "{table}");
    let red = chain(DXGI_RGBA8, 1, &[[200, 10, 10, 255]]).bytes();
    assert_eq!(report(&red, &[])["normals"]["is_normal_map"], json!(false));
}

#[test]
fn of_a_cube_all_faces_count_and_the_first_is_drawn() {
    let faces: Vec<u8> = (0..6).flat_map(|face| [40 * face, 0, 0, 255].repeat(4)).collect();
    let file = Dds { is_cube: true, ..Dds::flat(DXGI_RGBA8, [2, 2], &faces) }.bytes();
    let table = run(&file, &["-o", "b.png"]);
    assert!(table.contains("size        6 faces of 2×2 texels") && !table.contains("tiles in u"), "{table}");
    assert!(table.contains("red         0.000000 to 0.784314, mean 0.392157"), "{table}");
}
