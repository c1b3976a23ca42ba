//! `[[sphere]]`.

use glam::DVec3;

use super::fields::required;
use super::{Bounds, Described, Fields};
use crate::core::error::Result;
use crate::scene::limits::{COORDINATE, LENGTH};
use crate::scene::model::{DEFAULT, Material};
use crate::scene::refusal::{Check, Key};

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Its middle.
    pub center: DVec3,
    /// In scene units.
    pub radius: f64,
    /// Index of its material.
    pub material: usize,
    /// Its displacement between the times 0 and 1.
    pub motion: DVec3,
}

impl Sphere {
    /// Returns a sphere.
    pub fn new(center: impl Into<DVec3>, radius: f64) -> Sphere {
        Sphere { center: center.into(), radius, material: DEFAULT, motion: DVec3::ZERO }
    }
}

impl Described for Sphere {
    const KEYS: &[&str] = &["center", "radius"];

    fn read(fields: &dyn Fields, material: usize) -> Result<Sphere> {
        let center = required(fields, "center", |key| fields.vector(key))?;
        let radius = required(fields, "radius", |key| fields.number(key))?;
        Ok(Sphere::new(center, radius).with_material(material))
    }

    fn translate(&mut self, way: DVec3) {
        self.center += way;
    }

    fn middle(&self) -> Option<DVec3> {
        Some(self.center)
    }

    fn extent(&self) -> Option<Bounds> {
        let reach = DVec3::splat(self.radius);
        Some(Bounds { min: self.center - reach, max: self.center + reach })
    }

    fn check(&self, key: Key, _material: &Material) -> Check {
        key.of("center").vector(self.center, &COORDINATE)?;
        key.of("radius").number(self.radius, &LENGTH)
    }
}
