//! What the page says of a pixel agrees with the layers of a render, and with the picture.

use moire::internal::core::progress::NoProgress;
use moire::internal::render::layers::{Aov, render_layers};
use moire::internal::render::{On, Options, render_scene};
use moire::internal::scene::changes::Changes;
use moire::internal::scene::load;
use moire::internal::scene::prune::prune;
use serde_json::{Value, json};

use super::{View, refined};
use crate::stage::path;

const SIZE: [u32; 2] = [24, 18];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

fn near(a: &Value, b: f32, what: &str) {
    let (a, b) = (number(a), f64::from(b));
    assert!((a - b).abs() <= 1e-5 * b.abs().max(1.0), "{what}: {a} and {b}");
}

/// Compares every pixel of a small picture of a scene.
fn compare(name: &str, mip: &str, filter: &str) {
    let arguments = ["--size", "24x18", "--spp", "4", "--mip", mip, "--filter", filter, "--device", "oracle"];
    let view = View::of_file(&std::path::absolute(path(name)).unwrap(), &arguments);
    let mut tab = view.tab("t");
    assert!(tab.done()["sides"][0]["failure"].is_null());
    let mut scene = load(&path(name)).unwrap();
    let mip = moire::internal::texture::sampler_spec::LevelUse::from_name(mip);
    let filter = moire::internal::texture::sampler_spec::Filter::from_name(filter);
    Changes { size: Some(SIZE), spp: Some(4), mip, filter, ..Changes::default() }.apply(&mut scene).unwrap();
    prune(&mut scene);
    let (options, on) = (Options::default(), [On::Oracle]);
    let wanted = [Aov::Uv, Aov::Level, Aov::Texels, Aov::Depth, Aov::Material];
    let layers = render_layers(&scene, &options, &on, &wanted, None, &NoProgress).unwrap();
    let film = render_scene(&scene, &options, &on, &NoProgress).unwrap().film;
    let (mut textured, mut met) = (0, 0);
    for y in 0..SIZE[1] {
        for x in 0..SIZE[0] {
            let at = (y * SIZE[0] + x) as usize;
            let told = view.get(&format!("pixel?tab=t&side=a&x={x}&y={y}")).json();
            let what = format!("{name} at {x}, {y}: {told:.400}");
            for c in 0..3 {
                let shown = number(&told["value"]["linear"][c]);
                assert!((shown - f64::from(film.pixels[at][c])).abs() < 1e-6, "{what}");
            }
            let [uv, level, texels, depth, material] = &layers[..] else { unreachable!() };
            let surface = &told["surface"];
            assert_eq!(surface.is_object(), depth.present[at], "{what}");
            if surface.is_object() {
                met += 1;
                near(&surface["depth"], depth.channels[0].values[at], &what);
                let own = &scene.materials[material.channels[0].values[at] as usize - 1].name;
                assert!(own.is_empty() || surface["material"] == own.as_str(), "{what}");
            }
            if uv.present[at] {
                textured += 1;
                let look_up = told["look_ups"].as_array().unwrap().iter().find(|own| own["size"].is_array());
                let look_up = look_up.unwrap_or_else(|| panic!("no look-up: {what}"));
                for c in 0..2 {
                    near(&look_up["place"][c], uv.channels[c].values[at], &what);
                    near(&look_up["texels"][c], texels.channels[c].values[at], &what);
                }
                near(&look_up["level"], level.channels[0].values[at], &what);
                let window = &look_up["window"];
                let side = number(&window["side"]);
                assert!((0..2).all(|c| (number(&window["centre"][c]) / side - 0.5).abs() < 0.1), "{what}");
            }
        }
    }
    assert!(textured > 20 && met > 20, "{textured} pixels with textures, {met} with surfaces");
}

#[test]
fn pixels_agree_with_layers_and_the_picture() {
    compare("horizon", "linear", "linear");
    compare("horizon", "linear", "ewa");
    compare("lecture", "none", "nearest");
    compare("environment", "nearest", "anisotropic");
}

#[test]
fn samples_lie_where_the_pattern_has_them_and_say_what_they_meet() {
    let view = View::of("lecture", &["--size", "24x18"]);
    let mut tab = view.tab("t");
    refined(&view, &mut tab, 0, json!({ "pattern": "grid", "spp": "16", "size": "24x18" }), &[]);
    let mut most = 0;
    for at in 0..24 {
        let told = view.get(&format!("pixel?tab=t&side=a&x={at}&y=9")).json();
        let samples = told["samples"].as_array().unwrap();
        let mut places: Vec<[f64; 2]> =
            samples.iter().map(|own| [number(&own[0]), number(&own[1])]).collect();
        places.sort_by(|a, b| a.partial_cmp(b).unwrap());
        let grid = (0..4).flat_map(|x| (0..4).map(move |y| [x, y].map(|i| (f64::from(i) + 0.5) / 4.0)));
        for (own, wanted) in places.iter().zip(grid) {
            assert!((0..2).all(|c| (own[c] - wanted[c]).abs() < 1e-6), "{own:?} and {wanted:?}");
        }
        let surfaces = told["surfaces"].as_array().unwrap();
        most = most.max(surfaces.len());
        let all: f64 = surfaces.iter().map(|own| number(&own["samples"])).sum();
        assert_eq!((samples.len(), all), (16, 16.0));
        assert!(samples.iter().all(|own| number(&own[2]) < surfaces.len() as f64));
    }
    assert!(most >= 2, "no pixel of the row has two surfaces");
}

#[test]
fn computed_textures_show_the_footprint_too() {
    let view = View::of("procedural", &["--size", "24x18", "--spp", "1"]);
    let mut tab = view.tab("t");
    tab.done();
    let told = view.get("pixel?tab=t&side=a&x=12&y=12").json();
    let look_up = &told["look_ups"][0];
    assert!(look_up["size"].is_null() && look_up["window"]["level"].is_null(), "{told}");
    assert!(look_up["window"]["png"].as_str().unwrap().len() > 100);
}
