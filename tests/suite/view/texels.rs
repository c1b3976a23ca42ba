//! What the page says of textures, held against the pictures themselves: with filter `nearest` and one sample in the middle of
//! each pixel, the picture's colour is that of the texel which the page names, in the texture's file and in its window. For
//! rotated and repeated mappings, texel centres, borders, meshes, tiles, cubes and environments; and the footprint is
//! the change of the coordinate from a pixel to its neighbours.

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{Rgb, RgbImage};
use serde_json::{Value, json};
use tempfile::{TempDir, tempdir};

use super::pictures::picture;
use super::{View, refined};
use crate::stage::device_name;

const SIZE: [u32; 2] = [16, 12];

/// A picture whose texels all differ.
fn noise(width: u32, height: u32, seed: u64) -> RgbImage {
    let mut rng = fastrand::Rng::with_seed(seed);
    RgbImage::from_fn(width, height, |_, _| Rgb([rng.u8(..), rng.u8(..), rng.u8(..)]))
}

fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    let save = |name: &str, picture: RgbImage| picture.save(folder.path().join(name)).unwrap();
    save("t.png", noise(13, 9, 1));
    for (number, seed) in [(1001, 2), (1002, 3), (1011, 4), (1012, 5)] {
        save(&format!("u.{number}.png"), noise(5, 4, seed));
    }
    for face in 0..6 {
        save(&format!("f{face}.png"), noise(7, 7, 10 + face));
    }
    let quad = "v -2 -1 0\nv 2 -1 0\nv 2 1 0\nv -2 1 0\nvt -0.3 0.2\nvt 1.7 0.1\nvt 1.5 1.3\nvt -0.2 1.2\nf 1/1 2/2 3/3 4/4\n";
    fs::write(folder.path().join("quad.obj"), quad).unwrap();
    folder
}

const PLANE: &str =
    "[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n";

/// A scene of which each pixel shows one texel; `material` are the lines of mapping and model.
fn scene(texture: &str, sampler: &str, material: &str, rest: &str) -> String {
    let space = if texture.starts_with("procedural") { "" } else { "color_space = 'srgb'\n" };
    format!(
        "[camera]\neye = [0.2, 0.1, 3]\nlook_at = [0.1, 0, 0]\northographic_height = 1.9\n\
         [image]\nwidth = {}\nheight = {}\n[sampling]\npattern = 'center'\n\
         [[texture]]\nname = 't'\n{space}{texture}\n[[sampler]]\nname = 's'\nfilter = 'nearest'\n{sampler}\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n{material}\n{rest}",
        SIZE[0], SIZE[1]
    )
}

