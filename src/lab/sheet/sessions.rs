//! The device's side of a sheet: textures are read once, and a session is kept for as long as cells need the same one.
//! Input: scenes. Output: films with what they took.

use super::identity::Identity;
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::Gpu;
use crate::integrators::adaptive::Goal;
use crate::pack;
use crate::render::{KeptTextures, MipChoice, Options, Report, Session, Tuning, render_on};
use crate::scene::model::Scene;
use crate::texture::decode::AllowedFloats;

pub(super) struct Sessions<'a> {
    gpu: &'a Gpu,
    textures: KeptTextures,
    current: Option<(Identity, Session<'a>)>,
}

impl<'a> Sessions<'a> {
    pub(super) fn new(gpu: &'a Gpu) -> Sessions<'a> {
        Sessions { gpu, textures: KeptTextures::of_all_scenes(), current: None }
    }

    /// Returns the session of a scene, in place of the one before unless that is the same.
    pub(super) fn session(&mut self, scene: &Scene) -> Result<&Session<'a>> {
        let identity = Identity::of(scene);
        if self.current.as_ref().is_none_or(|(own, _)| *own != identity) {
            // Freed first: two sessions may not fit on the device.
            self.current = None;
            let (textures, _) = self.textures.read(scene, AllowedFloats::Finite)?;
            let mip_chains = MipChoice::Auto.mip_chains(self.gpu.info());
            let packed = pack::pack_by(scene, textures, None, mip_chains, &mut self.textures)?;
            let session = Session::open(self.gpu, packed, false, &Tuning::default())?;
            self.current = Some((identity, session));
        }
        let session = self.current.as_ref().map(|(_, session)| session);
        session.ok_or_else(|| Error::new("no session is open"))
    }

    /// Renders a scene as often as `repeats` says; the pictures are the same, and the last one is returned.
    pub(super) fn render(
        &mut self,
        scene: &Scene,
        repeats: u32,
        progress: &dyn Progress,
    ) -> Result<(Film, Vec<Report>)> {
        let prepared = self.session(scene)?.prepare_sampling(scene)?;
        let (mut film, report) = prepared.render(progress)?;
        let mut reports = vec![report];
        for _ in 1..repeats {
            let (again, report) = prepared.render(progress)?;
            film = again;
            reports.push(report);
        }
        Ok((film, reports))
    }

    /// Renders a scene once, to a goal.
    pub(super) fn render_to(
        &mut self,
        scene: &Scene,
        goal: Goal,
        progress: &dyn Progress,
    ) -> Result<(Film, Vec<Report>)> {
        self.current = None;
        let options = Options { goal: Some(goal), tells_pixels: false, ..Options::default() };
        let (textures, _) = self.textures.read(scene, AllowedFloats::Finite)?;
        let (film, report) = render_on(self.gpu, scene, textures, &options, progress)?;
        Ok((film, vec![report]))
    }
}
