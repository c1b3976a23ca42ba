//! Which scenes can share a session on the device, and which cells one reference. Input: scenes. Output: values that are
//! equal where scenes differ in their samples only.

use std::fmt::{self, Write};
use std::hash::{DefaultHasher, Hasher};

use crate::scene::model::{PixelFilter, Sampling, Scene};
use crate::texture::sampler_spec::SamplerSpec;

/// Everything that a session fixes: a scene without the choice of its samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Identity {
    size: [u32; 2],
    pixel_filter: PixelFilter,
    sampling: Sampling,
    samplers: Vec<SamplerSpec>,
    /// Of the rest: shapes, materials, textures, lights, camera.
    rest: u64,
}

impl Identity {
    pub(super) fn of(scene: &Scene) -> Identity {
        let own = scene.sampling;
        let sampling = Sampling {
            algorithm: own.algorithm.reads_textures_as(),
            footprint: own.footprint,
            precision: own.precision,
            max_depth: own.max_depth,
            quantity: own.quantity,
            ..Sampling::default()
        };
        Identity {
            size: [scene.width, scene.height],
            pixel_filter: scene.pixel_filter,
            sampling,
            samplers: scene.samplers.clone(),
            rest: rest_of(scene),
        }
    }
}

/// Hashes what is written instead of keeping it: scenes of meshes are long.
struct Digest(DefaultHasher);

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

fn rest_of(scene: &Scene) -> u64 {
    let mut digest = Digest(DefaultHasher::new());
    let Scene { camera, background, textures, materials, shapes, lights, .. } = scene;
    // Writing to a hash cannot fail.
    let _ = write!(digest, "{camera:?}{background:?}{textures:?}{materials:?}{shapes:?}{lights:?}");
    digest.0.finish()
}
