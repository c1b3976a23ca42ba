//! `[[disc]]`: a flat disc.

use glam::DVec3;

use super::fields::required;
use super::{Bounds, Described, Fields};
use crate::core::error::Result;
use crate::core::named::named_enum;
use crate::scene::limits::{COORDINATE, LENGTH};
use crate::scene::model::{DEFAULT, Material};
use crate::scene::refusal::{Check, Key};

named_enum! {
    /// The texture coordinates of a disc for the mapping `surface`.
    pub enum DiscUv {
        /// The square around the disc, seen against its normal, is the texture.
        Planar = "planar",
        /// u is the angle, counter-clockwise seen against the normal, over 2π; v is the distance from the centre over
        /// the radius.
        Polar = "polar",
    }
}

/// A flat disc.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Its middle.
    pub center: DVec3,
    /// At right angles to it; any length.
    pub normal: DVec3,
    /// In scene units.
    pub radius: f64,
    /// Its texture coordinates.
    pub uv: DiscUv,
    /// Index of its material.
    pub material: usize,
    /// Its displacement between the times 0 and 1.
    pub motion: DVec3,
}

impl Disc {
    /// Returns a disc with planar texture coordinates.
    pub fn new(center: impl Into<DVec3>, normal: impl Into<DVec3>, radius: f64) -> Disc {
        let (center, normal) = (center.into(), normal.into());
        Disc { center, normal, radius, uv: DiscUv::Planar, material: DEFAULT, motion: DVec3::ZERO }
    }

    /// Returns the unit vectors from the centre along which u and v of planar coordinates grow: with the normal a
    /// right-handed frame that turns with it without a jump but at -z (Duff et al. 2017). A disc that faces +z has +x
    /// and +y, one that faces +y has +x and -z.
    pub fn axes(&self) -> [DVec3; 2] {
        let n = self.normal.normalize();
        let sign = 1f64.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        [
            DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            DVec3::new(b, sign + n.y * n.y * a, -n.y),
        ]
    }
}

impl Described for Disc {
    const KEYS: &[&str] = &["center", "normal", "radius", "uv"];

    fn read(fields: &dyn Fields, material: usize) -> Result<Disc> {
        let vector = |key| required(fields, key, |key| fields.vector(key));
        let (center, normal) = (vector("center")?, vector("normal")?);
        let radius = required(fields, "radius", |key| fields.number(key))?;
        let disc = Disc::new(center, normal, radius);
        let uv = fields.choice("uv", DiscUv::NAMES)?.map_or(disc.uv, |place| DiscUv::ALL[place]);
        Ok(Disc { uv, material, ..disc })
    }

    fn translate(&mut self, way: DVec3) {
        self.center += way;
    }

    fn middle(&self) -> Option<DVec3> {
        Some(self.center)
    }

    fn extent(&self) -> Option<Bounds> {
        // On each axis the disc reaches R sin of the angle between normal and axis.
        let n = self.normal.normalize();
        let reach = self.radius * (DVec3::ONE - n * n).max(DVec3::ZERO).map(f64::sqrt);
        Some(Bounds { min: self.center - reach, max: self.center + reach })
    }

    fn check(&self, key: Key, _material: &Material) -> Check {
        key.of("center").vector(self.center, &COORDINATE)?;
        key.of("normal").direction(self.normal)?;
        key.of("radius").number(self.radius, &LENGTH)
    }
}
