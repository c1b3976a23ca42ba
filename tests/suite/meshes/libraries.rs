//! What libraries of materials say of a surface beside its colour: opacity, emission, textures that are missing or lie
//! elsewhere, statements that are not drawn. Pictures that PLY files name.

use std::fs;
use std::path::Path;

use glam::{DVec2, DVec3};
use moire::internal::scene::load;
use moire::internal::scene::model::{AlphaMode, Material, Scene};
use moire::internal::texture::data::TextureData;
use moire::internal::texture::load::load as load_texture;
use tempfile::TempDir;

use super::{QUAD, folder};
use crate::support::told;

/// Pictures: colours of 2 × 1 texels, their opacity in grey, and one with an alpha of its own.
fn pictures(folder: &Path) {
    let save = |name: &str, [width, height]: [u32; 2], texels: &[u8], kind| {
        image::save_buffer(folder.join(name), texels, width, height, kind).unwrap();
    };
    save("color.png", [2, 1], &[200, 100, 50, 10, 20, 30], image::ColorType::Rgb8);
    save("grey.png", [2, 1], &[255, 51], image::ColorType::L8);
    save("wide.png", [4, 1], &[0, 51, 102, 255], image::ColorType::L8);
    save("own.png", [2, 1], &[200, 100, 50, 255, 10, 20, 30, 51], image::ColorType::Rgba8);
}

/// The quad in material `a` of this library.
fn with_library(library: &str) -> (TempDir, moire::internal::core::error::Result<Scene>) {
    let folder = folder(&[
        ("m.obj", &format!("mtllib m.mtl\n{QUAD}usemtl a\nf 1/1 2/2 3/3\n")),
        ("m.mtl", &format!("newmtl a\n{library}\n")),
    ]);
    pictures(folder.path());
    let scene = load(&folder.path().join("m.obj"));
    (folder, scene)
}

fn drawn(library: &str) -> (Material, Vec<TextureData>, String) {
    let (_folder, scene) = with_library(library);
    let scene = scene.unwrap_or_else(|e| panic!("{library}: {e}"));
    let textures = scene.textures.iter().map(|texture| load_texture(texture).unwrap()).collect();
    (scene.materials[0].clone(), textures, scene.notes.join("\n"))
}

/// Alpha of the texels in a row.
fn alphas(texture: &TextureData) -> Vec<u8> {
    texture.texels.chunks_exact(4).map(|texel| texel[3]).collect()
}

#[test]
fn opacity_blends_by_number_and_by_picture() {
    for (library, opacity) in
        [("d 0.25", 0.25), ("Tr 0.25", 0.75), ("d 0.5\nTr 0.25", 0.5), ("Tr 0.25\nd -halo 0.5", 0.5)]
    {
        let (material, ..) = drawn(library);
        assert_eq!((material.alpha, material.opacity), (AlphaMode::Blend, opacity), "{library}");
    }
    assert_eq!(drawn("d 1\nTr 0").0.alpha, AlphaMode::Opaque);
    for (library, color, wanted) in [
        ("map_Kd color.png\nmap_d grey.png", [200, 100, 50], [255, 51]),
        ("map_Kd color.png\nmap_d own.png", [200, 100, 50], [255, 51]),
        ("map_Kd own.png\nmap_d own.png", [200, 100, 50], [255, 51]),
        ("map_d grey.png", [255, 255, 255], [255, 51]),
        ("map_Kd color.png\nmap_d wide.png", [200, 100, 50], [51, 255]),
    ] {
        let (material, textures, _) = drawn(library);
        assert_eq!((material.alpha, material.opacity), (AlphaMode::Blend, 1.0), "{library}");
        let texture = &textures[material.texture.unwrap()];
        assert_eq!((&texture.texels[..3], alphas(texture)), (&color[..], wanted.to_vec()), "{library}");
    }
}

#[test]
fn emission_is_a_colour_times_a_picture() {
    assert_eq!(drawn("Kd 0 0 0\nKe 2 1 0.5").0.emission, DVec3::new(2.0, 1.0, 0.5));
    for (library, emission) in
        [("map_Ke color.png", 1.0), ("Ke 0 0 0\nmap_Ke color.png", 1.0), ("Ke 3\nmap_Ke color.png", 3.0)]
    {
        let (material, textures, _) = drawn(library);
        assert_eq!(material.emission, DVec3::splat(emission), "{library}");
        let map = material.emission_map.unwrap();
        assert_eq!(textures[map.texture].texels[..3], [200, 100, 50], "{library}");
    }
}

