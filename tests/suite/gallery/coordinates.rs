//! Textures of one material of which each has a set of coordinates and a transform of its own (KHR_texture_transform): the
//! picture is that of the same material with all of its pictures turned beforehand, read at one set without transforms.

use std::fs;

use moire::internal::core::film::Film;
use moire::internal::scene::parse;
use serde_json::{Value, json};
use tempfile::tempdir;

use super::made::document::Document;
use super::made::shapes::CORNERS;
use super::made::{pictures, shapes};
use super::seen_at_centers;

const NEAREST: u32 = 9728;
/// Texels of a side of each picture; a pixel sees one.
const SIDE: i64 = 4;

/// A map of coordinates: quarter turns clockwise of (u, v) times the signs, moved by quarters.
#[derive(Clone, Copy)]
struct Turn {
    quarters: u32,
    signs: [f64; 2],
    moved: [f64; 2],
}

impl Turn {
    const NONE: Turn = Turn { quarters: 0, signs: [1.0; 2], moved: [0.0; 2] };

    /// Sine and cosine of the rotation.
    fn turn(self) -> [f64; 2] {
        [[0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0]][self.quarters as usize]
    }

    /// As the specification writes it: translation × rotation × scale.
    fn applied(self, uv: [f64; 2]) -> [f64; 2] {
        let [sin, cos] = self.turn();
        let [u, v] = [uv[0] * self.signs[0], uv[1] * self.signs[1]];
        [cos * u + sin * v + self.moved[0], -sin * u + cos * v + self.moved[1]]
    }

    /// What the rotation and the signs make of a way, backwards.
    fn undone(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [sin, cos] = self.turn();
        [(cos * x - sin * y) * self.signs[0], (sin * x + cos * y) * self.signs[1]]
    }

    fn extension(self) -> Value {
        let rotation = f64::from(self.quarters) * std::f64::consts::FRAC_PI_2;
        json!({ "KHR_texture_transform": { "rotation": rotation, "scale": self.signs, "offset": self.moved } })
    }
}

/// The sets of coordinates of the square.
const SETS: [Turn; 5] = [
    Turn::NONE,
    Turn { quarters: 1, signs: [1.0, 1.0], moved: [0.0, 1.0] },
    Turn { quarters: 0, signs: [-1.0, 1.0], moved: [1.0, 0.25] },
    Turn { quarters: 2, signs: [1.0, 1.0], moved: [1.5, 1.0] },
    Turn { quarters: 3, signs: [1.0, -1.0], moved: [0.5, 0.0] },
];

/// The transforms of the slots.
const TRANSFORMS: [Turn; 5] = [
    Turn { quarters: 1, signs: [1.0, 1.0], moved: [0.25, 0.0] },
    Turn { quarters: 2, signs: [1.0, 1.0], moved: [0.0, 0.75] },
    Turn { quarters: 0, signs: [1.0, -1.0], moved: [0.5, 0.5] },
    Turn { quarters: 3, signs: [1.0, 1.0], moved: [0.75, 0.25] },
    Turn { quarters: 1, signs: [-1.0, 1.0], moved: [0.0, 0.25] },
];

const SLOTS: [&str; 5] = ["base colour", "metallic and roughness", "normals", "occlusion", "emission"];
const NORMALS: usize = 2;

/// A texel of a slot's picture, none like another.
fn texel(slot: usize, [x, y]: [i64; 2]) -> [u8; 3] {
    let number = (7 * x + 5 * y + 3 * slot as i64) * 37 % 101;
    let code = |k: i64| (40 + (number * k) % 170) as u8;
    match slot {
        // To one side, as far everywhere.
        NORMALS => [code(1), code(3), 235],
        _ => [code(1), code(3), code(5)],
    }
}

/// The picture of a slot, or what it shows where coordinates went this way before.
fn picture(slot: usize, way: &[Turn]) -> Vec<u8> {
    pictures::rgb([SIDE as u32; 2], |x, y| {
        let middle = [x, y].map(|i| (f64::from(i) + 0.5) / SIDE as f64);
        let uv = way.iter().fold(middle, |uv, turn| turn.applied(uv));
        let [r, g, b] = texel(slot, uv.map(|x| ((x * SIDE as f64).floor() as i64).rem_euclid(SIDE)));
        if slot != NORMALS {
            return [r, g, b];
        }
        // Along u and, upwards, against v of the turned coordinates.
        let turned = [f64::from(r) - 127.5, 127.5 - f64::from(g)];
        let [along_u, along_v] = way.iter().rev().fold(turned, |ways, turn| turn.undone(ways));
        [(127.5 + along_u) as u8, (127.5 - along_v) as u8, b]
    })
}

