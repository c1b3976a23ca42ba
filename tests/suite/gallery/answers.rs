//! What follows from a file alone, of its textures. Complaints: no sampler means repeated and trilinear (1); transforms turn
//! the right way, in every slot (2); sizes that are no powers of two, and charts side by side (9); 16 bits, and sets of
//! coordinates (10).

use std::f64::consts::FRAC_PI_2;

use moire::internal::core::color::srgb_to_linear;
use moire::internal::scene::model::{Quantity, Scene};
use serde_json::json;

use super::made::document::Document;
use super::made::shapes::corner_uvs;
use super::made::{pictures, shapes};
use super::{near, pixel, read, seen, seen_at_centers};

const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;

/// Reads a file whose surfaces show their emission alone: with a light that reaches nothing, in place of those under which
/// files without any are seen, and without what surfaces mirror.
fn read_dark(document: &mut Document) -> Scene {
    document.light(json!({ "type": "point", "intensity": 0 }), json!({ "translation": [0, 0, 9] }));
    let mut scene = read(document);
    scene.sampling.max_depth = 0;
    scene
}

fn linear(texel: [u8; 3]) -> [f64; 3] {
    texel.map(|code| srgb_to_linear(f64::from(code) / 255.0))
}

/// Complaint 1: 160 × 160 fields of a checker on 18 × 18 pixels.
#[test]
fn without_a_sampler_or_with_an_empty_one_a_fine_checker_is_grey() {
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let uvs = document.floats("VEC2", &corner_uvs([0.0, 0.0], [80.0, 80.0]));
    let square = square.with("TEXCOORD_0", uvs);
    for (x, sampler) in [(-2, None), (0, Some(json!({}))), (2, Some(json!({ "minFilter": NEAREST })))] {
        let texture = document.texture(&pictures::checker(255, 0), sampler);
        let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
        square.stand(&mut document, material, json!({ "translation": [x, 0, 0], "scale": [1.8, 1.8, 1] }));
    }
    for film in seen(read(&document), [60, 40]) {
        let farthest = |first: u32| {
            let pixels = (13..27).flat_map(|y| (first..first + 14).map(move |x| (x, y)));
            pixels.map(|(x, y)| (pixel(&film, x, y)[0] - 0.5).abs()).fold(0.0, f64::max)
        };
        let [absent, empty, named] = [3, 23, 43].map(farthest);
        assert!(absent <= 1.0 / 255.0 && empty <= 1.0 / 255.0, "{absent} {empty}");
        assert!(named > 0.05, "a sampler without levels is not obeyed: {named}");
    }
}

/// Complaint 1: coordinates from −1 to 2 over four texels, by the formula of linear filters.
#[test]
fn without_a_sampler_texels_repeat_and_are_blended() {
    let codes = [0u8, 90, 160, 255];
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let uvs = document.floats("VEC2", &corner_uvs([-1.0, 0.0], [2.0, 1.0]));
    let texture = document.texture(&pictures::rgb([4, 1], |x, _| [codes[x as usize]; 3]), None);
    let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
    square.with("TEXCOORD_0", uvs).stand(&mut document, material, json!({ "scale": [6, 4, 1] }));
    for film in seen_at_centers(read(&document), [60, 40]) {
        for x in 0..60 {
            let place = 4.0 * (3.0 * (f64::from(x) + 0.5) / 60.0 - 1.0) - 0.5;
            let texel = |i: f64| linear([codes[i.rem_euclid(4.0) as usize]; 3])[0];
            let share = place - place.floor();
            let wanted = texel(place.floor()) * (1.0 - share) + texel(place.floor() + 1.0) * share;
            let found = pixel(&film, x, 20);
            assert!(near(found, [wanted; 3], 1e-3), "pixel {x}: {found:?}, not {wanted}");
        }
    }
}

