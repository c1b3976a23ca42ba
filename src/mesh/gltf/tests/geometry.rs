//! Primitives: modes, indices, attributes, what is left out, and how much is read.

use glam::{DVec2, DVec3, DVec4};
use serde_json::json;

use super::super::read;
use super::build::{Build, f32s, no_files, u16s, u32s};

/// Returns a zigzag of five vertices in the plane z = 0.
fn zigzag(mode: usize) -> Build {
    let mut build = Build::new();
    let positions = [0., 0., 0., 0., 1., 0., 1., 0., 0., 1., 1., 0., 2., 0., 0.];
    build.attribute("POSITION", 5126, "VEC3", &f32s(&positions));
    build.set("/meshes/0/primitives/0/mode", json!(mode));
    build
}

#[test]
fn forms_triangles_by_mode() {
    assert_eq!(zigzag(5).read().unwrap().primitives[0].triangles, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    assert_eq!(zigzag(6).read().unwrap().primitives[0].triangles, [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
    // Two corners are left.
    assert_eq!(zigzag(4).read().unwrap().primitives[0].triangles, [[0, 1, 2]]);
    let mut build = zigzag(5);
    let indices = build.accessor(5121, "SCALAR", &[4, 3, 2, 1]);
    build.set("/meshes/0/primitives/0/indices", json!(indices));
    assert_eq!(build.read().unwrap().primitives[0].triangles, [[4, 3, 2], [3, 1, 2]]);
    for mode in 0..4 {
        let model = zigzag(mode).read().unwrap();
        assert!(model.instances.is_empty());
        assert_eq!(model.notes, ["points and lines are not drawn (at /meshes/0/primitives/0)"]);
    }
    assert_eq!(zigzag(7).fault(), "/meshes/0/primitives/0/mode: it is 7; 0 to 6 are allowed");
}

#[test]
fn keeps_one_direction_in_strips_and_fans() {
    let mut fan = Build::new();
    let pentagon = [0., 0., 0., 2., 0., 0., 3., 1., 0., 1., 3., 0., -1., 1., 0.];
    fan.attribute("POSITION", 5126, "VEC3", &f32s(&pentagon));
    fan.set("/meshes/0/primitives/0/mode", json!(6));
    for (build, sign) in [(zigzag(5), -1.0), (fan, 1.0)] {
        let primitive = build.read().unwrap().primitives.remove(0);
        assert_eq!(primitive.triangles.len(), 3);
        for corners in primitive.triangles {
            let [a, b, c] = corners.map(|corner| primitive.positions[corner as usize]);
            assert!((b - a).cross(c - a).z * sign > 0.0);
        }
    }
}

#[test]
fn reads_indices_of_every_type() {
    for (component, bytes) in [(5121, vec![2, 0, 1]), (5123, u16s(&[2, 0, 1])), (5125, u32s(&[2, 0, 1]))] {
        let mut build = Build::triangle();
        let indices = build.accessor(component, "SCALAR", &bytes);
        build.set("/meshes/0/primitives/0/indices", json!(indices));
        assert_eq!(build.read().unwrap().primitives[0].triangles, [[2, 0, 1]]);
        build.set("/accessors/1/normalized", json!(true));
        let what = "indices have to be of unsigned integers (5121, 5123, 5125), not normalized";
        assert_eq!(build.fault(), format!("/accessors/1/componentType: {what}"));
    }
    let mut build = Build::triangle();
    build.set("/meshes/0/primitives/0/indices", json!(1));
    let missing = "/meshes/0/primitives/0/indices: 1 does not exist; the file has 1 accessors";
    assert_eq!(build.fault(), missing);
    build.accessor(5121, "SCALAR", &[0, 1, 3]);
    assert_eq!(build.fault(), "/accessors/1: element 2 is 3; the primitive has 3 vertices");
    build.set("/accessors/1/type", json!("VEC2")).set("/accessors/1/count", json!(1));
    // One element makes no triangle, and its type does not matter.
    let few = "primitives of fewer than three corners are not drawn (at /meshes/0/primitives/0)";
    assert_eq!(build.read().unwrap().notes, [few]);
    build.accessor(5121, "VEC2", &[0; 6]);
    build.set("/meshes/0/primitives/0/indices", json!(2));
    assert_eq!(build.fault(), "/accessors/2/type: it is VEC2; indices have to be SCALAR");
}

#[test]
fn reads_every_attribute() {
    let mut build = Build::triangle();
    build.attribute("NORMAL", 5126, "VEC3", &f32s(&[0., 0., 2.].repeat(3)));
    build.attribute("TANGENT", 5126, "VEC4", &f32s(&[1., 0., 0., -1.].repeat(3)));
    build.attribute("TEXCOORD_0", 5126, "VEC2", &f32s(&[0., 0., 1., 0., 0., 1.]));
    build.attribute("TEXCOORD_1", 5126, "VEC2", &f32s(&[0.5, 0.25].repeat(3)));
    build.attribute("COLOR_0", 5126, "VEC3", &f32s(&[0.5, 2., 0.].repeat(3)));
    build.set("/meshes/0/name", json!("sail"));
    let model = build.read().unwrap();
    let primitive = &model.primitives[0];
    assert_eq!(primitive.name, "sail");
    assert_eq!(primitive.positions, [DVec3::ZERO, DVec3::X, DVec3::Y]);
    assert_eq!(primitive.normals, [DVec3::Z * 2.; 3]);
    assert_eq!(primitive.tangents, [DVec4::new(1., 0., 0., -1.); 3]);
    // As in the file, v downwards.
    assert_eq!(primitive.uvs[0], [DVec2::ZERO, DVec2::X, DVec2::Y]);
    assert_eq!(primitive.uvs[1], [DVec2::new(0.5, 0.25); 3]);
    assert_eq!(primitive.colors, [DVec4::new(0.5, 2., 0., 1.); 3]);
    assert!(model.notes.is_empty());
    build.json["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    let primitive = build.read().unwrap().primitives.remove(0);
    assert!(primitive.normals.is_empty() && primitive.tangents.is_empty());
}

#[test]
fn notes_what_it_ignores() {
    let mut build = Build::triangle();
    let part = "/meshes/0/primitives/0";
    for name in ["TEXCOORD_8", "TEXCOORD_10", "COLOR_1", "JOINTS_0", "WEIGHTS_0", "_OWN", "OTHER"] {
        build.set(&format!("{part}/attributes/{name}"), json!(0));
    }
    build.set(&format!("{part}/targets"), json!([{}]));
    build.set("/animations", json!([{}])).set("/nodes/0/skin", json!(0));
    build
        .set("/extensionsUsed", json!(["KHR_materials_sheen", "KHR_materials_unlit", "KHR_materials_sheen"]));
    let notes = build.read().unwrap().notes;
    assert_eq!(
        notes,
        [
            "animations are ignored (at /animations)",
            "skins are ignored; the mesh stands where its node is (at /nodes/0)",
            "morph targets are ignored (at /meshes/0/primitives/0)",
            "colours beyond COLOR_0 are ignored (at /meshes/0/primitives/0/attributes/COLOR_1)",
            "joints and weights are ignored (2 times, first at /meshes/0/primitives/0/attributes/JOINTS_0)",
            "texture coordinates beyond TEXCOORD_7 are ignored (2 times, first at \
             /meshes/0/primitives/0/attributes/TEXCOORD_10)",
            "extension \"KHR_materials_sheen\" is ignored",
        ]
    );
    let unused = Build::triangle().set("/nodes", json!([{ "skin": 0 }])).read().unwrap();
    assert_eq!(unused.notes, ["meshes that no node holds are not drawn (at /meshes/0)"]);
    let model = Build::new().read().unwrap();
    assert_eq!(model.notes, ["primitives without positions are not drawn (at /meshes/0/primitives/0)"]);
}

#[test]
fn leaves_out_triangles_without_an_area() {
    let mut build = Build::new();
    let positions = [0., 0., 0., 1., 0., 0., 0., 1., 0., 2., 0., 0., 1., 0., 0.];
    build.attribute("POSITION", 5126, "VEC3", &f32s(&positions));
    // Good, a corner twice, three in a line, two equal positions.
    let indices = build.accessor(5121, "SCALAR", &[0, 1, 2, 0, 0, 2, 0, 1, 3, 1, 4, 2]);
    build.set("/meshes/0/primitives/0/indices", json!(indices));
    let model = build.read().unwrap();
    assert_eq!(model.primitives[0].triangles, [[0, 1, 2]]);
    assert_eq!(model.notes, ["triangles without an area are left out (3 times, first at /accessors/0)"]);
    // However small or large, an area is one.
    for size in [1e-30, 1e30] {
        let mut build = Build::new();
        build.attribute("POSITION", 5126, "VEC3", &f32s(&[0., 0., 0., size, 0., 0., 0., size, 0.]));
        assert_eq!(build.read().unwrap().primitives[0].triangles.len(), 1);
    }
}

#[test]
fn reads_only_vertices_in_use() {
    let mut build = Build::new();
    let positions: Vec<f32> = (0..100).flat_map(|i| [i as f32, (i * i) as f32, 0.]).collect();
    build.attribute("POSITION", 5126, "VEC3", &f32s(&positions));
    let indices = build.accessor(5121, "SCALAR", &[90, 7, 50]);
    build.set("/meshes/0/primitives/0/indices", json!(indices));
    let primitive = build.read().unwrap().primitives.remove(0);
    assert_eq!(primitive.positions.iter().map(|p| p.x).collect::<Vec<_>>(), [7., 50., 90.]);
    assert_eq!(primitive.triangles, [[2, 0, 1]]);
}

#[test]
fn shares_what_is_equal() {
    let mut build = Build::triangle();
    build.set("/materials", json!([{}, {}]));
    build.set("/meshes/1", json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 1 }] }));
    build.set("/nodes/1", json!({ "mesh": 1 })).set("/nodes/2", json!({ "mesh": 0 }));
    let model = build.read().unwrap();
    assert_eq!(model.primitives.len(), 1);
    let found: Vec<_> = model.instances.iter().map(|i| (i.primitive, i.material, i.node)).collect();
    assert_eq!(found, [(0, None, 0), (0, Some(1), 1), (0, None, 2)]);
    let place = "/meshes/0/primitives/0/material";
    assert_eq!(
        build.set(place, json!(2)).fault(),
        format!("{place}: 2 does not exist; the file has 2 materials")
    );
}

#[test]
fn limits_triangles_of_all_meshes_however_often_they_are_drawn() {
    let mut build = Build::triangle();
    for node in 1..10 {
        build.set(&format!("/nodes/{node}"), json!({ "mesh": 0 }));
    }
    assert_eq!(read(&build.glb(), 1, no_files()).unwrap().instances.len(), 10);
    let same = build.json["meshes"][0].clone();
    build.set("/meshes/1", same).set("/nodes/9/mesh", json!(1));
    assert!(read(&build.glb(), 2, no_files()).is_ok());
    let fault = read(&build.glb(), 1, no_files()).unwrap_err().to_string();
    assert_eq!(fault, "/nodes/9: up to here, it has more than 1 triangles, the most a scene may have");
}
