//! Textures: samplers, transforms, sets of coordinates, formats and depths of bits.

use std::f64::consts::FRAC_PI_6;

use serde_json::{Value, json};

use super::document::Document;
use super::pictures;
use super::shapes::{self, corner_uvs};

const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;
const MIRROR: u32 = 33648;
const CLAMP: u32 = 33071;

/// Above, from left to right: repeated, mirrored, clamped, each with sharp texels. Below: clamped and blended; a fine
/// checker without any sampler, grey; the same checker with the sampler 9728, which does not average.
pub fn samplers(document: &mut Document) {
    document.front_camera();
    let square = shapes::square(document);
    let far = document.floats("VEC2", &corner_uvs([-0.75, -0.75], [1.75, 1.75]));
    let fine = document.floats("VEC2", &corner_uvs([0.0, 0.0], [1600.0, 1600.0]));
    let (letter, checker) = (pictures::letter(), pictures::checker(255, 0));
    let sharp = |wrap: Value| {
        let mut sampler = json!({ "magFilter": NEAREST, "minFilter": NEAREST });
        if !wrap.is_null() {
            (sampler["wrapS"], sampler["wrapT"]) = (wrap.clone(), wrap);
        }
        Some(sampler)
    };
    let blended = json!({ "magFilter": LINEAR, "minFilter": LINEAR, "wrapS": CLAMP, "wrapT": CLAMP });
    let panels = [
        (&letter, sharp(Value::Null), far),
        (&letter, sharp(json!(MIRROR)), far),
        (&letter, sharp(json!(CLAMP)), far),
        (&letter, Some(blended), far),
        (&checker, None, fine),
        (&checker, sharp(Value::Null), fine),
    ];
    for (k, (picture, sampler, uvs)) in panels.into_iter().enumerate() {
        let texture = document.texture(picture, sampler);
        let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
        square.with("TEXCOORD_0", uvs).stand(document, material, sixth(k));
    }
}

/// Returns the node of one of six panels.
pub fn sixth(k: usize) -> Value {
    let (column, row) = ((k % 3) as f64, (k / 3) as f64);
    json!({ "translation": [2.0 * column - 2.0, 0.95 - 1.9 * row, 0], "scale": [1.7, 1.7, 1] })
}

/// Above: none, an offset, a rotation by 30 degrees. Below: a scale, all three, and a rotation of the emission alone, over a
/// base colour that stays.
pub fn transforms(document: &mut Document) {
    document.uses("KHR_texture_transform");
    document.front_camera();
    let square = shapes::square(document);
    let texture = document.texture(&pictures::letter(), Some(json!({ "magFilter": NEAREST })));
    let turn = FRAC_PI_6;
    for (k, transform) in [
        json!({}),
        json!({ "offset": [0.25, 0.5] }),
        json!({ "rotation": turn }),
        json!({ "scale": [2, 0.5] }),
        json!({ "offset": [0.25, 0.5], "rotation": turn, "scale": [2, 2] }),
    ]
    .into_iter()
    .enumerate()
    {
        let info = json!({ "index": texture, "extensions": { "KHR_texture_transform": transform } });
        let material = document.unlit(json!({ "baseColorTexture": info }));
        square.stand(document, material, sixth(k));
    }
    let turned = json!({ "index": texture, "extensions": { "KHR_texture_transform": { "rotation": turn } } });
    let base = json!({ "baseColorTexture": { "index": texture }, "metallicFactor": 0 });
    let material = document.push(
        "materials",
        json!({ "pbrMetallicRoughness": base, "emissiveTexture": turned, "emissiveFactor": [0.6, 0.3, 0] }),
    );
    square.stand(document, material, sixth(5));
    document.sun([0.0, 0.0, 1.0], 1.0);
}