#[test]
fn statements_that_are_not_drawn_are_told_by_name_and_line() {
    for (statement, what) in [
        ("map_Ks color.png", "m.mtl: line 2: map_Ks is not drawn"),
        ("map_Ns color.png", "map_Ns is not drawn"),
        ("disp color.png", "disp is not drawn"),
        ("refl -type sphere color.png", "refl is not drawn"),
        ("decal color.png", "decal is not drawn"),
        ("Kd spectral a.rfl 1", "Kd is given by a spectrum"),
        ("map_Kd", "line 2: map_Kd names no file"),
    ] {
        let said = drawn(statement).2;
        assert!(said.contains(what), "{statement}: {said}");
    }
    assert_eq!(drawn("Kd 1 0 0\nKa 1 1 1\nillum 2").2, "");
}

#[test]
fn faults_of_a_library_name_its_line() {
    for (library, parts) in [
        ("Kd 1 -1 0", &["m.mtl as MTL", "line 2", "-1"][..]),
        ("d 1.5", &["m.mtl as MTL", "line 2", "1.5", "0 to 1"]),
        ("Kd 1 0 0\nmap_Kd gone.png", &["m.mtl: line 3", "gone.png: there is no such file"]),
        ("map_Kd /etc/hostname", &["m.mtl: line 2", "\"/etc/hostname\" is an absolute path"]),
        ("map_Ke ../color.png", &["m.mtl: line 2", "\"../color.png\" leaves the folder"]),
        ("map_Bump C:\\textures\\a.png", &["m.mtl: line 2", "has a colon"]),
        ("map_Kd m.obj", &["m.mtl: line 2", "not a picture"]),
    ] {
        let said = told(with_library(library).1);
        assert!(parts.iter().all(|part| said.contains(part)), "{library}: {said}");
    }
}

#[test]
fn a_model_may_have_several_libraries_and_pictures_beside_their_folder() {
    let mesh = format!("mtllib none.mtl sub/b.mtl\n{QUAD}usemtl a\nf 1/1 2/2 3/3\n");
    let folder = folder(&[("m.obj", &mesh)]);
    pictures(folder.path());
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/b.mtl"), "newmtl a\nmap_Kd ../color.png\n").unwrap();
    let scene = load(&folder.path().join("m.obj")).unwrap();
    assert_eq!(load_texture(&scene.textures[0]).unwrap().texels[..3], [200, 100, 50]);
    assert!(scene.notes.len() == 1 && scene.notes[0].contains("none.mtl"), "{:?}", scene.notes);
    fs::write(folder.path().join("sub/b.mtl"), "newmtl a\nmap_Kd ../../color.png\n").unwrap();
    let said = told(load(&folder.path().join("m.obj")));
    assert!(said.contains("leaves the folder"), "{said}");
    fs::write(folder.path().join("m.obj"), mesh.replace("none", "../../etc/none")).unwrap();
    let said = told(load(&folder.path().join("m.obj")));
    assert!(said.contains("m.obj as OBJ: line 1") && said.contains("leaves the folder"), "{said}");
}

const PLY: &str = "ply\nformat ascii 1.0\ncomment TextureFile color.png\nelement vertex 4\nproperty float x\nproperty float y\n\
                   property float z\nelement face 1\nproperty list uchar int vertex_indices\n";
const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

#[test]
fn a_ply_file_shows_its_picture_at_the_coordinates_of_corners() {
    let file = format!(
        "{PLY}property list uchar float texcoord\nend_header\n{SQUARE}4 0 1 2 3 8 0 0 .25 0 1 1 0 1\n"
    );
    let folder = folder(&[("m.ply", &file)]);
    pictures(folder.path());
    let scene = load(&folder.path().join("m.ply")).unwrap();
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    let triangle = scene.shapes.triangles[0];
    // v of textures grows downwards.
    let wanted = |corner: DVec3| {
        if corner == DVec3::X { DVec2::new(0.25, 1.0) } else { DVec2::new(corner.x, 1.0 - corner.y) }
    };
    assert_eq!(triangle.uvs, triangle.vertices.map(wanted));
    let texture = scene.materials[triangle.material].texture.unwrap();
    assert_eq!(load_texture(&scene.textures[texture]).unwrap().texels[..3], [200, 100, 50]);
    fs::remove_file(folder.path().join("color.png")).unwrap();
    let said = told(load(&folder.path().join("m.ply")));
    assert!(
        said.contains("m.ply: its texture: ") && said.contains("color.png: there is no such file"),
        "{said}"
    );
}

#[test]
fn a_picture_without_coordinates_is_told() {
    let folder = folder(&[("m.ply", &format!("{PLY}end_header\n{SQUARE}4 0 1 2 3\n"))]);
    let scene = load(&folder.path().join("m.ply")).unwrap();
    assert!(scene.notes[0].contains("\"color.png\" is left out"), "{:?}", scene.notes);
}
