//! The tree over all meshes, whose root is at the front of the buffer of meshes. Input: the meshes, and the buffer with the
//! tree of each one. Output: nodes whose children are nodes and triangles of those trees, or meshes that move or have a matrix.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::pack::PackedScene;
use crate::scene::model::{Mesh, Scene, Shape};
use crate::schema::constants::{NO_PLACEMENT, TREE_MESH, TREE_WIDTH};
use crate::schema::layout;
use crate::tree::{self, Child, Growing};

/// Shape of the tree over all meshes.
const OF_ALL: Growing = Growing { width: TREE_WIDTH as usize, leaf: 1, levels: LEVELS_OF_ALL };
/// Texels of a child of a node.
pub(super) const TEXELS_OF_CHILD: u32 = 2;
const TEXELS_OF_NODE: usize = (TEXELS_OF_CHILD * TREE_WIDTH) as usize;
/// Room for as many meshes as a scene may have shapes.
pub(super) const LEVELS_OF_ALL: u32 = 8;
/// The boxes of meshes that are placed by a matrix grow by this part of their largest coordinate, as devices compute
/// the corners in f32.
const PLACED_PART: f32 = 1.0 / (1 << 19) as f32;

/// Pieces of the trees of meshes over which that tree is built, a mesh: where meshes interlock, as those of a model's
/// materials do, the boxes of whole meshes would hold much of each other (Benthin et al. 2017, "Improved Two-Level BVHs
/// using Partial Re-Braiding").
const PIECES_OF_MESH: usize = 64;
/// Most pieces, unless there are more meshes: their tree takes some milliseconds.
const MAX_PIECES: usize = 1 << 13;

/// Begins the buffer of meshes with room for the root of the tree over all, which follows the meshes; a single mesh that
/// stays as it is needs none.
pub(super) fn begin(packed: &mut PackedScene, meshes: &[Mesh]) {
    if needs_forest(meshes) {
        Arc::make_mut(&mut packed.mesh_texels).resize(TEXELS_OF_NODE, [0; 4]);
    }
}

fn needs_forest(meshes: &[Mesh]) -> bool {
    meshes.len() > 1 || meshes.iter().any(|mesh| moves(mesh) || mesh.is_shared())
}

fn moves(mesh: &Mesh) -> bool {
    mesh.motion != DVec3::ZERO
}

/// Builds the tree over all meshes, whose own trees are in the buffer.
pub(super) fn finish(packed: &mut PackedScene, scene: &Scene) {
    let meshes = &scene.shapes.meshes;
    if !needs_forest(meshes) {
        return;
    }
    let texels = Arc::make_mut(&mut packed.mesh_texels);
    let pieces = pieces(scene, &packed.records.meshes, texels);
    let boxes: Vec<[Vec3; 2]> = pieces.iter().map(|piece| [piece.min.into(), piece.max.into()]).collect();
    let mut tree = tree::build(&boxes, OF_ALL);
    // The node of the first children is at the front, all others are behind the meshes.
    let behind = (texels.len() - TEXELS_OF_NODE) as u32;
    for child in tree.children.iter_mut().filter(|child| child.is_used()) {
        if child.count > 0 {
            let piece = pieces[tree.order[child.reference as usize] as usize];
            (child.reference, child.count) = (piece.reference, piece.count);
        } else {
            child.reference = behind + TEXELS_OF_CHILD * child.reference;
        }
    }
    let nodes: &[[u32; 4]] = bytemuck::cast_slice(&tree.children);
    let (root, others) = nodes.split_at(TEXELS_OF_NODE);
    texels[..TEXELS_OF_NODE].copy_from_slice(root);
    texels.reserve_exact(others.len());
    texels.extend_from_slice(others);
}

/// Returns what the leaves of the tree over all stand for: meshes that move or have a matrix, and nodes or triangles of
/// the trees of others, the largest of which are opened.
fn pieces(scene: &Scene, records: &[layout::Mesh], texels: &[[u32; 4]]) -> Vec<Child> {
    let meshes = &scene.shapes.meshes;
    let most = (PIECES_OF_MESH * meshes.len()).min(MAX_PIECES);
    let (mut done, mut open) = (Vec::new(), BinaryHeap::new());
    for (mesh, number) in meshes.iter().zip(0..) {
        let record = &records[number as usize];
        if moves(mesh) || record.placement != NO_PLACEMENT {
            let [min, max] = box_of_leaf(scene, mesh).map(|corner| corner.to_array());
            done.push(Child { min, reference: number, max, count: TREE_MESH });
        } else {
            let [min, max] = children_at(texels, record.nodes)
                .fold([Vec3::MAX, Vec3::MIN], |[min, max], child| {
                    [min.min(child.min.into()), max.max(child.max.into())]
                });
            let root = Child { min: min.into(), reference: record.nodes, max: max.into(), count: 0 };
            open.push(Piece(root));
        }
    }
    while done.len() + open.len() + TREE_WIDTH as usize <= most {
        let Some(Piece(piece)) = open.pop() else { break };
        for child in children_at(texels, piece.reference) {
            if child.count > 0 { done.push(child) } else { open.push(Piece(child)) }
        }
    }
    done.extend(open.into_iter().map(|Piece(child)| child));
    done
}

/// Returns the children of the node at a texel that are used.
fn children_at(texels: &[[u32; 4]], node: u32) -> impl Iterator<Item = Child> {
    let children = &texels[node as usize..][..TEXELS_OF_NODE];
    bytemuck::cast_slice::<_, Child>(children).iter().copied().filter(Child::is_used)
}

/// Returns the box of a mesh that is a leaf, as seen from the eye, over all times.
fn box_of_leaf(scene: &Scene, mesh: &Mesh) -> [Vec3; 2] {
    let eye = scene.camera.eye;
    // Bounds exist, as there are triangles.
    let [min, max] = mesh.bounds().map_or([eye; 2], |bounds| [bounds.min, bounds.max]);
    let ways = scene.camera.shutter.map(|time| time * mesh.motion);
    let low = (min + ways[0].min(ways[1]) - eye).as_vec3();
    let high = (max + ways[0].max(ways[1]) - eye).as_vec3();
    let margin = PLACED_PART * low.abs().max(high.abs()).max_element();
    [low - margin, high + margin]
}

/// A node of the tree of a mesh, by the area of its box; of equal ones the one in front in the buffer is the greater.
struct Piece(Child);

impl Piece {
    fn rank(&self) -> (f32, Reverse<u32>) {
        let [x, y, z] = (Vec3::from(self.0.max) - Vec3::from(self.0.min)).to_array();
        (x * y + y * z + z * x, Reverse(self.0.reference))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Piece) -> Ordering {
        let (own, its) = (self.rank(), other.rank());
        own.0.total_cmp(&its.0).then(own.1.cmp(&its.1))
    }
}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Piece) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Piece {
    fn eq(&self, other: &Piece) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Piece {}
