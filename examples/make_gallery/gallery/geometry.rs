//! Nodes and accessors: transforms, interleaved and sparse accessors, quantized ones, instances.

use std::f64::consts::FRAC_1_SQRT_2;

use serde_json::json;

use super::document::{Document, F32, I8, I16, U8};
use super::pictures;
use super::shapes::{self, CORNERS, ball_points};

fn paint(document: &mut Document, color: [f64; 3]) -> usize {
    let [r, g, b] = color;
    let base = json!({ "baseColorFactor": [r, g, b, 1], "metallicFactor": 0, "roughnessFactor": 0.6 });
    document.push("materials", json!({ "pbrMetallicRoughness": base }))
}

/// A letter and a ball each: as they are, mirrored, stretched, and turned by a parent that is stretched.
pub fn transforms(document: &mut Document) {
    document.front_camera();
    document.sun([-1.0, 1.0, 1.5], 3.0);
    let (letter, ball) = (shapes::letter(document), shapes::ball(document, 3));
    let paint = paint(document, [0.8, 0.45, 0.2]);
    let meshes = [(0.8, &letter), (-1.1, &ball)];
    for (x, scale) in [(-2.2, [1.0, 1.0, 1.0]), (-0.7, [-1.0, 1.0, 1.0]), (0.75, [1.2, 0.6, 0.3])] {
        for (y, shape) in meshes {
            let size = if y > 0.0 { 1.0 } else { 0.6 };
            let node = json!({ "translation": [x, y, 0], "scale": scale.map(|s| s * size) });
            shape.stand(document, paint, node);
        }
    }
    // The child turns by 30 degrees about z, and then its parent stretches it: a shear.
    for (y, shape) in meshes {
        let size = if y > 0.0 { 0.8 } else { 0.5 };
        let mesh = document.mesh(&shape.attributes, shape.indices, paint);
        let turn = [0.0, 0.0, 0.258_819_045, 0.965_925_826];
        let child =
            document.push("nodes", json!({ "mesh": mesh, "rotation": turn, "scale": [size, size, size] }));
        document.stand(json!({ "children": [child], "translation": [2.2, y, 0], "scale": [0.7, 1.4, 1] }));
    }
}

