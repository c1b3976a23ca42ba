//! Chooses the integrator that renders a packed scene.

use crate::integrators::adaptive::Goal;
use crate::integrators::{Adaptive, Beam, Cone, Fixed, Integrator};
use crate::pack::{PackedScene, Schedule};
use crate::scene::model::Algorithm;

/// Returns the integrator of the scene's algorithm. `goal` applies to adaptive sampling; by default it is the scene's
/// number of samples; it tells the estimates of single pixels if `tells_pixels` is true.
pub fn integrator(scene: &PackedScene, goal: Option<Goal>, tells_pixels: bool) -> Box<dyn Integrator> {
    let samples = scene.samples;
    match scene.schedule {
        Schedule::Batches => {
            let goal = goal.unwrap_or(Goal::Samples(samples));
            Box::new(Adaptive { goal, tells_pixels })
        }
        Schedule::Tiles if scene.beams => Box::new(Beam { samples }),
        Schedule::Tiles if scene.algorithm == Algorithm::Cone => Box::new(Cone { samples }),
        Schedule::Tiles => Box::new(Fixed { samples }),
    }
}
