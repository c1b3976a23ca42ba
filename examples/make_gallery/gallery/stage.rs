//! Cameras and lights.

use serde_json::json;

use super::document::{Document, looking};
use super::shapes;

fn grey(document: &mut Document) -> usize {
    let base = json!({ "baseColorFactor": [0.6, 0.6, 0.6, 1], "metallicFactor": 0, "roughnessFactor": 0.9 });
    document.push("materials", json!({ "pbrMetallicRoughness": base }))
}

/// Two rows of blocks, seen by a camera with perspective, and by one without that has a name and another ratio of its sides.
pub fn cameras(document: &mut Document) {
    document.camera([2.0, 1.6, 5.0], [0.0, 0.6, -3.0], 0.6);
    let lens = json!({ "xmag": 5, "ymag": 5, "znear": 0.1, "zfar": 100 });
    let above = json!({ "type": "orthographic", "orthographic": lens, "name": "above" });
    let above = document.push("cameras", above);
    document.stand(json!({ "camera": above, "matrix": looking([6.0, 9.0, 4.0], [0.0, 0.0, -3.0]) }));
    document.sun([-2.0, 3.0, 1.0], 3.0);
    let (block, grey) = (shapes::block(document), grey(document));
    block.stand(document, grey, json!({ "translation": [0, -1, -3], "scale": [5, 1, 9] }));
    for k in 0..4 {
        for x in [-1.0, 1.0] {
            let base = json!({ "baseColorFactor": [0.9 - 0.2 * f64::from(k), 0.4, 0.1 + 0.25 * f64::from(k), 1],
                               "metallicFactor": 0 });
            let paint = document.push("materials", json!({ "pbrMetallicRoughness": base }));
            let node = json!({ "translation": [x, 0, -2 * k], "scale": [0.7, 1.2, 0.7] });
            block.stand(document, paint, node);
        }
    }
}

/// A wall: a point whose light ends at its range, a spot that fades, one that ends at once, and a dim sun.
pub fn lights(document: &mut Document) {
    document.front_camera();
    document.sun([2.0, 1.0, 1.0], 0.3);
    let (square, grey) = (shapes::square(document), grey(document));
    square.stand(document, grey, json!({ "scale": [6, 4, 1] }));
    let block = shapes::block(document);
    for x in [-2.0, 0.0, 2.0] {
        block.stand(document, grey, json!({ "translation": [x, -0.6, 0.1], "scale": [0.2, 0.2, 0.2] }));
    }
    let point = json!({ "type": "point", "color": [1, 0.6, 0.3], "intensity": 1.2, "range": 1.2 });
    document.light(point, json!({ "translation": [-2, 0.2, 0.6] }));
    let spot = |color: [f64; 3], inner: f64, range: f64| {
        json!({ "type": "spot", "color": color, "intensity": 8, "range": range,
                "spot": { "innerConeAngle": inner, "outerConeAngle": 0.4 } })
    };
    // A node without rotation shines along −z.
    document.light(spot([0.5, 1.0, 0.6], 0.0, 20.0), json!({ "translation": [0, 0, 2] }));
    let aslant = json!({ "matrix": looking([2.0, 1.4, 2.0], [2.0, 0.0, 0.0]) });
    document.light(spot([0.5, 0.6, 1.0], 0.399, 20.0), aslant);
}
