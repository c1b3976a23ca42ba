//! Many meshes, and meshes that stand in many places: rays meet by one tree over all what they meet mesh by mesh, triangles
//! are stored once however often they are seen, and what is seen is what copies of them show.

use std::fmt::Write as _;
use std::fs;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::DVec3;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::rays::{hit_surface, nearest_hit, occluded};
use moire::internal::pack::PackedScene;
use moire::internal::scene::load;
use moire::internal::scene::model::{Algorithm, Pattern, Scene};
use moire::internal::schema::layout::NO_SHAPE;
use tempfile::tempdir;

use super::trees::{apart, ball, compare_device, corners_of, queries, ray_of, taken_apart};
use super::{folder, scene_in};
use crate::stage::{packed, render, render_on_oracle};
use crate::tile_culling::assert_same;

/// Triangles of a ball, and the number of balls that save enough by standing in several places.
const TRIANGLES: usize = 2208;
const BALLS: usize = 31;

/// Where a ball stands: scale, rotation about y in degrees, translation.
fn place(i: usize) -> (f64, f64, DVec3) {
    let column = DVec3::new((i % 6) as f64 - 2.5, (i / 6) as f64 - 2.5, (i % 3) as f64 - 1.0);
    let size = [0.4, 0.3, 0.5, 0.35][i % 4] * if i % 5 == 4 { -1.0 } else { 1.0 };
    (size, 37.0 * i as f64, 0.9 * column)
}

/// The corners of a text of OBJ, each as often as a triangle has it: positions, coordinates, normals.
fn corners_in(text: &str) -> [Vec<f32>; 3] {
    let numbers = |kind: &str| -> Vec<Vec<f32>> {
        let lines = text.lines().filter_map(|line| line.strip_prefix(kind)?.strip_prefix(' '));
        lines.map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect()).collect()
    };
    let kinds = ["v", "vt", "vn"].map(numbers);
    let mut found = [const { Vec::new() }; 3];
    for corner in text.lines().filter_map(|line| line.strip_prefix("f ")).flat_map(|line| line.split(' ')) {
        for (k, index) in corner.split('/').enumerate() {
            found[k].extend(&kinds[k][index.parse::<usize>().unwrap() - 1]);
        }
    }
    // v of glTF grows downwards.
    found[1].chunks_mut(2).for_each(|uv| uv[1] = 1.0 - uv[1]);
    found
}

/// A glTF file of balls of two materials, one of which is red.
fn balls() -> Scene {
    let [positions, uvs, normals] = corners_in(&ball(true));
    let bytes: Vec<u8> =
        [&positions, &normals, &uvs].iter().flat_map(|list| bytemuck::cast_slice(list).to_vec()).collect();
    let corners = 3 * TRIANGLES;
    let (mut views, mut accessors, mut nodes, mut first) = (String::new(), String::new(), String::new(), 0);
    for (kind, parts) in [("VEC3", 3), ("VEC3", 3), ("VEC2", 2)] {
        let length = 4 * parts * corners;
        write!(views, "{{\"buffer\":0,\"byteOffset\":{first},\"byteLength\":{length}}},").unwrap();
        let view = accessors.matches("bufferView").count();
        write!(
            accessors,
            "{{\"bufferView\":{view},\"componentType\":5126,\"count\":{corners},\"type\":\"{kind}\"}},"
        )
        .unwrap();
        first += length;
    }
    for i in 0..BALLS {
        let (size, turn, at) = place(i);
        let (sin, cos) = (0.5 * turn.to_radians()).sin_cos();
        write!(
            nodes,
            "{{\"mesh\":{},\"translation\":{:?},\"rotation\":[0,{sin},0,{cos}],\"scale\":[{size},{size},{size}]}},",
            i % 2,
            at.to_array()
        )
        .unwrap();
    }
    let mesh = |material: usize| {
        format!(
            "{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}},\"material\":{material}}}]}}"
        )
    };
    let cut = |list: &str| list.trim_end_matches(',').to_owned();
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scenes\":[{{\"nodes\":{:?}}}],\"scene\":0,\"nodes\":[{}],\"meshes\":[{},{}],\
         \"materials\":[{{\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"metallicFactor\":0}}}},\
         {{\"doubleSided\":true,\"pbrMetallicRoughness\":{{\"metallicFactor\":0,\"baseColorFactor\":[0.8,0.1,0.1,1]}}}}],\
         \"accessors\":[{}],\"bufferViews\":[{}],\
         \"buffers\":[{{\"byteLength\":{first},\"uri\":\"data:application/octet-stream;base64,{}\"}}]}}",
        (0..BALLS).collect::<Vec<_>>(),
        cut(&nodes),
        mesh(0),
        mesh(1),
        cut(&accessors),
        cut(&views),
        BASE64_STANDARD.encode(bytes)
    );
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("balls.gltf"), text).unwrap();
    load(&folder.path().join("balls.gltf")).unwrap()
}

