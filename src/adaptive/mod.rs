//! Samples where they lower the error most: jobs for a tracer out, sums of two independent halves in,
//! until a goal is met. Each pass estimates every pixel's error from the halves and from the spread of
//! its samples (Rousselle et al. 2011, "Adaptive Sampling and Reconstruction"), and asks for what a
//! Lagrange multiplier gives each pixel so that the whole picture's error falls fastest.

mod allocate;
mod audit;
mod auditor;
mod draws;
mod estimate;
mod exact;
mod explore;
mod pace;
mod run;
mod unseen;

use serde::Serialize;

use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::schema::layout::Job;

pub use audit::CONFIDENCE;
pub use exact::Trial;
pub use run::run;

/// Samples of a half: f32 sums of so many stay exact enough.
const MOST: u32 = 1 << 16;

/// What ends the sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Samples a pixel, on average.
    Samples(u32),
    /// The picture's RMSE against its converged self.
    Error(f64),
    /// Wall seconds of sampling.
    Seconds(f64),
}

/// Counts are told apart by their octave.
const OCTAVES: usize = 18;

fn octave(count: u32) -> usize {
    (count.max(1).ilog2() as usize).min(OCTAVES - 1)
}

/// Who takes the samples.
pub trait Tracer {
    /// Adds the samples of each job to its pixel of its half. No two jobs of a call are of one pixel and
    /// one half.
    fn sample(&mut self, jobs: &[Job], progress: &dyn Progress) -> Result<()>;
    /// Adds as many samples to both halves of all pixels of a picture of that size.
    fn sample_all(
        &mut self,
        [width, height]: [u32; 2],
        first: u32,
        count: u32,
        progress: &dyn Progress,
    ) -> Result<()> {
        let job =
            |i: u32| Job { place: Job::place_of(i >> 1, width), part: Job::part_of(i & 1), first, count };
        self.sample(&(0..2 * width * height).map(job).collect::<Vec<_>>(), progress)
    }
    /// Takes the samples of each job beside the film: of each red, green, blue, and their squares' mean, as sums. Their
    /// parts have `JOB_APART`.
    fn sample_apart(&mut self, jobs: &[Job], progress: &dyn Progress) -> Result<Vec<[f32; 4]>>;
    /// The share of a texture, an environment or the like that is far brighter than the rest and yet has much of its
    /// light; 1 where nothing is known to be.
    fn bright_share(&self) -> f64 {
        1.0
    }
    /// Whether samples are averages over footprints.
    fn prefilters(&self) -> bool;
    /// The sums so far.
    fn read(&mut self, sums: &mut Sums) -> Result<()>;
    /// Samples of each half of each pixel in the first pass, at most so many: fewer where it is known that little
    /// is missed.
    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        Ok(vec![most; pixels])
    }
    /// Tells a part of the picture without samples, to see what that takes. None where it cannot.
    fn trial(&mut self, _: &dyn Progress) -> Result<Option<Trial>> {
        Ok(None)
    }
    /// Tells the whole picture: of each pixel red, green, blue and 0, or a last 1 where it needs samples.
    fn tell(&mut self, _: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        Ok(Vec::new())
    }
}

/// Of each half, row by row: sums of red, green, blue, and of their squares' mean.
pub struct Sums {
    pub width: u32,
    pub height: u32,
    pub halves: [Vec<[f32; 4]>; 2],
}

/// What was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// RMSE of noise and bias: by the audit, and no less than by the difference of the halves.
    pub estimated_rmse: f64,
    /// Bounds of the RMSE by the audit, which hold it with a probability of `confidence`. None where none was made.
    pub interval: Option<[f64; 2]>,
    pub confidence: f64,
    /// RMSE of the noise, by the difference of the halves.
    pub estimated_noise: f64,
    /// RMSE of the prefilter's bias, which the halves have in common.
    pub estimated_bias: f64,
    /// Pixels and samples of all audits; their samples are not part of the picture.
    pub audited_pixels: u64,
    pub audit_samples: u64,
    pub passes: u32,
    pub mean_samples: f64,
    pub least_samples: u32,
    pub most_samples: u32,
    /// Pixels that one beam tells: they have no noise, and their samples do not count.
    pub beam_pixels: u64,
    /// Whether the goal was met: the error before the limit of samples, or the time kept.
    pub reached: bool,
}
