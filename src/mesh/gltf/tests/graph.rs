//! Nodes, scenes and copies: matrices and their order, what belongs to a scene, graphs that are no forest.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::{DAffine3, DVec3};
use serde_json::{Value, json};

use super::build::{Build, f32s, fault_with, i8s};

/// Returns the matrix of the only instance of a file with this node.
fn matrix(node: Value) -> DAffine3 {
    let mut build = Build::triangle();
    build.set("/nodes/0", node).set("/nodes/0/mesh", json!(0));
    build.read().unwrap().instances[0].matrix
}

/// Compares a point to three numbers.
fn near(point: DVec3, expected: [f64; 3]) {
    assert!(point.abs_diff_eq(DVec3::from_array(expected), 1e-6), "{point} is not {expected:?}");
}

#[test]
fn scales_then_rotates_then_moves() {
    let quarter = [0., 0., FRAC_1_SQRT_2, FRAC_1_SQRT_2];
    let node = json!({ "translation": [10, 20, 30], "rotation": quarter, "scale": [2, 3, -4] });
    let matrix = matrix(node);
    near(matrix.transform_point3(DVec3::X), [10., 22., 30.]);
    near(matrix.transform_point3(DVec3::Y), [7., 20., 30.]);
    near(matrix.transform_point3(DVec3::Z), [10., 20., 26.]);
    assert!(matrix.matrix3.determinant() < 0.0);
}

#[test]
fn reads_matrices_by_columns() {
    let matrix = matrix(json!({ "matrix": [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1] }));
    near(matrix.transform_point3(DVec3::ZERO), [11., 12., 13.]);
    near(matrix.transform_vector3(DVec3::X), [1., 2., 3.]);
    near(matrix.transform_vector3(DVec3::Z), [7., 8., 10.]);
}

#[test]
fn multiplies_from_the_root() {
    let mut build = Build::triangle();
    build.set("/nodes/1", json!({ "children": [0], "scale": [2, 2, 2] }));
    build.set("/nodes/2", json!({ "children": [1], "translation": [1, 0, 0] }));
    build.set("/nodes/0/translation", json!([0, 5, 0])).set("/scenes/0/nodes", json!([2]));
    let model = build.read().unwrap();
    near(model.instances[0].matrix.transform_point3(DVec3::X), [3., 10., 0.]);
    assert_eq!(model.instances[0].matrix, model.nodes[0].matrix);
}

#[test]
fn normalizes_rotations() {
    let matrix = matrix(json!({ "rotation": [0, 0, 5e200, 5e200] }));
    near(matrix.transform_vector3(DVec3::X), [0., 1., 0.]);
    let fault = fault_with("/nodes/0/rotation", json!([0, 0, 0, 0]));
    assert_eq!(fault, "/nodes/0/rotation: it has no length");
}

#[test]
fn refuses_wrong_nodes() {
    let identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    let mut projective = identity;
    projective[3] = 1;
    for (node, fault) in [
        (
            json!({ "matrix": identity, "scale": [1, 1, 1] }),
            "/matrix: a node has either a matrix or translation, rotation and scale",
        ),
        (json!({ "matrix": projective }), "/matrix: its last row is [1, 0, 0, 1]; [0, 0, 0, 1] is needed"),
        (json!({ "matrix": [1, 2] }), "/matrix: it is [1,2]; a list of 16 numbers is needed"),
        (json!({ "scale": ["a", 1, 1] }), "/scale: it is [\"a\",1,1]; a list of 3 numbers is needed"),
        (json!({ "mesh": 1 }), "/mesh: 1 does not exist; the file has 1 meshes"),
        (json!({ "camera": 0 }), "/camera: 0 does not exist; the file has 0 cameras"),
        (json!({ "children": [4] }), "/children/0: 4 does not exist; the file has 1 nodes"),
        (json!({ "children": [0] }), "/children: the node is below itself"),
        (json!({ "children": {} }), "/children: it is {}; a list is needed"),
        (json!({ "name": 3 }), "/name: it is 3; a text is needed"),
    ] {
        assert_eq!(fault_with("/nodes/0", node), format!("/nodes/0{fault}"));
    }
    let mut build = Build::triangle();
    build.set("/nodes/0/scale", json!([1e300, 1, 1])).set("/nodes/0/children", json!([1]));
    build.set("/nodes/1", json!({ "scale": [1e300, 1, 1] }));
    assert_eq!(build.fault(), "/nodes/1: its matrix, times those above it, has numbers that are not finite");
}