/// What is seen of a square in a material of five textures; `reading`: the set and the transform of each slot. `baked`: the
/// pictures are turned instead, but for one of them.
fn films(reading: [(usize, Turn); 5], baked: bool, plain: Option<usize>) -> [Film; 2] {
    let mut document = Document::default();
    document.uses("KHR_texture_transform");
    let corners = CORNERS.map(|[x, y, _]| [x + 0.5, 0.5 - y]);
    let mut square = shapes::square(&mut document);
    for (number, set) in SETS.iter().enumerate() {
        let uvs = document.floats("VEC2", corners.map(|corner| set.applied(corner)).as_flattened());
        square = square.with(&format!("TEXCOORD_{number}"), uvs);
    }
    let slots = [0, 1, 2, 3, 4].map(|slot| {
        let (set, transform) = reading[slot];
        let way: &[Turn] = if baked && plain != Some(slot) { &[SETS[set], transform] } else { &[] };
        let texture = document
            .texture(&picture(slot, way), Some(json!({ "magFilter": NEAREST, "minFilter": NEAREST })));
        match baked {
            true => json!({ "index": texture }),
            false => json!({ "index": texture, "texCoord": set, "extensions": transform.extension() }),
        }
    });
    let [base, roughness, normals, occlusion, emission] = slots;
    let material = document.push(
        "materials",
        json!({
            "pbrMetallicRoughness": { "baseColorTexture": base, "metallicRoughnessTexture": roughness },
            "normalTexture": normals, "occlusionTexture": occlusion,
            "emissiveTexture": emission, "emissiveFactor": [0.5, 0.5, 0.5]
        }),
    );
    square.stand(&mut document, material, json!({ "scale": [4, 4, 1] }));
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("m.gltf"), document.text()).unwrap();
    image::save_buffer(folder.path().join("sky.png"), &[90, 160, 220, 250], 2, 2, image::ColorType::L8)
        .unwrap();
    let text = "[camera]\neye = [0, 0, 9]\nlook_at = [0, 0, 0]\northographic_height = 4\n\
                [image]\nwidth = 4\nheight = 4\n[sampling]\nmax_depth = 0\n\
                [[texture]]\nname = 'sky'\nfile = 'sky.png'\ncolor_space = 'linear'\n\
                [background]\nenvironment = 'sky'\n[[light]]\nkind = 'environment'\n\
                [[mesh]]\nfile = 'm.gltf'\n";
    let scene = parse(&folder.path().join("scene.toml"), text).unwrap();
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    seen_at_centers(scene, [SIDE as u32; 2])
}

fn farthest(a: &Film, b: &Film) -> f32 {
    let apart = a.pixels.iter().flatten().zip(b.pixels.iter().flatten()).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f32::max)
}

#[test]
fn each_texture_has_its_own_set_and_its_own_transform() {
    let own_sets = [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4)];
    let one_set = [(0, 0), (0, 1), (0, 2), (0, 3), (0, 4)];
    let two_sets = [(1, 0), (0, 1), (1, 2), (1, 2), (0, 4)];
    for numbers in [own_sets, one_set, two_sets] {
        let reading = numbers.map(|(set, transform)| (set, TRANSFORMS[transform]));
        let [device, oracle] = films(reading, false, None);
        let [device_wanted, wanted] = films(reading, true, None);
        for (by, found, wanted, most) in
            [("by the oracle", &oracle, &wanted, 1e-4), ("on the device", &device, &device_wanted, 1e-3)]
        {
            let apart = farthest(found, wanted);
            assert!(apart < most, "{numbers:?}: {apart} {by}");
        }
        // The oracle's picture tells whether a slot is read anywhere else: ten times as far apart.
        for (slot, name) in SLOTS.iter().enumerate() {
            let [_, other] = films(reading, true, Some(slot));
            assert!(farthest(&other, &wanted) > 1e-3, "{name} is not seen: {}", farthest(&other, &wanted));
        }
    }
}

/// Two coordinates cost no records; five cost one for each texture beside the first.
#[test]
fn only_materials_of_more_than_two_coordinates_have_records() {
    let count = |reading: [(usize, Turn); 5]| {
        let mut document = Document::default();
        let square = shapes::square(&mut document);
        let texture = document.texture(&picture(0, &[]), None);
        let of = |slot: usize| json!({ "index": texture, "extensions": reading[slot].1.extension() });
        let material = json!({
            "pbrMetallicRoughness": { "baseColorTexture": of(0), "metallicRoughnessTexture": of(1) },
            "normalTexture": of(2), "occlusionTexture": of(3), "emissiveTexture": of(4)
        });
        let material = document.push("materials", material);
        square.stand(&mut document, material, json!({}));
        crate::stage::packed(super::read(&document), None).records.map_uvs.len()
    };
    let [a, b, ..] = TRANSFORMS;
    assert_eq!(count([a, b, b, a, b].map(|turn| (0, turn))), 0);
    assert_eq!(count(TRANSFORMS.map(|turn| (0, turn))), 4);
}
