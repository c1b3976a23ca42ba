//! Damaged files. Input: small files that use all parts of the reader, with bytes flipped, cut off, and digits of the
//! JSON changed. Whatever the reader says about them, it must say something and hold to its own promises.

use serde_json::json;

use super::super::{Model, read};
use super::build::{Build, f32s, i8s, u16s};

/// The most triangles.
const MOST: usize = 20_000;

/// How many damaged files are read, unless `MOIRE_GLTF_FUZZ` asks for another number.
const COUNT: usize = 2000;

#[test]
fn survives_damage() {
    let seeds = seeds();
    for seed in &seeds {
        check(&read(seed, MOST, &mut |_| Ok(vec![1; 100])).unwrap());
    }
    let wanted = std::env::var("MOIRE_GLTF_FUZZ").ok();
    let count = wanted.and_then(|count| count.parse().ok()).unwrap_or(COUNT);
    let mut random = fastrand::Rng::with_seed(7);
    let mut read_well = 0;
    for _ in 0..count {
        let mut bytes = random.choice(&seeds).unwrap().clone();
        for _ in 0..random.usize(1..4) {
            damage(&mut bytes, &mut random);
        }
        if let Ok(model) = read(&bytes, MOST, &mut |_| Ok(vec![1; 100])) {
            check(&model);
            read_well += 1;
        }
    }
    // Files that are all refused at once would test nothing.
    assert!(read_well > count / 20 && read_well < count, "{read_well} of {count}");
}

/// Changes something in a file.
fn damage(bytes: &mut Vec<u8>, random: &mut fastrand::Rng) {
    let at = random.usize(..bytes.len().max(1));
    match random.u8(..8) {
        0 => bytes.truncate(at),
        1 => bytes.iter_mut().skip(at).take(4).for_each(|byte| *byte = random.u8(..)),
        2 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << random.u8(..8)),
        3 => {
            let some = bytes.iter().skip(at).take(random.usize(..40)).copied().collect::<Vec<u8>>();
            let to = random.usize(..bytes.len().max(1));
            bytes.splice(to..(to + random.usize(..some.len().max(1))).min(bytes.len()), some);
        }
        // A number of the JSON; often, as it changes more than it breaks.
        _ => {
            let digit = |(at, byte): (usize, &u8)| byte.is_ascii_digit().then_some(at);
            let digits: Vec<usize> = bytes.iter().take(4000).enumerate().filter_map(digit).collect();
            if let Some(at) = random.choice(digits) {
                let number =
                    ["0", "1", "2", "3", "9", "12", "5121", "5126", "99999999", "-1", "4294967296", "1e300"];
                bytes.splice(at..=at, random.choice(number).unwrap().bytes());
            }
        }
    }
}

/// Checks what the reader promises about a model.
fn check(model: &Model) {
    for primitive in &model.primitives {
        let count = primitive.positions.len();
        assert!(!primitive.triangles.is_empty());
        assert!(primitive.triangles.as_flattened().iter().all(|corner| (*corner as usize) < count));
        assert!(primitive.positions.iter().all(|position| position.is_finite()));
        assert!(primitive.uvs.len() >= 2);
        let others = [primitive.normals.len(), primitive.tangents.len(), primitive.colors.len()];
        for length in primitive.uvs.iter().map(Vec::len).chain(others) {
            assert!(length == 0 || length == count);
        }
    }
    let mut triangles = 0;
    for instance in &model.instances {
        triangles += model.primitives[instance.primitive].triangles.len();
        assert!(instance.matrix.is_finite() && instance.node < model.nodes.len());
        assert!(instance.material.is_none_or(|material| material < model.materials.len()));
    }
    assert!(triangles <= MOST);
    for texture in &model.textures {
        assert!(texture.sources.iter().all(|source| *source < model.images.len()));
        assert!(texture.sampler.is_none_or(|sampler| sampler < model.samplers.len()));
    }
    assert!(model.in_scene(model.default_scene).len() == model.nodes.len());
}

