//! What `moire inspect` says of all the maps of a material, of images that are read more than once, and of models.

use std::fs;
use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::core::layer::Layer;
use moire::internal::lab::inspect::survey::{Seen, Survey, View, survey};
use moire::internal::lab::inspect::uses::Slot;
use moire::internal::lab::inspect::{Coordinates, charts, readers};
use moire::internal::output::{WriteOptions, write};
use moire::internal::render::layers::{Aov, packed_at_centres};
use moire::internal::render::{On, Options};
use moire::internal::scene::model::Scene;
use moire::internal::scene::{self, prune::prune};

use super::{DOWN, layers, stage};
use crate::stage::device_name;
use crate::support::{data, gradient};

fn surveyed(scene: &Scene) -> Survey {
    survey(scene, &packed_at_centres(scene, &Options::default()).unwrap())
}

fn loaded(path: &Path) -> Scene {
    let mut scene = scene::load(path).unwrap();
    prune(&mut scene);
    scene
}

/// The plane of `DOWN`, four texels of `t.png` a pixel, with these textures and keys of its material, beside an image `o.png`
/// of half the size.
fn with_maps<T>(textures: &str, keys: &str, with: impl FnOnce(Scene) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    write(&gradient(32, 32), &folder.path().join("o.png"), &WriteOptions::default()).unwrap();
    let text = DOWN
        .replace("[[sampler]]", &format!("{textures}\n[[sampler]]"))
        .replace("model = \"unlit\"\ntexture = \"t\"", keys)
        .replace("scale = [0.5, 0.25]", "scale = [0.5, 0.5]");
    with(loaded(&stage(folder.path(), &text)))
}

fn uses(view: &View) -> Vec<(Slot, u64)> {
    view.uses.iter().map(|own| (own.slot, own.pixels)).collect()
}

#[test]
fn every_map_of_a_material_is_looked_at_and_an_image_is_listed_once() {
    let textures = "[[texture]]\nname = 'numbers'\nfile = 't.png'\ncolor_space = 'linear'\n\
                    [[texture]]\nname = 'o'\nfile = 'o.png'\ncolor_space = 'linear'\n\
                    [[texture]]\nname = 'e'\nfile = 'o.png'\n";
    let keys = "model = 'metallic-roughness'\ntexture = 't'\nnormal_map = 'numbers'\n\
                metallic_roughness_map = 'o'\nocclusion_map = 'o'\nemission_map = 'e'";
    with_maps(textures, keys, |scene| {
        let found = surveyed(&scene);
        assert_eq!(found.views.len(), 2, "{found:?}");
        assert_eq!(found.untextured, 0);
        assert_eq!(found.seen, Seen { textured: 256, minified: 256, elongated: 0, magnified: 0 });
        let [t, o] = [&found.views[0], &found.views[1]];
        assert_eq!(uses(t), [(Slot::Color, 256), (Slot::Bump, 256)]);
        assert_eq!(uses(o), [(Slot::Roughness, 256), (Slot::Emission, 256), (Slot::Occlusion, 256)]);
        assert_eq!([t.textures.len(), o.textures.len()], [2, 2]);
        for (view, length, level) in [(t, 4.0, 2), (o, 2.0, 1)] {
            assert_eq!(view.density.pixels(), 256, "a pixel counts once");
            assert_eq!(view.density.quantile(0.0), Some(length));
            assert_eq!(view.density.quantile(1.0), Some(length));
            assert_eq!(view.level_pixels[level], 256);
            assert_eq!(view.level_pixels.iter().sum::<u64>(), 256);
            assert_eq!(view.never_read.unwrap().cells, 0);
        }
        let words: Vec<String> = t.uses.iter().map(|own| own.words(&scene)).collect();
        assert_eq!(words, ["colour of m (256 pixels)", "normal map of m (256 pixels)"]);
    });
}

#[test]
fn a_map_without_a_texture_of_the_colour_is_read_too() {
    for (keys, slot) in [
        ("normal_map = 't'", Slot::Bump),
        ("bump_map = 't'", Slot::Bump),
        ("metallic_roughness_map = 't'", Slot::Roughness),
        ("emission_map = 't'", Slot::Emission),
        ("occlusion_map = 't'", Slot::Occlusion),
        ("specular_weight_map = 't'", Slot::SpecularWeight),
        ("specular_tint_map = 't'", Slot::SpecularTint),
        ("transmission = 1\ntransmission_texture = 't'", Slot::Transmission),
    ] {
        with_maps("", &format!("model = 'metallic-roughness'\n{keys}"), |scene| {
            let found = surveyed(&scene);
            assert_eq!((found.views.len(), found.seen.textured), (1, 256), "{keys}");
            assert_eq!(uses(&found.views[0]), [(slot, 256)], "{keys}");
        });
    }
}

/// The layers of look-ups of the plane, on the oracle and on the device.
fn look_ups(keys: &str) -> [Vec<Layer>; 2] {
    let wanted = [Aov::Texels, Aov::Magnification, Aov::Level, Aov::Anisotropy, Aov::Uv];
    let textures = "[[texture]]\nname = 'o'\nfile = 'o.png'\ncolor_space = 'linear'\n";
    let keys = format!("model = 'metallic-roughness'\n{keys}");
    with_maps(textures, &keys, |scene| {
        [On::Oracle, On::parse(&device_name()).unwrap()].map(|on| layers(&scene, on, &wanted))
    })
}

