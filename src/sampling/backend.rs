//! The one interface of all that takes samples: devices, the oracle, and several of them together. A backend is open
//! for one scene with one choice of samples. In: ranges, or lists of samples for single pixels. Out: sums.

use super::FilmSums;
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::core::range::{Range, Rect};
use crate::schema::layout::Job;

/// Takes samples of one scene.
pub trait Backend: Send {
    /// Returns what a person calls it.
    fn name(&self) -> String;

    /// Whether samples are averages over footprints.
    fn prefilters(&self) -> bool;

    /// Returns the share of a texture, an environment or the like that is far brighter than the rest and yet has much
    /// of its light; 1 where nothing is known to be.
    fn bright_share(&self) -> f64 {
        1.0
    }

    /// Sums a range of the samples that the scene was packed with. A pixel's sums do not depend on the range's other
    /// pixels.
    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums>;

    /// Resolves pixels without samples, row by row: red, green, blue and 0, or a last 1 where a pixel needs samples.
    /// None of a scene that was packed for samples, before there was a pilot run.
    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>>;

    /// Resolves a part of the picture, to see what that takes; `None` where pixels cannot be resolved.
    fn pilot(&mut self, progress: &dyn Progress) -> Result<Option<PilotRun>>;

    /// Adds the samples of each batch to its pixel of its half. No two batches of a call are of one pixel and one
    /// half.
    fn sample(&mut self, batches: &[Job], progress: &dyn Progress) -> Result<()>;

    /// Adds as many samples to both halves of all pixels of a picture of that size.
    fn sample_all(&mut self, size: [u32; 2], first: u32, count: u32, progress: &dyn Progress) -> Result<()> {
        self.sample(&batches_of_all(size, first, count), progress)
    }

    /// Takes the samples of each batch beside the film: of each red, green, blue, and their squares' mean, as sums.
    /// Their parts have `JOB_APART`.
    fn sample_apart(&mut self, batches: &[Job], progress: &dyn Progress) -> Result<Vec<[f32; 4]>>;

    /// Reads what the batches have summed so far.
    fn read(&mut self, sums: &mut HalfSums) -> Result<()>;

    /// Returns the samples of each half of each pixel in the first pass, at most so many: fewer where it is known that
    /// little is missed.
    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        Ok(vec![most; pixels])
    }
}

/// The batches of both halves of all pixels, both of a pixel side by side.
pub(super) fn batches_of_all([width, height]: [u32; 2], first: u32, count: u32) -> Vec<Job> {
    let batch = |i: u32| Job { place: Job::place_of(i >> 1, width), part: Job::part_of(i & 1), first, count };
    (0..2 * width * height).map(batch).collect()
}

/// Sums of two independent halves of the samples, as a device keeps them between passes: of each half, row by row,
/// red, green, blue, and their squares' mean.
pub struct HalfSums {
    pub width: u32,
    pub height: u32,
    pub halves: [Vec<[f32; 4]>; 2],
}

impl HalfSums {
    /// No samples yet.
    pub fn new([width, height]: [u32; 2]) -> HalfSums {
        let half = || vec![[0.0; 4]; width as usize * height as usize];
        HalfSums { width, height, halves: [half(), half()] }
    }
}

/// What resolving a part of the picture took.
#[derive(Clone, Debug, Default)]
pub struct PilotRun {
    /// For the whole picture, at the rate of the part.
    pub seconds: f64,
    /// Pixels of the part, and whether they were resolved.
    pub pixels: Vec<(u32, bool)>,
}