/// What a page says of every pixel, row by row, and the picture.
fn told(folder: &Path, text: &str) -> (Vec<Value>, Vec<u8>) {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    let view = View::of_file(&path, &["--device", &device_name(), "--spp", "1"]);
    let mut tab = view.tab("t");
    let state = tab.done();
    assert!(state["sides"][0]["failure"].is_null(), "{state}");
    let pixel = |x: u32, y: u32| view.get(&format!("pixel?tab=t&side=a&x={x}&y={y}")).json();
    let pixels =
        (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    (pixels, picture(&view, "a"))
}

/// Returns the colour of the texel in which a window has its centre.
fn in_window(window: &Value) -> [u8; 3] {
    let png = STANDARD.decode(window["png"].as_str().unwrap()).unwrap();
    let texels = image::load_from_memory(&png).unwrap().to_rgb8();
    let [x, y] = [0, 1].map(|c| window["centre"][c].as_f64().unwrap() as u32);
    texels.get_pixel(x, y).0
}

fn numbers(value: &Value) -> Vec<u32> {
    value.as_array().unwrap().iter().map(|own| own.as_u64().unwrap() as u32).collect()
}

/// Compares each pixel with the texel that is named; `file` opens the picture that it is of. Returns how many lie beyond a
/// border.
fn compare(text: &str, folder: &Path, file: &dyn Fn(&Value) -> String) -> usize {
    let (pixels, shown) = told(folder, text);
    let mut beyond = 0;
    for (own, color) in pixels.iter().zip(shown.chunks_exact(3)) {
        let look_up = &own["look_ups"][0];
        assert_eq!(in_window(&look_up["window"]), color, "the window of {:.600}\n{text}", own.to_string());
        if look_up["texel"].is_null() {
            beyond += 1;
            continue;
        }
        let texels = image::open(folder.join(file(look_up))).unwrap().to_rgb8();
        let place =
            if look_up["in_file"].is_null() { &look_up["texel"] } else { &look_up["in_file"]["texel"] };
        let place = numbers(place);
        assert_eq!(
            texels.get_pixel(place[0], place[1]).0,
            color,
            "the texel of {:.600}\n{text}",
            own.to_string()
        );
    }
    beyond
}

const FILE: &str = "file = 't.png'";
const TURNED: &str =
    "mapping = { kind = 'surface', scale = [0.83, 1.21], rotate = 31.0, offset = [0.37, -0.6] }";

fn one(_: &Value) -> String {
    "t.png".into()
}

#[test]
fn texels_are_those_of_the_picture_under_rotation_and_every_address() {
    let folder = folder();
    for address in ["repeat", "mirrored-repeat", "clamp-to-edge", "mirror-clamp-to-edge", "clamp-to-border"] {
        let sampler = format!("address = '{address}'\nborder_color = [0, 1, 0, 1]");
        let beyond = compare(&scene(FILE, &sampler, TURNED, PLANE), folder.path(), &one);
        assert_eq!(beyond > 0, address == "clamp-to-border", "{address}: {beyond}");
    }
    for sampler in ["texel_center = 'integer'", "address = ['clamp-to-edge', 'repeat']"] {
        compare(&scene(FILE, sampler, TURNED, PLANE), folder.path(), &one);
    }
    compare(&scene("file = 't.png'\nflip_v = true", "", TURNED, PLANE), folder.path(), &one);
}

#[test]
fn texels_are_those_of_the_picture_on_meshes_tiles_cubes_and_environments() {
    let folder = folder();
    let mesh = "[[mesh]]\nfile = 'quad.obj'\nmaterial = 'm'\ntransform = { rotate = [0, 0, 10] }\n[[plane]]\norigin = [0, 0, -1]\n\
                tangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n";
    compare(&scene(FILE, "", "", mesh), folder.path(), &one);
    for flip in [false, true] {
        let tiles = format!("file = 'u.<UDIM>.png'\nflip_v = {flip}");
        let mapping = "mapping = { kind = 'surface', scale = [0.9, 0.9], offset = [0.9, 0.2] }";
        let file = |look_up: &Value| format!("u.{}.png", look_up["in_file"]["tile"]);
        compare(&scene(&tiles, "", mapping, PLANE), folder.path(), &file);
    }
    let faces = "faces = ['f0.png', 'f1.png', 'f2.png', 'f3.png', 'f4.png', 'f5.png']";
    let face = |look_up: &Value| {
        let names = ["+x", "−x", "+y", "−y", "+z", "−z"];
        format!("f{}.png", names.iter().position(|own| look_up["face"] == *own).unwrap())
    };
    let solid = "mapping = { kind = 'cube', entity = 'normal' }";
    let sky = |texture: &str, material: &str| {
        let text = scene(texture, "", material, "[background]\nenvironment = 't'\nsampler = 's'\n");
        text.replace("orthographic_height = 1.9", "vertical_fov = 100.0")
    };
    compare(&sky(faces, solid), folder.path(), &face);
    compare(&sky(FILE, ""), folder.path(), &one);
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 3.0\nmaterial = 'm'\n";
    let slices = "slices = ['f0.png', 'f1.png', 'f2.png', 'f3.png', 'f4.png', 'f5.png']";
    let block = "mapping = { kind = 'solid', scale = [0.9, 1.1, 1.0], rotate = 20.0 }";
    let slice = |look_up: &Value| format!("f{}.png", look_up["texel"][2]);
    compare(&scene(slices, "", block, ball).replace("0.2, 0.1, 3]", "0.2, 0.1, 9]"), folder.path(), &slice);
    compare(&scene(faces, "", solid, ball).replace("0.2, 0.1, 3]", "0.2, 0.1, 9]"), folder.path(), &face);
}

#[test]
fn windows_of_computed_textures_show_what_the_picture_shows() {
    let folder = folder();
    let mapping = "mapping = { kind = 'surface', scale = [0.4, 0.4], rotate = 31.0 }";
    let (pixels, shown) = told(folder.path(), &scene("procedural = 'noise'", "", mapping, PLANE));
    let far = |own: &Value, color: &[u8]| {
        let seen = in_window(&own["look_ups"][0]["window"]);
        seen.iter().zip(color).map(|(a, b)| u64::from(a.abs_diff(*b))).max().unwrap()
    };
    let differences: Vec<u64> =
        pixels.iter().zip(shown.chunks_exact(3)).map(|(own, color)| far(own, color)).collect();
    let mean = differences.iter().sum::<u64>() as f64 / differences.len() as f64;
    let spread = shown.iter().max().unwrap() - shown.iter().min().unwrap();
    // A window's pixel is a 32nd of the texture's unit.
    assert!(mean < 4.0 && spread > 60, "{mean}: {differences:?}; {spread}");
}

#[test]
fn footprints_are_the_change_from_pixel_to_pixel_for_every_filter() {
    let folder = folder();
    for filter in ["nearest", "linear", "anisotropic", "ewa", "summed-area"] {
        let sampler = format!("mip = 'linear'\nfilter = '{filter}'");
        let text = scene(FILE, &sampler, TURNED, PLANE).replace("filter = 'nearest'\n", "");
        let (pixels, _) = told(folder.path(), &text);
        let of = |x: u32, y: u32| &pixels[(y * SIZE[0] + x) as usize]["look_ups"][0];
        let uv = |own: &Value| [0, 1].map(|c| own["uv"][c].as_f64().unwrap());
        let own = of(5, 5);
        let [here, right, below] = [own, of(6, 5), of(5, 6)].map(uv);
        for (axis, there) in [right, below].into_iter().enumerate() {
            for c in 0..2 {
                let change = own["change"][axis][c].as_f64().unwrap();
                assert!((change.abs() - (there[c] - here[c]).abs()).abs() < 1e-6, "{filter}: {own:.500}");
                let drawn = own["window"]["axes"][axis][c].as_f64().unwrap();
                let size = f64::from([13u32, 9][c] >> own["window"]["level"].as_u64().unwrap()).max(1.0);
                assert!((drawn - change * size).abs() < 1e-6, "{filter}: {own:.500}");
            }
        }
        let wide = own["texels"].as_array().unwrap();
        assert!(wide[0].as_f64() >= wide[1].as_f64() && wide[1].as_f64() > Some(0.0), "{own:.500}");
    }
}

#[test]
fn a_file_that_has_changed_is_read_at_the_next_setting() {
    let folder = folder();
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene(FILE, "", TURNED, PLANE)).unwrap();
    let view = View::of_file(&path, &["--device", &device_name(), "--spp", "1"]);
    let mut tab = view.tab("t");
    tab.done();
    let before = picture(&view, "a");
    // The samples lie in the middle of pixels whatever the seed, and what is on the device is shared.
    refined(&view, &mut tab, 0, json!({ "spp": "1", "seed": "2" }), &[]);
    assert!(picture(&view, "a") == before);
    noise(13, 9, 99).save(folder.path().join("t.png")).unwrap();
    refined(&view, &mut tab, 0, json!({ "spp": "1", "seed": "3" }), &[]);
    assert!(picture(&view, "a") != before, "the old texture is shown");
}
