//! The pixels of a picture that is sampled to a goal: for each its sums of two halves, its number of samples and the
//! variance of its mean. The host keeps them for any backend, or a device does so itself. Input: the decisions of the
//! loop of passes. Output: a few numbers about the whole picture, the pixels of an audit, and at last the film.

use super::{Backend, PilotRun};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;

/// The aim of a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// Samples of both halves of all pixels.
    Samples(f64),
    Mse(f64),
}

/// What a pass has shown of the whole picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimated {
    /// Samples of both halves of all pixels.
    pub taken: f64,
    /// Seconds of the samples of the pass, by the backend's clock; with those of the estimate if both are one submission.
    pub sampling: f64,
    /// Mean squared error of the noise, by the difference of the halves, and its standard deviation.
    pub mse: f64,
    pub deviation: f64,
    /// The mean of the pixels' variances.
    pub variance: f64,
    /// Pixels that beams resolved.
    pub resolved: u64,
    /// Least and largest number of samples in a half.
    pub least: u32,
    pub most: u32,
}

impl Estimated {
    /// Returns the count of all pixels if it is the same for all.
    pub fn equal(&self) -> Option<u32> {
        (self.least == self.most).then_some(self.least)
    }

    /// Returns the ratio of the mean variance to the error that the halves show.
    pub fn weight(&self) -> f64 {
        if self.mse > 0.0 { self.variance / self.mse } else { 1.0 }
    }
}

/// How the samples of the next pass are distributed.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    pub aim: Aim,
    /// The error falls as MSE ~ samples^-exponent.
    pub exponent: f64,
    /// Largest factor by which a count grows in this pass, and largest count.
    pub growth: f64,
    pub most: u32,
    /// Pixels drawn at random gain samples even if no other one does.
    pub explores: bool,
}

/// A plan's effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planned {
    /// False if no pixel gains samples.
    pub gains: bool,
    /// Samples of both halves of all pixels by which the aim would be met.
    pub cost: f64,
}

/// A pixel that was drawn for an audit, as the film has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drawn {
    pub pixel: u32,
    /// Samples in each half.
    pub count: u32,
    /// Sums of both halves: red, green, blue, and the mean of their squares.
    pub halves: [[f32; 4]; 2],
    /// The expected number of draws of this pixel.
    pub draws: f64,
    /// True if beams resolved it.
    pub resolved: bool,
}

/// A drawn pixel with two means that are independent of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Audited {
    pub drawn: Drawn,
    /// Samples of each mean.
    pub samples: u32,
    pub sums: [[f32; 4]; 2],
}

/// The extent of an audit.
#[derive(Clone, Copy, Debug)]
pub struct AuditPlan {
    /// Samples, about.
    pub budget: f64,
    /// The place of the first draw, in 0 .. 1.
    pub start: f64,
    /// The `part` of the batches of the first means; that of the second ones has the stream that follows.
    pub part: u32,
}

/// Variances that an audit found to be too small.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Raises {
    /// Pixels with the variance of one of their samples: those around each are assumed to vary like it, by a share.
    pub around: Vec<(u32, f32)>,
    /// The least variance of one sample of pixels by the octave of their counts.
    pub floors: Option<Vec<f32>>,
}

/// The pixels of a picture.
pub trait Pixels {
    /// Returns the backend that takes their samples.
    fn backend(&mut self) -> &mut dyn Backend;

    /// Plans the first pass: in each half at most `most` samples, fewer for pixels in which little can be missed.
    fn plan_first(&mut self, most: u32) -> Result<()>;

    /// Plans the same number of samples in each half of all pixels, which have an equal number now.
    fn plan_all(&mut self, count: u32) -> Result<()>;

    /// Plans samples where they lower the error most.
    fn plan(&mut self, plan: &Plan) -> Result<Planned>;

    /// Takes the samples of the last plan.
    fn sample(&mut self, progress: &dyn Progress) -> Result<()>;

    /// Estimates all variances; `bright` is true if the scene is known to contain something small and bright.
    fn estimate(&mut self, bright: bool) -> Result<Estimated>;

    /// Draws the pixels of an audit and samples them anew; in the order of the draws.
    fn audit(&mut self, plan: &AuditPlan, progress: &dyn Progress) -> Result<Vec<Audited>>;

    /// Raises variances to what an audit found.
    fn raise(&mut self, raises: &Raises) -> Result<()>;

    /// Returns the shares of a pilot run's resolved pixels in what its pixels would still cost, and in their error.
    fn shares(&mut self, pilot: &PilotRun, exponent: f64) -> Result<[f64; 2]>;

    /// Replaces pixels by their resolved values: red, green, blue, and 0, or 1 for a pixel that needs samples.
    fn resolve(&mut self, resolved: Vec<[f32; 4]>) -> Result<()>;

    /// Writes the means over both halves to a film of the picture.
    fn write_to(&mut self, film: &mut Film) -> Result<()>;

    /// Returns the samples of both halves of each pixel, and the variance of its mean.
    fn counts_and_variances(&mut self) -> Result<(Vec<u32>, Vec<f32>)>;
}
