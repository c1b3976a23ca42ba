//! From samples to a picture: how many samples each pixel takes, and which pixels need none. Input: a backend, which
//! may consist of several. Output: a film and statistics. Integrators differ in their requests to the backend: ranges
//! of samples, resolved pixels, or samples of single pixels.

pub mod adaptive;
mod auto;
mod beam;
mod fixed;

pub use auto::Auto;
pub use beam::Beam;
pub use fixed::{Cone, Fixed, Run};

use adaptive::{Goal, Outcome, PixelEstimates};

use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::sampling::Backend;

/// A rendering algorithm.
pub trait Integrator {
    /// Renders a picture of the size of a black film, which becomes the picture or is not needed.
    fn render(&self, backend: &mut dyn Backend, film: Film, progress: &dyn Progress) -> Result<Integrated>;
}

/// A picture and the integrator's statistics.
#[derive(Clone, Debug)]
pub struct Integrated {
    pub film: Film,
    /// The result of sampling to a goal.
    pub outcome: Option<Outcome>,
    /// Samples and errors of single pixels, of sampling to a goal, if they were asked for.
    pub estimates: Option<PixelEstimates>,
    /// The number of pixels that beams left to samples.
    pub sampled_pixels: Option<u64>,
    /// The weight of secondary rays for which no cone was traced and of fragments for which there was no room, over
    /// that of the whole picture.
    pub dropped: Option<f64>,
}

impl From<Film> for Integrated {
    fn from(film: Film) -> Integrated {
        Integrated { film, outcome: None, estimates: None, sampled_pixels: None, dropped: None }
    }
}

/// Samples until a goal is met, placed where they lower the error most.
#[derive(Clone, Copy, Debug)]
pub struct Adaptive {
    pub goal: Goal,
    /// Tells samples and errors of single pixels, too.
    pub tells_pixels: bool,
    /// Samples per second, if they are known from before.
    pub rate: Option<f64>,
}

impl Integrator for Adaptive {
    fn render(&self, backend: &mut dyn Backend, film: Film, progress: &dyn Progress) -> Result<Integrated> {
        let adaptive::Run { film, outcome, estimates } =
            adaptive::run(backend, film, self.goal, self.tells_pixels, self.rate, progress)?;
        Ok(Integrated { outcome: Some(outcome), estimates, ..Integrated::from(film) })
    }
}
