//! Session cache of a study: one session on the device for each combination of algorithm, footprint
//! and filter, shared by all patterns. Returns the pipeline for each method and sample count.

use std::time::Instant;

use crate::core::error::{Error, Result};
use crate::gpu::Gpu;
use crate::pack;
use crate::render::{MipChoice, Prepared, Report, Session, Tuning};
use crate::scene::model::{Algorithm, Footprint, Scene};
use crate::texture::data::TextureData;
use crate::texture::sampler_spec::Filter;

use super::method::Method;

/// Footprint and filter with the algorithm, since beams and cones read textures differently.
type Key = (Algorithm, Footprint, Option<Filter>);

const PLAIN: Key = (Algorithm::Samples, Footprint::None, None);

struct CacheEntry<'a> {
    key: Key,
    session: Session<'a>,
    pack_seconds: f64,
}

pub struct SessionCache<'a> {
    sessions: Vec<CacheEntry<'a>>,
}

impl<'a> SessionCache<'a> {
    /// Opens a session per combination, and the one without a footprint with which references are
    /// rendered.
    pub fn open(
        gpu: &'a Gpu,
        scene: &Scene,
        textures: Vec<TextureData>,
        methods: &[Method],
    ) -> Result<SessionCache<'a>> {
        let mut keys = vec![PLAIN];
        methods.iter().map(key).for_each(|k| {
            if !keys.contains(&k) {
                keys.push(k)
            }
        });
        let mip_chains = MipChoice::Auto.mip_chains(gpu.info());
        let mut sessions = Vec::with_capacity(keys.len());
        for key in keys {
            let clock = Instant::now();
            let (algorithm, footprint, filter) = key;
            let pattern = Some(scene.sampling.pattern);
            let reading = Method { algorithm, pattern, footprint, filter };
            let reading = reading.apply(scene, scene.sampling.spp)?;
            let packed = pack::pack_with(&reading, textures.clone(), None, mip_chains)?;
            let pack_seconds = clock.elapsed().as_secs_f64();
            let session = Session::open(gpu, packed, false, &Tuning::default())?;
            sessions.push(CacheEntry { key, session, pack_seconds });
        }
        Ok(SessionCache { sessions })
    }

    /// Returns a pipeline for a method with a count, and the seconds that packing its scene took.
    pub fn prepare(&self, scene: &Scene, method: &Method, spp: u32) -> Result<(Prepared<'_, 'a>, f64)> {
        let key = key(method);
        let missing = || Error::new(format!("method {} was not opened", method.name()));
        let look = self.sessions.iter().find(|look| look.key == key).ok_or_else(missing)?;
        Ok((look.session.prepare_sampling(&method.apply(scene, spp)?)?, look.pack_seconds))
    }

    pub fn has(&self, method: &Method) -> bool {
        self.sessions.iter().any(|look| look.key == key(method))
    }
}

fn key(method: &Method) -> Key {
    (method.algorithm.reads_textures_as(), method.footprint, method.filter)
}

/// Returns, for beams, the fraction of the pixels that were sampled; 1 in a scene that does not
/// support beams.
pub fn sampled_part(algorithm: Algorithm, report: &Report, pixels: usize) -> Option<f64> {
    let part = || report.sampled_pixels.map_or(1.0, |count| count as f64 / pixels as f64);
    (algorithm == Algorithm::Beam).then(part)
}
