//! How surfaces reflect, let through and give off light.

use std::f64::consts::FRAC_1_SQRT_2;

use serde_json::{Value, json};

use super::document::Document;
use super::pictures;
use super::shapes::{self, Shape, corner_uvs};
use super::textures::sixth;

const GOLD: [f64; 3] = [1.0, 0.77, 0.34];

fn material(
    document: &mut Document,
    [r, g, b]: [f64; 3],
    metallic: f64,
    roughness: f64,
    more: Value,
) -> usize {
    let base =
        json!({ "baseColorFactor": [r, g, b, 1], "metallicFactor": metallic, "roughnessFactor": roughness });
    let mut material = json!({ "pbrMetallicRoughness": base });
    if !more.is_null() {
        material["extensions"] = more;
    }
    document.push("materials", material)
}

fn place(ball: &Shape, document: &mut Document, material: usize, place: [f64; 3], radius: f64) {
    ball.stand(document, material, json!({ "translation": place, "scale": [radius, radius, radius] }));
}

/// Rows of metallic 0, 0.5 and 1 from below, columns of roughness 0.05 to 1.
pub fn metallic_roughness(document: &mut Document) {
    document.front_camera();
    document.sun([-1.0, 1.0, 2.0], 2.0);
    document.sun([2.0, -0.5, 1.0], 0.8);
    let ball = shapes::ball(document, 3);
    for (row, metallic) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        for (column, roughness) in [0.05, 0.25, 0.5, 0.75, 1.0].into_iter().enumerate() {
            let material = material(document, GOLD, metallic, roughness, Value::Null);
            let (x, y) = (1.15 * column as f64 - 2.3, 1.2 * row as f64 - 1.2);
            place(&ball, document, material, [x, y, 0.0], 0.52);
        }
    }
}

/// A square whose texture says where it is metal (blue) and how rough (green): four quarters.
pub fn metallic_roughness_map(document: &mut Document) {
    document.camera([0.0, 2.0, 3.4], [0.0, 0.0, 0.0], 0.6);
    let sun = |x: f64, z: f64| ([x, 1.0, z], 1.2);
    for (towards, intensity) in [sun(-0.6, -1.4), sun(0.6, -1.4)] {
        document.sun(towards, intensity);
    }
    let square = shapes::square(document);
    let map =
        pictures::rgb([2, 2], |x, y| [255, if y == 0 { 60 } else { 200 }, if x == 0 { 0 } else { 255 }]);
    let texture = document.texture(&map, Some(json!({ "magFilter": 9728 })));
    let base =
        json!({ "baseColorFactor": [1, 0.77, 0.34, 1], "metallicRoughnessTexture": { "index": texture } });
    let material = document.push("materials", json!({ "pbrMetallicRoughness": base }));
    let lying = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    square.stand(document, material, json!({ "rotation": lying, "scale": [2.8, 1.9, 1] }));
}

/// Above: reflection of strength 0, 0.5 and 1. Below: coloured red, green and blue.
pub fn specular(document: &mut Document) {
    document.uses("KHR_materials_specular");
    document.front_camera();
    document.sun([-1.0, 1.0, 1.5], 3.0);
    let ball = shapes::ball(document, 3);
    for (k, specular) in [
        json!({ "specularFactor": 0 }),
        json!({ "specularFactor": 0.5 }),
        json!({}),
        json!({ "specularColorFactor": [1, 0.1, 0.1] }),
        json!({ "specularColorFactor": [0.1, 1, 0.1] }),
        json!({ "specularColorFactor": [0.1, 0.1, 1] }),
    ]
    .into_iter()
    .enumerate()
    {
        let extensions = json!({ "KHR_materials_specular": specular });
        let material = material(document, [0.02, 0.02, 0.02], 0.0, 0.35, extensions);
        let (x, y) = (2.0 * (k % 3) as f64 - 2.0, if k < 3 { 0.95 } else { -0.95 });
        place(&ball, document, material, [x, y, 0.0], 0.85);
    }
}

/// Two dark squares, each of four quarters: alpha of one texture weakens what the surface reflects, 0 to all of it; the
/// colours of the other one tint it.
pub fn specular_map(document: &mut Document) {
    document.uses("KHR_materials_specular");
    document.camera([0.0, 2.6, 2.6], [0.0, 0.0, 0.0], 0.6);
    document.sun([-0.3, 1.0, -1.0], 2.0);
    document.sun([0.3, 1.0, -1.0], 2.0);
    let square = shapes::square(document);
    let alpha = pictures::rgba([2, 2], |x, y| [255, 0, 0, 85 * (x + 2 * y) as u8]);
    let tints = [[255, 255, 255], [255, 40, 40], [40, 255, 40], [40, 40, 255]];
    let tint = pictures::rgb([2, 2], |x, y| tints[(x + 2 * y) as usize]);
    for (x, key, picture) in [(-0.95, "specularTexture", alpha), (0.95, "specularColorTexture", tint)] {
        let texture = document.texture(&picture, Some(json!({ "magFilter": 9728 })));
        let extensions = json!({ "KHR_materials_specular": { key: { "index": texture } } });
        let material = material(document, [0.02, 0.02, 0.02], 0.0, 0.5, extensions);
        let lying = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
        let node = json!({ "translation": [x, 0, 0], "rotation": lying, "scale": [1.7, 1.7, 1] });
        square.stand(document, material, node);
    }
}

