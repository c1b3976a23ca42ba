//! Chooses the integrator that renders a packed scene, and renders a prepared one by it.

use std::ops::Range;

use super::Report;
use super::backend::DeviceBackend;
use super::session::Prepared;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::integrators::adaptive::Goal;
use crate::integrators::{Adaptive, Auto, Beam, Cone, Fixed, Integrator, Run};
use crate::pack::{PackedScene, Schedule};
use crate::scene::model::Algorithm;

/// Returns the integrator of the scene's algorithm. `goal` applies to adaptive sampling; by default it is the scene's
/// number of samples; it tells the estimates of single pixels if `tells_pixels` is true.
pub fn integrator(scene: &PackedScene, goal: Option<Goal>, tells_pixels: bool) -> Box<dyn Integrator> {
    let samples = scene.samples;
    match scene.schedule {
        Schedule::Batches
            if let Some(Goal::Seconds(seconds)) = goal
                && scene.algorithm == Algorithm::Auto
                && !scene.prefilters() =>
        {
            Box::new(Auto { seconds, tells_pixels })
        }
        Schedule::Batches => {
            let goal = goal.unwrap_or(Goal::Samples(samples));
            Box::new(Adaptive { goal, tells_pixels, rate: None })
        }
        Schedule::Tiles if scene.beams => Box::new(Beam { samples }),
        Schedule::Tiles if scene.algorithm == Algorithm::Cone => Box::new(Cone { samples }),
        Schedule::Tiles => Box::new(Fixed { samples }),
    }
}

impl Prepared<'_, '_> {
    /// Renders once more. The report's times of loading and compiling are those of the first render.
    pub fn render(&self, progress: &dyn Progress) -> Result<(Film, Report)> {
        self.render_to_goal(None, progress)
    }

    /// Renders a run of the samples that it was prepared for, of a scene that is packed for equal samples in each pixel.
    pub fn render_run(&self, samples: Range<u32>, progress: &dyn Progress) -> Result<Film> {
        let [width, height] = self.scene.header.film_size.to_array();
        let mut backend = DeviceBackend::new(self)?;
        let run = Run { samples }.render(&mut backend, Film::new(width, height, 0), progress)?;
        backend.finish()?;
        Ok(run.film)
    }

    /// Renders as [`Prepared::render`] does; a scene that is sampled by batches ends at `goal`, by default its number
    /// of samples.
    pub fn render_to_goal(&self, goal: Option<Goal>, progress: &dyn Progress) -> Result<(Film, Report)> {
        let [width, height] = self.scene.header.film_size.to_array();
        let mut backend = DeviceBackend::new(self)?;
        let integrated = integrator(&self.scene, goal, false).render(
            &mut backend,
            Film::new(width, height, 0),
            progress,
        )?;
        let mut report = backend.finish()?;
        Ok((report.take(integrated), report))
    }
}
