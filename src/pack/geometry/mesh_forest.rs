//! The tree over all meshes, at the front of the buffer of meshes. Input: their boxes, and where each one's own tree begins.
//! Output: nodes whose children are nodes, or meshes that move or have a matrix.

use std::sync::Arc;

use glam::DVec3;

use crate::pack::PackedScene;
use crate::scene::model::{Mesh, Scene, Shape};
use crate::schema::constants::{NO_PLACEMENT, TREE_MESH, TREE_WIDTH};
use crate::tree::{self, Child, Growing};

/// Shape of the tree over all meshes.
const OF_ALL: Growing = Growing { width: TREE_WIDTH as usize, leaf: 1, levels: LEVELS_OF_ALL };
/// Texels of a child of a node.
pub(super) const TEXELS_OF_CHILD: u32 = 2;
/// Room for as many meshes as a scene may have shapes.
pub(super) const LEVELS_OF_ALL: u32 = 8;
/// The boxes of meshes that are placed by a matrix grow by this part of their largest coordinate, as devices compute
/// the corners in f32.
const PLACED_PART: f32 = 1.0 / (1 << 19) as f32;

/// Begins the buffer of meshes with the tree over all, whose leaves are meshes; a single mesh that stays as it is needs none.
pub(super) fn begin(packed: &mut PackedScene, scene: &Scene, meshes: &[Mesh], eye: DVec3) {
    let moves = |mesh: &Mesh| mesh.motion != DVec3::ZERO;
    if meshes.iter().all(|mesh| !moves(mesh) && !mesh.is_shared()) && meshes.len() <= 1 {
        return;
    }
    let shutter = scene.camera.shutter;
    let boxes = meshes.iter().map(|mesh| {
        // Bounds exist, as there are triangles.
        let [min, max] = mesh.bounds().map_or([eye; 2], |bounds| [bounds.min, bounds.max]);
        let ways = shutter.map(|time| if moves(mesh) { time * mesh.motion } else { DVec3::ZERO });
        let low = (min + ways[0].min(ways[1]) - eye).as_vec3();
        let high = (max + ways[0].max(ways[1]) - eye).as_vec3();
        let is_exact = !moves(mesh) && !mesh.is_shared();
        let margin = if is_exact { 0.0 } else { PLACED_PART * low.abs().max(high.abs()).max_element() };
        [low - margin, high + margin]
    });
    let mut tree = tree::build(&boxes.collect::<Vec<_>>(), OF_ALL);
    for child in tree.children.iter_mut().filter(|child| child.is_used()) {
        if child.count > 0 {
            (child.reference, child.count) = (tree.order[child.reference as usize], TREE_MESH);
        } else {
            child.reference *= TEXELS_OF_CHILD;
        }
    }
    Arc::make_mut(&mut packed.mesh_texels).extend_from_slice(bytemuck::cast_slice(&tree.children));
}

/// Puts the roots of meshes that neither move nor have a matrix in place of them as leaves.
pub(super) fn finish(packed: &mut PackedScene) {
    let records = &packed.records;
    let first = records.meshes.iter().map(|mesh| mesh.nodes).min().unwrap_or(0) as usize;
    let texels = Arc::make_mut(&mut packed.mesh_texels);
    let shapes_before = records.motions.len().saturating_sub(records.meshes.len());
    for child in bytemuck::cast_slice_mut::<_, Child>(&mut texels[..first]) {
        if child.is_used() && child.count == TREE_MESH {
            let number = child.reference as usize;
            let mesh = &records.meshes[number];
            let moves = records.motions.get(shapes_before + number).is_some_and(|m| m.shift != DVec3::ZERO);
            if mesh.placement == NO_PLACEMENT && !moves {
                (child.reference, child.count) = (mesh.nodes, 0);
            }
        }
    }
}
