//! `[[plane]]`: infinite, or a parallelogram about its origin.

use glam::DVec3;

use super::{Bounds, MaterialIndex, Shape, motion};
use crate::core::error::Result;
use crate::scene::model::{Material, Space};
use crate::scene::reader::{COORDINATE, LENGTH};
use crate::scene::source::quoted;
use crate::scene::table::Table;
use crate::scene::validate::parallel;

pub(in crate::scene) const KEYS: &[&str] =
    &["origin", "tangent", "bitangent", "half_extent", "material", "motion"];

#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub origin: DVec3,
    pub tangent: DVec3,
    pub bitangent: DVec3,
    /// Bounds |u| and |v|, measured in tangents and bitangents; infinite without.
    pub half_extent: Option<f64>,
    pub material: usize,
    /// How far it moves between the times 0 and 1.
    pub motion: DVec3,
}

impl Shape for Plane {
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
        self.origin += way;
    }

    fn centroid(&self) -> Option<DVec3> {
        self.half_extent.map(|_| self.origin)
    }

    fn bounds(&self) -> Option<Bounds> {
        let reach = self.half_extent? * (self.tangent.abs() + self.bitangent.abs());
        Some(Bounds { min: self.origin - reach, max: self.origin + reach })
    }
}

pub(super) fn read(
    table: &Table<'_>,
    index: &MaterialIndex<'_, '_>,
    materials: &[Material],
) -> Result<Plane> {
    let plane = plane(table, index)?;
    materials.get(plane.material).map_or(Ok(()), |m| check_bounds(table, &plane, m))?;
    Ok(plane)
}

fn plane(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Plane> {
    let origin = table.required("origin")?.vec3(&COORDINATE)?;
    let tangent = table.required("tangent")?.direction()?;
    let bitangent_field = table.required("bitangent")?;
    let bitangent = bitangent_field.direction()?;
    if parallel(tangent, bitangent) {
        let what = "tangent and bitangent are parallel and span no plane; turn one of them";
        return Err(bitangent_field.error(what, "parallel to tangent"));
    }
    let half_extent = table.get("half_extent").map(|field| field.number(&LENGTH)).transpose()?;
    let (material, motion) = (materials.of(table)?, motion(table)?);
    Ok(Plane { origin, tangent, bitangent, half_extent, material, motion })
}

/// A map in `space = "bounds"` measures in the shape's box, which an infinite plane lacks.
fn check_bounds(table: &Table<'_>, plane: &Plane, material: &Material) -> Result<()> {
    if plane.half_extent.is_some() || material.mapping.space != Space::Bounds {
        return Ok(());
    }
    let what = format!(
        "key \"plane.half_extent\" is missing in [[plane]]: material {} maps in space \"bounds\", and an \
         infinite plane has no bounds; set half_extent, or use space \"world\"",
        quoted(&material.name)
    );
    Err(table.error(&what, "infinite plane"))
}
