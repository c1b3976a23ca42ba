//! The gallery of glTF files: each is what the code makes, has a picture that a person has looked at, and a row on its
//! page. Answers that follow from a file alone, to what people complain of in viewers, are asserted in `answers` and
//! `surfaces`; `--camera` in `cameras`.
//!
//! Two of these complaints have their tests elsewhere: coordinates without extent under a normal map (4,
//! `meshes::gltf_materials::coordinates_without_extent_leave_the_normal_finite`), and colours of vertices that are linear
//! (6, `meshes::gltf_materials::colours_of_vertices_multiply_the_base_colour`).

mod answers;
mod cameras;
mod coordinates;
#[path = "../../examples/make_gallery/gallery/mod.rs"]
mod made;
mod surfaces;

use std::collections::BTreeSet;
use std::fs;

use moire::internal::core::film::Film;
use moire::internal::scene::model::{Pattern, Scene};
use moire::internal::scene::{load, load_seen_by};
use tempfile::tempdir;

use crate::golden::is_stored;
use crate::stage::{packed, render, render_on_oracle};
use crate::support::{data, untested};
use made::document::Document;

/// Pixels along the shorter side of the stored pictures.
const SIDE: f64 = 128.0;

/// The scene of a picture: its file has its name, but for that of the second camera.
fn pictured(name: &str) -> Scene {
    let (stem, camera) = if name == "cameras_above" { ("cameras", Some("above")) } else { (name, None) };
    let file = |ending| data().join(format!("gallery/{stem}.{ending}"));
    let file = ["gltf", "glb", "toml"].map(file).into_iter().find(|file| file.is_file()).unwrap();
    let mut scene = load_seen_by(&file, camera).unwrap();
    let scale = SIDE / f64::from(scene.width.min(scene.height));
    (scene.width, scene.height) =
        ((f64::from(scene.width) * scale).round() as u32, (f64::from(scene.height) * scale).round() as u32);
    scene
}

macro_rules! pictures {
    ($($name:ident)*) => {
        const PICTURES: &[&str] = &[$(stringify!($name)),*];
        mod stored {
            $(#[test]
            fn $name() {
                super::is_stored(stringify!($name), "gallery/pictures", super::pictured(stringify!($name)));
            })*
        }
    };
}
pictures! {
    accessors alpha cameras cameras_above emissive glass instancing lights metallic_roughness metallic_roughness_map
    metallic_roughness_sky normal_map occlusion_sky quantized samplers sides sixteen_bits specular specular_map
    texture_formats texture_transform transforms transmission unlit uv_sets vertex_colors
}

fn names(folder: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(data().join(folder)).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.file_type().unwrap().is_file());
    files.map(|entry| entry.file_name().into_string().unwrap()).collect()
}

#[test]
fn committed_files_equal_what_the_code_makes() {
    let mut made = BTreeSet::new();
    for file in made::all() {
        let committed = fs::read(data().join("gallery").join(file.name)).unwrap_or_default();
        assert!(
            committed == file.bytes,
            "{} differs: run `cargo run --release --example make_gallery` and commit",
            file.name
        );
        made.insert(file.name.to_owned());
    }
    let mut found = names("gallery");
    found.retain(|name| !name.ends_with(".toml"));
    assert_eq!(found, made);
}

/// Nothing is passed over in silence, and nothing is told of files that have no fault.
#[test]
fn files_are_read_without_notes() {
    for name in names("gallery") {
        let scene = load(&data().join("gallery").join(&name)).unwrap();
        assert!(scene.notes.is_empty(), "{name}: {:?}", scene.notes);
    }
}

#[test]
fn every_file_has_a_picture_and_a_row_on_the_page() {
    let pictures: BTreeSet<String> = PICTURES.iter().map(|name| format!("{name}.png")).collect();
    assert_eq!(names("gallery/pictures"), pictures);
    let page = data().join("../docs/gallery.md");
    if !page.is_file() {
        return untested("docs/gallery.md: it is not beside the data");
    }
    let page = fs::read_to_string(page).unwrap();
    for name in names("gallery") {
        assert!(page.contains(&format!("data/gallery/{name}")), "docs/gallery.md does not name {name}");
    }
    for picture in pictures {
        assert!(
            page.contains(&format!("gallery/pictures/{picture})")),
            "docs/gallery.md does not show {picture}"
        );
    }
}

/// Reads a file that a test makes; its pictures are within.
fn read(document: &Document) -> Scene {
    let folder = tempdir().unwrap();
    let path = folder.path().join("made.gltf");
    fs::write(&path, document.text()).unwrap();
    load(&path).unwrap()
}

/// Renders a scene at this size, on the device and on the oracle.
fn seen(mut scene: Scene, [width, height]: [u32; 2]) -> [Film; 2] {
    (scene.width, scene.height) = (width, height);
    let packed = packed(scene, None);
    [render(&packed), render_on_oracle(&packed)]
}

/// Renders what the middle of each pixel sees.
fn seen_at_centers(mut scene: Scene, size: [u32; 2]) -> [Film; 2] {
    scene.sampling.pattern = Pattern::Center;
    seen(scene, size)
}

fn pixel(film: &Film, x: u32, y: u32) -> [f64; 3] {
    film.pixels[(y * film.width + x) as usize].map(f64::from)
}

fn near(found: [f64; 3], wanted: [f64; 3], tolerance: f64) -> bool {
    found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= tolerance)
}