/// Complaint 2: a quarter of a turn puts the picture's lower left texel at its upper left, clockwise, wherever the texture
/// is used: u' = v, v' = −u.
#[test]
fn a_rotation_turns_the_picture_clockwise_in_every_slot() {
    let texels = [[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]];
    let turned = [[[0, 0, 255], [255, 0, 0]], [[255, 255, 255], [0, 255, 0]]];
    let mut document = Document::default();
    document.uses("KHR_texture_transform");
    document.front_camera();
    let square = shapes::square(&mut document);
    let picture = pictures::rgb([2, 2], |x, y| texels[y as usize][x as usize]);
    let texture = document.texture(&picture, Some(json!({ "magFilter": NEAREST })));
    let plain = json!({ "index": texture });
    let turn =
        json!({ "index": texture, "extensions": { "KHR_texture_transform": { "rotation": FRAC_PI_2 } } });
    let base = document.unlit(json!({ "baseColorTexture": turn }));
    let emission = |base, emission| {
        json!({ "pbrMetallicRoughness": { "baseColorTexture": base },
                "emissiveTexture": emission, "emissiveFactor": [1, 1, 1] })
    };
    let alone = document.push("materials", emission(&plain, &turn));
    let other = document.push("materials", emission(&turn, &plain));
    for (x, material) in [(-2, base), (0, alone), (2, other)] {
        square.stand(&mut document, material, json!({ "translation": [x, 0, 0], "scale": [2, 2, 1] }));
    }
    for film in seen_at_centers(read_dark(&mut document), [12, 8]) {
        for (panel, wanted) in [turned, turned, texels].into_iter().enumerate() {
            for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let found = pixel(&film, 4 * panel as u32 + 1 + 2 * column as u32, 3 + 2 * row as u32);
                let wanted = linear(wanted[row][column]);
                assert!(
                    near(found, wanted, 1e-4),
                    "panel {panel}, {row} {column}: {found:?}, not {wanted:?}"
                );
            }
        }
    }
}

/// Complaint 2: a normal map moved by half its width swaps its halves, under a base colour that stays.
#[test]
fn a_transform_moves_a_normal_map_alone() {
    let mut document = Document::default();
    document.uses("KHR_texture_transform");
    document.front_camera();
    let square = shapes::square(&mut document);
    let map = pictures::rgb([2, 1], |x, _| if x == 0 { [218, 128, 218] } else { [38, 128, 218] });
    let map = document.texture(&map, Some(json!({ "magFilter": NEAREST })));
    let colors = pictures::rgb([2, 1], |x, _| if x == 0 { [255, 0, 0] } else { [0, 0, 255] });
    let colors = document.texture(&colors, Some(json!({ "magFilter": NEAREST })));
    for (x, offset) in [(-1.5, 0.0), (1.5, 0.5)] {
        let moved =
            json!({ "index": map, "extensions": { "KHR_texture_transform": { "offset": [offset, 0] } } });
        let base = json!({ "baseColorTexture": { "index": colors }, "metallicFactor": 0 });
        let material =
            document.push("materials", json!({ "pbrMetallicRoughness": base, "normalTexture": moved }));
        square.stand(&mut document, material, json!({ "translation": [x, 0, 0], "scale": [3, 3, 1] }));
    }
    let mut scene = read(&document);
    for (quantity, signs) in
        [(Quantity::Normal, [1.0, -1.0, -1.0, 1.0]), (Quantity::Albedo, [1.0, -1.0, 1.0, -1.0])]
    {
        scene.sampling.quantity = quantity;
        for film in seen_at_centers(scene.clone(), [12, 8]) {
            for (k, sign) in signs.into_iter().enumerate() {
                let [x, _, z] = pixel(&film, 1 + 3 * k as u32, 4);
                let found = if quantity == Quantity::Normal { x } else { x - z };
                assert!(found * sign > 0.5, "{quantity:?} of half {k}: {found}");
            }
        }
    }
}

/// Complaint 9: two copies of 100 × 37 texels, one a pixel.
#[test]
fn sizes_that_are_no_powers_of_two_repeat_exactly() {
    let texel = |x: u32, y: u32| [(x * 2) as u8, (y * 6) as u8, ((x * 7 + y * 13) % 256) as u8];
    let picture = pictures::rgb([100, 37], texel);
    for filter in [NEAREST, LINEAR] {
        let mut document = Document::default();
        document.front_camera();
        let square = shapes::square(&mut document);
        let uvs = document.floats("VEC2", &corner_uvs([0.0, 0.0], [2.0, 1.0]));
        let sampler = json!({ "magFilter": filter, "minFilter": filter });
        let texture = document.texture(&picture, Some(sampler));
        let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
        // 40 pixels a unit; half a pixel upwards, so that texels are pixels.
        let node = json!({ "translation": [0, 0.0125, 0], "scale": [5, 0.925, 1] });
        square.with("TEXCOORD_0", uvs).stand(&mut document, material, node);
        for film in seen_at_centers(read(&document), [240, 160]) {
            for (x, y) in (0..37).flat_map(|y| (0..200).map(move |x| (x, y))) {
                let (found, wanted) = (pixel(&film, 20 + x, 61 + y), linear(texel(x % 100, y)));
                assert!(near(found, wanted, 1e-3), "{filter}: texel {x}, {y}: {found:?}, not {wanted:?}");
            }
        }
    }
}

