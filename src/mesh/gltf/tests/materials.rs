//! Materials, textures, samplers and images: defaults, every property, every slot of a texture, every number of a
//! sampler, embedded images and refusals.

use glam::{DVec2, DVec3, DVec4};
use serde_json::{Value, json};

use super::super::{AlphaMode, Content, Material, Sampler, TextureRef, TextureTransform, Weighting, Wrap};
use super::build::{Build, fault_with};

/// Returns a triangle with three textures.
fn textured() -> Build {
    let mut build = Build::triangle();
    build.set(
        "/images",
        json!([{ "uri": "a.png" }, { "uri": "b.ktx2" }, { "uri": "c.webp" }, { "uri": "d.dds" }]),
    );
    build.set("/textures", json!([{ "source": 0 }, {}, {}]));
    build
}

fn material(value: Value) -> Material {
    textured().set("/materials", json!([value])).read().unwrap().materials.remove(0)
}

#[test]
fn fills_in_defaults() {
    assert_eq!(material(json!({})), Material::default());
    assert_eq!(material(json!({ "pbrMetallicRoughness": {}, "name": "x" })).name, "x");
    let extensions = json!({
        "KHR_materials_ior": {}, "KHR_materials_specular": {}, "KHR_materials_transmission": {},
        "KHR_materials_emissive_strength": {},
    });
    assert_eq!(material(json!({ "extensions": extensions })), Material::default());
}

#[test]
fn reads_every_factor() {
    let found = material(json!({
        "name": "all",
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6 },
        "normalTexture": { "index": 0, "scale": -2 },
        "occlusionTexture": { "index": 0, "strength": 0.7 },
        "emissiveFactor": [0.8, 0.9, 1],
        "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        "extensions": {
            "KHR_materials_unlit": {},
            "KHR_materials_emissive_strength": { "emissiveStrength": 12 },
            "KHR_materials_ior": { "ior": 1.33 },
            "KHR_materials_transmission": { "transmissionFactor": 0.15 },
            "KHR_materials_specular": { "specularFactor": 0.35, "specularColorFactor": [1, 2, 3] },
        },
    }));
    let plain = Some(TextureRef { texture: 0, uv_set: 0, transform: None });
    let expected = Material {
        name: "all".into(),
        base_color: DVec4::new(0.1, 0.2, 0.3, 0.4),
        metallic: 0.5,
        roughness: 0.6,
        normal_texture: plain,
        normal_scale: -2.0,
        occlusion_texture: plain,
        occlusion_strength: 0.7,
        emissive: DVec3::new(0.8, 0.9, 1.0),
        emissive_strength: 12.0,
        alpha: AlphaMode::Mask(0.25),
        double_sided: true,
        unlit: true,
        ior: 1.33,
        transmission: 0.15,
        specular: 0.35,
        specular_color: DVec3::new(1.0, 2.0, 3.0),
        ..Material::default()
    };
    assert_eq!(found, expected);
    assert_eq!(material(json!({ "alphaMode": "MASK" })).alpha, AlphaMode::Mask(0.5));
    assert_eq!(material(json!({ "alphaMode": "BLEND", "alphaCutoff": 0.1 })).alpha, AlphaMode::Blend);
}

