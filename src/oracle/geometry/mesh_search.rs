//! The way of a ray through the trees of meshes: the tree over all meshes begins at texel 0, or is that of the only mesh. A
//! mesh that moves, or has a matrix of its own as it shares its triangles, is a leaf: boxes below it are tested in its
//! space, triangles in that of the scene, as everywhere else. Twin of `glsl/shared/geometry/mesh_search.glsl`.

use glam::{DVec2, DVec3};

use super::hit::{Hit, at_rest};
use super::kinds::{Query, Search};
use super::mesh_tests::{MARGIN, Slabs, corners, distance_between, entry, mesh_texel, point_in, slabs_of};
use crate::oracle::camera::Ray;
use crate::pack::PackedScene;
use crate::schema::constants::{NO_PLACEMENT, TREE_MESH, TREE_STACK, TREE_WIDTH};
use crate::schema::layout::{Mesh, Placement};

/// The exchanges that sort the children of a node are for four.
const _: () = assert!(TREE_WIDTH == 4);

pub fn placement_of<'a>(scene: &'a PackedScene, mesh: &Mesh) -> Option<&'a Placement> {
    let is_placed = mesh.placement != NO_PLACEMENT;
    is_placed.then(|| &scene.records.placements[mesh.placement as usize])
}

pub fn placed_vector(placement: Option<&Placement>, v: DVec3) -> DVec3 {
    placement.map_or(v, |p| [p.x, p.y, p.z].map(|row| row.truncate().dot(v)).into())
}

pub fn placed_point(placement: Option<&Placement>, point: DVec3) -> DVec3 {
    placement.map_or(point, |p| [p.x, p.y, p.z].map(|row| row.dot(point.extend(1.0))).into())
}

/// By the inverse transpose.
pub fn placed_normal(placement: Option<&Placement>, n: DVec3) -> DVec3 {
    placement.map_or(n, |p| {
        let rows = [p.to_mesh_x, p.to_mesh_y, p.to_mesh_z].map(|row| row.truncate());
        (n.x * rows[0] + n.y * rows[1] + n.z * rows[2]).normalize()
    })
}

fn ray_in_mesh(placement: Option<&Placement>, ray: &Ray) -> Ray {
    placement.map_or(*ray, |p| {
        let rows = [p.to_mesh_x, p.to_mesh_y, p.to_mesh_z];
        Ray {
            origin: rows.map(|row| row.dot(ray.origin.extend(1.0))).into(),
            direction: rows.map(|row| row.dot(ray.direction.extend(0.0))).into(),
            ..*ray
        }
    })
}

/// As `distance_in` of the shader for triangles that are not placed. `at`: the texel of its corners.
fn distance_in_placed(
    scene: &PackedScene,
    at: u32,
    placement: Option<&Placement>,
    ray: &Ray,
    search: Search,
) -> f64 {
    let one_sided = search == Search::Nearest && mesh_texel(scene, at)[3] != 0;
    let corners = corners(scene, at).map(|corner| placed_point(placement, corner) - ray.origin);
    distance_between(corners, ray.direction, one_sided)
}

/// A triangle of a mesh, by the texel of its corners.
#[derive(Clone, Copy)]
pub struct FoundTriangle {
    mesh: u32,
    at: u32,
}

/// The mesh within which a search is, if that is a leaf of the tree over all, and the ray for which it is at rest.
pub struct Within<'a> {
    pub mesh: u32,
    pub placement: Option<&'a Placement>,
    pub ray: Ray,
}

/// Boxes of a mesh whose corners are moved grow by more: the matrix and its inverse may be rounded to f32 each for itself.
const PLACED_MARGIN: f64 = 1.0 / (1u64 << 15) as f64;

/// A child that waits: its reference, its number of triangles, and where the ray enters it.
type Waiting = (u32, u32, f64);

