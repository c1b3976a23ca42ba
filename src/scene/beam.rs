//! What beam tracing needs of a scene.

use glam::DVec3;

use super::model::{PixelFilterKind, Scene};

impl Scene {
    /// Whether one beam can stand for all rays of a pixel: those from its square, by equal weights, from one
    /// place at one time.
    pub fn suits_beams(&self) -> bool {
        let still = !self.camera.moves() && self.motions().all(|motion| motion == DVec3::ZERO);
        self.pixel_filter.kind == PixelFilterKind::Box && self.camera.lens.is_none() && still
    }
}
