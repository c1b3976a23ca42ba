//! Tangents for normal maps by MikkTSpace (Mikkelsen 2008), as programs that bake such maps make them. Input: a mesh with
//! texture coordinates. Output: the same with a tangent at each corner that had none.

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{DVec2, DVec3, Vec4};

use super::Mesh;

impl Mesh {
    /// Gives a tangent to each triangle that has none; `second`: along the second texture coordinates. Corners at which
    /// these have no direction keep none.
    pub fn complete_tangents(&mut self, second: bool) {
        let count = self.triangles.len();
        self.tangents.resize(count, [Vec4::ZERO; 3]);
        if self.tangents.iter().all(|corners| *corners != [Vec4::ZERO; 3]) {
            return;
        }
        let mut made = Made { mesh: self, second, tangents: vec![[Vec4::ZERO; 3]; count] };
        if generate_tangents(&mut made).is_err() {
            return;
        }
        let made = made.tangents;
        for (own, made) in self.tangents.iter_mut().zip(made) {
            if *own == [Vec4::ZERO; 3] {
                *own = made;
            }
        }
    }
}

/// A mesh as the algorithm reads it, and what it writes.
struct Made<'a> {
    mesh: &'a Mesh,
    second: bool,
    tangents: Vec<[Vec4; 3]>,
}

impl Made<'_> {
    fn corners(&self, face: usize) -> [DVec3; 3] {
        self.mesh.triangles.positions()[face].map(|index| self.mesh.positions[index as usize])
    }
}

impl Geometry for Made<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.corners(face)[corner].as_vec3().into()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        let own =
            self.mesh.triangles.get(face).normals.map(|indices| self.mesh.normals[indices[corner] as usize]);
        let [a, b, c] = self.corners(face);
        let normal = own.and_then(DVec3::try_normalize).unwrap_or_else(|| (b - a).cross(c - a));
        normal.normalize_or(DVec3::Z).as_vec3().into()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let triangle = self.mesh.triangles.get(face);
        let uv = if self.second {
            self.mesh.second_uvs.get(triangle.positions[corner] as usize).copied()
        } else {
            triangle.uvs.map(|indices| self.mesh.uvs[indices[corner] as usize])
        };
        uv.unwrap_or(DVec2::ZERO).as_vec2().into()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(space) = space {
            let tangent = Vec4::from_array(space.tangent_encoded());
            self.tangents[face][corner] = if tangent.is_finite() { tangent } else { Vec4::ZERO };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MeshTriangle;

    /// A square in the plane z = 0 whose u grows along +x, or against it.
    fn square(mirrored: bool) -> Mesh {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(DVec2::from_array);
        let triangle = |positions: [u32; 3]| MeshTriangle {
            positions,
            uvs: Some(positions),
            normals: None,
            material: None,
        };
        Mesh {
            positions: corners.map(|c| c.extend(0.0)).to_vec(),
            uvs: corners.map(|c| if mirrored { DVec2::new(1.0 - c.x, c.y) } else { c }).to_vec(),
            triangles: [triangle([0, 1, 2]), triangle([0, 2, 3])].into_iter().collect(),
            ..Mesh::default()
        }
    }

    #[test]
    fn tangents_follow_u_and_know_mirrored_coordinates() {
        for (mirrored, expected) in
            [(false, Vec4::new(1.0, 0.0, 0.0, 1.0)), (true, Vec4::new(-1.0, 0.0, 0.0, -1.0))]
        {
            let mut mesh = square(mirrored);
            mesh.complete_tangents(false);
            let wrong = mesh.tangents.iter().flatten().find(|tangent| **tangent != expected);
            assert!(wrong.is_none() && mesh.tangents.len() == 2, "{mirrored}: {wrong:?}");
        }
    }

    #[test]
    fn tangents_of_the_file_stay() {
        let mut mesh = square(false);
        let own = [Vec4::new(0.0, 1.0, 0.0, -1.0); 3];
        mesh.tangents = vec![own];
        mesh.complete_tangents(false);
        assert_eq!(mesh.tangents[0], own);
        assert_eq!(mesh.tangents[1][0], Vec4::new(1.0, 0.0, 0.0, 1.0));
    }
}
