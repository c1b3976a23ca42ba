//! Scenes by whose pictures a render for a time may be made instead of by samples. Input: the scene, and its textures.
//! Output: sessions with their pipelines, once they are asked for: most renders need none of them.

use std::sync::{Arc, OnceLock};

use super::options::Options;
use super::session::{Prepared, Session};
use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::integrators::Auto;
use crate::integrators::adaptive::Goal;
use crate::pack;
use crate::sampling::Candidate;
use crate::scene::model::{Algorithm, Footprint, Scene};
use crate::scene::prefiltered;
use crate::texture::data::TextureData;

/// Opens sessions of the candidates that need one of their own.
pub(super) trait Rivals: Sync {
    /// Returns the prepared session of a candidate, opened on first use; `None` if the scene does not have the candidate.
    fn open<'p>(&'p self, candidate: Candidate) -> Result<Option<&'p Prepared<'p, 'p>>>;
}

/// The scenes, and the textures of all of them.
#[derive(Default)]
pub(super) struct RivalScenes {
    scenes: Vec<(Candidate, Scene)>,
    pub(super) textures: Option<Arc<Vec<TextureData>>>,
}

impl RivalScenes {
    /// Returns the scenes that a render with these options may choose instead.
    pub(super) fn of(scene: &Scene, options: &Options) -> RivalScenes {
        let is_free =
            scene.sampling.algorithm == Algorithm::Auto && scene.sampling.footprint == Footprint::None;
        if !is_free || !matches!(options.goal, Some(Goal::Seconds(seconds)) if Auto::tries_others(seconds)) {
            return RivalScenes::default();
        }
        let scenes = [
            (Candidate::Prefiltered, prefiltered::by_one_sample(scene)),
            (Candidate::Cone, prefiltered::by_one_cone(scene)),
        ];
        let scenes = scenes.into_iter().filter_map(|(candidate, scene)| Some((candidate, scene?))).collect();
        RivalScenes { scenes, textures: None }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.scenes.is_empty()
    }
}

/// Sessions of the scenes, each opened on first use.
pub(super) struct RivalSessions<'g> {
    gpu: Option<&'g Gpu>,
    scenes: RivalScenes,
    options: &'g Options,
    sessions: Vec<OnceLock<Session<'g>>>,
}

impl<'g> RivalSessions<'g> {
    pub(super) fn new(gpu: Option<&'g Gpu>, scenes: RivalScenes, options: &'g Options) -> RivalSessions<'g> {
        let sessions = scenes.scenes.iter().map(|_| OnceLock::new()).collect();
        RivalSessions { gpu, scenes, options, sessions }
    }

    fn open(&self, at: usize) -> Result<Option<&Session<'g>>> {
        let (Some(gpu), Some(textures)) = (self.gpu, &self.scenes.textures) else { return Ok(None) };
        if self.sessions[at].get().is_none() {
            let Options { crop, keep_everything, tuning, mips, diagnosed, .. } = self.options;
            let scene = &self.scenes.scenes[at].1;
            let mip_chains = mips.mip_chains(gpu.info());
            let mut packed = pack::pack_with(scene, textures.to_vec(), *crop, mip_chains)?;
            packed.diagnosed = *diagnosed;
            // Never set twice: it was empty just now.
            let _ = self.sessions[at].set(Session::open(gpu, packed, *keep_everything, tuning)?);
        }
        Ok(self.sessions[at].get())
    }
}

/// The sessions with their pipelines, which are built on first use.
pub(super) struct PreparedRivals<'s, 'g> {
    sessions: &'s RivalSessions<'g>,
    prepared: Vec<OnceLock<Prepared<'s, 'g>>>,
}

impl<'s, 'g> PreparedRivals<'s, 'g> {
    pub(super) fn new(sessions: &'s RivalSessions<'g>) -> PreparedRivals<'s, 'g> {
        PreparedRivals { sessions, prepared: sessions.sessions.iter().map(|_| OnceLock::new()).collect() }
    }
}

impl Rivals for PreparedRivals<'_, '_> {
    fn open<'p>(&'p self, candidate: Candidate) -> Result<Option<&'p Prepared<'p, 'p>>> {
        let Some(at) = self.sessions.scenes.scenes.iter().position(|(own, _)| *own == candidate) else {
            return Ok(None);
        };
        if self.prepared[at].get().is_none() {
            let Some(session) = self.sessions.open(at)? else { return Ok(None) };
            let _ = self.prepared[at].set(session.prepare()?);
        }
        Ok(self.prepared[at].get().map(|prepared| prepared as &Prepared<'p, 'p>))
    }
}
