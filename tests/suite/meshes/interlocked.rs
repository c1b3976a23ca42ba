//! Meshes that interlock, as those of a model's materials do: the tree over all takes them apart, and rays and pictures meet
//! what they meet without it.

use glam::Vec3;
use moire::internal::oracle::geometry::rays::nearest_hit;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Scene;
use moire::internal::schema::layout::NO_SHAPE;
use moire::internal::tree::Child;

use super::trees::{ball, compare_device, corners_of, queries, ray_of, taken_apart};
use super::{folder, scene_in};
use crate::stage::packed;
use crate::tile_culling::assert_same;

const MATERIALS: usize = 8;
const TRIANGLES: usize = 2208;

/// A ball whose pairs of triangles are of each material in turn.
fn interlocked() -> Scene {
    let ball = ball(true);
    let (vertices, faces): (Vec<&str>, Vec<&str>) = ball.lines().partition(|line| line.starts_with('v'));
    let library: String = (0..MATERIALS).map(|m| format!("newmtl m{m}\nKd 0.{m} 0.5 1\n")).collect();
    let faces = faces.chunks(2).enumerate();
    let faces: String =
        faces.map(|(i, pair)| format!("usemtl m{}\n{}\n", i % MATERIALS, pair.join("\n"))).collect();
    let text = format!("mtllib all.mtl\n{}\n{faces}", vertices.join("\n"));
    let folder = folder(&[("ball.obj", &text), ("all.mtl", &library)]);
    scene_in(folder.path(), "[[mesh]]\nfile = 'ball.obj'\n").unwrap()
}

fn children(scene: &PackedScene, node: u32) -> Vec<Child> {
    let children: &[Child] = bytemuck::cast_slice(&scene.mesh_texels[node as usize..node as usize + 8]);
    children.iter().copied().filter(Child::is_used).collect()
}

fn area(child: &Child) -> f32 {
    let [x, y, z] = (Vec3::from(child.max) - Vec3::from(child.min)).to_array();
    x * y + y * z + z * x
}

#[test]
fn the_tree_over_all_holds_every_triangle_once_in_boxes_that_hold_little_of_each_other() {
    let scene = packed(interlocked(), None);
    assert_eq!(scene.records.meshes.len(), MATERIALS);
    let top = children(&scene, 0);
    let least = top.iter().fold(Vec3::MAX, |least, child| least.min(child.min.into()));
    let greatest = top.iter().fold(Vec3::MIN, |greatest, child| greatest.max(child.max.into()));
    let whole = area(&Child { min: least.into(), max: greatest.into(), ..top[0] });
    // Those of whole meshes would be 4 together.
    let together = top.iter().map(area).sum::<f32>() / whole;
    assert!(together < 2.5, "{together}");

    let mut found = Vec::new();
    let mut waiting = top;
    while let Some(child) = waiting.pop() {
        let holds =
            |min: Vec3, max: Vec3| min.cmpge(child.min.into()).all() && max.cmple(child.max.into()).all();
        for triangle in 0..child.count {
            let at = (child.reference + 3 * triangle) as usize;
            for corner in &scene.mesh_texels[at..at + 3] {
                let point = Vec3::from_array([0, 1, 2].map(|axis| f32::from_bits(corner[axis])));
                assert!(holds(point, point), "{child:?}: {point}");
            }
            found.push(at);
        }
        if child.count == 0 {
            for below in children(&scene, child.reference) {
                assert!(holds(below.min.into(), below.max.into()), "{child:?}: {below:?}");
                waiting.push(below);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    assert_eq!(found.len(), TRIANGLES);
}

#[test]
fn rays_meet_interlocked_meshes_as_they_meet_their_triangles_one_by_one() {
    let scene = interlocked();
    let queries = queries(-scene.camera.eye, &corners_of(&scene), 4000);
    let (by_tree, one_by_one) = (packed(scene.clone(), None), packed(taken_apart(&scene), None));
    let (mut met, mut apart) = (0, 0);
    for ray in queries.iter().map(ray_of) {
        let [found, wanted] = [&by_tree, &one_by_one].map(|scene| nearest_hit(scene, &ray, NO_SHAPE));
        met += usize::from(found.shape != NO_SHAPE);
        // Rays through corners and edges may be on either side of a silhouette.
        apart += usize::from((found.t - wanted.t).abs() > 1e-5 * wanted.t);
    }
    assert!(met > 2000 && apart < 40, "{met} of 4000, {apart}");
    // Two fifths of the rays go through corners and edges, between triangles of different meshes.
    let within = queries.into_iter().enumerate().filter(|(i, _)| i % 5 > 1).map(|(_, query)| query);
    compare_device(&by_tree, &within.collect::<Vec<_>>(), false);
    assert_same(&by_tree, "interlocked");
}
