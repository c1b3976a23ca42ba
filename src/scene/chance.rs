//! The sample dimensions that a scene needs beside the position in the pixel.

use glam::DVec3;

use super::model::{Light, Material, PixelFilterKind, Scene};

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

    /// Returns true if some material lets rays pass.
    pub fn lets_rays_pass(&self) -> bool {
        self.materials.iter().any(Material::lets_rays_pass)
    }

    /// Returns true if the environment lights surfaces, or rough mirrors reflect it.
    pub fn is_lit_by_environment(&self) -> bool {
        let lights = self.lights.iter().any(|light| matches!(light, Light::Environment));
        lights && self.materials.iter().any(|m| m.model.is_lit() || m.is_rough_mirror())
    }

    /// Returns true if lit surfaces continue paths.
    pub fn scatters(&self) -> bool {
        self.is_lit_by_environment() || self.materials.iter().any(|m| m.model.is_glossy())
    }

    /// Returns true if a picture by cones lacks something of the scene's materials.
    pub fn reflects_or_lets_pass(&self) -> bool {
        self.lets_rays_pass() || self.scatters()
    }

    /// Returns true if a beam can represent all rays of a pixel.
    pub fn supports_beams(&self) -> bool {
        self.has_square_pixels() && !self.lets_rays_pass()
    }

    /// Returns true if the rays of a pixel are those from its square, with equal weights, from one point at one time.
    pub fn has_square_pixels(&self) -> bool {
        self.pixel_filter.kind == PixelFilterKind::Box && self.camera.lens.is_none() && !self.moves()
    }

    /// Returns true if samples have other dimensions than the position in the pixel, which cones do not have.
    pub fn leaves_more_to_chance(&self) -> bool {
        let wide = self.lights.iter().any(|light| light.has_extent() && !matches!(light, Light::Environment));
        self.moves() || self.camera.lens.is_some() || wide || self.is_glossy()
    }
}