/// The same balls, each a mesh of a file of its own, in the scene of `balls`.
fn copies(like: &Scene) -> Scene {
    let (names, text) = ((0..BALLS).map(|i| format!("{i}.obj")).collect::<Vec<_>>(), ball(true));
    let folder = folder(&names.iter().map(|name| (name.as_str(), text.as_str())).collect::<Vec<_>>());
    let sections = (0..BALLS).map(|i| {
        let (size, turn, at) = place(i);
        let at = at.to_array();
        format!("[[mesh]]\nfile = '{i}.obj'\ntransform = {{ scale = [{size}, {size}, {size}], rotate = [0, {turn}, 0], translate = {at:?} }}\n")
    });
    let mut scene = scene_in(folder.path(), &sections.collect::<String>()).unwrap();
    (scene.camera, scene.width, scene.height) = (like.camera, like.width, like.height);
    scene
}

#[test]
fn triangles_in_many_places_are_stored_once_for_each_side_of_a_mirror() {
    let scene = balls();
    assert_eq!(scene.shapes.triangle_count(), BALLS * TRIANGLES);
    let (shared, copied) = (packed(scene.clone(), None), packed(copies(&scene), None));
    assert_eq!((shared.records.meshes.len(), copied.records.meshes.len()), (BALLS, BALLS));
    assert_eq!((shared.records.placements.len(), copied.records.placements.len()), (BALLS, 0));
    let texels = |packed: &PackedScene| packed.mesh_texels.len() as f64;
    assert!(texels(&shared) * (BALLS as f64 - 1.0) < 2.1 * texels(&copied), "{}", texels(&shared));
}

/// Rays towards all balls.
fn rays(scene: &Scene, count: usize) -> Vec<moire::internal::lab::probe::RayQuery> {
    let apart = corners_of(scene);
    let few: Vec<DVec3> = apart.into_iter().step_by(97).collect();
    queries(-scene.camera.eye, &few, count)
}

#[test]
fn the_oracle_meets_balls_in_many_places_where_copies_are() {
    let scene = balls();
    let (shared, copied) = (packed(scene.clone(), None), packed(copies(&scene), None));
    let (mut met, mut apart) = (0, 0);
    let queries = rays(&scene, 5000);
    for query in &queries {
        let ray = ray_of(query);
        let [found, wanted] = [&shared, &copied].map(|scene| nearest_hit(scene, &ray, NO_SHAPE));
        // Corners are off by parts of their coordinates.
        let length = ray.direction.length();
        if (found.t - wanted.t).abs() * length > 1e-5 * wanted.t * length + 4e-6 {
            // Beside a corner of the silhouette, few ways lead onto the triangle.
            let steps = [-1.0, 0.0, 1.0];
            let ways = steps
                .iter()
                .flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| DVec3::new(*x, *y, z))));
            let by_silhouette = ways.flat_map(|way| [3e-6 * way, 1e-5 * way]).any(|way| {
                let direction = ray.direction + length * way;
                let t = nearest_hit(&copied, &Ray { direction, ..ray }, NO_SHAPE).t;
                (t - found.t).abs() <= 1e-4 * t.min(1e6)
            });
            assert!(by_silhouette, "{query:?}: {found:?}, {wanted:?}");
            apart += 1;
            continue;
        }
        if found.shape == NO_SHAPE {
            continue;
        }
        met += 1;
        let [a, b] = [(&shared, found), (&copied, wanted)].map(|(scene, hit)| hit_surface(scene, &ray, &hit));
        assert!((a.point - b.point).length() < 1e-4 && a.inside == b.inside, "{query:?}");
        // Of two triangles at an edge either may be met.
        // At a pole, a triangle has any longitude.
        let is_pole = !(0.1..0.9).contains(&a.own_uv.y);
        let is_near = is_pole || a.own_uv.distance(b.own_uv) < 0.1 || a.own_uv.distance(b.own_uv) > 0.9;
        assert!(is_near && a.normal.dot(b.normal) > 0.95, "{query:?}: {a:?}, {b:?}");
        let t_max = f64::from(query.direction[3]);
        assert_eq!(occluded(&shared, &ray, t_max, NO_SHAPE), found.t < t_max, "{query:?}");
    }
    assert!(met > 1500 && apart < queries.len() / 50, "{met} met, {apart} apart");
}

