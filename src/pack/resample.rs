//! Changes the samples of a packed scene: the device's shapes and textures stay as they are.

use super::header::header;
use super::pixel_filter::Warp;
use super::{PackedScene, schedule};
use crate::core::range::Rect;
use crate::scene::model::Scene;
use crate::schema::record::Field;

impl PackedScene {
    /// Adopts the samples of `scene`, which may differ from the packed scene in algorithm, pattern, number,
    /// seed and whether pixels share them.
    pub fn set_sampling(&mut self, scene: &Scene) {
        let [x, y] = self.header.crop.to_array();
        let [width, height] = self.header.film_size.to_array();
        let fresh = header(scene, Rect { x, y, width, height }, &Warp::new(scene.pixel_filter));
        let side = fresh.sample_side;
        self.header.sample_side = if self.double { side } else { side.quantize_f32() };
        self.header.pattern = fresh.pattern;
        self.header.strata_side = fresh.strata_side;
        self.header.samples = fresh.samples;
        self.header.seed = fresh.seed;
        self.header.shares_pattern = fresh.shares_pattern;
        self.samples = scene.sampling.samples();
        self.schedule = schedule(scene);
        self.algorithm = scene.sampling.algorithm;
    }
}