/// Red panes before a checker. Above factors 0, 0.5 and 1; below a texture whose quarters let nothing to all of the light
/// through, of a body, half a metal and a metal.
pub fn transmission(document: &mut Document) {
    document.uses("KHR_materials_transmission");
    document.uses("KHR_materials_ior");
    document.front_camera();
    document.sun([-0.5, 0.5, 2.0], 2.0);
    let square = shapes::square(document);
    checkered_wall(document, &square);
    let quarters = pictures::rgb([2, 2], |x, y| [85 * (x + 2 * y) as u8, 255, 0]);
    let texture = document.texture(&quarters, Some(json!({ "magFilter": 9728 })));
    let factor = |factor: f64| json!({ "transmissionFactor": factor });
    let map = || json!({ "transmissionFactor": 1, "transmissionTexture": { "index": texture } });
    let factors = [0.0, 0.5, 1.0].map(|share| (0.0, factor(share)));
    let metals = [0.0, 0.5, 1.0].map(|metallic| (metallic, map()));
    for (k, (metallic, transmission)) in factors.into_iter().chain(metals).enumerate() {
        // Index 1 bends no ray: what is behind the panes stays where it is.
        let extensions =
            json!({ "KHR_materials_transmission": transmission, "KHR_materials_ior": { "ior": 1 } });
        let material = material(document, [0.9, 0.3, 0.2], metallic, 0.4, extensions);
        square.stand(document, material, sixth(k));
    }
}

/// A wall of grey tiles behind everything.
fn checkered_wall(document: &mut Document, square: &Shape) {
    let uvs = document.floats("VEC2", &corner_uvs([0.0, 0.0], [12.0, 8.0]));
    let texture = document.texture(&pictures::checker(220, 60), Some(json!({ "magFilter": 9728 })));
    let behind = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
    let node = json!({ "translation": [0, 0, -2], "scale": [12, 8, 1] });
    square.with("TEXCOORD_0", uvs).stand(document, behind, node);
}

/// Balls that let all light through, of refractive index 1.0, 1.33 and 2.4, before a checker.
pub fn glass(document: &mut Document) {
    document.uses("KHR_materials_transmission");
    document.uses("KHR_materials_ior");
    document.camera([0.0, 0.6, 8.0], [0.0, 0.0, 0.0], 0.5);
    document.sun([-1.0, 1.0, 1.5], 3.0);
    let square = shapes::square(document);
    checkered_wall(document, &square);
    let ball = shapes::ball(document, 4);
    for (x, ior) in [(-1.95, 1.0), (0.0, 1.33), (1.95, 2.4)] {
        let extensions = json!({ "KHR_materials_transmission": { "transmissionFactor": 1 },
                                 "KHR_materials_ior": { "ior": ior } });
        let material = material(document, [1.0; 3], 0.0, 0.0, extensions);
        place(&ball, document, material, [x, 0.0, 0.0], 0.9);
    }
}

/// The same texture gives off light of strength 0.1, 1 and 5, and below it in one colour.
pub fn emissive(document: &mut Document) {
    document.uses("KHR_materials_emissive_strength");
    document.front_camera();
    document.sun([0.0, 0.0, 1.0], 0.2);
    let square = shapes::square(document);
    let texture = document.texture(&pictures::letter(), Some(json!({ "magFilter": 9728 })));
    for (k, strength) in [0.1, 1.0, 5.0].into_iter().enumerate() {
        let extensions = json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
        let base = json!({ "metallicFactor": 0 });
        let material = document.push(
            "materials",
            json!({ "pbrMetallicRoughness": base, "emissiveFactor": [1, 1, 1],
                    "emissiveTexture": { "index": texture }, "extensions": extensions }),
        );
        square.stand(document, material, sixth(k));
        let material = document.push(
            "materials",
            json!({ "pbrMetallicRoughness": base, "emissiveFactor": [0.2, 0.1, 0], "extensions": extensions }),
        );
        square.stand(document, material, sixth(3 + k));
    }
}

/// Lit on the left, as it is on the right.
pub fn unlit(document: &mut Document) {
    document.front_camera();
    document.sun([-1.0, 1.0, 1.0], 3.0);
    let ball = shapes::ball(document, 3);
    let lit = material(document, GOLD, 0.0, 0.6, Value::Null);
    place(&ball, document, lit, [-1.4, 0.0, 0.0], 1.2);
    let [r, g, b] = GOLD;
    let plain = document.unlit(json!({ "baseColorFactor": [r, g, b, 1] }));
    place(&ball, document, plain, [1.4, 0.0, 0.0], 1.2);
}