/// Of a texture of which a pixel covers this many texels: four of `t.png`, two of `o.png`.
fn assert_shows(found: &[Vec<Layer>; 2], texels: f32, what: &str) {
    for layers in found {
        let is = |layer: usize, wanted: f32| {
            layers[layer].first_values().all(|value| (value - wanted).abs() < 1e-3)
        };
        assert!(
            layers.iter().all(|layer| layer.present.iter().all(|present| *present)),
            "{what}: of every pixel"
        );
        assert!(
            is(0, texels) && is(1, -texels.log2()) && is(2, texels.log2()) && is(3, 1.0),
            "{what}: {layers:?}"
        );
    }
    let [oracle, device] = found.each_ref().map(|layers| layers.iter().flat_map(|layer| &layer.channels));
    for (oracle, device) in oracle.zip(device) {
        let far = oracle.values.iter().zip(&device.values).any(|(a, b)| (a - b).abs() > 1e-3);
        assert!(!far, "{what}: {oracle:?} {device:?}");
    }
}

#[test]
fn layers_of_look_ups_show_the_first_map_where_the_colour_has_no_texture() {
    let color = look_ups("texture = 't'");
    assert_shows(&color, 4.0, "colour");
    for map in [
        "normal_map",
        "bump_map",
        "metallic_roughness_map",
        "emission_map",
        "occlusion_map",
        "specular_weight_map",
        "specular_tint_map",
        "transmission_texture",
    ] {
        let found = look_ups(&format!("{map} = 't'"));
        assert_shows(&found, 4.0, map);
        assert_eq!(found, color, "{map}: every layer is that of the same texture");
        assert_shows(&look_ups(&format!("texture = 't'\n{map} = 'o'")), 4.0, "the colour comes first");
    }
    assert_shows(
        &look_ups("normal_map = 't'\nmetallic_roughness_map = 'o'"),
        4.0,
        "relief before the other maps",
    );
    assert_shows(&look_ups("emission_map = 'o'\nocclusion_map = 't'"), 2.0, "in their order");
    let none = look_ups("color = [1, 1, 1]");
    assert!(none.iter().flatten().all(|layer| !layer.present.contains(&true)), "without any");
}

#[test]
fn an_image_of_one_texel_is_a_colour_that_no_filter_changes() {
    let folder = tempfile::tempdir().unwrap();
    let path = stage(folder.path(), DOWN);
    write(&Film::new(1, 1, 1), &folder.path().join("t.png"), &WriteOptions::default()).unwrap();
    let found = surveyed(&loaded(&path));
    assert_eq!(found.seen, Seen { textured: 256, ..Seen::default() });
}

#[test]
fn charts_are_those_of_the_coordinates_that_a_map_reads() {
    let scene = loaded(&data().join("gallery/uv_sets.gltf"));
    let all = readers(&scene, &(0..scene.textures.len()).collect::<Vec<_>>());
    let reads = |coordinates| all.iter().any(|own| own.1 == coordinates);
    assert!(reads(Coordinates::First) && reads(Coordinates::Second), "{all:?}");
    for reader in &all {
        let found = charts(&scene, &[*reader], [64, 64], 7);
        assert!(found.is_none_or(|charts| charts.count > 0));
    }
    assert_eq!(charts(&scene, &[], [64, 64], 7), None);
}

#[test]
fn textures_of_models_have_the_name_of_the_file_or_of_the_image() {
    let folder = tempfile::tempdir().unwrap();
    let model = fs::read_to_string(data().join("gallery/normal_map.gltf")).unwrap();
    let mut model: serde_json::Value = serde_json::from_str(&model).unwrap();
    let bytes = model["images"][0]["uri"].clone();
    write(&gradient(8, 8), &folder.path().join("a b.png"), &WriteOptions::default()).unwrap();
    for (uri, image, texture, name) in [
        ("a%20b.png".into(), "picture", "texture", "a b.png"),
        (bytes.clone(), "picture", "texture", "picture"),
        (bytes.clone(), "", "texture", "texture"),
        (bytes, "", "", "image 0"),
    ] {
        (model["images"][0]["uri"], model["images"][0]["name"]) = (uri, image.into());
        model["textures"][0]["name"] = texture.into();
        let path = folder.path().join("m.gltf");
        fs::write(&path, model.to_string()).unwrap();
        assert_eq!(loaded(&path).textures[0].name, name);
    }
}

#[test]
fn the_size_that_an_image_needs_is_that_of_the_use_that_magnifies_most() {
    let folder = tempfile::tempdir().unwrap();
    let model = fs::read_to_string(data().join("gallery/normal_map.gltf")).unwrap();
    let mut model: serde_json::Value = serde_json::from_str(&model).unwrap();
    model["materials"][0]["emissiveFactor"] = serde_json::json!([1, 1, 1]);
    model["materials"][0]["emissiveTexture"] = serde_json::json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [0.25, 0.25] } } });
    let path = folder.path().join("m.gltf");
    fs::write(&path, model.to_string()).unwrap();
    let found = surveyed(&loaded(&path));
    let view =
        found.views.iter().find(|view| view.uses.iter().any(|own| own.slot == Slot::Emission)).unwrap();
    assert!(view.uses.len() > 1, "{:?}", view.uses);
    let [all, closest] = [&view.density, &view.closest].map(|density| density.quantile(0.5).unwrap());
    assert!((all / closest - 4.0).abs() < 1e-6, "{all} and {closest}");
}

#[test]
fn a_material_without_a_name_has_its_number() {
    with_maps("", "texture = 't'", |mut scene| {
        scene.materials[0].name = String::new();
        let words = surveyed(&scene).views[0].uses[0].words(&scene);
        assert_eq!(words, "colour of material 1 (256 pixels)");
    });
}