/// The nearest triangle up to `best`, or for `Any` just one, below the node at a texel: of those at the same t that of the
/// lowest mesh, in it the first in the tree's order. `first`: the shape that is the first mesh.
pub fn search<'a>(
    scene: &'a PackedScene,
    node: u32,
    mut inside: Option<Within<'a>>,
    first: u32,
    ray: &Ray,
    kind: Search,
    best: &mut f64,
) -> Option<FoundTriangle> {
    let mut found: Option<FoundTriangle> = None;
    let slabs_within = |inside: &Within| slabs_of(&ray_in_mesh(inside.placement, &inside.ray));
    let mut slabs = inside.as_ref().map_or_else(|| slabs_of(ray), slabs_within);
    let mut waiting = [(0, 0, 0.0); TREE_STACK as usize];
    let mut height = 0;
    // Those from here on are below a leaf of the tree over all.
    let mut ground = 0;
    let (mut reference, mut count) = (node, 0);
    loop {
        if count == TREE_MESH {
            let mesh = &scene.records.meshes[reference as usize];
            let at_rest = at_rest(scene, ray, first + reference);
            let within = Within { mesh: reference, placement: placement_of(scene, mesh), ray: at_rest };
            slabs = slabs_within(&within);
            inside = Some(within);
            (reference, count, ground) = (mesh.nodes, 0, height);
        }
        if count == 0 {
            let margin = if inside.is_some() { PLACED_MARGIN } else { MARGIN };
            let children = children_of(scene, reference, &slabs, margin, *best * slabs.longest);
            for child in children.into_iter().filter(|child| child.2 >= 0.0) {
                waiting[height] = child;
                height += 1;
            }
        }
        for at in (0..count).map(|k| reference + 3 * k) {
            let (placement, own) = inside.as_ref().map_or((None, ray), |w| (w.placement, &w.ray));
            let t = distance_in_placed(scene, at, placement, own, kind);
            let mesh = inside.as_ref().map_or_else(|| mesh_texel(scene, at + 1)[3], |within| within.mesh);
            let precedes = |other: &FoundTriangle| (mesh, at) < (other.mesh, other.at);
            if t > 0.0 && (t < *best || t == *best && found.as_ref().is_some_and(precedes)) {
                (*best, found) = (t, Some(FoundTriangle { mesh, at }));
            }
        }
        if kind == Search::Any && found.is_some() {
            return found;
        }
        // Equal distances are entered as well, for the first of equal triangles.
        while height > ground && waiting[height - 1].2 > *best * slabs.longest {
            height -= 1;
        }
        if height == ground && ground != 0 {
            (inside, slabs, ground) = (None, slabs_of(ray), 0);
            while height > 0 && waiting[height - 1].2 > *best * slabs.longest {
                height -= 1;
            }
        }
        if height == 0 {
            return found;
        }
        height -= 1;
        (reference, count, _) = waiting[height];
    }
}

/// The children of the node at a texel: the farthest first, those that are missed last.
fn children_of(scene: &PackedScene, node: u32, slabs: &Slabs, margin: f64, most: f64) -> [Waiting; 4] {
    let mut children = [0, 1, 2, 3].map(|k| {
        let [least, greatest] = [0, 1].map(|end| mesh_texel(scene, node + 2 * k + end));
        let enter = entry(slabs, point_in(least), point_in(greatest), margin, most);
        (least[3], greatest[3], enter)
    });
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        if children[i].2 < children[j].2 {
            children.swap(i, j);
        }
    }
    children
}

/// Material and map of a triangle are those of its mesh, whose shape follows `first`.
pub fn hit_of(scene: &PackedScene, found: &FoundTriangle, first: u32, t: f64) -> Hit {
    let index = mesh_texel(scene, found.at + 2)[3];
    Hit { t, shape: first + found.mesh, local: DVec2::new(f64::from(index), 0.0) }
}

/// Replaces the hit by the nearest triangle of a mesh, if that is nearer.
pub fn nearest_in_meshes(query: &Query, first: u32, hit: &mut Hit) {
    let mut best = hit.t;
    let found = search(query.scene, 0, None, first, query.ray, query.search, &mut best);
    if let Some(found) = found {
        *hit = hit_of(query.scene, &found, first, best);
    }
}

/// True when a triangle of a mesh lies before `t_max`.
pub fn occluded_by_meshes(query: &Query, first: u32, t_max: f64) -> bool {
    let mut best = t_max;
    search(query.scene, 0, None, first, query.ray, Search::Any, &mut best).is_some()
}
