//! What covers a surface beside its colour: colours of vertices, alpha, sides, relief and occlusion.

use serde_json::json;

use super::document::{Document, U8, U16};
use super::pictures;
use super::shapes::{self, Shape, corner_uvs};
use super::textures::sixth;

/// The same four colours in 8 bits, 16 bits and floats, half of them multiplied by a texture.
pub fn vertex_colors(document: &mut Document) {
    document.front_camera();
    let square = shapes::square(document);
    let colors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.5]];
    let codes = |most: f64| colors.map(|[r, g, b]| [r, g, b, 1.0].map(|c| (most * c).round()));
    let bytes: Vec<u8> = codes(255.0).as_flattened().iter().map(|&c| c as u8).collect();
    let view = document.view(&bytes, None);
    let kind = |view: usize, component: u32| json!({ "bufferView": view, "componentType": component, "normalized": true, "count": 4, "type": "VEC4" });
    let eight = document.push("accessors", kind(view, U8));
    let bytes: Vec<u8> =
        codes(65535.0).as_flattened().iter().flat_map(|&c| (c as u16).to_le_bytes()).collect();
    let view = document.view(&bytes, None);
    let sixteen = document.push("accessors", kind(view, U16));
    let floats = document.floats("VEC3", colors.as_flattened());
    let texture = document.texture(&pictures::letter(), Some(json!({ "magFilter": 9728 })));
    let plain = document.unlit(json!({}));
    let textured = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
    for (row, material) in [plain, textured].into_iter().enumerate() {
        for (column, colors) in [eight, sixteen, floats].into_iter().enumerate() {
            square.with("COLOR_0", colors).stand(document, material, sixth(3 * row + column));
        }
    }
}

/// One texture whose alpha falls outwards, before a checker. Above: opaque, a mask, blended. Below: masks with the
/// cutoffs 0.1 and 0.9, and blended with half the alpha.
pub fn alpha(document: &mut Document) {
    document.front_camera();
    let square = shapes::square(document);
    let checker = document.texture(&pictures::checker(200, 120), Some(json!({ "magFilter": 9728 })));
    let uvs = document.floats("VEC2", &corner_uvs([0.0, 0.0], [12.0, 8.0]));
    let behind = document.unlit(json!({ "baseColorTexture": { "index": checker } }));
    let node = json!({ "translation": [0, 0, -1], "scale": [6, 4, 1] });
    square.with("TEXCOORD_0", uvs).stand(document, behind, node);
    let sampler = json!({ "wrapS": 33071, "wrapT": 33071 });
    let leaf = document.texture(&pictures::leaf(), Some(sampler));
    for (k, (mode, cutoff, factor)) in [
        ("OPAQUE", None, 1.0),
        ("MASK", None, 1.0),
        ("BLEND", None, 1.0),
        ("MASK", Some(0.1), 1.0),
        ("MASK", Some(0.9), 1.0),
        ("BLEND", None, 0.5),
    ]
    .into_iter()
    .enumerate()
    {
        document.uses("KHR_materials_unlit");
        let base = json!({ "baseColorTexture": { "index": leaf }, "baseColorFactor": [1, 1, 1, factor] });
        let mut material = json!({ "pbrMetallicRoughness": base, "alphaMode": mode,
                                   "extensions": { "KHR_materials_unlit": {} } });
        if let Some(cutoff) = cutoff {
            material["alphaCutoff"] = json!(cutoff);
        }
        let material = document.push("materials", material);
        square.stand(document, material, sixth(k));
    }
}

/// Above two-sided, below one-sided: from the front, turned by 50 degrees, and from behind.
pub fn sides(document: &mut Document) {
    document.front_camera();
    document.sun([0.0, 1.0, 2.0], 3.0);
    let square = shapes::square(document);
    let texture = document.texture(&pictures::letter(), Some(json!({ "magFilter": 9728 })));
    for (row, both) in [true, false].into_iter().enumerate() {
        let base = json!({ "baseColorTexture": { "index": texture }, "metallicFactor": 0 });
        let material =
            document.push("materials", json!({ "pbrMetallicRoughness": base, "doubleSided": both }));
        let turns = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.422_618_262, 0.0, 0.906_307_787], [0.0, 1.0, 0.0, 0.0]];
        for (column, turn) in turns.into_iter().enumerate() {
            let mut node = sixth(3 * row + column);
            node["rotation"] = json!(turn);
            square.stand(document, material, node);
        }
    }
}

/// Domes, lit from the upper left, with coordinates upright, mirrored along u and along v. Above without tangents; below
/// with those of the file, the last one under a node that mirrors.
pub fn normal_map(document: &mut Document) {
    document.front_camera();
    document.sun([-1.0, 1.0, 1.0], 3.0);
    let square = shapes::square(document);
    let texture = document.texture(&pictures::domes(), None);
    let base = json!({ "baseColorFactor": [0.8, 0.7, 0.5, 1], "metallicFactor": 0, "roughnessFactor": 0.7 });
    let material = document
        .push("materials", json!({ "pbrMetallicRoughness": base, "normalTexture": { "index": texture } }));
    let mirrored_u = document.floats("VEC2", &corner_uvs([1.0, 0.0], [0.0, 1.0]));
    let mirrored_v = document.floats("VEC2", &corner_uvs([0.0, 1.0], [1.0, 0.0]));
    let along = document.floats("VEC4", [[1.0, 0.0, 0.0, 1.0]; 4].as_flattened());
    let against = document.floats("VEC4", [[-1.0, 0.0, 0.0, -1.0]; 4].as_flattened());
    let [by_u, by_v] = [mirrored_u, mirrored_v].map(|uvs| square.with("TEXCOORD_0", uvs));
    let panels: [(&Shape, Option<usize>, f64); 6] = [
        (&square, None, 1.0),
        (&by_u, None, 1.0),
        (&by_v, None, 1.0),
        (&square, Some(along), 1.0),
        (&by_u, Some(against), 1.0),
        (&square, Some(along), -1.0),
    ];
    for (k, (shape, tangents, sign)) in panels.into_iter().enumerate() {
        let mut node = sixth(k);
        node["scale"] = json!([sign * 1.7, 1.7, 1]);
        match tangents {
            Some(tangents) => shape.with("TANGENT", tangents).stand(document, material, node),
            None => shape.stand(document, material, node),
        }
    }
}

/// The map of occlusion of a grid of grooves: without it, at half and at full strength. Only light from all around is
/// held back, which the scene `occlusion.toml` has.
pub fn occlusion(document: &mut Document) {
    document.front_camera();
    let square = shapes::square(document);
    let map = pictures::rgb([16, 16], |x, y| {
        let open = [x, y].map(|i| (i % 8).min(7 - i % 8).min(2) as u8);
        [85 + 85 * open[0].min(open[1]); 3]
    });
    let texture = document.texture(&map, None);
    let base = json!({ "baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0 });
    for (k, strength) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        let material = document.push(
            "materials",
            json!({ "pbrMetallicRoughness": base,
                    "occlusionTexture": { "index": texture, "strength": strength } }),
        );
        let x = 2.0 * k as f64 - 2.0;
        square.stand(document, material, json!({ "translation": [x, 0, 0], "scale": [1.8, 1.8, 1] }));
    }
}
