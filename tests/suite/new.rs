//! `moire new` and the scenes of the program: what is written renders, says what was found in the files, and replaces nothing.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::Output;

use moire::internal::core::film::Film;
use moire::internal::scene::model::*;
use moire::internal::scene::{BuiltIn, load};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::Address;
use tempfile::{TempDir, tempdir};

use crate::support::{data, moire};

fn new(folder: &Path, arguments: &[&OsStr]) -> Output {
    moire().current_dir(folder).arg("new").args(arguments).output().unwrap()
}

fn words<'a>(words: &[&'a str]) -> Vec<&'a OsStr> {
    words.iter().map(|word| OsStr::new(*word)).collect()
}

/// Runs it, and reads the scene that it says to have written.
fn made(folder: &TempDir, arguments: &[&str], file: &str) -> Scene {
    let output = new(folder.path(), &words(arguments));
    assert!(output.status.success(), "{}", told(&output));
    load(&folder.path().join(file)).unwrap()
}

fn refused(folder: &TempDir, arguments: &[&str]) -> String {
    let output = new(folder.path(), &words(arguments));
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    told(&output)
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Writes a picture of these values.
fn picture(folder: &TempDir, name: &str, size: [u32; 2], value: impl Fn(u32, u32) -> [f32; 3]) -> PathBuf {
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let film = Film {
        width: size[0],
        height: size[1],
        pixels: pixels.map(|(x, y)| value(x, y)).collect(),
        samples: 1,
    };
    let path = folder.path().join(name);
    film.save(&path).unwrap();
    path
}

/// Levels of a wave with a whole number of periods, or of a ramp.
fn wave(x: u32, of: u32) -> f32 {
    0.5 + 0.4 * (std::f32::consts::TAU * x as f32 / of as f32).sin()
}

#[test]
fn without_files_every_kind_renders_with_those_of_the_program() {
    for kind in ["floor", "ball", "quad", "model"] {
        let folder = tempdir().unwrap();
        let scene = made(&folder, &[kind], &format!("{kind}.toml"));
        assert!(kind == "model" || !scene.textures.is_empty(), "{kind}");
        let output = moire()
            .current_dir(folder.path())
            .args(["render", &format!("{kind}.toml"), "--size", "24x16", "--spp", "1", "--device", "oracle"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{kind}: {}", told(&output));
        assert!(!told(&output).contains("warning"), "{kind}: {}", told(&output));
    }
}

#[test]
fn what_is_chosen_follows_the_file_and_is_said() {
    let folder = tempdir().unwrap();
    picture(&folder, "photo.png", [64, 32], |x, y| [wave(x, 64), y as f32 / 32.0, 0.2]);
    let scene = made(&folder, &["-t", "photo.png"], "floor.toml");
    assert_eq!(scene.textures[0].color_space, ColorSpace::Srgb);
    assert_eq!(scene.samplers[0].address, [Address::Repeat, Address::MirroredRepeat]);
    assert_eq!(scene.materials[0].mapping.scale.x, 0.5);
    let text = fs::read_to_string(folder.path().join("floor.toml")).unwrap();
    assert!(text.contains("64 x 32 texels") && text.contains("upper and lower differ"), "{text}");
    let quad = made(&folder, &["quad", "-t", "photo.png"], "quad.toml");
    assert_eq!(([quad.width, quad.height], quad.samplers[0].address), ([64, 32], [Address::ClampToEdge; 2]));
}

/// A set repeats where all its maps do, and a map of normals is never mirrored.
#[test]
fn addresses_follow_all_maps_of_a_set() {
    let folder = tempdir().unwrap();
    let tiling = |x: u32, y: u32| [wave(x, 64), wave(y, 64), 0.2];
    let ramp = |_: u32, y: u32| [y as f32 / 64.0; 3];
    let flat = |_: u32, _: u32| [0.2140, 0.2140, 1.0];
    picture(&folder, "a_albedo.png", [64, 64], tiling);
    picture(&folder, "a_height.png", [64, 64], ramp);
    picture(&folder, "b_albedo.png", [64, 64], ramp);
    picture(&folder, "b_normal.png", [64, 64], flat);
    let of = |files: [&str; 2]| {
        let scene = made(&folder, &["ball", "--force", "-t", files[0], "-t", files[1]], "ball.toml");
        let text = fs::read_to_string(folder.path().join("ball.toml")).unwrap();
        (scene.samplers[0].address, text)
    };
    let (address, _) = of(["a_albedo.png", "a_height.png"]);
    assert_eq!(address, [Address::Repeat, Address::MirroredRepeat], "the heights do not tile");
    let (address, text) = of(["b_albedo.png", "b_normal.png"]);
    assert_eq!(address, [Address::Repeat; 2]);
    assert!(text.contains("inside out"), "{text}");
}

#[test]
fn a_set_is_recognised_by_names_and_what_has_no_map_is_left_out() {
    let folder = tempdir().unwrap();
    let grey =
        |name, value: f32| picture(&folder, name, [8, 8], move |x, _| [value + 0.01 * (x % 2) as f32; 3]);
    for (name, value) in
        [("rock_diff.png", 0.4), ("rock_nor_dx.png", 0.5), ("rock_rough.png", 0.3), ("rock_ao.png", 0.9)]
    {
        grey(name, value);
    }
    let set =
        ["ball", "-t", "rock_rough.png", "-t", "rock_nor_dx.png", "-t", "rock_ao.png", "-t", "rock_diff.png"];
    let scene = made(&folder, &set, "ball.toml");
    let material = &scene.materials[0];
    let file = |texture: usize| scene.textures[texture].content.files()[0].file_name().unwrap().to_owned();
    assert_eq!(file(material.texture.unwrap()), "rock_diff.png");
    let bump = material.bump.as_ref().unwrap();
    assert_eq!((file(bump.texture), bump.kind), ("rock_nor_dx.png".into(), BumpKind::Normal));
    assert_eq!(material.metallic, 0.0);
    let text = fs::read_to_string(folder.path().join("ball.toml")).unwrap();
    assert!(text.contains("# Left out: rock_ao.png: occlusion dims the light of a sky"), "{text}");
    let alone = made(&folder, &["-t", "rock_rough.png", "-o", "alone.toml"], "alone.toml");
    assert!(alone.materials[0].texture.is_some(), "a picture alone is of colours");
}

/// Writes a JPEG with a mark at one end, and Exif data with this orientation.
fn turned(folder: &TempDir, name: &str, orientation: u8) {
    let path = picture(folder, name, [16, 8], |x, _| [if x < 4 { 1.0 } else { 0.0 }; 3]);
    let jpeg = fs::read(&path).unwrap();
    let exif =
        [&b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"[..], &[orientation], &[0; 6]].concat();
    let segment = [&b"\xff\xe1"[..], &(exif.len() as u16 + 2).to_be_bytes(), &exif].concat();
    fs::write(path, [&jpeg[..2], &segment, &jpeg[2..]].concat()).unwrap();
}

#[test]
fn every_orientation_is_applied_and_said() {
    for orientation in 1..=8u8 {
        let folder = tempdir().unwrap();
        turned(&folder, "p.jpg", orientation);
        let scene = made(&folder, &["quad", "-t", "p.jpg"], "quad.toml");
        let upright = if orientation < 5 { [16, 8] } else { [8, 16] };
        assert_eq!([scene.width, scene.height], upright, "{orientation}");
        let text = fs::read_to_string(folder.path().join("quad.toml")).unwrap();
        assert!(text.contains(&format!("{} x {} texels", upright[0], upright[1])), "{orientation}: {text}");
        assert_eq!(text.contains("turned upright"), orientation != 1, "{orientation}: {text}");
        let output = moire()
            .current_dir(folder.path())
            .args(["render", "quad.toml", "--spp", "1", "--device", "oracle", "-q", "-o", "q.exr"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", told(&output));
        // Where the mark of the file's first columns is seen (Exif 2.32, 4.6.4).
        let film = Film::open(folder.path().join("q.exr")).unwrap();
        let [width, height] = [film.width as usize, film.height as usize];
        let bright = |x: usize, y: usize| film.pixels[y * width + x][0] > 0.5;
        let (left, right) = (bright(0, height / 2), bright(width - 1, height / 2));
        let (top, bottom) = (bright(width / 2, 0), bright(width / 2, height - 1));
        let seen = [left, right, top, bottom];
        let place = match orientation {
            1 | 4 => "left",
            2 | 3 => "right",
            5 | 6 => "top",
            _ => "bottom",
        };
        let wanted = ["left", "right", "top", "bottom"].map(|side| side == place);
        assert_eq!(seen, wanted, "{orientation}: {place}");
    }
}

#[test]
fn alpha_is_a_mask_or_blended_or_not_mentioned() {
    for (name, alpha, wanted) in [
        ("opaque", (|_| 255) as fn(u32) -> u8, None),
        ("cut-out", |i| if i % 16 < 5 { 0 } else { 255 }, Some("alpha = \"mask\"")),
        ("smooth", |i| (i % 16 * 17) as u8, Some("alpha = \"blend\"")),
    ] {
        let folder = tempdir().unwrap();
        let texels: Vec<u8> = (0..256).flat_map(|i| [i as u8, 99, 30, alpha(i)]).collect();
        let file = fs::File::create(folder.path().join("p.png")).unwrap();
        let mut encoder = png::Encoder::new(file, 16, 16);
        encoder.set_color(png::ColorType::Rgba);
        encoder.write_header().unwrap().write_image_data(&texels).unwrap();
        made(&folder, &["quad", "-t", "p.png"], "quad.toml");
        let text = fs::read_to_string(folder.path().join("quad.toml")).unwrap();
        let found = text.lines().find(|line| line.starts_with("alpha"));
        assert_eq!(found.map(|line| line.split("  ").next().unwrap()), wanted, "{name}");
    }
}

#[test]
fn maps_of_other_programs_are_taken_by_their_names_or_named() {
    let folder = tempdir().unwrap();
    for (i, name) in
        ["T_Rock_D", "T_Rock_ORM", "Rock_Cavity", "Rock_RMA", "Rock_Opacity", "preview"].iter().enumerate()
    {
        let red = 0.1 * i as f32;
        picture(&folder, &format!("{name}.png"), [8, 8], move |x, y| {
            [red, 0.3 + 0.05 * x as f32, 0.05 * y as f32]
        });
    }
    // A folder stands for its pictures, and options may come before the kind.
    fs::create_dir(folder.path().join("scenes")).unwrap();
    let scene = made(&folder, &["-o", "scenes/s.toml", "-t", ".", "ball"], "scenes/s.toml");
    assert!(refused(&folder, &["-t", "scenes"]).contains("scenes: there are no pictures in this folder"));
    let file = |texture: usize| scene.textures[texture].content.files()[0].file_name().unwrap().to_owned();
    assert_eq!(file(scene.materials[0].texture.unwrap()), "T_Rock_D.png");
    let output = new(
        folder.path(),
        &words(&["ball", "-t", "T_Rock_ORM.png", "T_Rock_D.png", "Rock_Cavity.png", "Rock_RMA.png"]),
    );
    let said = told(&output);
    for what in ["no material here has a map of this kind (\"cavity\")", "in another order (\"rma\")"] {
        assert!(said.contains(what), "{said}");
    }
    let text = fs::read_to_string(folder.path().join("ball.toml")).unwrap();
    assert!(text.contains("metallic_roughness_map = \"packed\""), "{text}");
}

#[test]
fn gloss_and_metal_in_one_become_means() {
    let folder = tempdir().unwrap();
    let file = fs::File::create(folder.path().join("Rock_MetallicSmoothness.png")).unwrap();
    let mut encoder = png::Encoder::new(file, 2, 2);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().unwrap().write_image_data(&[51u8, 0, 0, 204].repeat(4)).unwrap();
    picture(&folder, "Rock_Albedo.png", [2, 2], |_, _| [0.5; 3]);
    let set = ["ball", "-t", "Rock_Albedo.png", "Rock_MetallicSmoothness.png"];
    let material = made(&folder, &set, "ball.toml").materials[0].clone();
    assert_eq!((material.metallic, material.roughness), (0.2, 0.2));
}

#[test]
fn a_model_keeps_its_materials_under_a_sky() {
    let folder = tempdir().unwrap();
    picture(&folder, "sky.hdr", [16, 8], |x, y| [x as f32, y as f32, 3.0]);
    let file = fs::canonicalize(data().join("models/crate.obj")).unwrap();
    let scene = made(&folder, &["model", file.to_str().unwrap(), "-t", "sky.hdr"], "model.toml");
    assert!(scene.background.environment.is_some() && matches!(scene.lights[..], [Light::Environment]));
    assert!(scene.materials.iter().any(|material| material.texture.is_some()), "the crate has a texture");
    let quad = made(&folder, &["quad", "-t", "sky.hdr"], "quad.toml");
    assert!(quad.background.environment.is_none() && quad.materials[0].texture.is_some());
}

#[test]
fn a_panorama_of_floats_is_sky_and_light() {
    let folder = tempdir().unwrap();
    picture(&folder, "studio.hdr", [16, 8], |x, y| [x as f32, y as f32, 3.0]);
    let scene = made(&folder, &["ball", "-t", "studio.hdr"], "ball.toml");
    assert!(scene.background.environment.is_some());
    assert!(matches!(scene.lights[..], [Light::Environment]));
}

#[test]
fn a_model_is_seen_by_the_camera_of_its_own_view() {
    let folder = tempdir().unwrap();
    let file = fs::canonicalize(data().join("models/knot.ply")).unwrap();
    let scene = made(&folder, &[file.to_str().unwrap()], "model.toml");
    let own = load(&file).unwrap();
    assert!((scene.camera.eye - own.camera.eye).length() < 1e-3 * own.camera.eye.length());
    assert_eq!((scene.lights.len(), scene.width), (own.lights.len(), own.width));
}

#[test]
fn paths_of_any_name_are_written_relative_to_the_scene() {
    let folder = tempdir().unwrap();
    for name in ["a b", "it's \"so\"", "größe", "back\\slash", "tab\there", "new\nline"] {
        let name = format!("{name}.png");
        picture(&folder, &name, [4, 4], |x, y| [x as f32 / 4.0, y as f32 / 4.0, 0.1]);
        fs::create_dir_all(folder.path().join("scenes")).unwrap();
        let scene = made(&folder, &["-t", &name, "-o", "scenes/s.toml", "--force"], "scenes/s.toml");
        let file = scene.textures[0].content.files()[0].to_owned();
        assert_eq!(fs::canonicalize(&file).unwrap(), fs::canonicalize(folder.path().join(&name)).unwrap());
    }
    let odd = folder.path().join(OsStr::from_bytes(b"odd\xff.png"));
    fs::copy(folder.path().join("a b.png"), &odd).unwrap();
    let output = new(
        folder.path(),
        &[OsStr::new("-t"), odd.file_name().unwrap(), OsStr::new("-o"), OsStr::new("o.toml")],
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(told(&output).contains("the name is not UTF-8"), "{}", told(&output));
    assert!(!folder.path().join("o.toml").exists());
}

#[test]
fn nothing_is_replaced_unless_it_is_asked_for() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("floor.toml");
    fs::write(&path, "mine").unwrap();
    assert!(refused(&folder, &["floor"]).contains("floor.toml: the file exists"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "mine");
    assert!(!folder.path().join("poster.png").exists(), "a part was written");
    fs::write(folder.path().join("poster.png"), "mine too").unwrap();
    assert!(refused(&folder, &["floor", "-o", "f.toml"]).contains("poster.png: the file exists"));
    assert!(!folder.path().join("f.toml").exists());
    made(&folder, &["floor", "--force"], "floor.toml");
    // The program's own files are there already.
    made(&folder, &["floor", "-o", "again.toml"], "again.toml");
}

#[test]
fn mistakes_name_the_file_and_what_is_allowed() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("broken.png"), "no picture").unwrap();
    for (arguments, said) in [
        (&["-t", "missing.jpg"][..], "missing.jpg: there is no such file"),
        (&["-t", "broken.png"], "broken.png: not a picture"),
        (&["-t", "a.<UDIM>.png"], "a new scene takes single pictures"),
        (&["flor"], "flor: expected one of floor, ball, quad, model"),
        (&["@lectur"], "did you mean \"@lecture\"?"),
        (&["floor", "-t", "x.glb"], "x.glb: this is a model, and a floor has none"),
        (&["model", "x.png"], "x.png: expected the file of a model"),
        (&["a.ply", "b.ply"], "b.ply: a second model"),
        (&["@lecture", "-t", "x.png"], "has files of its own"),
        (&["floor", "-o", "none/floor.toml"], "create the folder first"),
        (&["floor", "-o", "floor.png"], "floor.png: this is a picture's name"),
        (&["@lecture", "-o", "lecture.GLB"], "lecture.GLB: this is a model's name"),
        (&["floor", "-o", "-"], "-o -: a new scene is a file"),
    ] {
        let found = refused(&folder, arguments);
        assert!(found.contains(said), "{arguments:?}: {found}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "something was written");
}

#[test]
fn scenes_of_the_program_are_those_of_the_repository() {
    let scenes = BuiltIn::all();
    let in_data: usize = ["scenes", "scenes/start"]
        .iter()
        .map(|folder| fs::read_dir(data().join(folder)).unwrap().flatten())
        .map(|files| {
            files.filter(|file| file.path().extension().is_some_and(|ending| ending == "toml")).count()
        })
        .sum();
    assert_eq!(scenes.len(), in_data);
    for scene in scenes {
        let summary = scene.summary();
        assert!(summary.len() > 15 && !summary.contains('#'), "{}: {summary:?}", scene.name);
        let read = load(Path::new(&scene.shown())).unwrap();
        let files = read.textures.iter().flat_map(|texture| texture.content.files());
        for file in files.chain(read.sources.iter().map(PathBuf::as_path)) {
            assert!(
                moire::internal::core::built_in::bytes(file).is_some(),
                "{}: {}",
                scene.name,
                file.display()
            );
        }
    }
}

#[test]
fn a_scene_of_the_program_and_its_copy_render_as_the_file_does() {
    let folder = tempdir().unwrap();
    made(&folder, &["@meshes", "-o", "copy.toml"], "copy.toml");
    let file = fs::canonicalize(data().join("scenes/meshes.toml")).unwrap();
    let pictures = ["@meshes", "copy.toml", file.to_str().unwrap()].map(|scene| {
        let output = moire()
            .current_dir(folder.path())
            .env("HOME", "/nonexistent")
            .args([
                "render",
                scene,
                "--size",
                "24x16",
                "--spp",
                "1",
                "--no-metadata",
                "--device",
                "oracle",
                "-q",
                "-o",
                "a.exr",
            ])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", told(&output));
        fs::read(folder.path().join("a.exr")).unwrap()
    });
    assert!(pictures[0] == pictures[1] && pictures[1] == pictures[2]);
    let output = moire().current_dir(folder.path()).args(["new", "--list"]).output().unwrap();
    let list = String::from_utf8(output.stdout).unwrap();
    assert!(
        list.lines().any(|line| line.starts_with("@lecture ") && line.contains("The lecture's exercise")),
        "{list}"
    );
}
