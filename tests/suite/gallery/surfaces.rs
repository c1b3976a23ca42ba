//! What follows from a file alone, of its surfaces. Complaints: relief that is inverted where coordinates or nodes mirror (3);
//! normal maps decoded as colours, and the gamma of PNG files (5); masks far away and in shadows (7); nodes that mirror and
//! stretch (8).

use moire::internal::lab::metrics::compare;
use moire::internal::scene::model::Quantity;
use serde_json::{Value, json};

use super::made::document::Document;
use super::made::shapes::{ball_points, corner_uvs};
use super::made::{pictures, shapes};
use super::{near, pixel, read, seen, seen_at_centers};

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

/// The normal that a texel stands for, in the frame of its coordinates.
fn decoded(texel: [u8; 3]) -> [f64; 3] {
    unit(texel.map(|code| f64::from(code) / 127.5 - 1.0))
}

/// Complaint 3: a normal map of one texel under coordinates that are mirrored along u or v, without tangents and with
/// those of the file, under nodes that mirror and that do not. Red points along u, green against v.
#[test]
fn relief_follows_mirrored_coordinates_and_mirrored_nodes() {
    const TEXEL: [u8; 3] = [200, 166, 220];
    let [right, up, out] = decoded(TEXEL);
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let texture = document.texture(&pictures::rgb([1, 1], |_, _| TEXEL), None);
    let material = document.push("materials", json!({ "normalTexture": { "index": texture } }));
    let mut wanted = Vec::new();
    for (row, given) in [false, true].into_iter().enumerate() {
        for (column, [u, v]) in [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]].into_iter().enumerate() {
            let uvs = match [u, v] {
                [-1.0, _] => corner_uvs([1.0, 0.0], [0.0, 1.0]),
                [_, -1.0] => corner_uvs([0.0, 1.0], [1.0, 0.0]),
                _ => corner_uvs([0.0, 0.0], [1.0, 1.0]),
            };
            let mut shape = square.with("TEXCOORD_0", document.floats("VEC2", &uvs));
            if given {
                let tangents = [[u, 0.0, 0.0, u * v]; 4];
                shape = shape.with("TANGENT", document.floats("VEC4", tangents.as_flattened()));
            }
            for (half, side) in [1.0, -1.0].into_iter().enumerate() {
                let (x, y) = (column as f64 * 2.0 + half as f64 - 2.5, 1.0 - 2.0 * row as f64);
                let node = json!({ "translation": [x, y, 0], "scale": [0.9 * side, 0.9, 1] });
                shape.stand(&mut document, material, node);
                wanted.push((x, y, [side * u * right, v * up, out]));
            }
        }
    }
    let mut scene = read(&document);
    scene.sampling.quantity = Quantity::Normal;
    for film in seen_at_centers(scene, [60, 40]) {
        for (x, y, wanted) in &wanted {
            let found = pixel(&film, (10.0 * (x + 3.0)) as u32, (10.0 * (2.0 - y)) as u32);
            assert!(near(found, *wanted, 1e-3), "at {x}, {y}: {found:?}, not {wanted:?}");
        }
    }
}

/// Returns a PNG file with a chunk that claims a gamma of 1.
fn with_gamma(png: &[u8]) -> Vec<u8> {
    let body = [&b"gAMA"[..], &100_000u32.to_be_bytes()].concat();
    let chunk = [&4u32.to_be_bytes()[..], &body, &crc32fast::hash(&body).to_be_bytes()].concat();
    // Behind the signature and the header.
    [&png[..33], &chunk, &png[33..]].concat()
}

/// Complaint 5: half is a normal of 0, not of 0.2158 · 2 − 1, and nobody asks what a PNG file says of gamma.
#[test]
fn normal_maps_are_numbers_and_the_gamma_of_files_is_ignored() {
    let mut document = Document::default();
    document.front_camera();
    let square = shapes::square(&mut document);
    let flat = pictures::rgb([1, 1], |_, _| [128, 128, 255]);
    let colors = pictures::rgb([1, 1], |_, _| [200, 120, 40]);
    let panels = [(-2.0, flat.clone(), colors.clone()), (2.0, with_gamma(&flat), with_gamma(&colors))];
    for (x, flat, colors) in panels {
        let normal = document.texture(&flat, None);
        let color = document.texture(&colors, None);
        let base = json!({ "baseColorTexture": { "index": color }, "metallicFactor": 0 });
        let material = document
            .push("materials", json!({ "pbrMetallicRoughness": base, "normalTexture": { "index": normal } }));
        square.stand(&mut document, material, json!({ "translation": [x, 0, 0], "scale": [2, 4, 1] }));
    }
    let mut scene = read(&document);
    let towards: [f64; 3] = [0.0, 0.6, 0.8];
    for film in seen_at_centers(scene.clone(), [12, 8]) {
        assert_eq!(pixel(&film, 2, 4), pixel(&film, 9, 4));
    }
    scene.sampling.quantity = Quantity::Normal;
    for film in seen_at_centers(scene.clone(), [12, 8]) {
        let found = pixel(&film, 2, 4);
        assert!(near(found, decoded([128, 128, 255]), 1e-3), "{found:?}");
        let cosine: f64 = found.iter().zip(towards).map(|(n, l)| n * l).sum();
        assert!((cosine - towards[2]).abs() <= 1.0 / 255.0, "{cosine}");
        assert_eq!(found, pixel(&film, 9, 4));
    }
}