/// Complaint 9: charts that end half a texel before the gutter, few and many texels a pixel.
#[test]
fn charts_do_not_mix_at_level_0() {
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let atlas = pictures::rgb([32, 8], |x, _| match x {
        0..12 => [255, 0, 0],
        20.. => [0, 0, 255],
        _ => [0, 255, 0],
    });
    let texture = document.texture(&atlas, Some(json!({ "magFilter": LINEAR, "minFilter": LINEAR })));
    let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
    for (y, first) in [(1.0, 0.5), (-1.0, 20.5)] {
        let uvs = document.floats("VEC2", &corner_uvs([first / 32.0, 0.0], [(first + 11.0) / 32.0, 1.0]));
        for (x, side) in [(-1.5, 1.6), (1.5, 0.2)] {
            let node = json!({ "translation": [x, y, 0], "scale": [side, side, 1] });
            square.with("TEXCOORD_0", uvs).stand(&mut document, material, node);
        }
    }
    for film in seen(read(&document), [60, 40]) {
        let mut counts = [0; 2];
        for found in film.pixels.iter().map(|pixel| pixel.map(f64::from)) {
            // The ground is grey, and an edge may share its pixel with it.
            let [r, g, b] = found;
            let (shown, chart) = if r > b { (r, 0) } else { (b, 1) };
            if shown > 0.99 {
                counts[chart] += 1;
                assert!(near([r + b - shown, g, 0.0], [0.0; 3], 1e-6), "{found:?}");
            }
            assert!(g <= 0.19, "the gutter is seen: {found:?}");
        }
        assert!(counts.iter().all(|&count| count > 240), "{counts:?}");
    }
}

/// Complaint 10: four codes that are all 128 in 8 bits.
#[test]
fn a_png_of_16_bits_keeps_them() {
    let codes = [32_800u16, 32_864, 32_928, 32_992];
    assert!(codes.iter().all(|code| code / 256 == 128));
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let picture = pictures::grey16([4, 1], |x, _| codes[x as usize]);
    let texture = document.texture(&picture, Some(json!({ "magFilter": NEAREST })));
    let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
    square.stand(&mut document, material, json!({ "scale": [6, 4, 1] }));
    for film in seen_at_centers(read(&document), [12, 8]) {
        for (k, code) in codes.into_iter().enumerate() {
            let wanted = srgb_to_linear(f64::from(code) / 65535.0);
            let found = pixel(&film, 1 + 3 * k as u32, 4);
            assert!(near(found, [wanted; 3], 1e-5), "{code}: {found:?}, not {wanted}");
        }
    }
}

/// Complaint 10: the colour at the second set of coordinates, the emission at the first, and a mesh that lacks one.
#[test]
fn each_texture_is_read_at_its_own_set_and_a_missing_one_is_told() {
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let texels = [[255, 0, 0], [0, 0, 255]];
    let picture = pictures::rgb([2, 1], |x, _| texels[x as usize]);
    let texture = document.texture(&picture, Some(json!({ "magFilter": NEAREST })));
    let at = |u: f64| [u, 0.5].repeat(4);
    let [left, right] = [0.25, 0.75].map(|u| document.floats("VEC2", &at(u)));
    let both = square.with("TEXCOORD_0", right).with("TEXCOORD_1", left);
    let second = json!({ "index": texture, "texCoord": 1 });
    let colored = document.unlit(json!({ "baseColorTexture": second }));
    let glowing = json!({ "name": "glowing", "pbrMetallicRoughness": { "baseColorTexture": second },
                          "emissiveTexture": { "index": texture }, "emissiveFactor": [1, 1, 1] });
    let glowing = document.push("materials", glowing);
    let lacking = json!({ "name": "lacking", "pbrMetallicRoughness": { "baseColorTexture": second },
                          "extensions": { "KHR_materials_unlit": {} } });
    let lacking = document.push("materials", lacking);
    both.stand(&mut document, colored, json!({ "translation": [-2, 0, 0], "scale": [2, 2, 1] }));
    both.stand(&mut document, glowing, json!({ "scale": [2, 2, 1] }));
    square.with("TEXCOORD_0", right).stand(
        &mut document,
        lacking,
        json!({ "translation": [2, 0, 0], "scale": [2, 2, 1] }),
    );
    let scene = read_dark(&mut document);
    let [note] = &scene.notes[..] else { panic!("{:?}", scene.notes) };
    assert!(["lacking", "TEXCOORD_1", "(0, 0)"].iter().all(|part| note.contains(part)), "{note}");
    for film in seen_at_centers(scene, [12, 8]) {
        let [red, blue] = texels.map(linear);
        for (x, wanted) in [(2, red), (6, blue), (10, red)] {
            let found = pixel(&film, x, 4);
            assert!(near(found, wanted, 1e-4), "pixel {x}: {found:?}, not {wanted:?}");
        }
    }
}