#[test]
fn refuses_graphs_that_are_no_forest() {
    let mut build = Build::triangle();
    build.set("/nodes/0/children", json!([1])).set("/nodes/1", json!({ "children": [2] }));
    build.set("/nodes/2", json!({}));
    assert!(build.read().is_ok());
    let twice = build.clone().set("/nodes/0/children", json!([1, 2])).fault();
    assert_eq!(twice, "/nodes/1/children/0: node 2 is a child of node 0 already");
    let twice = build.clone().set("/nodes/0/children", json!([1, 1])).fault();
    assert_eq!(twice, "/nodes/0/children/1: node 1 is a child of node 0 already");
    // The first three nodes stand below the circle of the other two.
    build.set("/nodes/3", json!({ "children": [4] })).set("/nodes/4", json!({ "children": [3, 0] }));
    assert_eq!(build.fault(), "/nodes/4/children: the node is below itself");
}

#[test]
fn limits_depth() {
    let chain = |length: usize| {
        let mut build = Build::triangle();
        for node in 1..length {
            build.set(&format!("/nodes/{}/children", node - 1), json!([node]));
            build.set(&format!("/nodes/{node}"), json!({}));
        }
        build
    };
    assert_eq!(chain(256).read().unwrap().nodes.len(), 256);
    assert_eq!(chain(257).fault(), "/nodes/256: it is more than 256 nodes deep");
}

#[test]
fn tells_scenes_and_branches_apart() {
    let mut build = Build::triangle();
    build.set(
        "/nodes",
        json!([{ "children": [1], "name": "a" }, { "mesh": 0, "name": "b" }, { "name": "b" }, {}]),
    );
    build.set("/scenes", json!([{ "nodes": [0], "name": "one" }, { "nodes": [2, 0] }, {}]));
    build.set("/scene", json!(1));
    let model = build.read().unwrap();
    assert_eq!((model.default_scene, model.scenes[0].name.as_str()), (1, "one"));
    assert_eq!(model.in_scene(0), [true, true, false, false]);
    assert_eq!(model.in_scene(1), [true, true, true, false]);
    assert_eq!(model.in_scene(2), [false; 4]);
    assert_eq!(model.in_scene(3), [false; 4]);
    assert_eq!(model.named("b"), [1, 2]);
    assert_eq!(model.below(&model.named("b")), [false, true, true, false]);
    let long = build.clone().set("/nodes/3/name", json!("é".repeat(300))).read().unwrap();
    assert_eq!(long.nodes[3].name, "é".repeat(256));
    let inner = build.clone().set("/scenes/0/nodes/0", json!(1)).fault();
    assert_eq!(inner, "/scenes/0/nodes/0: node 1 is a child of node 0; scenes list roots");
    assert_eq!(
        build.clone().set("/scene", json!(3)).fault(),
        "/scene: 3 does not exist; the file has 3 scenes"
    );
    build.json["scene"].take();
    assert_eq!(build.read().unwrap().default_scene, 0);
    build.json["scenes"].take();
    let model = build.read().unwrap();
    assert_eq!((model.scenes.len(), model.in_scene(0)), (1, vec![true; 4]));
}

#[test]
fn copies_instances() {
    let mut build = Build::triangle();
    build.set("/nodes/0/scale", json!([2, 2, 2]));
    let translation = build.accessor(5126, "VEC3", &f32s(&[1., 0., 0., 0., 1., 0.]));
    let rotation = build.accessor(5120, "VEC4", &i8s(&[0, 0, 0, 127, 0, 0, 90, 90]));
    build.set(&format!("/accessors/{rotation}/normalized"), json!(true));
    let scale = build.accessor(5126, "VEC3", &f32s(&[1., 1., 1., 3., 3., 3.]));
    let place = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    build.set(place, json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale, "_ID": 0 }));
    let model = build.read().unwrap();
    assert_eq!(model.instances.len(), 2);
    near(model.instances[0].matrix.transform_point3(DVec3::X), [4., 0., 0.]);
    near(model.instances[1].matrix.transform_point3(DVec3::X), [0., 8., 0.]);
    assert_eq!(build.clone().set(place, json!({ "_ID": 0 })).read().unwrap().instances.len(), 1);
    let short = build.clone().set("/accessors/1/count", json!(1)).fault();
    assert_eq!(short, "/accessors/2/count: it is 2; ROTATION has to have 1 elements here");
    let wrong = build.clone().set(&format!("{place}/SCALE"), json!(rotation)).fault();
    assert_eq!(wrong, "/accessors/2/type: it is VEC4; SCALE has to be VEC3");
    build.bytes[36 + 24..36 + 28].fill(0);
    assert_eq!(build.fault(), "/accessors/2: element 0, a rotation, has no length");
    // Copies of zeros need no bytes, but count as places.
    build.set("/accessors/4", json!({ "componentType": 5126, "type": "VEC3", "count": 1 << 20 }));
    build.set(place, json!({ "TRANSLATION": 4 }));
    assert_eq!(build.read().unwrap().instances.len(), 1 << 20);
    build.set("/nodes/1", json!({ "mesh": 0 }));
    let what = "1048576 places where primitives of meshes stand, the most that are drawn";
    assert_eq!(build.fault(), format!("/nodes/1: up to here, it has more than {what}"));
}