#[test]
fn transforms_every_slot() {
    type Get = fn(&Material) -> Option<TextureRef>;
    let slots: [(&str, Get); 8] = [
        ("/pbrMetallicRoughness/baseColorTexture", |m| m.base_color_texture),
        ("/pbrMetallicRoughness/metallicRoughnessTexture", |m| m.metallic_roughness_texture),
        ("/normalTexture", |m| m.normal_texture),
        ("/occlusionTexture", |m| m.occlusion_texture),
        ("/emissiveTexture", |m| m.emissive_texture),
        ("/extensions/KHR_materials_transmission/transmissionTexture", |m| m.transmission_texture),
        ("/extensions/KHR_materials_specular/specularTexture", |m| m.specular_texture),
        ("/extensions/KHR_materials_specular/specularColorTexture", |m| m.specular_color_texture),
    ];
    for (slot, get) in slots {
        let place = format!("/materials/0{slot}");
        let mut build = textured();
        build.set("/materials", json!([{}]));
        let mut found = |value: Value| get(&build.set(&place, value).read().unwrap().materials[0]).unwrap();
        let transform = |offset, rotation, scale| Some(TextureTransform { offset, rotation, scale });
        let plain = TextureRef { texture: 2, uv_set: 1, transform: None };
        assert_eq!(found(json!({ "index": 2, "texCoord": 1 })), plain, "{slot}");
        let with = |extension: Value| json!({ "index": 2, "texCoord": 1, "extensions": { "KHR_texture_transform": extension } });
        let nothing = transform(DVec2::ZERO, 0.0, DVec2::ONE);
        assert_eq!(found(with(json!({}))), TextureRef { transform: nothing, ..plain });
        let all = json!({ "offset": [0.1, 0.2], "rotation": -0.3, "scale": [4, -5], "texCoord": 0 });
        let expected = transform(DVec2::new(0.1, 0.2), -0.3, DVec2::new(4.0, -5.0));
        assert_eq!(found(with(all)), TextureRef { texture: 2, uv_set: 0, transform: expected });
        let fault = build.set(&place, json!({ "index": 3 })).fault();
        assert_eq!(fault, format!("{place}/index: 3 does not exist; the file has 3 textures"));
        assert_eq!(build.set(&place, json!({})).fault(), format!("{place}/index: it is missing"));
        build.set(&place, with(json!({ "offset": [1] })));
        let what = "extensions/KHR_texture_transform/offset: it is [1]; a list of 2 numbers is needed";
        assert_eq!(build.fault(), format!("{place}/{what}"));
    }
}

#[test]
fn moves_factors_into_range() {
    let mut build = textured();
    build.set(
        "/materials",
        json!([{ "pbrMetallicRoughness": { "metallicFactor": 1.000_01, "roughnessFactor": -1 } }]),
    );
    let model = build.read().unwrap();
    assert_eq!((model.materials[0].metallic, model.materials[0].roughness), (1.0, 0.0));
    let place = "/materials/0/pbrMetallicRoughness/metallicFactor";
    let note = format!("factors of materials out of range are moved into it (2 times, first at {place})");
    assert_eq!(model.notes, [note]);
    build.set("/materials", json!([{ "normalTexture": { "index": 0, "texCoord": 8 } }]));
    let note =
        "textures use coordinates beyond TEXCOORD_7, which are ignored (at /materials/0/normalTexture)";
    assert_eq!(build.read().unwrap().notes, [note]);
}

#[test]
fn refuses_wrong_materials() {
    for (value, fault) in [
        (json!({ "alphaMode": "CUTOUT" }), "alphaMode: it is \"CUTOUT\"; OPAQUE, MASK and BLEND are allowed"),
        (json!({ "emissiveFactor": [1, 2] }), "emissiveFactor: it is [1,2]; a list of 3 numbers is needed"),
        (json!({ "doubleSided": 1 }), "doubleSided: it is 1; true or false is needed"),
        (json!({ "pbrMetallicRoughness": 1 }), "pbrMetallicRoughness: it is 1; an object is needed"),
        (
            json!({ "extensions": { "KHR_materials_ior": { "ior": 0.5 } } }),
            "extensions/KHR_materials_ior/ior: it is 0.5; it has to be 0 or at least 1",
        ),
    ] {
        assert_eq!(fault_with("/materials", json!([value])), format!("/materials/0/{fault}"));
    }
}

