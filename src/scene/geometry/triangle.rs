//! `[[triangle]]`, with texture coordinates and shading normals of its corners.

use glam::{DVec2, DVec3};

use super::fields::required;
use super::{Bounds, Described, Facets, Fields};
use crate::core::error::Result;
use crate::scene::limits::{COORDINATE, collinear};
use crate::scene::model::{DEFAULT, Material};
use crate::scene::refusal::{Check, Key};

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Its corners; counter-clockwise as seen from its front.
    pub vertices: [DVec3; 3],
    /// Their texture coordinates.
    pub uvs: [DVec2; 3],
    /// Shading normals (any length, not zero); the geometric normal without.
    pub normals: Option<[DVec3; 3]>,
    /// Index of its material.
    pub material: usize,
    /// Its displacement between the times 0 and 1.
    pub motion: DVec3,
}

impl Triangle {
    /// Returns a flat triangle whose corners have the texture coordinates (0, 0), (1, 0) and (0, 1).
    pub fn new(vertices: [impl Into<DVec3>; 3]) -> Triangle {
        let uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let vertices = vertices.map(Into::into);
        Triangle { vertices, uvs, normals: None, material: DEFAULT, motion: DVec3::ZERO }
    }
}

impl Described for Triangle {
    const KEYS: &[&str] = &["vertices", "uvs", "normals"];
    const FACETS: Facets = Facets::One;

    fn read(fields: &dyn Fields, material: usize) -> Result<Triangle> {
        let vertices = required(fields, "vertices", |key| fields.vectors(key, "vertices"))?;
        let triangle = Triangle::new(vertices);
        let uvs = fields.coordinates("uvs")?.unwrap_or(triangle.uvs);
        Ok(Triangle { uvs, normals: fields.vectors("normals", "normals")?, material, ..triangle })
    }

    fn translate(&mut self, way: DVec3) {
        self.vertices = self.vertices.map(|v| v + way);
    }

    fn middle(&self) -> Option<DVec3> {
        Some(self.vertices.iter().sum::<DVec3>() / 3.0)
    }

    fn extent(&self) -> Option<Bounds> {
        let [a, b, c] = self.vertices;
        Some(Bounds { min: a.min(b).min(c), max: a.max(b).max(c) })
    }

    /// Meshes have triangles whose vertices lie on one line.
    fn is_empty(&self) -> bool {
        collinear(self.vertices)
    }

    fn check(&self, key: Key, _material: &Material) -> Check {
        for (i, vertex) in self.vertices.iter().enumerate() {
            key.of("vertices").at(i).vector(*vertex, &COORDINATE)?;
        }
        for (i, uv) in self.uvs.iter().enumerate() {
            key.of("uvs").at(i).numbers(uv.to_array(), &COORDINATE)?;
        }
        let mut normals = self.normals.iter().flatten().enumerate();
        normals.try_for_each(|(i, normal)| key.of("normals").at(i).direction(*normal))
    }
}
