//! What is said of files of meshes that cannot be drawn, or not as they stand: the place, what was found, and what is
//! allowed; and what is drawn with a warning.

use std::fs;

use moire::internal::scene::load;
use moire::internal::scene::model::Model;
use serde_json::{Value, json};
use tempfile::{TempDir, tempdir};

use super::{QUAD, folder, scene_in};
use crate::containers::write::{Ktx2, VK_RGBA8, solid_levels};
use crate::stage::packed;
use crate::support::{moire, told};

/// A triangle in a material without a name, with a camera and a light, as values to change.
pub(super) fn document() -> Value {
    let corners: Vec<u8> =
        [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let bytes = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, &corners);
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "mesh": 0 }, { "camera": 0, "translation": [0, 0, 5] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": {} }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.5 } }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": format!("data:application/octet-stream;base64,{bytes}") }]
    })
}

/// The document with another value at a pointer.
fn with(pointer: &str, value: Value) -> Value {
    let mut document = document();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = document.pointer_mut(parent).unwrap();
    match parent {
        Value::Array(list) if key == "-" => list.push(value),
        Value::Array(list) => list[key.parse::<usize>().unwrap()] = value,
        _ => parent[key] = value,
    }
    document
}

/// The document with a texture of these images.
fn with_images(images: Value, texture: Value) -> Value {
    let mut document = with("/materials/0/pbrMetallicRoughness/baseColorTexture", json!({ "index": 0 }));
    (document["images"], document["textures"]) = (images, json!([texture]));
    document
}

pub(super) fn stored(document: &Value) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("m.gltf"), document.to_string()).unwrap();
    folder
}

fn refused(document: &Value) -> String {
    told(load(&stored(document).path().join("m.gltf")))
}

pub(super) fn notes(document: &Value) -> String {
    load(&stored(document).path().join("m.gltf")).unwrap().notes.join("\n")
}

#[test]
fn files_without_a_triangle_say_so() {
    let mut points = with("/meshes/0/primitives/0/mode", json!(0));
    points.as_object_mut().unwrap().remove("cameras");
    points["nodes"][1] = json!({});
    for document in [&points, &with("/scenes/0/nodes", json!([1])), &json!({ "asset": { "version": "2.0" } })]
    {
        let said = refused(document);
        assert!(said.contains("m.gltf: the file has no triangles (0 degenerate, points"), "{said}");
    }
    let mut stl = vec![0; 84];
    let flat = "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\nf 1 1 2\n";
    let folder = folder(&[("flat.obj", flat)]);
    fs::write(folder.path().join("none.stl"), &stl).unwrap();
    stl[80] = 1;
    stl.resize(84 + 50, 0);
    fs::write(folder.path().join("flat.stl"), &stl).unwrap();
    for (file, count) in [("flat.obj", 2), ("none.stl", 0), ("flat.stl", 1)] {
        let path = folder.path().join(file);
        let said = told(load(&path));
        assert!(said.contains(&format!("no triangles ({count} degenerate")), "{file}: {said}");
        let output = moire().args(["render", "-o", "-", "--format", "png"]).arg(&path).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).replace('\n', " ");
        assert!(output.status.code() == Some(2) && said.contains("help: export"), "{said}");
    }
}

#[test]
fn a_mesh_without_a_material_has_the_default_one_of_the_specification() {
    let mut document = with("/materials/-", json!({ "doubleSided": true }));
    document["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("material");
    let scene = load(&stored(&document).path().join("m.gltf")).unwrap();
    let of = |index: usize| {
        let material = &scene.materials[index];
        (material.model, material.color.to_array(), material.metallic, material.roughness)
    };
    assert_eq!((scene.materials.len(), of(0)), (1, (Model::PHYSICAL, [1.0; 3], 1.0, 1.0)));
    // A scene may still give it another.
    let folder = stored(&document);
    let body = "[[material]]\nname = 'own'\n[[mesh]]\nfile = 'm.gltf'\nmaterial = 'own'\n";
    let scene = scene_in(folder.path(), body).unwrap();
    assert_eq!((scene.materials.len(), scene.materials[0].model), (1, Model::Lambert));
}

#[test]
fn faults_of_gltf_say_what_was_found_and_what_is_allowed() {
    let sparse = json!({ "count": 1, "indices": { "bufferView": 0, "componentType": 5126 }, "values": { "bufferView": 0 } });
    let rows = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1]);
    let light = json!({ "KHR_lights_punctual": { "lights": [{ "type": "area" }] } });
    let mut lit = document();
    lit["extensions"] = light;
    let mut without_bytes = document();
    without_bytes["buffers"][0].as_object_mut().unwrap().remove("uri");
    let mut empty = with("/accessors/-", json!({ "componentType": 5121, "count": 3, "type": "SCALAR" }));
    empty["accessors"][0]["count"] = json!(0);
    empty["meshes"][0]["primitives"][0]["indices"] = json!(1);
    for (document, parts) in [
        (
            with("/materials/0/alphaMode", json!("GLASS")),
            ["/materials/0/alphaMode", "\"GLASS\"", "OPAQUE, MASK and BLEND"],
        ),
        (with("/accessors/0/type", json!("VEC5")), ["/accessors/0/type", "\"VEC5\"", "VEC2, VEC3"]),
        (with("/accessors/0/type", json!("VEC2")), ["/accessors/0/type", "it is VEC2", "VEC3"]),
        (
            with("/accessors/0/sparse", sparse),
            ["/accessors/0/sparse/indices/componentType", "5126", "5121, 5123"],
        ),
        (
            with("/cameras/0/type", json!("fish")),
            ["/cameras/0/type", "\"fish\"", "perspective and orthographic"],
        ),
        (lit, ["/lights/0/type", "\"area\"", "directional, point"]),
        (with("/nodes/0/matrix", rows), ["/nodes/0/matrix", "[0, 0, 0.5, 1]", "[0, 0, 0, 1]"]),
        (without_bytes, ["/buffers/0", "no data", "/accessors/0 needs it"]),
        (empty, ["/accessors/0/count", "it is 0", "1 at least"]),
    ] {
        let said = refused(&document);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}: {said}");
    }
}

