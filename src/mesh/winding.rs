//! Normals and the order of corners of a mesh that does not say which of the two is right. Input: the mesh as its file has
//! it. Output: normals that are finite, and triangles that run counter-clockwise as seen from where their normals point;
//! what was changed is noted with its count.

use glam::DVec3;

use super::{Mesh, MeshTriangle};
use crate::core::counted::{counted, verb};

/// Makes normals that are not finite zero, which stands for none, and turns triangles around whose three normals point
/// away from their fronts.
pub(super) fn settle(mesh: &mut Mesh) {
    let is_none = |normal: &&mut DVec3| !normal.is_finite();
    let none = mesh.normals.iter_mut().filter(is_none).map(|normal| *normal = DVec3::ZERO).count();
    if none > 0 {
        let (normals, verb) = (counted(none, "normal"), verb(none, "is", "are"));
        mesh.notes.push(format!("{normals} of it {verb} not finite; triangles there are flat"));
    }
    let turned = turn(mesh);
    if turned > 0 {
        let (triangles, verb) = (counted(turned, "triangle"), verb(turned, "is", "are"));
        mesh.notes.push(format!("{triangles} {verb} turned around, as all three normals point backwards"));
    }
}

/// Turns triangles around and returns how many.
fn turn(mesh: &mut Mesh) -> usize {
    let Mesh { positions, normals, triangles, .. } = mesh;
    let points_back = |triangle: &MeshTriangle| {
        let [a, b, c] = triangle.positions.map(|i| positions[i as usize]);
        let front = (b - a).cross(c - a);
        triangle.normals.is_some_and(|own| own.iter().all(|&i| normals[i as usize].dot(front) < 0.0))
    };
    if normals.is_empty() { 0 } else { triangles.turn_where(points_back) }
}
