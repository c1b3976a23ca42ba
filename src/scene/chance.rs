//! The sample dimensions that a scene needs beside the position in the pixel.

use glam::DVec3;

use super::model::{Light, PixelFilterKind, Scene};

impl Scene {
    /// Returns the motions of all shapes.
    pub fn motions(&self) -> impl Iterator<Item = DVec3> {
        self.shapes.iter().map(|shape| shape.motion())
    }

    /// Returns true if any shape moves.
    pub fn shapes_move(&self) -> bool {
        self.motions().any(|motion| motion != DVec3::ZERO)
    }

    /// Returns true if the picture depends on the time of its samples.
    pub fn moves(&self) -> bool {
        self.camera.moves() || self.shapes_move()
    }

    /// Returns true if some light has an extent.
    pub fn has_wide_lights(&self) -> bool {
        self.lights.iter().any(Light::has_extent)
    }

    /// Returns true if some mirror or glass is rough.
    pub fn is_glossy(&self) -> bool {
        self.materials.iter().any(|m| m.model.is_specular() && m.roughness > 0.0)
    }

    /// Returns true if a beam can represent all rays of a pixel: those from its square, with equal weights, from one
    /// point at one time.
    pub fn supports_beams(&self) -> bool {
        self.pixel_filter.kind == PixelFilterKind::Box && self.camera.lens.is_none() && !self.moves()
    }

    /// Returns true if samples have other dimensions than the position in the pixel, which cones do not have.
    pub fn leaves_more_to_chance(&self) -> bool {
        self.moves() || self.camera.lens.is_some() || self.has_wide_lights() || self.is_glossy()
    }
}
