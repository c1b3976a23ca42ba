//! What of a scene its samples choose, beside their place in the pixel.

use glam::DVec3;

use super::model::{Light, PixelFilterKind, Scene};

impl Scene {
    /// Of all shapes.
    pub fn motions(&self) -> impl Iterator<Item = DVec3> {
        self.shapes.iter().map(|shape| shape.motion())
    }

    /// Returns whether any shape moves.
    pub fn shapes_move(&self) -> bool {
        self.motions().any(|motion| motion != DVec3::ZERO)
    }

    /// Whether a picture depends on when its samples are taken.
    pub fn moves(&self) -> bool {
        self.camera.moves() || self.shapes_move()
    }

    /// Whether some light shines from more than one place or direction.
    pub fn has_wide_lights(&self) -> bool {
        self.lights.iter().any(Light::has_extent)
    }

    /// Whether some mirror or glass is rough.
    pub fn is_glossy(&self) -> bool {
        self.materials.iter().any(|m| m.model.is_specular() && m.roughness > 0.0)
    }

    /// Whether one beam can stand for all rays of a pixel: those from its square, by equal weights, from one
    /// place at one time.
    pub fn supports_beams(&self) -> bool {
        self.pixel_filter.kind == PixelFilterKind::Box && self.camera.lens.is_none() && !self.moves()
    }

    /// Whether samples choose anything but their place in the pixel: a cone, which does not, sees another scene.
    pub fn leaves_more_to_chance(&self) -> bool {
        self.moves() || self.camera.lens.is_some() || self.has_wide_lights() || self.is_glossy()
    }
}