/// Complaint 7: stripes of one texel, of which half are holes, from near and from far, and their shadow on a wall that a
/// sun from the right throws to the left.
#[test]
fn masks_cover_the_same_share_from_near_and_far_and_in_shadows() {
    let stripes = pictures::rgba([64, 1], |x, _| [255, 255, 255, if x % 2 == 0 { 255 } else { 0 }]);
    for (mode, repeats, share) in
        [("MASK", 0.25, 0.5), ("MASK", 4.0, 0.5), ("MASK", 400.0, 0.5), ("OPAQUE", 4.0, 1.0)]
    {
        let mut document = Document::default();
        document.front_camera();
        document.sun([1.0, 0.0, 1.0], 3.0);
        let square = shapes::square(&mut document);
        let uvs = document.floats("VEC2", &corner_uvs([0.0, 0.0], [repeats, 1.0]));
        let texture = document.texture(&stripes, None);
        // The wall, with a black strip behind the mask, which itself gives off its own light.
        let wall = json!({ "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0 });
        let wall = document.push("materials", json!({ "pbrMetallicRoughness": wall }));
        square.stand(&mut document, wall, json!({ "scale": [6, 4, 1] }));
        let black = document.unlit(json!({ "baseColorFactor": [0, 0, 0, 1] }));
        square.stand(&mut document, black, json!({ "translation": [1.5, 0, 0.01], "scale": [2, 3, 1] }));
        document.uses("KHR_materials_unlit");
        let base = json!({ "baseColorTexture": { "index": texture } });
        let mask = json!({ "pbrMetallicRoughness": base, "alphaMode": mode,
                           "extensions": { "KHR_materials_unlit": {} } });
        let mask = document.push("materials", mask);
        let node = json!({ "translation": [1.5, 0, 2.5], "scale": [1.6, 1.6, 1] });
        square.with("TEXCOORD_0", uvs).stand(&mut document, mask, node);
        let mut scene = read(&document);
        // No light from one surface to the other.
        scene.sampling.max_depth = 0;
        for film in seen(scene, [180, 120]) {
            // 30 pixels a unit, 1.6 units wide and high: the mask about x = 1.5, its shadow about x = −1.
            let mean = |first: u32| {
                let pixels = (36..84).flat_map(|y| (first..first + 48).map(move |x| (x, y)));
                pixels.map(|(x, y)| pixel(&film, x, y)[0]).sum::<f64>() / (48.0 * 48.0)
            };
            let bright = pixel(&film, 5, 5)[0];
            let (covered, shadowed) = (mean(111), 1.0 - mean(36) / bright);
            assert!(bright > 0.3 && (covered - share).abs() <= 0.01, "{mode} {repeats}: {covered}");
            assert!((shadowed - share).abs() <= 0.01, "{mode} {repeats}: a shadow of {shadowed}");
        }
    }
}

/// Complaint 8: nodes that mirror and stretch against meshes whose corners and normals are where nodes would put them.
#[test]
fn mirrored_and_stretched_nodes_show_what_baked_meshes_show() {
    let (points, indices) = ball_points(2);
    for scale in [[-1.0, 1.0, 1.0], [0.5, 1.5, 0.5], [-0.5, -1.0, -1.5]] {
        let pictures = [false, true].map(|baked| {
            let mut document = Document::default();
            document.front_camera();
            document.sun([-1.0, 1.0, 1.0], 3.0);
            let base = json!({ "baseColorFactor": [0.8, 0.6, 0.4, 1], "metallicFactor": 0.5 });
            let material = document.push("materials", json!({ "pbrMetallicRoughness": base }));
            let factors = if baked { scale } else { [1.0; 3] };
            let product = |point: &[f64; 3]| [0, 1, 2].map(|i| point[i] * factors[i]);
            let normal = |point: &[f64; 3]| unit([0, 1, 2].map(|i| point[i] / factors[i]));
            let turned = factors.iter().product::<f64>() < 0.0;
            let corners: Vec<u16> = indices
                .as_chunks::<3>()
                .0
                .iter()
                .flat_map(|&[a, b, c]| if turned { [a, c, b] } else { [a, b, c] })
                .collect();
            let positions = document.positions(&points.iter().map(product).collect::<Vec<_>>());
            let normals: Vec<[f64; 3]> = points.iter().map(normal).collect();
            let normals = document.floats("VEC3", normals.as_flattened());
            let corners = document.indices(&corners);
            let node = |x: f64| -> Value {
                let mut node = json!({ "translation": [x, 0, 0] });
                if !baked {
                    node["scale"] = json!(scale);
                }
                node
            };
            // With normals, and flat.
            let smooth = json!({ "POSITION": positions, "NORMAL": normals });
            for (x, attributes) in [(-1.5, smooth), (1.5, json!({ "POSITION": positions }))] {
                let mesh = document.mesh(&attributes, Some(corners), material);
                let mut node = node(x);
                node["mesh"] = json!(mesh);
                document.stand(node);
            }
            seen(read(&document), [48, 32])
        });
        let [nodes, baked] = pictures;
        for (nodes, baked) in nodes.iter().zip(&baked) {
            let apart = compare(nodes, baked).unwrap();
            assert!(apart.rmse < 2e-4, "{scale:?}: {apart:?}");
            let lit = nodes.pixels.iter().filter(|pixel| pixel[0] > 0.3).count();
            assert!(lit > 20, "{scale:?}: only {lit} pixels are lit");
        }
    }
}
