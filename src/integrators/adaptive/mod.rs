//! Places samples where they lower the error most, until a goal is met. Output: batches of samples for a backend.
//! Input: the sums of two independent halves. Each pass estimates every pixel's error from the halves and from the
//! variance of its samples (Rousselle et al. 2011, "Adaptive Sampling and Reconstruction"), and distributes the next
//! samples by a Lagrange multiplier so that the whole picture's error falls fastest.

mod allocate;
mod analytic;
mod audit;
mod auditor;
mod batch_lists;
mod draws;
mod estimate;
mod explore;
mod host_pixels;
mod pace;
mod resolved;
mod run;
mod unseen;

use serde::Serialize;

use crate::schema::constants::{COUNT_OCTAVES, MAX_HALF_SAMPLES};

pub use audit::{CONFIDENCE, DEVIATE, sample_drawn};
pub use draws::{DrawRates, DrawSums, first_draw};
pub use host_pixels::HostPixels;
pub use resolved::shares;
pub use run::{Run, run};

/// Most samples of a half: f32 sums of this many are still accurate enough.
const MAX_COUNT: u32 = MAX_HALF_SAMPLES;

/// A time limit counts as met if it is exceeded by no more than this factor.
const KEPT: f64 = 1.05;

/// The condition that ends the sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Samples per pixel, on average.
    Samples(u32),
    /// The picture's RMSE against its converged self.
    Error(f64),
    /// Wall-clock seconds of sampling.
    Seconds(f64),
}

impl Goal {
    /// Returns true if a time limit counts as met.
    pub fn is_kept(limit: f64, seconds: f64) -> bool {
        seconds <= KEPT * limit
    }
}

/// How the picture was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Chosen {
    /// Samples placed pixel by pixel, and beams for pixels that they resolved.
    #[default]
    Adaptive,
    /// The same number of samples in each pixel.
    Samples,
    /// One prefiltered sample in the centre of each pixel.
    Prefiltered,
    /// One cone a pixel.
    Cone,
}

/// Counts are classified by their octave.
const OCTAVES: usize = COUNT_OCTAVES as usize;

fn octave(count: u32) -> usize {
    (count.max(1).ilog2() as usize).min(OCTAVES - 1)
}

/// Samples and errors of single pixels, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelEstimates {
    /// Samples of both halves.
    pub samples: Vec<u32>,
    /// Errors by which the next samples would have been placed, as RMS of the channels; 0 for pixels that beams resolved;
    /// where none was to be placed, the picture's for all.
    pub errors: Vec<f32>,
}

/// The result of sampling to a goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Outcome {
    pub chosen: Chosen,
    /// RMSE of noise and bias: by the audit, and at least the difference of the halves.
    pub estimated_rmse: f64,
    /// Bounds of the RMSE by the audit, at the probability `confidence`; `None` without an audit.
    pub interval: Option<[f64; 2]>,
    pub confidence: f64,
    /// RMSE of the noise, by the difference of the halves.
    pub estimated_noise: f64,
    /// RMSE of the prefilter's bias, which both halves share.
    pub estimated_bias: f64,
    /// Pixels and samples of all audits; their samples are not part of the picture.
    pub audited_pixels: u64,
    pub audit_samples: u64,
    pub passes: u32,
    pub mean_samples: f64,
    pub least_samples: u32,
    pub most_samples: u32,
    /// Pixels resolved by beams: they have no noise, and their samples do not count.
    pub beam_pixels: u64,
    /// True if the goal was met: the error within the limit of samples, or the time limit.
    pub reached: bool,
}