/// An interleaved square, a field whose middle a sparse accessor lifts, and one that a sparse accessor makes of nothing.
pub fn accessors(document: &mut Document) {
    document.camera([0.0, 4.0, 7.0], [0.0, 0.1, 0.0], 0.5);
    document.sun([-1.0, 2.0, 1.0], 3.0);
    let base = json!({ "metallicFactor": 0, "roughnessFactor": 0.6 });
    let material = document.push("materials", json!({ "pbrMetallicRoughness": base, "doubleSided": true }));
    // Positions and colours in turn, 16 bytes a vertex.
    let colors: [[u8; 4]; 4] =
        [[255, 40, 40, 255], [255, 220, 40, 255], [40, 200, 80, 255], [60, 90, 255, 255]];
    let vertex = |(corner, color): (&[f64; 3], &[u8; 4])| {
        let place = corner.iter().flat_map(|&x| (x as f32).to_le_bytes());
        place.chain(*color).collect::<Vec<u8>>()
    };
    let bytes: Vec<u8> = CORNERS.iter().zip(&colors).flat_map(vertex).collect();
    let view = document.view(&bytes, Some(16));
    let position = document.push(
        "accessors",
        json!({ "bufferView": view, "componentType": F32, "count": 4, "type": "VEC3",
                "min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0] }),
    );
    let color = document.push(
        "accessors",
        json!({ "bufferView": view, "byteOffset": 12, "componentType": U8, "normalized": true,
                "count": 4, "type": "VEC4" }),
    );
    let indices = document.indices(&[0, 1, 2, 0, 2, 3]);
    let mesh = document.mesh(&json!({ "POSITION": position, "COLOR_0": color }), Some(indices), material);
    let lying = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    document.stand(
        json!({ "mesh": mesh, "translation": [-2, 0, 0], "rotation": lying, "scale": [1.6, 1.6, 1.6] }),
    );
    // A middle and eight points around it.
    let around = [[-1, -1], [0, -1], [1, -1], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0]];
    let mut points = vec![[0.0; 3]];
    points.extend(around.map(|[x, z]: [i32; 2]| [0.8 * f64::from(x), 0.0, 0.8 * f64::from(z)]));
    let fan: Vec<u16> = (1..9).flat_map(|i| [0, i % 8 + 1, i]).collect();
    let fan = document.indices(&fan);
    let flat = document.positions(&points);
    let peak = sparse(document, &[0], &[[0.0, 1.0, 0.0]]);
    let mut lifted = json!({ "componentType": F32, "count": 9, "type": "VEC3", "sparse": peak,
                             "min": [-0.8, 0, -0.8], "max": [0.8, 1, 0.8] });
    lifted["bufferView"] = json!(flat_view(document, &points));
    let lifted = document.push("accessors", lifted);
    let mesh = document.mesh(&json!({ "POSITION": lifted }), Some(fan), material);
    document.stand(json!({ "mesh": mesh }));
    // Without a view all points are 0 but those that are named: four of the eight corners and a peak.
    let named = [1, 3, 5, 7].map(|i| points[usize::from(i as u16)]);
    let values = [[0.0, 0.5, 0.0], named[0], named[1], named[2], named[3]];
    let star = sparse(document, &[0, 1, 3, 5, 7], &values);
    let star = document.push(
        "accessors",
        json!({ "componentType": F32, "count": 9, "type": "VEC3", "sparse": star,
                "min": [-0.8, 0, -0.8], "max": [0.8, 0.5, 0.8] }),
    );
    let mesh = document.mesh(&json!({ "POSITION": star }), Some(fan), material);
    document.stand(json!({ "mesh": mesh, "translation": [2, 0, 0] }));
    // The same field as the file has it before the middle is lifted, below both.
    let mesh = document.mesh(&json!({ "POSITION": flat }), Some(fan), material);
    document.stand(json!({ "mesh": mesh, "translation": [0, -0.3, 0], "scale": [3.6, 1, 1.4] }));
}

fn flat_view(document: &mut Document, points: &[[f64; 3]]) -> usize {
    let bytes: Vec<u8> = points.as_flattened().iter().flat_map(|&x| (x as f32).to_le_bytes()).collect();
    document.view(&bytes, None)
}

/// Returns the member `sparse` of an accessor of positions.
fn sparse(document: &mut Document, indices: &[u8], values: &[[f64; 3]]) -> serde_json::Value {
    let places = document.view(indices, None);
    let values = flat_view(document, values);
    json!({ "count": indices.len(), "indices": { "bufferView": places, "componentType": U8 },
            "values": { "bufferView": values } })
}

/// A ball in 8 bits, and a square in 16 bits whose texture coordinates have 8.
pub fn quantized(document: &mut Document) {
    document.requires("KHR_mesh_quantization");
    document.front_camera();
    document.sun([-1.0, 1.0, 1.5], 3.0);
    let paint = paint(document, [0.3, 0.6, 0.75]);
    let (points, indices) = ball_points(3);
    let codes: Vec<u8> = points
        .iter()
        .flat_map(|point| {
            let [x, y, z] = point.map(|x| (127.0 * x).round() as i8 as u8);
            [x, y, z, 0]
        })
        .collect();
    let view = document.view(&codes, Some(4));
    let eight_bits = json!({ "bufferView": view, "componentType": I8, "normalized": true,
                             "count": points.len(), "type": "VEC3",
                             "min": [-127, -127, -127], "max": [127, 127, 127] });
    let accessor = document.push("accessors", eight_bits);
    let indices = document.indices(&indices);
    let mesh = document.mesh(&json!({ "POSITION": accessor, "NORMAL": accessor }), Some(indices), paint);
    document.stand(json!({ "mesh": mesh, "translation": [-1.5, 0, 0], "scale": [1.2, 1.2, 1.2] }));
    // Whole numbers that the node makes small.
    let codes: Vec<u8> = CORNERS
        .iter()
        .flat_map(|[x, y, z]| [*x, *y, *z, 0.0].map(|x| (2000.0 * x) as i16))
        .flat_map(i16::to_le_bytes)
        .collect();
    let view = document.view(&codes, Some(8));
    let position = document.push(
        "accessors",
        json!({ "bufferView": view, "componentType": I16, "count": 4, "type": "VEC3",
                "min": [-1000, -1000, 0], "max": [1000, 1000, 0] }),
    );
    let uvs: Vec<u8> =
        [[0, 255], [255, 255], [255, 0], [0, 0]].iter().flat_map(|[u, v]| [*u, *v, 0, 0]).collect();
    let view = document.view(&uvs, Some(4));
    let uv = document.push(
        "accessors",
        json!({ "bufferView": view, "componentType": U8, "normalized": true, "count": 4, "type": "VEC2" }),
    );
    let texture = document.texture(&pictures::letter(), Some(json!({ "magFilter": 9728 })));
    let sign = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
    let indices = document.indices(&[0, 1, 2, 0, 2, 3]);
    let mesh = document.mesh(&json!({ "POSITION": position, "TEXCOORD_0": uv }), Some(indices), sign);
    document.stand(json!({ "mesh": mesh, "translation": [1.5, 0, 0], "scale": [0.0012, 0.0012, 1] }));
}

/// Twelve blocks of one mesh on a circle, turned and growing.
pub fn instancing(document: &mut Document) {
    document.requires("EXT_mesh_gpu_instancing");
    document.camera([0.0, 4.0, 6.0], [0.0, 0.3, 0.0], 0.55);
    document.sun([-1.0, 2.0, 1.0], 3.0);
    let red = paint(document, [0.7, 0.3, 0.35]);
    let ground = document.floats("VEC3", [[0.0, 1.0, 0.0]; 4].as_flattened());
    let corners =
        document.positions(&[[-3.0, 0.0, 3.0], [3.0, 0.0, 3.0], [3.0, 0.0, -3.0], [-3.0, 0.0, -3.0]]);
    let indices = document.indices(&[0, 1, 2, 0, 2, 3]);
    let grey = paint(document, [0.5, 0.5, 0.5]);
    let mesh = document.mesh(&json!({ "POSITION": corners, "NORMAL": ground }), Some(indices), grey);
    document.stand(json!({ "mesh": mesh }));
    let block = shapes::block(document);
    // Sine and cosine of steps of 30 degrees, and of half of them as 16-bit codes.
    let half = 3f64.sqrt() / 2.0;
    let quarter = [(0.0, 1.0), (0.5, half), (half, 0.5)];
    let turn = |k: usize| {
        let (sine, cosine) = quarter[k % 3];
        [(sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine)][k / 3]
    };
    let places: Vec<f64> = (0..12).flat_map(|k| [2.0 * turn(k).0, 0.0, 2.0 * turn(k).1]).collect();
    let scales: Vec<f64> = (0..12).flat_map(|k| [0.5, 0.3 + 0.1 * k as f64, 0.5]).collect();
    let turns: Vec<u8> = (0..12)
        .flat_map(|k| {
            let (sine, cosine) = turn(k);
            // Half an angle by its tangent's law; the angle 180 degrees is the seventh.
            let (s, c) = if k == 6 { (1.0, 0.0) } else { (sine, 1.0 + cosine) };
            let length = f64::sqrt(s * s + c * c);
            [0.0, s / length, 0.0, c / length].map(|x| (32767.0 * x).round() as i16)
        })
        .flat_map(i16::to_le_bytes)
        .collect();
    let view = document.view(&turns, None);
    let rotation = document.push(
        "accessors",
        json!({ "bufferView": view, "componentType": I16, "normalized": true, "count": 12, "type": "VEC4" }),
    );
    let (translation, scale) = (document.floats("VEC3", &places), document.floats("VEC3", &scales));
    let mesh = document.mesh(&block.attributes, block.indices, red);
    let attributes = json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale });
    document.stand(json!({ "mesh": mesh, "extensions": {
        "EXT_mesh_gpu_instancing": { "attributes": attributes } } }));
}
