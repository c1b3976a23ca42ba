//! Models that would take all time or memory, are no files, or are not what their place asks for: each is refused at once,
//! and the message says what is allowed.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use moire::internal::scene::load;
use moire::internal::texture::data::{ColorSpace, Dimension, MipKernel, TexelFormat, TextureData};
use moire::internal::texture::room::{bytes_of_levels, check_room};
use tempfile::tempdir;

use crate::support::{moire, told};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn said_of(files: &[(&str, &str)]) -> String {
    let folder = tempdir().unwrap();
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    told(load(&folder.path().join(files[0].0)))
}

#[test]
fn more_materials_than_shapes_are_refused_while_they_are_read() {
    let start = Instant::now();
    let named: String = (0..70_000).map(|i| format!("usemtl a{i}\nf 1 2 3\n")).collect();
    let said = said_of(&[("m.obj", &format!("{TRIANGLE}{named}"))]);
    assert!(said.contains("line 131074: more than 65535 different materials"), "{said}");
    let library = "newmtl a\n".repeat(70_000);
    let said =
        said_of(&[("m.obj", &format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n")), ("m.mtl", &library)]);
    assert!(said.contains("m.mtl") && said.contains("line 65536: more than 65535 materials"), "{said}");
    let libraries: String = (0..2000).map(|i| format!("mtllib {i}.mtl\n")).collect();
    let said = said_of(&[("m.obj", &format!("{libraries}{TRIANGLE}f 1 2 3\n"))]);
    assert!(said.contains("line 1025: more than 1024 different libraries"), "{said}");
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
}

#[test]
fn a_library_that_is_named_again_and_again_is_missed_once() {
    let folder = tempdir().unwrap();
    let named = "mtllib gone.mtl\n".repeat(10_000);
    fs::write(folder.path().join("m.obj"), format!("{named}{TRIANGLE}f 1 2 3\n")).unwrap();
    let notes = load(&folder.path().join("m.obj")).unwrap().notes;
    assert_eq!(notes.len(), 1, "{}", notes.len());
    assert!(notes[0].contains("gone.mtl"), "{notes:?}");
}

#[test]
fn the_same_warning_of_several_sections_is_told_once_with_its_count() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("m.obj"), format!("{TRIANGLE}f 1 2 3\nl 1 2\n")).unwrap();
    fs::copy(folder.path().join("m.obj"), folder.path().join("n.obj")).unwrap();
    fs::create_dir(folder.path().join("x")).unwrap();
    let sections = "[[mesh]]\nfile = 'm.obj'\n[[mesh]]\nfile = 'n.obj'\n[[mesh]]\nfile = 'x/../m.obj'\n";
    let head =
        "[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = 4\nheight = 4\n";
    fs::write(folder.path().join("s.toml"), format!("{head}{sections}")).unwrap();
    let notes = load(&folder.path().join("s.toml")).unwrap().notes;
    assert_eq!(notes.len(), 3, "three files: {notes:?}");
}

#[cfg(unix)]
#[test]
fn devices_are_no_models_and_no_libraries() {
    let folder = tempdir().unwrap();
    let device = |name: &str| std::os::unix::fs::symlink("/dev/zero", folder.path().join(name)).unwrap();
    device("m.ply");
    device("m.mtl");
    let said = told(load(&folder.path().join("m.ply")));
    assert!(said.contains("it is not a regular file"), "{said}");
    fs::write(folder.path().join("m.obj"), format!("mtllib m.mtl\n{TRIANGLE}f 1 2 3\n")).unwrap();
    let notes = load(&folder.path().join("m.obj")).unwrap().notes;
    assert!(notes[0].contains("m.mtl: it is not a regular file"), "{notes:?}");
}

fn refused(arguments: &[&Path], input: &[u8]) -> String {
    let output =
        moire().arg("render").args(arguments).args(["-o", "x.png"]).write_stdin(input).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn models_in_place_of_scenes_are_told_what_a_scene_may_be() {
    for (input, what) in [
        (&b"ply\nformat ascii 1.0\n"[..], "a PLY file"),
        (b"glTF\x02\0\0\0", "a glTF file"),
        (b"{\"asset\":{}}", "JSON, as glTF files are"),
        (b"# by hand\n\nv 0 0 0\n", "an OBJ file"),
    ] {
        let said = refused(&[Path::new("-")], input);
        assert!(said.contains(what) && said.contains(".toml, .ply, .obj, .stl, .glb, .gltf"), "{said}");
    }
    let said = refused(&[Path::new("-")], b"[camera]\n");
    assert!(
        !said.contains("where a scene in TOML is needed"),
        "a scene with a mistake is none of these: {said}"
    );
    let said = told(load(Path::new("hero.fbx")));
    assert!(said.contains("the ending .fbx are not read"), "{said}");
}

#[test]
fn numbers_of_any_size_are_told_in_a_few_letters() {
    let said = said_of(&[("m.obj", &format!("{TRIANGLE}v 1e300 0 0\nf 1 2 3\n"))]);
    assert!(said.contains("[1e300, 0, 0]"), "{said}");
    let said = said_of(&[
        ("m.obj", &format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n")),
        ("m.mtl", "newmtl a\nd 1e300\n"),
    ]);
    assert!(said.contains("1e300 is out of range"), "{said}");
}

/// A texture of this size whose texels are not there.
fn announced(size: u32, depth: u32, dimension: Dimension) -> TextureData {
    TextureData {
        name: "t".into(),
        dimension,
        width: size,
        height: size,
        depth,
        format: TexelFormat::Grey8,
        color_space: ColorSpace::Linear,
        file_channels: 1,
        texels: Vec::new(),
        stored_levels: Vec::new(),
    }
}

#[test]
fn levels_that_do_not_fit_into_memory_are_an_error() {
    let small = announced(4, 1, Dimension::Two);
    // Levels of 4 and 1 texels, as bytes and as floats.
    assert_eq!(bytes_of_levels(&small, MipKernel::Box), 5 + 4 * 5);
    check_room(&small, "its mip levels", bytes_of_levels(&small, MipKernel::Box)).unwrap();
    let huge = announced(65_536, 65_536, Dimension::Three);
    let said = told(check_room(&huge, "its mip levels", bytes_of_levels(&huge, MipKernel::Box)));
    assert!(said.contains("texture \"t\": no room in memory for its mip levels"), "{said}");
}
