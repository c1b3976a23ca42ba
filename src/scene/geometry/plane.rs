//! `[[plane]]`: infinite, or a parallelogram about its origin.

use glam::DVec3;

use super::fields::required;
use super::{Bounds, Described, Fields};
use crate::core::error::Result;
use crate::scene::limits::{COORDINATE, LENGTH, parallel};
use crate::scene::model::{DEFAULT, Material, Space};
use crate::scene::refusal::{Check, Key};

/// A plane, or a parallelogram of it.
#[derive(Clone, Copy, Debug)]
pub struct Plane {
    /// Where u and v are 0.
    pub origin: DVec3,
    /// From u = 0 to u = 1.
    pub tangent: DVec3,
    /// From v = 0 to v = 1.
    pub bitangent: DVec3,
    /// Bounds |u| and |v|, measured in tangents and bitangents; infinite without.
    pub half_extent: Option<f64>,
    /// Index of its material.
    pub material: usize,
    /// Its displacement between the times 0 and 1.
    pub motion: DVec3,
}

impl Plane {
    /// Returns an infinite plane: u and v are 0 at the origin, and 1 at the ends of tangent and bitangent.
    pub fn new(origin: impl Into<DVec3>, tangent: impl Into<DVec3>, bitangent: impl Into<DVec3>) -> Plane {
        let (origin, tangent, bitangent) = (origin.into(), tangent.into(), bitangent.into());
        Plane { origin, tangent, bitangent, half_extent: None, material: DEFAULT, motion: DVec3::ZERO }
    }
}

impl Described for Plane {
    const KEYS: &[&str] = &["origin", "tangent", "bitangent", "half_extent"];

    fn read(fields: &dyn Fields, material: usize) -> Result<Plane> {
        let vector = |key| required(fields, key, |key| fields.vector(key));
        let plane = Plane::new(vector("origin")?, vector("tangent")?, vector("bitangent")?);
        Ok(Plane { half_extent: fields.number("half_extent")?, material, ..plane })
    }

    fn translate(&mut self, way: DVec3) {
        self.origin += way;
    }

    fn middle(&self) -> Option<DVec3> {
        self.half_extent.map(|_| self.origin)
    }

    fn extent(&self) -> Option<Bounds> {
        let reach = self.half_extent? * (self.tangent.abs() + self.bitangent.abs());
        Some(Bounds { min: self.origin - reach, max: self.origin + reach })
    }

    fn check(&self, key: Key, material: &Material) -> Check {
        key.of("origin").vector(self.origin, &COORDINATE)?;
        key.of("tangent").direction(self.tangent)?;
        key.of("bitangent").direction(self.bitangent)?;
        if parallel(self.tangent, self.bitangent) {
            let what = "tangent and bitangent are parallel and span no plane; turn one of them";
            return key.of("bitangent").refuse(what, "parallel to tangent");
        }
        self.half_extent.map_or(Ok(()), |extent| key.of("half_extent").number(extent, &LENGTH))?;
        // A map in space "bounds" measures in the shape's box, which an infinite plane lacks.
        if self.half_extent.is_some() || material.mapping.space != Space::Bounds {
            return Ok(());
        }
        let what = format!(
            "material \"{}\" maps in space \"bounds\", and an infinite plane has no bounds; set half_extent, or use \
             space \"world\"",
            material.name
        );
        key.of("half_extent").refuse(what, "infinite plane")
    }
}
