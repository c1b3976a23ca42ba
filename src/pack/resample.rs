//! A packed scene with other samples: what a device holds of shapes and textures stays as it is.

use super::header::header;
use super::pixel_filter::Warp;
use super::{Crop, PackedScene, schedule};
use crate::scene::model::Scene;
use crate::schema::layout::{Header, Record};

impl PackedScene {
    /// Takes the samples of `scene`, which is the one it was packed from but for algorithm, pattern, number,
    /// seed and whether pixels share them.
    pub fn set_sampling(&mut self, scene: &Scene) {
        let [_, _, x, y] = self.header.image;
        let [width, height, _, _] = self.header.size;
        let Header { step_x, sampling, key: [shared, ..], .. } =
            header(scene, Crop { x, y, width, height }, &Warp::new(scene.pixel_filter));
        let step_x =
            if self.double { step_x } else { Header { step_x, ..self.header }.quantize_f32().step_x };
        (self.header.step_x, self.header.sampling, self.header.key[0]) = (step_x, sampling, shared);
        self.samples = scene.sampling.samples();
        self.schedule = schedule(scene);
        self.algorithm = scene.sampling.algorithm;
    }
}