#[test]
fn reads_every_number_of_samplers() {
    use Weighting::{Linear, Nearest};
    let sampler =
        |value: Value| Build::triangle().set("/samplers", json!([value])).read().unwrap().samplers[0];
    assert_eq!(sampler(json!({})), Sampler { mag: None, min: None, wrap: [Wrap::Repeat; 2] });
    for (code, mag) in [(9728, Nearest), (9729, Linear)] {
        assert_eq!(sampler(json!({ "magFilter": code })).mag, Some(mag));
    }
    for (code, min) in [
        (9728, (Nearest, None)),
        (9729, (Linear, None)),
        (9984, (Nearest, Some(Nearest))),
        (9985, (Linear, Some(Nearest))),
        (9986, (Nearest, Some(Linear))),
        (9987, (Linear, Some(Linear))),
    ] {
        assert_eq!(sampler(json!({ "minFilter": code })).min, Some(min));
    }
    for (code, wrap) in [(33071, Wrap::Clamp), (33648, Wrap::Mirror), (10497, Wrap::Repeat)] {
        assert_eq!(sampler(json!({ "wrapS": code })).wrap, [wrap, Wrap::Repeat]);
        assert_eq!(sampler(json!({ "wrapT": code })).wrap, [Wrap::Repeat, wrap]);
    }
    for (key, allowed) in [
        ("magFilter", "9728 and 9729"),
        ("minFilter", "9728, 9729 and 9984 to 9987"),
        ("wrapS", "33071, 33648 and 10497"),
        ("wrapT", "33071, 33648 and 10497"),
    ] {
        let fault = fault_with("/samplers", json!([{ key: 9983 }]));
        assert_eq!(fault, format!("/samplers/0/{key}: it is 9983; {allowed} are allowed"));
    }
}

#[test]
fn lists_sources_by_preference() {
    let mut build = textured();
    build.set("/samplers", json!([{}]));
    build.set("/textures/0/sampler", json!(0)).set("/textures/0/name", json!("t"));
    for (name, source) in [("EXT_texture_webp", 2), ("KHR_texture_basisu", 1), ("MSFT_texture_dds", 3)] {
        build.set(&format!("/textures/0/extensions/{name}"), json!({ "source": source }));
    }
    let textures = build.read().unwrap().textures;
    assert_eq!((textures[0].name.as_str(), textures[0].sampler), ("t", Some(0)));
    assert_eq!(textures[0].sources, [1, 3, 2, 0]);
    assert_eq!((textures[1].sampler, textures[1].sources.len()), (None, 0));
    let fault = build.clone().set("/textures/1/source", json!(4)).fault();
    assert_eq!(fault, "/textures/1/source: 4 does not exist; the file has 4 images");
    let fault = build.set("/textures/1/sampler", json!(1)).fault();
    assert_eq!(fault, "/textures/1/sampler: 1 does not exist; the file has 1 samplers");
}

#[test]
fn finds_embedded_images() {
    let mut build = Build::triangle();
    let view = build.view(b"png");
    build.set(
        "/images",
        json!([
            { "bufferView": view, "mimeType": "image/png", "name": "i" },
            { "uri": "data:image/jpeg;base64,anBn" },
            { "uri": "DATA:,a%20b" },
            { "uri": "tex/./a%20b/../c%C3%A9.png" },
            { "bufferView": view },
        ]),
    );
    let images = build.read().unwrap().images;
    let found: Vec<_> = images.iter().map(|image| (image.content.clone(), image.mime.as_deref())).collect();
    let bytes = |bytes: &[u8]| Content::Bytes(bytes.into());
    assert_eq!(
        found,
        [
            (bytes(b"png"), Some("image/png")),
            (bytes(b"jpg"), Some("image/jpeg")),
            (bytes(b"a b"), None),
            (Content::Path("tex/c\u{e9}.png".into()), None),
            (bytes(b"png"), None),
        ]
    );
    assert_eq!(images[0].name, "i");
    for image in [json!({}), json!({ "uri": "a", "bufferView": 0 })] {
        assert_eq!(fault_with("/images", json!([image])), "/images/0: it needs either uri or bufferView");
    }
    // Equal views share their bytes; others must not add up to more than the file has.
    build.set("/bufferViews/2", json!({ "buffer": 0, "byteLength": 37 }));
    build.set("/images/5", json!({ "bufferView": 2 }));
    let fault = "/images/5/bufferView: the images together have more bytes than all buffers";
    assert_eq!(build.fault(), fault);
}
