//! `[[sphere]]`.

use glam::DVec3;

use super::{Bounds, Checked, Kind, Shape};
use crate::scene::builder::DEFAULT;
use crate::scene::limits::{COORDINATE, LENGTH};
use crate::scene::model::{Material, Scene};
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
    /// How far it moves between the times 0 and 1.
    pub motion: DVec3,
}

impl Sphere {
    /// Returns a sphere.
    pub fn new(center: impl Into<DVec3>, radius: f64) -> Sphere {
        Sphere { center: center.into(), radius, material: DEFAULT, motion: DVec3::ZERO }
    }

    /// Returns it with the material of this index.
    pub fn with_material(self, material: usize) -> Sphere {
        Sphere { material, ..self }
    }
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

impl Kind for Sphere {
    const SECTION: &str = "sphere";

    fn list(scene: &Scene) -> &Vec<Self> {
        &scene.spheres
    }

    fn list_mut(scene: &mut Scene) -> &mut Vec<Self> {
        &mut scene.spheres
    }
}

impl Checked for Sphere {
    fn check(&self, key: Key, _material: &Material) -> Check {
        key.of("center").vector(self.center, &COORDINATE)?;
        key.of("radius").number(self.radius, &LENGTH)
    }
}
