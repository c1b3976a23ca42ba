//! Warnings about scenes that are valid but probably not intended: no light source, pictures read
//! as linear light, pictures that are no normal maps. The project's own scenes produce none.

use std::fs;
use std::path::Path;

use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};
use moire::internal::scene::advice::of_scene;
use moire::internal::scene::prune::prune;
use moire::internal::scene::texture_advice::of_textures;
use moire::internal::texture::load::load;
use tempfile::{TempDir, tempdir};

use crate::support::{data, moire};

const HEAD: &str = "\
camera = { eye = [0, 0, 3], look_at = [0, 0, 0], vertical_fov = 40 }
image = { width = 8, height = 6 }
sampling = { spp = 1 }
plane = [{ origin = [0, 0, 0], tangent = [1, 0, 0], bitangent = [0, 1, 0], material = 'm' }]
";
const LIGHT: &str = "[[light]]\nkind = 'point'\nposition = [0, 0, 3]\nintensity = [9, 9, 9]\n";

/// Pictures of each kind that the tests name.
fn pictures() -> TempDir {
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    RgbImage::from_fn(4, 4, |x, _| Rgb([40 * x as u8, 90, 130])).save(at("photo.png")).unwrap();
    RgbImage::from_fn(8, 8, |x, _| Rgb([20 * x as u8, 90, 130])).save(at("photo.jpg")).unwrap();
    RgbImage::from_fn(4, 4, |x, y| Rgb([255 * ((x + y) % 2) as u8; 3])).save(at("checker.png")).unwrap();
    RgbImage::from_pixel(4, 4, Rgb([128, 128, 255])).save(at("normals.png")).unwrap();
    RgbImage::from_pixel(4, 4, Rgb([128; 3])).save(at("flat.png")).unwrap();
    GrayImage::from_fn(4, 4, |x, _| Luma([60 * x as u8])).save(at("heights.png")).unwrap();
    ImageBuffer::<Luma<u16>, _>::from_pixel(4, 4, Luma([9000u16])).save(at("deep.png")).unwrap();
    folder
}

/// Returns all warnings about a scene after unused parts are removed.
fn told(path: &Path) -> Vec<String> {
    let mut scene = moire::internal::scene::load(path).unwrap();
    prune(&mut scene);
    let textures: Vec<_> = scene.textures.iter().map(|t| load(t).unwrap()).collect();
    [of_scene(&scene), of_textures(&scene, &textures)].concat()
}

fn told_of(folder: &TempDir, body: &str) -> Vec<String> {
    let path = folder.path().join("scene.toml");
    fs::write(&path, format!("{HEAD}{body}")).unwrap();
    told(&path)
}

fn says(messages: &[String], words: &[&str]) {
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(words.iter().all(|word| messages[0].contains(word)), "{words:?} in {messages:?}");
}

#[test]
fn black_for_want_of_light_is_told() {
    let folder = pictures();
    let sky = "[[texture]]\nname = 'sky'\nfile = 'photo.png'\ncolor_space = 'srgb'\n\
               [background]\nenvironment = 'sky'\n";
    let of = |model: &str, more: &str| {
        told_of(&folder, &format!("[[material]]\nname = 'm'\nmodel = '{model}'\n{more}"))
    };
    says(&of("lambert", ""), &["\"m\" (model \"lambert\")", "is black", "no [[light]]", "model = \"unlit\""]);
    says(&of("phong", sky), &["\"m\" (model \"phong\")", "environment is seen but lights nothing"]);
    says(&of("lambert", &LIGHT.replace("9, 9, 9", "0, 0, 0")), &["zero power"]);
    for (model, more) in
        [("lambert", LIGHT), ("phong", LIGHT), ("unlit", ""), ("mirror", sky), ("dielectric", "")]
    {
        assert!(of(model, more).is_empty(), "{model}: {:?}", of(model, more));
    }
    assert!(of("lambert", "color = [0, 0, 0]\n").is_empty(), "black on purpose");
    // Materials of no shape.
    assert!(of("unlit", "[[material]]\nname = 'unused'\n").is_empty());
}

