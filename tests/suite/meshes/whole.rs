//! What a mesh is does not depend on its number of triangles: its box, its centre, and its number in the layer of
//! instances are those of the mesh, or of the node of a glTF file, however few they are.

use std::fmt::Write as _;
use std::fs;

use moire::internal::scene::{Reading, load, load_as};
use serde_json::json;

use super::told::{document, stored};
use super::{folder, scene_in};
use crate::stage::packed;

/// A square of side 2 about the origin, cut into 2·n² triangles.
fn grid(n: usize) -> String {
    let mut text = String::new();
    let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
    for y in 0..=n {
        for x in 0..=n {
            writeln!(text, "v {} {} 0.5", at(x), at(y)).unwrap();
        }
    }
    for y in 0..n {
        for x in 0..n {
            let first = y * (n + 1) + x + 1;
            writeln!(text, "f {first} {} {} {}", first + 1, first + n + 2, first + n + 1).unwrap();
        }
    }
    text
}

const TEXTURED: &str = "[[texture]]\nname = 't'\nprocedural = 'checker'\n\
                        [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\n";

#[test]
fn boxes_and_centres_are_those_of_the_mesh_however_few_its_triangles_are() {
    let folder = folder(&[("few.obj", &grid(1)), ("many.obj", &grid(8))]);
    for mapping in [
        "{ kind = 'planar', axis = [0, 1, 0], space = 'bounds' }",
        "{ kind = 'spherical', entity = 'centroid' }",
        "{ kind = 'spherical', entity = 'centroid', space = 'bounds' }",
    ] {
        let maps = ["few", "many"].map(|name| {
            let mesh =
                format!("{TEXTURED}mapping = {mapping}\n[[mesh]]\nfile = '{name}.obj'\nmaterial = 'm'\n");
            let packed = packed(scene_in(folder.path(), &mesh).unwrap(), None);
            assert_eq!(packed.shape_count(), 1, "{name}: {mapping}");
            let map = packed.records.uv_projections[0];
            [map.x, map.y, map.z]
        });
        assert_eq!(maps[0], maps[1], "{mapping}");
    }
}

#[test]
fn few_triangles_stay_shapes_of_their_own_where_nothing_looks_at_the_mesh() {
    let folder = folder(&[("few.obj", &grid(1))]);
    for mapping in
        ["{}", "{ kind = 'planar', axis = [0, 1, 0] }", "{ kind = 'spherical', entity = 'normal' }"]
    {
        let mesh = format!("{TEXTURED}mapping = {mapping}\n[[mesh]]\nfile = 'few.obj'\nmaterial = 'm'\n");
        let shapes = scene_in(folder.path(), &mesh).unwrap().shapes;
        assert_eq!((shapes.triangles.len(), shapes.meshes.len()), (2, 0), "{mapping}");
    }
    let whole = Reading { keeps_meshes: true, ..Reading::default() };
    let shapes = load_as(&folder.path().join("few.obj"), &whole).unwrap().shapes;
    assert_eq!((shapes.triangles.len(), shapes.meshes.len()), (0, 1));
}

#[test]
fn nodes_of_one_material_are_one_shape_unless_something_looks_at_each() {
    let mut document = document();
    document["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0, "translation": [3, 0, 0] }));
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    // A node with two parts of one material is one.
    let part = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"].as_array_mut().unwrap().push(part);
    let folder = stored(&document);
    let path = folder.path().join("m.gltf");
    assert_eq!(load(&path).unwrap().shapes.meshes.len(), 1);
    let whole = Reading { keeps_meshes: true, ..Reading::default() };
    let shapes = load_as(&path, &whole).unwrap().shapes;
    assert_eq!(shapes.meshes.len(), 2);
    assert_eq!(shapes.triangle_count(), 4);
    for (mapping, count) in [("{ kind = 'planar', space = 'bounds' }", 2), ("{ kind = 'planar' }", 1)] {
        let mesh = format!("{TEXTURED}mapping = {mapping}\n[[mesh]]\nfile = 'm.gltf'\nmaterial = 'm'\n");
        assert_eq!(scene_in(folder.path(), &mesh).unwrap().shapes.meshes.len(), count, "{mapping}");
    }
}

/// Through the program: `instance` numbers two nodes, which are one shape of the picture.
#[test]
fn the_layer_of_instances_numbers_nodes() {
    let mut document = document();
    document["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0, "translation": [-1, -1, 0] }));
    document["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let folder = stored(&document);
    let out = folder.path().join("i.exr");
    let output = crate::support::moire()
        .args(["render", "--device", "oracle", "--aov", "instance", "--no-beauty", "--size", "16x16", "-o"])
        .arg(&out)
        .arg(folder.path().join("m.gltf"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(fs::metadata(&out).unwrap().len() > 0);
    let layers = exr::prelude::read_all_flat_layers_from_file(&out).unwrap();
    let channels = layers.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
    let mut seen: Vec<u32> = channels
        .filter(|channel| channel.name.to_string().ends_with("instance.Y") || channel.name.eq("Y"))
        .flat_map(|channel| channel.sample_data.values_as_f32().map(|x| x as u32).collect::<Vec<_>>())
        .collect();
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen, [0, 1, 2]);
}
