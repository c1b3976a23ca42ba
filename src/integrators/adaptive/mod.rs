//! Samples where they lower the error most: batches of samples for a backend out, sums of two independent halves in,
//! until a goal is met. Each pass estimates every pixel's error from the halves and from the spread of
//! its samples (Rousselle et al. 2011, "Adaptive Sampling and Reconstruction"), and asks for what a
//! Lagrange multiplier gives each pixel so that the whole picture's error falls fastest.

mod allocate;
mod analytic;
mod audit;
mod auditor;
mod draws;
mod estimate;
mod explore;
mod pace;
mod run;
mod unseen;

use serde::Serialize;

pub use audit::CONFIDENCE;
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
    /// Pixels that one beam resolves: they have no noise, and their samples do not count.
    pub beam_pixels: u64,
    /// Whether the goal was met: the error before the limit of samples, or the time kept.
    pub reached: bool,
}