#[test]
fn what_chooses_its_footprint_is_not_advised_to_take_one() {
    let folder = pictures();
    let path = folder.path().join("mips.toml");
    let sampler = "[[texture]]\nname = 't'\nfile = 'flat.png'\ncolor_space = 'srgb'\n[[sampler]]\nname = 's'\nmip = 'linear'\n\
                   [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n";
    let of = |sampling: &str| {
        let head = HEAD.replace("spp = 1", sampling);
        fs::write(&path, head + sampler).unwrap();
        told(&path)
    };
    says(&of("spp = 1, footprint = 'none'"), &["mip = \"linear\" has no effect", "footprint = \"cone\""]);
    assert!(of("algorithm = 'auto', pattern = 'sobol-owen', footprint = 'none'").is_empty());
}

#[test]
fn eight_bit_colours_of_unstated_meaning_are_told_once() {
    let folder = pictures();
    let of = |textures: &str, material: &str| {
        told_of(&folder, &format!("{textures}[[material]]\nname = 'm'\nmodel = 'unlit'\n{material}"))
    };
    let texture = |name: &str, file: &str, more: &str| {
        format!("[[texture]]\nname = '{name}'\nfile = '{file}'\n{more}\n")
    };
    let both = texture("a", "photo.png", "") + &texture("sky", "photo.jpg", "");
    let background = "texture = 'a'\n[background]\nenvironment = 'sky'\n";
    says(&of(&both, background), &["textures \"a\", \"sky\" are", "color_space = \"srgb\"", "\"linear\""]);
    says(&of(&texture("a", "photo.jpg", ""), "texture = 'a'\n"), &["texture \"a\" is"]);
    for (file, more) in [
        ("photo.png", "color_space = 'linear'"),
        ("photo.png", "color_space = 'srgb'"),
        ("checker.png", ""),
        ("deep.png", ""),
    ] {
        assert!(of(&texture("a", file, more), "texture = 'a'\n").is_empty(), "{file} {more}");
    }
    assert!(of(&texture("a", "heights.png", ""), "bump_map = 'a'\n").is_empty(), "heights are no colours");
    assert!(of(&texture("a", "normals.png", ""), "normal_map = 'a'\n").is_empty(), "normals are no colours");
    assert!(of(&texture("a", "photo.png", ""), "").is_empty(), "a texture that nothing shows");
}

#[test]
fn normal_maps_that_are_colours_or_heights_are_told() {
    let folder = pictures();
    let of = |file: &str, space: &str| {
        told_of(
            &folder,
            &format!(
                "[[texture]]\nname = 't'\nfile = '{file}'\ncolor_space = '{space}'\n\
                 [[material]]\nname = 'm'\nnormal_map = 't'\n{LIGHT}"
            ),
        )
    };
    says(&of("normals.png", "srgb"), &["normal map \"t\" is declared color_space = \"srgb\"", "\"linear\""]);
    says(&of("flat.png", "linear"), &["normal map \"t\" is grey", "bump_map"]);
    says(&of("heights.png", "linear"), &["normal map \"t\" is grey"]);
    assert!(of("normals.png", "linear").is_empty());
}

#[test]
fn of_the_projects_own_scenes_nothing_is_told() {
    let scenes = data().join("scenes");
    let folders = [scenes.clone(), scenes.join("bench"), scenes.join("slopes")];
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let files = files.map(|entry| entry.unwrap().path());
    let mut count = 0;
    for file in files.filter(|path| path.extension().is_some_and(|e| e == "toml")) {
        let doubts: Vec<String> =
            told(&file).into_iter().filter(|m| m.contains("light") || m.contains("normal map")).collect();
        assert!(doubts.is_empty(), "{}: {doubts:?}", file.display());
        count += 1;
    }
    assert!(count > 30, "only {count} scenes were found");
}

#[test]
fn doubts_reach_stderr_and_json_unless_quiet() {
    let folder = pictures();
    let scene = "[[texture]]\nname = 'a'\nfile = 'photo.jpg'\n[[material]]\nname = 'm'\ntexture = 'a'\n";
    fs::write(folder.path().join("scene.toml"), format!("{HEAD}{scene}")).unwrap();
    for device in [crate::stage::device_name().as_str(), "oracle"] {
        let run = |more: &str| {
            let args = ["render", "scene.toml", "--device", device, more];
            let output = moire().current_dir(folder.path()).args(args).output().unwrap();
            assert!(output.status.success(), "{output:?}");
            (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
        };
        let (report, said) = run("--json");
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let warnings: Vec<&str> =
            report["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        for warning in warnings {
            assert!(said.contains(&format!("warning: {warning}")), "{said}");
        }
        assert_eq!(run("-q").1, "", "{device}");
    }
}