/// Sections of one file share its triangles, each with its own material, matrix and motion.
#[test]
fn sections_of_one_file_are_held_once() {
    let scene = balls();
    let folder = folder(&[("ball.obj", &ball(true)), ("other.obj", &ball(true))]);
    let section = |file: &str, x: usize, more: &str| {
        format!("[[mesh]]\nfile = '{file}.obj'\ntransform = {{ translate = [{x}, 0, 0] }}\n{more}\n")
    };
    let red = "[[material]]\nname = 'red'\nmodel = 'unlit'\ncolor = [1, 0, 0]\n";
    let mut body = red.to_owned() + &section("ball", 0, "") + &section("other", 1, "");
    (1..BALLS).for_each(|i| body += &section("ball", 2 * i, ["", "material = 'red'"][i % 2]));
    let found = scene_in(folder.path(), &body).unwrap();
    let materials: Vec<&str> =
        found.shapes.meshes.iter().map(|mesh| found.materials[mesh.material].name.as_str()).collect();
    assert_eq!((materials.len(), materials[1], materials[3]), (BALLS + 1, "red", "red"));
    assert_ne!(materials[2], "red");
    let (packed, alone) = (packed(found, None), packed(scene, None));
    // As many as those of the two sides of a mirror, one for each file, beside the tree over all, which takes the mesh of
    // the other file apart.
    let (held, of_two) = (packed.mesh_texels.len(), alone.mesh_texels.len());
    assert!(held.abs_diff(of_two) < of_two / 8, "{held}, {of_two}");
    let unsuited = section("ball", 0, "") + &section("ball", 1, "node = 'a'");
    let said = crate::support::told(scene_in(folder.path(), &unsuited));
    assert!(said.contains("only glTF files") && said.contains(":8:"), "{said}");
}

#[test]
fn the_oracle_meets_by_one_tree_over_all_what_it_meets_one_by_one() {
    let folder = folder(&[("ball.obj", &ball(false))]);
    let section = |at: &str, more: &str| {
        format!("[[mesh]]\nfile = 'ball.obj'\ntransform = {{ translate = {at} }}\n{more}\n")
    };
    let body = section("[0, 0, 0]", "")
        + &section("[0.7, 0.4, 0]", "motion = [0.3, 0, 0]")
        + &section("[0, 0, 0]", "");
    let scene = scene_in(folder.path(), &body).unwrap();
    let (by_tree, one_by_one) = (packed(scene.clone(), None), packed(taken_apart(&scene), None));
    let (mut met, mut second, mut apart) = (0, 0, 0);
    for query in rays(&scene, 1500) {
        let ray = ray_of(&query);
        let [found, wanted] = [&by_tree, &one_by_one].map(|scene| nearest_hit(scene, &ray, NO_SHAPE));
        if (found.t - wanted.t).abs() > 1e-5 * wanted.t {
            apart += 1;
        } else if found.shape != NO_SHAPE {
            met += 1;
            second += usize::from(found.shape == 1);
            // The third lies where the first does, which is met before it.
            assert!(found.shape < 2, "{query:?}");
        }
    }
    assert!(met > 400 && second > 100 && apart < 15, "{met}, {second}, {apart}");
}

#[test]
fn devices_meet_what_the_oracle_meets_in_many_places_and_moving() {
    let scene = balls();
    let queries = rays(&scene, 4000);
    for keep_everything in [false, true] {
        compare_device(&packed(scene.clone(), None), &queries, keep_everything);
    }
    let mut moving = copies(&scene);
    moving.shapes.meshes.truncate(5);
    moving.shapes.meshes[2].motion = DVec3::new(0.4, 0.1, 0.0);
    let queries = rays(&moving, 4000);
    compare_device(&packed(moving, None), &queries, false);
}

#[test]
fn pictures_of_copies_and_of_balls_in_many_places_are_alike_by_every_algorithm() {
    let mut scene = balls();
    (scene.width, scene.height) = (48, 48);
    assert_same(&packed(scene.clone(), None), "in many places");
    scene.sampling.spp = 64;
    scene.sampling.pattern = Pattern::SobolOwen;
    // Of the same materials, lights and background.
    let mut shapes = copies(&scene).shapes;
    for (copy, mesh) in shapes.meshes.iter_mut().zip(&scene.shapes.meshes) {
        copy.material = mesh.material;
    }
    let copied = packed(Scene { shapes, ..scene.clone() }, None);
    assert_same(&copied, "copies");
    let wanted = render_on_oracle(&packed(scene.clone(), None));
    let found = apart(&render(&copied), &wanted);
    assert!(found < 0.01, "copies: {found}");
    for (algorithm, bound) in
        [(Algorithm::Samples, 0.01), (Algorithm::Adaptive, 0.02), (Algorithm::Cone, 0.3)]
    {
        scene.sampling.algorithm = algorithm;
        let found = apart(&render(&packed(scene.clone(), None)), &wanted);
        assert!(found < bound, "{algorithm}: {found}");
    }
}
