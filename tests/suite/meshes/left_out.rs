//! What files have and is not drawn is told, once with its count; and spellings of files that are drawn as others are.

use std::fs;

use moire::internal::mesh::{FORMATS, Mesh};
use serde_json::{Value, json};

use super::told::{document, notes, stored};
use super::{QUAD, folder, scene_in};

fn read(ending: &str, bytes: &[u8]) -> Mesh {
    let format = FORMATS.iter().find(|format| format.ending == ending).unwrap();
    (format.read)(bytes, 100).unwrap()
}

#[test]
fn statements_of_obj_that_are_not_read_are_told_by_name_with_their_count() {
    let mesh = read(
        "obj",
        format!("{QUAD}g a\ns 1\no b\nf 1 2 3\nl 1 2\nl 2 3\np 1\nsurf 1\nfoo x\n#l\n").as_bytes(),
    );
    assert_eq!(
        mesh.notes,
        [
            "left out: 2 lines, the first in line 14",
            "left out: 1 statement of points, in line 16",
            "left out: 1 free-form surface, in line 17",
            "left out: 1 statement \"foo\", in line 18",
        ]
    );
    let many: String = (0..1000).map(|i| format!("word{i} 1\n")).collect();
    let mesh = read("obj", format!("{QUAD}f 1 2 3\n{many}").as_bytes());
    assert_eq!(mesh.notes.len(), 8, "a file of other words is no list of warnings");
}

#[test]
fn keywords_of_obj_may_be_capitals() {
    let small = format!("{QUAD}usemtl A\nf 1/1/1 2/2/1 3/3/1\n");
    let capitals = small.replace("v", "V").replace("usemtl", "UseMtl").replace("f ", "F ").replace("n", "N");
    assert_eq!(read("obj", capitals.as_bytes()), read("obj", small.as_bytes()));
}

#[test]
fn colours_of_faces_and_of_stl_are_told() {
    let vertex = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let face = "element face 1\nproperty list uchar int vertex_indices\n";
    let colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    let ply = |colors: &str, values: &str| {
        let text = format!(
            "ply\nformat ascii 1.0\n{vertex}{face}{colors}end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2{values}\n"
        );
        read("ply", text.as_bytes()).notes
    };
    assert_eq!(ply(colors, " 1 2 3"), ["left out: colours of 1 face; those of vertices are read"]);
    assert!(ply("", "").is_empty());
    let stl = |header: &[u8], attributes: [u16; 2]| {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(2u32.to_le_bytes());
        for attribute in attributes {
            let corners = [0f32, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
            bytes.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend(attribute.to_le_bytes());
        }
        read("stl", &bytes).notes
    };
    assert!(stl(b"made by hand", [0, 0]).is_empty());
    assert!(stl(b"made by hand", [0x8001, 0])[0].contains("colours of 1 triangle,"));
    assert!(stl(b"by Magics COLOR=abcd", [0x8000, 0x8000]).is_empty(), "they have the colour of the header");
    assert!(stl(b"by Magics COLOR=abcd", [0x8000, 0x001f])[0].contains("colours of 1 triangle,"));
}

#[test]
fn stl_may_be_one_line_and_a_name_may_have_words_of_stl() {
    let lines = "solid a facet b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
                 endfacet\nendsolid a facet b\n";
    let mesh = read("stl", lines.as_bytes());
    assert_eq!(mesh.positions.len(), 3);
    assert_eq!(read("stl", lines.replace('\n', " ").as_bytes()), mesh);
    assert_eq!(read("stl", lines.replace("\nendsolid", " endsolid").as_bytes()), mesh);
}

#[test]
fn triangles_without_the_coordinates_of_their_picture_are_told() {
    let picture = image::RgbImage::from_pixel(1, 1, image::Rgb([1, 2, 3]));
    let library = "newmtl a\nmap_Kd a.png\nnewmtl b\nKd 1 0 0\n";
    let faces = "mtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\nf 1 2 3 4\nusemtl b\nf 1 2 3\n";
    let folder = folder(&[("m.mtl", library), ("q.obj", &format!("{QUAD}{faces}"))]);
    picture.save(folder.path().join("a.png")).unwrap();
    let notes = scene_in(folder.path(), "[[mesh]]\nfile = 'q.obj'\n").unwrap().notes;
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].contains("2 triangles of textured materials, the first \"a\""), "{notes:?}");
}

#[test]
fn a_node_or_a_scene_without_triangles_is_told() {
    let folder = stored(&document());
    fs::write(folder.path().join("q.obj"), format!("{QUAD}f 1 2 3\n")).unwrap();
    for (keys, part) in [("node = 1", "node \"1\""), ("scene = 0", "")] {
        let mesh = format!("[[mesh]]\nfile = 'q.obj'\n[[mesh]]\nfile = 'm.gltf'\n{keys}\n");
        let notes = scene_in(folder.path(), &mesh).unwrap().notes.join("\n");
        assert_eq!(notes.contains("has no triangles"), !part.is_empty(), "{keys}: {notes}");
        assert!(notes.contains(part), "{notes}");
    }
}

#[test]
fn corners_behind_the_last_whole_triangle_are_told() {
    let mut document = document();
    let bytes = document["buffers"][0]["uri"].as_str().unwrap().to_owned();
    document["accessors"][0]["count"] = json!(3);
    let told = |document: &Value| notes(document);
    assert!(!told(&document).contains("corners behind"));
    let indices = [0u8, 1, 2, 0, 1];
    let text = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, indices);
    document["buffers"] = json!([
        { "byteLength": 36, "uri": bytes },
        { "byteLength": 5, "uri": format!("data:application/octet-stream;base64,{text}") }
    ]);
    document["bufferViews"].as_array_mut().unwrap().push(json!({ "buffer": 1, "byteLength": 5 }));
    document["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "bufferView": 1, "componentType": 5121, "count": 5, "type": "SCALAR" }));
    document["meshes"][0]["primitives"][0]["indices"] = json!(1);
    let said = told(&document);
    assert!(said.contains("corners behind the last whole triangle are left out (at /accessors/1)"), "{said}");
}
