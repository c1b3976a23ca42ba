//! The device's side of a sheet: textures are read once, and a session is kept for as long as cells need the same one.
//! Input: scenes. Output: films with what they took.

use super::identity::Identity;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::Gpu;
use crate::integrators::adaptive::Goal;
use crate::pack;
use crate::render::{MipChoice, Options, Report, Session, Tuning, render_on};
use crate::scene::model::{Scene, TextureSource};
use crate::texture;
use crate::texture::data::TextureData;

pub(super) struct Sessions<'a> {
    gpu: &'a Gpu,
    textures: Vec<(TextureSource, TextureData)>,
    current: Option<(Identity, Session<'a>)>,
}

impl<'a> Sessions<'a> {
    pub(super) fn new(gpu: &'a Gpu) -> Sessions<'a> {
        Sessions { gpu, textures: Vec::new(), current: None }
    }

    /// Renders a scene as often as `repeats` says; the pictures are the same, and the last one is returned.
    pub(super) fn render(
        &mut self,
        scene: &Scene,
        repeats: u32,
        progress: &dyn Progress,
    ) -> Result<(Film, Vec<Report>)> {
        let identity = Identity::of(scene);
        if self.current.as_ref().is_none_or(|(own, _)| *own != identity) {
            // Freed first: two sessions may not fit on the device.
            self.current = None;
            let textures = self.textures_of(scene)?;
            let packed = pack::pack_with(scene, textures, None, MipChoice::Auto.mip_chains(self.gpu.info()))?;
            let session = Session::open(self.gpu, packed, false, &Tuning::default())?;
            self.current = Some((identity, session));
        }
        let mut films = Vec::new();
        let mut reports = Vec::new();
        if let Some((_, session)) = &self.current {
            let prepared = session.prepare_sampling(scene)?;
            for _ in 0..repeats.max(1) {
                films.clear();
                let (film, report) = prepared.render(progress)?;
                films.push(film);
                reports.push(report);
            }
        }
        let film = films.pop().unwrap_or_else(|| Film::new(scene.width, scene.height, 0));
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
        let textures = self.textures_of(scene)?;
        let (film, report) = render_on(self.gpu, scene, textures, &options, progress)?;
        Ok((film, vec![report]))
    }

    fn textures_of(&mut self, scene: &Scene) -> Result<Vec<TextureData>> {
        let mut found = Vec::with_capacity(scene.textures.len());
        for source in &scene.textures {
            let known = self.textures.iter().find(|(own, _)| own == source);
            let data = match known {
                Some((_, data)) => data.clone(),
                None => {
                    let data = texture::load::load(source)?;
                    self.textures.push((source.clone(), data.clone()));
                    data
                }
            };
            found.push(data);
        }
        Ok(found)
    }
}
