//! `[[sphere]]`.

use glam::DVec3;

use super::{Bounds, MaterialIndex, Shape, motion};
use crate::core::error::Result;
use crate::scene::reader::{COORDINATE, LENGTH};
use crate::scene::table::Table;

pub(in crate::scene) const KEYS: &[&str] = &["center", "radius", "material", "motion"];

#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
    pub material: usize,
    pub motion: DVec3,
}

impl Shape for Sphere {
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
        self.center += way;
    }

    fn centroid(&self) -> Option<DVec3> {
        Some(self.center)
    }

    fn bounds(&self) -> Option<Bounds> {
        let reach = DVec3::splat(self.radius);
        Some(Bounds { min: self.center - reach, max: self.center + reach })
    }
}

pub(super) fn read(table: &Table<'_>, materials: &MaterialIndex<'_, '_>) -> Result<Sphere> {
    let center = table.required("center")?.vec3(&COORDINATE)?;
    let radius = table.required("radius")?.number(&LENGTH)?;
    Ok(Sphere { center, radius, material: materials.of(table)?, motion: motion(table)? })
}
