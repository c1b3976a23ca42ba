//! From samples to a picture: how many each pixel has, and what is done without any. In: a backend, which may be
//! several of them. Out: a film, and what came of it. Integrators differ in what they ask the backend for: ranges of
//! samples, resolved pixels, or samples of single pixels.

pub mod adaptive;
mod beam;
mod fixed;

pub use beam::Beam;
pub use fixed::{Cone, Fixed};

use adaptive::{Goal, Outcome};

use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::sampling::Backend;

/// Makes pictures by one method.
pub trait Integrator {
    /// Renders a picture of that size.
    fn render(
        &self,
        backend: &mut dyn Backend,
        size: [u32; 2],
        progress: &dyn Progress,
    ) -> Result<Integrated>;
}

/// A picture, and what its integrator found.
#[derive(Clone, Debug)]
pub struct Integrated {
    pub film: Film,
    /// How far sampling to a goal came.
    pub outcome: Option<Outcome>,
    /// Of beams: pixels that were left to samples.
    pub sampled_pixels: Option<u64>,
    /// Of cones: weight of what none was traced for, or no room was kept, over that of the whole picture.
    pub dropped: Option<f64>,
}

impl From<Film> for Integrated {
    fn from(film: Film) -> Integrated {
        Integrated { film, outcome: None, sampled_pixels: None, dropped: None }
    }
}

/// Samples until a goal is met, where they lower the error most.
#[derive(Clone, Copy, Debug)]
pub struct Adaptive {
    pub goal: Goal,
}

impl Integrator for Adaptive {
    fn render(
        &self,
        backend: &mut dyn Backend,
        size: [u32; 2],
        progress: &dyn Progress,
    ) -> Result<Integrated> {
        let (film, outcome) = adaptive::run(backend, size, self.goal, progress)?;
        Ok(Integrated { outcome: Some(outcome), ..Integrated::from(film) })
    }
}