/// The base colour at the first set, at the second, and at the first with an emission at the second.
pub fn uv_sets(document: &mut Document) {
    document.front_camera();
    document.sun([0.0, 0.0, 1.0], 2.5);
    let square = shapes::square(document);
    // Upside down and twice as often.
    let second = document.floats("VEC2", &corner_uvs([0.0, 2.0], [2.0, 0.0]));
    let square = square.with("TEXCOORD_1", second);
    let texture = document.texture(&pictures::letter(), Some(json!({ "magFilter": NEAREST })));
    let base =
        |set: u32| json!({ "baseColorTexture": { "index": texture, "texCoord": set }, "metallicFactor": 0 });
    for (k, material) in [
        json!({ "pbrMetallicRoughness": base(0) }),
        json!({ "pbrMetallicRoughness": base(1) }),
        json!({ "pbrMetallicRoughness": base(0), "emissiveFactor": [0, 0.5, 0],
                "emissiveTexture": { "index": texture, "texCoord": 1 } }),
    ]
    .into_iter()
    .enumerate()
    {
        let material = document.push("materials", material);
        let x = 2.0 * k as f64 - 2.0;
        square.stand(document, material, json!({ "translation": [x, 0, 0], "scale": [1.8, 1.8, 1] }));
    }
}

/// PNG, and the formats of three extensions: DDS, WebP, and KTX2 with Basis Universal.
pub fn formats(document: &mut Document) {
    const KTX2: &[u8] = include_bytes!("../../../data/pictures/etc1s.ktx2");
    const WEBP: &[u8] = include_bytes!("../../../data/pictures/lossy.webp");
    document.front_camera();
    let square = shapes::square(document);
    let sampler = document.push("samplers", json!({ "magFilter": NEAREST }));
    let png = document.image("image/png", &pictures::letter());
    let dds = document.image("image/vnd-ms.dds", &pictures::letter_dds());
    let webp = document.image("image/webp", WEBP);
    let ktx2 = document.image("image/ktx2", KTX2);
    let extension = |name: &str, source: usize| json!({ "sampler": sampler, "extensions": { name: { "source": source } } });
    let textures = [
        json!({ "sampler": sampler, "source": png }),
        extension("MSFT_texture_dds", dds),
        extension("EXT_texture_webp", webp),
        extension("KHR_texture_basisu", ktx2),
    ];
    for name in ["MSFT_texture_dds", "EXT_texture_webp", "KHR_texture_basisu"] {
        document.requires(name);
    }
    for (k, texture) in textures.into_iter().enumerate() {
        let texture = document.push("textures", texture);
        let material = document.unlit(json!({ "baseColorTexture": { "index": texture } }));
        let (x, y) = (if k % 2 == 0 { -1.4 } else { 1.4 }, if k < 2 { 0.95 } else { -0.95 });
        square.stand(document, material, json!({ "translation": [x, y, 0], "scale": [2.6, 1.7, 1] }));
    }
}

/// A ramp within one step of 8 bits, made visible by emission of great strength: 16 bits above, below it in 8.
pub fn sixteen_bits(document: &mut Document) {
    document.uses("KHR_materials_emissive_strength");
    document.front_camera();
    let square = shapes::square(document);
    // 64 codes of 16 bits from black to the first grey of 8 bits, which is 257 of them.
    let fine = pictures::grey16([64, 1], |x, _| 4 * x as u16);
    let coarse = pictures::rgb([64, 1], |x, _| [u8::from(x >= 32); 3]);
    for (y, picture) in [(0.95, fine), (-0.95, coarse)] {
        let sampler = json!({ "magFilter": NEAREST, "wrapS": CLAMP });
        let texture = document.texture(&picture, Some(sampler));
        // sRGB is linear there, at a slope of 1 / 12.92: 1 / 255 is 1 / 3295.
        let material = document.push(
            "materials",
            json!({ "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1] },
                    "emissiveTexture": { "index": texture }, "emissiveFactor": [1, 1, 1],
                    "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 3000 } } }),
        );
        square.stand(document, material, json!({ "translation": [0, y, 0], "scale": [5.6, 1.7, 1] }));
    }
    document.light(json!({ "type": "point", "intensity": 0 }), json!({ "translation": [0, 0, 9] }));
}