#[test]
fn what_is_odd_is_told_and_drawn() {
    let notes_of = |pointer: &str, value: Value| notes(&with(pointer, value));
    assert_eq!(notes(&document()), "");
    let said = notes_of("/bufferViews/0/byteStride", json!(0));
    assert!(said.contains("byteStride of 0") && said.contains("/bufferViews/0"), "{said}");
    let said = notes_of("/scenes/0/nodes", json!([0, 1, 0]));
    assert!(said.contains("lists a node again") && said.contains("/scenes/0"), "{said}");
    // Neither the material nor the mesh has a name.
    let pixel = crate::meshes::gltf_materials::PNG;
    let said = notes(&with_images(json!([{ "uri": pixel }]), json!({ "source": 0 })));
    assert!(said.contains("/materials/0: /meshes/0/primitives/0 has no TEXCOORD_0"), "{said}");
}

/// Missing ones and others that are no pictures alike, unless another one can be read in their place.
#[test]
fn images_that_cannot_be_read_are_refused_where_the_file_names_them() {
    for (image, place) in [
        (json!({ "uri": "gone.png" }), "/images/0/uri: "),
        (json!({ "uri": "data:image/png;base64,aGVsbG8gd29ybGQ=" }), "/images/0: "),
        (json!({ "uri": "m.gltf" }), "/images/0/uri: "),
    ] {
        let said = refused(&with_images(json!([image]), json!({ "source": 0 })));
        assert!(said.contains("m.gltf") && said.contains(place), "{image}: {said}");
    }
    let both = json!({ "source": 1, "extensions": { "MSFT_texture_dds": { "source": 0 } } });
    let images = json!([{ "uri": "gone.dds" }, { "uri": crate::meshes::gltf_materials::PNG }]);
    let said = notes(&with_images(images, both));
    assert!(
        said.contains("/images/1 is read in place of /images/0/uri: ") && said.contains("gone.dds"),
        "{said}"
    );
    let none = notes(&with_images(json!([]), json!({})));
    assert!(none.contains("/textures/0") && none.contains("left out"), "{none}");
}

#[test]
fn a_transform_is_to_blame_for_what_it_makes_of_corners() {
    let folder = folder(&[("quad.obj", &format!("{QUAD}f 1 2 3\n"))]);
    for transform in ["{ scale = nan }", "{ scale = 1e300 }", "{ translate = [0, inf, 0] }"] {
        let said =
            told(scene_in(folder.path(), &format!("[[mesh]]\nfile = 'quad.obj'\ntransform = {transform}\n")));
        assert!(said.contains("\"mesh.transform\""), "{transform}: {said}");
    }
}

#[test]
fn scenes_and_nodes_without_names_are_chosen_by_number() {
    let mut document = with("/scenes/-", json!({ "nodes": [1, 2] }));
    document["nodes"].as_array_mut().unwrap().extend([json!({ "mesh": 0 }), json!({ "name": "0" })]);
    let folder = stored(&document);
    let count = |keys: &str| {
        let scene = scene_in(folder.path(), &format!("[[mesh]]\nfile = 'm.gltf'\n{keys}\n")).unwrap();
        scene.shapes.triangle_count()
    };
    // A name comes first.
    assert_eq!(
        [count("node = 2"), count("node = '2'"), count("scene = 1"), count("node = '0'")],
        [1, 1, 1, 0]
    );
    for (keys, what) in
        [("scene = 2", "numbers are 0 to 1"), ("node = 'x'", "numbers are 0 to 3"), ("node = 1.5", "string")]
    {
        let said = told(scene_in(folder.path(), &format!("[[mesh]]\nfile = 'm.gltf'\n{keys}\n")));
        assert!(said.contains(what), "{keys}: {said}");
    }
}

/// Levels red, green, blue and white, of a texture with and one without levels; by glTF and by MTL.
#[test]
fn levels_that_a_file_stores_are_read_as_they_are() {
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255; 4]];
    let chain = solid_levels(8, |side| side * side, &colors);
    for count in [4, 1] {
        let texture = json!({ "extensions": { "KHR_texture_basisu": { "source": 0 } } });
        let folder = stored(&with_images(json!([{ "uri": "a.ktx2" }]), texture));
        fs::write(folder.path().join("a.ktx2"), Ktx2::flat(VK_RGBA8, [8, 8], &chain[..count]).bytes())
            .unwrap();
        fs::write(folder.path().join("m.obj"), format!("mtllib m.mtl\n{QUAD}usemtl a\nf 1/1 2/2 3/3\n"))
            .unwrap();
        fs::write(folder.path().join("m.mtl"), "newmtl a\nmap_Kd a.ktx2\n").unwrap();
        for file in ["m.gltf", "m.obj"] {
            let packed = packed(load(&folder.path().join(file)).unwrap(), None);
            assert_eq!(packed.records.textures[0].levels, 4, "{file}");
            for level in 0..4 {
                let wanted = colors[if count == 4 { level } else { 0 }];
                let found = &packed.level_texels(0, level as u32)[..4];
                assert_eq!(found, wanted, "{file}: level {level} of {count} stored ones");
            }
        }
    }
}
