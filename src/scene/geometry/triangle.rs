//! `[[triangle]]`, with texture coordinates and shading normals of its corners.

use glam::{DVec2, DVec3};

use super::{Bounds, MaterialIndex, Shape, motion};
use crate::core::error::Result;
use crate::scene::reader::{COORDINATE, Field};
use crate::scene::table::Table;
use crate::scene::validate::collinear;

pub(in crate::scene) const KEYS: &[&str] = &["vertices", "uvs", "normals", "material", "motion"];

#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub vertices: [DVec3; 3],
    pub uvs: [DVec2; 3],
    /// Shading normals (any length, not zero); the geometric normal without.
    pub normals: Option<[DVec3; 3]>,
    pub material: usize,
    pub motion: DVec3,
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

/// None where the vertices lie on one line: meshes have such triangles, and no ray meets them.
pub(super) fn read(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Option<Triangle>> {
    let field = table.required("vertices")?;
    let vertices =
        field.array("3 vertices of 3 finite numbers each", [DVec3::ZERO; 3], |f| f.vec3(&COORDINATE))?;
    let mut uvs = [DVec2::ZERO, DVec2::X, DVec2::Y];
    if let Some(field) = table.get("uvs") {
        let wanted = "3 texture coordinates of 2 finite numbers each";
        uvs = field.array(wanted, uvs, |f| f.vec2(&COORDINATE))?;
    }
    let normals = table
        .get("normals")
        .map(|field| field.array("3 normals of 3 finite numbers each", [DVec3::Z; 3], Field::direction))
        .transpose()?;
    let triangle =
        Triangle { vertices, uvs, normals, material: materials.of(table)?, motion: motion(table)? };
    Ok((!collinear(vertices)).then_some(triangle))
}
