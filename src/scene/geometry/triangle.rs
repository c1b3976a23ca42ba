//! `[[triangle]]`, with texture coordinates and shading normals of its corners.

use glam::{DVec2, DVec3};

use super::{Bounds, Checked, Kind, Shape};
use crate::scene::builder::DEFAULT;
use crate::scene::limits::{COORDINATE, collinear};
use crate::scene::model::{Material, Scene};
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
    /// How far it moves between the times 0 and 1.
    pub motion: DVec3,
}

impl Triangle {
    /// Returns a flat triangle whose corners have the texture coordinates (0, 0), (1, 0) and (0, 1).
    pub fn new(vertices: [impl Into<DVec3>; 3]) -> Triangle {
        let uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let vertices = vertices.map(Into::into);
        Triangle { vertices, uvs, normals: None, material: DEFAULT, motion: DVec3::ZERO }
    }

    /// Returns whether its vertices lie on one line: meshes have such triangles, and no ray meets them.
    pub fn is_empty(&self) -> bool {
        collinear(self.vertices)
    }

    /// Returns it with the material of this index.
    pub fn with_material(self, material: usize) -> Triangle {
        Triangle { material, ..self }
    }
}

impl Shape for Triangle {
    fn material(&self) -> usize {
        self.material
    }

    fn material_mut(&mut self) -> &mut usize {
        &mut self.material
    }

    fn motion(&self) -> DVec3 {
        self.motion
    }

    fn freeze(&mut self, time: f64) {
        let way = time * std::mem::take(&mut self.motion);
        self.vertices = self.vertices.map(|v| v + way);
    }

    fn centroid(&self) -> Option<DVec3> {
        Some(self.vertices.iter().sum::<DVec3>() / 3.0)
    }

    fn bounds(&self) -> Option<Bounds> {
        let [a, b, c] = self.vertices;
        Some(Bounds { min: a.min(b).min(c), max: a.max(b).max(c) })
    }
}

impl Kind for Triangle {
    const SECTION: &str = "triangle";

    fn list(scene: &Scene) -> &Vec<Self> {
        &scene.triangles
    }

    fn list_mut(scene: &mut Scene) -> &mut Vec<Self> {
        &mut scene.triangles
    }
}

impl Checked for Triangle {
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