/// Returns the files to damage.
fn seeds() -> Vec<Vec<u8>> {
    let plain = Build::triangle();

    let mut quantized = Build::new();
    let positions: Vec<i8> = (0..24).map(|i| (i * i * 7 % 101) as i8).collect();
    quantized.attribute("POSITION", 5120, "VEC3", &i8s(&positions));
    quantized.attribute("TEXCOORD_0", 5123, "VEC2", &u16s(&[1; 16]));
    let indices = quantized.accessor(5121, "SCALAR", &[0, 1, 2, 3, 4, 5, 6, 7, 0, 2]);
    quantized.set("/meshes/0/primitives/0/indices", json!(indices));
    quantized.set("/meshes/0/primitives/0/mode", json!(5));
    quantized.set("/meshes/0/primitives/1", json!({ "attributes": { "POSITION": 0 }, "mode": 6 }));

    let mut sparse = Build::triangle();
    let (indices, values) = (sparse.view(&[0, 2]), sparse.view(&f32s(&[3.0; 6])));
    sparse.set(
        "/accessors/0/sparse",
        json!({
            "count": 2,
            "indices": { "bufferView": indices, "componentType": 5121 },
            "values": { "bufferView": values },
        }),
    );
    sparse.set("/bufferViews/0/byteStride", json!(12));

    let mut graph = Build::triangle();
    graph.set("/nodes/1", json!({ "children": [0, 2], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1] }));
    graph.set("/nodes/2", json!({ "children": [3], "rotation": [0, 0, 1, 0], "scale": [1, 2, 3] }));
    graph.set("/nodes/3", json!({ "mesh": 0, "camera": 0 })).set("/scenes/0/nodes/0", json!(1));
    graph.set("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]));
    graph.set(
        "/extensions",
        json!({ "KHR_lights_punctual": { "lights": [{ "type": "point", "range": 2 }] } }),
    );
    graph.set("/nodes/2/extensions", json!({ "KHR_lights_punctual": { "light": 0 } }));
    let copies = graph.accessor(5126, "VEC3", &f32s(&[0.0; 12]));
    let attributes = json!({ "TRANSLATION": copies, "SCALE": copies });
    graph.set("/nodes/0/extensions", json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } }));

    let mut textured = Build::triangle();
    let view = textured.view(b"image");
    textured
        .set("/images", json!([{ "bufferView": view }, { "uri": "a.png" }, { "uri": "data:;base64,AAAA" }]));
    textured.set("/samplers", json!([{ "magFilter": 9728, "minFilter": 9987, "wrapS": 10497 }]));
    textured.set("/textures", json!([{ "source": 0, "sampler": 0 }, { "source": 1 }, { "source": 2 }]));
    let transform = json!({ "KHR_texture_transform": { "offset": [0, 1], "texCoord": 1 } });
    textured.set(
        "/materials",
        json!([{
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 2, "extensions": transform } },
            "normalTexture": { "index": 1, "scale": 2 }, "alphaMode": "MASK", "emissiveFactor": [0, 0, 1],
        }]),
    );
    textured.set("/meshes/0/primitives/0/material", json!(0));

    let mut beside = Build::triangle();
    beside.set("/buffers/1", json!({ "uri": "beside.bin", "byteLength": 100 }));
    beside
        .set("/bufferViews/1", json!({ "buffer": 1, "byteLength": 100, "byteOffset": 0, "byteStride": 16 }));
    let color =
        json!({ "bufferView": 1, "componentType": 5121, "normalized": true, "type": "VEC4", "count": 3 });
    beside.set("/accessors/1", color).set("/meshes/0/primitives/0/attributes/COLOR_0", json!(1));
    vec![plain.glb(), quantized.glb(), sparse.glb(), graph.glb(), graph.text(), textured.text(), beside.glb()]
}
