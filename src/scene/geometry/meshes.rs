//! Meshes of files as triangles of a scene. Input: a mesh, its placement, and the index of each material. Output: its
//! triangles in the builder, or shapes that hold many. Positions are multiplied by the matrix, normals by its inverse
//! transpose; a mirroring matrix exchanges two corners, so that fronts stay fronts. v of a mesh file grows upwards, v of a
//! texture downwards.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, DVec4, EulerRot, Vec4};

use crate::mesh::{Mesh, MeshTriangle};
use crate::scene::builder::SceneBuilder;
use crate::scene::limits::{COORDINATE, collinear};
use crate::scene::model::{self as shapes, DEFAULT, Triangle};

/// Most triangles that are added one by one.
const FEW: usize = 64;

/// A transformation from a mesh's own space to the world.
pub(in crate::scene) type Placement = DAffine3;

/// Returns the transformation that scales, then rotates about x, y and z in this order (degrees), then translates.
pub(in crate::scene) fn placement(translate: DVec3, rotate: DVec3, scale: DVec3) -> Placement {
    let [x, y, z] = rotate.to_array().map(f64::to_radians);
    // Of intrinsic rotations the last one acts first.
    DAffine3::from_scale_rotation_translation(scale, DQuat::from_euler(EulerRot::ZYX, z, y, x), translate)
}

/// What is added to a scene for a mesh.
pub(in crate::scene) struct Part<'a> {
    pub placement: &'a Placement,
    /// An index for each material of the mesh.
    pub material_of: &'a [usize],
    /// The material of triangles that name none.
    pub other: usize,
    pub motion: DVec3,
    /// Some material is seen from the front only: no triangle is added one by one, as trees know sides.
    pub one_sided: bool,
}

/// Adds the triangles of a mesh: few one by one, so that beams and cones know their outlines, more as one shape for each
/// material. Returns how many have no area and were left out, or an error if a corner leaves the range of coordinates.
pub(in crate::scene) fn add(
    builder: &mut SceneBuilder,
    mesh: Mesh,
    part: &Part<'_>,
) -> Result<usize, String> {
    let placed = Placed::new(&mesh, part.placement);
    let outside = |p: &DVec3| !p.to_array().iter().all(|&x| (COORDINATE.allow)(x));
    if let Some(i) = placed.positions.iter().position(outside) {
        return Err(format!(
            "position {i} becomes {}, which is not {}",
            placed.positions[i], COORDINATE.words
        ));
    }
    let all = mesh.triangles.iter().zip(0u32..);
    let kept: Vec<(usize, u32)> = all
        .filter(|(triangle, _)| !collinear(placed.corners(triangle)))
        .map(|(triangle, index)| {
            let material = triangle.material.and_then(|i| part.material_of.get(i as usize)).copied();
            (material.filter(|&index| index != DEFAULT).unwrap_or(part.other), index)
        })
        .collect();
    let dropped = mesh.triangles.len() - kept.len();
    let motion = part.motion;
    if kept.len() <= FEW && !mesh.has_attributes() && !part.one_sided {
        for (material, index) in kept {
            builder.shape(Triangle { material, motion, ..placed.triangle(index) });
        }
        return Ok(dropped);
    }
    let mut of_material: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    kept.into_iter().for_each(|(material, index)| of_material.entry(material).or_default().push(index));
    let file = Arc::new(mesh);
    for (material, triangles) in of_material {
        let shape = shapes::Mesh::new(Arc::clone(&file), triangles.into(), *part.placement);
        builder.shape(shapes::Mesh { material, motion, ..shape });
    }
    Ok(dropped)
}

/// A mesh in the world.
pub(super) struct Placed<'a> {
    mesh: &'a Mesh,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    uvs: Vec<DVec2>,
    mirrors: bool,
}

impl Placed<'_> {
    pub fn new<'a>(mesh: &'a Mesh, placement: &Placement) -> Placed<'a> {
        let normal_matrix = normal_matrix(&placement.matrix3);
        Placed {
            mesh,
            positions: mesh.positions.iter().map(|p| placement.transform_point3(*p)).collect(),
            normals: mesh.normals.iter().map(|n| (normal_matrix * *n).normalize_or_zero()).collect(),
            uvs: mesh.uvs.iter().map(|uv| DVec2::new(uv.x, 1.0 - uv.y)).collect(),
            mirrors: placement.matrix3.determinant() < 0.0,
        }
    }

    fn corners(&self, triangle: &MeshTriangle) -> [DVec3; 3] {
        triangle.positions.map(|i| self.positions[i as usize])
    }

    /// Returns a triangle that lies still and has the default material.
    pub fn triangle(&self, index: u32) -> Triangle {
        let found = self.mesh.triangles[index as usize];
        let found = if self.mirrors { reversed(&found) } else { found };
        let flat = Triangle::new(self.corners(&found));
        let own = found.normals.map(|indices| indices.map(|i| self.normals[i as usize]));
        Triangle {
            uvs: found.uvs.map_or(flat.uvs, |indices| indices.map(|i| self.uvs[i as usize])),
            // Files have normals of length zero where a program could not make any.
            normals: own.filter(|normals| !normals.contains(&DVec3::ZERO)),
            ..flat
        }
    }
}

/// What the corners of a triangle have beside normals and texture coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CornerAttributes {
    pub colors: [Vec4; 3],
    pub second_uvs: [DVec2; 3],
    /// In the world, unit or zero, with the sign of the bitangent.
    pub tangents: [DVec4; 3],
}

impl Placed<'_> {
    /// Returns the attributes of a triangle's corners, in the order of `triangle`.
    pub fn attributes(&self, index: u32, placement: &Placement) -> CornerAttributes {
        let mesh = self.mesh;
        let found = mesh.triangles[index as usize];
        let order = if self.mirrors { [0, 2, 1] } else { [0, 1, 2] };
        let at = |corner: usize| found.positions[order[corner]] as usize;
        let tangents = mesh.tangents.get(index as usize).copied().unwrap_or_default();
        let sign = if self.mirrors { -1.0 } else { 1.0 };
        CornerAttributes {
            colors: [0, 1, 2].map(|corner| mesh.colors.get(at(corner)).copied().unwrap_or(Vec4::ONE)),
            second_uvs: [0, 1, 2].map(|corner| {
                let uv = mesh.second_uvs.get(at(corner)).copied().unwrap_or_default();
                DVec2::new(uv.x, 1.0 - uv.y)
            }),
            tangents: order.map(|corner| {
                let tangent = tangents[corner].as_dvec4();
                let way = placement.transform_vector3(tangent.truncate()).normalize_or_zero();
                way.extend(sign * tangent.w)
            }),
        }
    }
}

/// Returns the inverse transpose up to a positive factor, also of a matrix that flattens.
pub(in crate::scene) fn normal_matrix(matrix: &DMat3) -> DMat3 {
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
