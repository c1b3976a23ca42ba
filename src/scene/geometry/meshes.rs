//! Meshes of files as triangles of a scene. Input: a mesh, its placement, and the index of each material. Output: its
//! triangles in the builder. Positions are multiplied by the matrix, normals by its inverse transpose; a mirroring
//! matrix exchanges two corners, so that fronts stay fronts. v of a mesh file grows upwards, v of a texture downwards.

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, EulerRot};

use crate::mesh::{Mesh, MeshTriangle};
use crate::scene::builder::SceneBuilder;
use crate::scene::limits::COORDINATE;
use crate::scene::model::{DEFAULT, Triangle};

/// A transformation from a mesh's own space to the world.
pub(in crate::scene) type Placement = DAffine3;

/// Returns the transformation that scales, then rotates about x, y and z in this order (degrees), then translates.
pub(in crate::scene) fn placement(translate: DVec3, rotate: DVec3, scale: DVec3) -> Placement {
    let [x, y, z] = rotate.to_array().map(f64::to_radians);
    // Of intrinsic rotations the last one acts first.
    DAffine3::from_scale_rotation_translation(scale, DQuat::from_euler(EulerRot::ZYX, z, y, x), translate)
}

/// Adds the triangles of a mesh; `material_of` has an index for each material of the mesh, and `other` is that of
/// triangles that name none. Returns an error if a corner leaves the range of coordinates.
pub(in crate::scene) fn add(
    builder: &mut SceneBuilder,
    mesh: &Mesh,
    placement: &Placement,
    material_of: &[usize],
    other: usize,
    motion: DVec3,
) -> Result<(), String> {
    let positions: Vec<DVec3> = mesh.positions.iter().map(|p| placement.transform_point3(*p)).collect();
    if let Some(i) = positions.iter().position(|p| !p.to_array().iter().all(|&x| (COORDINATE.allow)(x))) {
        return Err(format!("position {i} becomes {}, which is not {}", positions[i], COORDINATE.words));
    }
    let normal_matrix = normal_matrix(&placement.matrix3);
    let normals: Vec<DVec3> = mesh.normals.iter().map(|n| (normal_matrix * *n).normalize_or_zero()).collect();
    let uvs: Vec<DVec2> = mesh.uvs.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect();
    let mirrors = placement.matrix3.determinant() < 0.0;
    for found in &mesh.triangles {
        let triangle = if mirrors { reversed(found) } else { *found };
        let material = triangle.material.and_then(|i| material_of.get(i as usize)).copied();
        let corners = |indices: [u32; 3], list: &[DVec3]| indices.map(|i| list[i as usize]);
        let own = triangle.normals.map(|indices| corners(indices, &normals));
        let flat = Triangle::new(corners(triangle.positions, &positions));
        builder.shape(Triangle {
            uvs: triangle.uvs.map_or(flat.uvs, |indices| indices.map(|i| uvs[i as usize])),
            // Files have normals of length zero where a program could not make any.
            normals: own.filter(|normals| !normals.contains(&DVec3::ZERO)),
            material: material.filter(|&index| index != DEFAULT).unwrap_or(other),
            motion,
            ..flat
        });
    }
    Ok(())
}

/// Returns the inverse transpose up to a positive factor, also of a matrix that flattens.
fn normal_matrix(matrix: &DMat3) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if matrix.determinant() < 0.0 { -cofactors } else { cofactors }
}

fn reversed(triangle: &MeshTriangle) -> MeshTriangle {
    let swap = |[a, b, c]: [u32; 3]| [a, c, b];
    MeshTriangle {
        positions: swap(triangle.positions),
        uvs: triangle.uvs.map(swap),
        normals: triangle.normals.map(swap),
        ..*triangle
    }
}
