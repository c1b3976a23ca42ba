//! Normals against the order of corners: in formats where a program wrote both, normals say which side is the front; glTF
//! files are taken as they are.

use moire::internal::mesh::{FORMATS, Mesh};
use moire::internal::scene::load;
use serde_json::json;

use super::told::{document, stored};

fn read(ending: &str, text: &str) -> Mesh {
    let format = FORMATS.iter().find(|format| format.ending == ending).unwrap();
    (format.read)(text.as_bytes(), 10).unwrap()
}

/// A triangle that faces +z by its corners, with normals along z of these signs.
fn obj(normals: [f64; 3]) -> Mesh {
    let normals = normals.map(|z| format!("vn 0 0 {z}\n")).concat();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
    read("obj", &format!("{corners}{normals}f 1/1/1 2/2/2 3/3/3\n"))
}

#[test]
fn a_triangle_whose_normals_all_point_backwards_is_turned_around_and_told() {
    let turned = obj([-1.0, -0.5, -2.0]);
    let triangle = turned.triangles.get(0);
    assert_eq!(triangle.positions, [0, 2, 1]);
    assert_eq!((triangle.uvs, triangle.normals), (Some([0, 2, 1]), Some([0, 2, 1])), "corners stay whole");
    assert_eq!(turned.notes, ["1 triangle is turned around, as all three normals point backwards"]);
    for normals in [[1.0; 3], [-1.0, -1.0, 1.0], [-1.0, -1.0, 0.0]] {
        let kept = obj(normals);
        assert_eq!((kept.triangles.get(0).positions, kept.notes.len()), ([0, 1, 2], 0), "{normals:?}");
    }
    let vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
                  property float ny\nproperty float nz\n";
    let face = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let ply =
        format!("ply\nformat ascii 1.0\n{vertex}{face}0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n3 0 1 2\n");
    assert_eq!(read("ply", &ply).triangles.get(0).positions, [0, 2, 1]);
}

#[test]
fn normals_that_are_not_finite_are_none_and_told() {
    for normal in [f64::NAN, f64::INFINITY] {
        let mesh = obj([1.0, normal, 1.0]);
        assert_eq!(mesh.normals[1], glam::DVec3::ZERO);
        assert!(mesh.notes[0].starts_with("1 normal of it is not finite"), "{:?}", mesh.notes);
    }
}

#[test]
fn gltf_keeps_the_order_that_its_author_wrote() {
    let mut document = document();
    let backwards: Vec<u8> = [0f32, 0.0, -1.0].repeat(3).iter().flat_map(|x| x.to_le_bytes()).collect();
    let bytes = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, &backwards);
    document["buffers"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "byteLength": 36, "uri": format!("data:application/octet-stream;base64,{bytes}") }));
    document["bufferViews"].as_array_mut().unwrap().push(json!({ "buffer": 1, "byteLength": 36 }));
    document["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3" }));
    document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(1);
    let scene = load(&stored(&document).path().join("m.gltf")).unwrap();
    let mut seen = Vec::new();
    scene.shapes.for_each_triangle(|triangle| seen.push(*triangle));
    let [a, b, c] = seen[0].vertices;
    assert_eq!((b - a).cross(c - a), glam::DVec3::Z);
    assert_eq!(seen[0].normals, Some([glam::DVec3::NEG_Z; 3]));
    assert!(!scene.notes.concat().contains("turned around"), "{:?}", scene.notes);
}
