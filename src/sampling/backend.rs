//! The interface of everything that takes samples: devices, the oracle, and several of them together. A backend is
//! opened for one scene and one choice of samples. Input: ranges, or batches of samples for single pixels. Output:
//! sums.

use std::sync::LazyLock;
use std::time::Instant;

use super::{Candidate, FilmSums, Made, Pixels};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::{Range, Rect};
use crate::schema::layout::PixelBatch;

/// Returns the wall-clock seconds since a fixed moment.
pub fn wall_seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// A source of samples of one scene.
pub trait Backend: Send {
    /// Returns the name that is shown to the user.
    fn name(&self) -> String;

    /// Returns true if samples are averages over footprints.
    fn prefilters(&self) -> bool;

    /// Returns the seconds since a fixed moment, by the clock that decides how sampling to a goal goes on. A backend of a
    /// test has one of its own, so that its passes are the same on a busy machine.
    fn seconds(&self) -> f64 {
        wall_seconds()
    }

    /// Returns the smallest share of a texture, an environment or the like that is far brighter than the rest and still
    /// emits much of its light; 1 if none is known.
    fn bright_share(&self) -> f64 {
        1.0
    }

    /// Sums a range of the samples for which the scene was packed. A pixel's sums do not depend on the other pixels of
    /// the range.
    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums>;

    /// Writes the means of a range of samples into a film of the whole picture, the same numbers as those of its sums.
    /// Returns the weight that cones dropped, summed over all pixels.
    fn means(&mut self, range: &Range, film: &mut Film, progress: &dyn Progress) -> Result<f64> {
        let sums = self.sum(range, progress)?;
        sums.write_to(film);
        Ok(sums.dropped())
    }

    /// Resolves pixels without samples, row by row: red, green, blue and 0, or 1 in the fourth place if the pixel needs
    /// samples. Empty for a scene that was packed for samples, until a pilot run was made.
    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>>;

    /// Resolves a part of the picture to measure the time that it takes; `None` if pixels cannot be resolved.
    fn pilot(&mut self, progress: &dyn Progress) -> Result<Option<PilotRun>>;

    /// Measures the seconds that a picture of `samples` samples a pixel by a candidate would take, on a part of it; `None`
    /// if the backend does not have the candidate.
    fn cost(
        &mut self,
        _candidate: Candidate,
        _samples: u32,
        _progress: &dyn Progress,
    ) -> Result<Option<f64>> {
        Ok(None)
    }

    /// Takes samples as [`Backend::sample_apart`] does, of a prefiltered picture; `None` if the backend has none.
    fn prefiltered_apart(
        &mut self,
        _batches: &[PixelBatch],
        _progress: &dyn Progress,
    ) -> Result<Option<Vec<[f32; 4]>>> {
        Ok(None)
    }

    /// Renders the whole picture by a candidate whose cost was measured, into a film: with `samples` samples a pixel, and
    /// more while `seconds` have not passed, if that makes it better.
    fn render_by(
        &mut self,
        candidate: Candidate,
        _samples: u32,
        _seconds: f64,
        _film: &mut Film,
        _progress: &dyn Progress,
    ) -> Result<Made> {
        Err(Error::new(format!("{} cannot render by {candidate:?}", self.name())))
    }

    /// Adds the samples of each batch to its pixel in its half. No two batches of a call share pixel and half.
    fn sample(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<()>;

    /// Adds the same number of samples to both halves of all pixels of a picture of that size.
    fn sample_all(&mut self, size: [u32; 2], first: u32, count: u32, progress: &dyn Progress) -> Result<()> {
        self.sample(&batches_of_all(size, first, count), progress)
    }

    /// Takes the samples of each batch without adding them to the film. Returns for each batch the sums of red, green,
    /// blue, and of the mean of their squares. The batches' `part` contains `BATCH_APART`.
    fn sample_apart(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<[f32; 4]>>;

    /// Reads the sums of all batches so far.
    fn read(&mut self, sums: &mut HalfSums) -> Result<()>;

    /// Returns true if it keeps the pixels of a picture itself: [`Backend::kept_pixels`] then returns them.
    fn keeps_pixels(&self) -> bool {
        false
    }

    /// Returns the pixels that it keeps; `None` if the host has to.
    fn kept_pixels(&mut self) -> Result<Option<Box<dyn Pixels + '_>>> {
        Ok(None)
    }

    /// Returns the samples of each half of each pixel in the first pass, at most `most`: fewer for pixels in which
    /// little can be missed.
    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        Ok(vec![most; pixels])
    }
}

/// Returns the batches of both halves of all pixels; the two of a pixel are neighbours.
pub(super) fn batches_of_all([width, height]: [u32; 2], first: u32, count: u32) -> Vec<PixelBatch> {
    let batch = |i: u32| PixelBatch {
        place: PixelBatch::place_of(i >> 1, width),
        part: PixelBatch::part_of(i & 1),
        first,
        count,
    };
    (0..2 * width * height).map(batch).collect()
}

/// Sums of two independent halves of the samples, as a device keeps them between passes: for each half, row by row,
/// red, green, blue, and the mean of their squares.
pub struct HalfSums {
    pub width: u32,
    pub height: u32,
    pub halves: [Vec<[f32; 4]>; 2],
}

impl HalfSums {
    /// Returns sums of no samples.
    pub fn new([width, height]: [u32; 2]) -> HalfSums {
        let half = || vec![[0.0; 4]; width as usize * height as usize];
        HalfSums { width, height, halves: [half(), half()] }
    }
}

/// The cost and the outcome of resolving a part of the picture.
#[derive(Clone, Debug, Default)]
pub struct PilotRun {
    /// Seconds for the whole picture, extrapolated from the part.
    pub seconds: f64,
    /// The indices of the part's pixels, each with true if it was resolved.
    pub pixels: Vec<(u32, bool)>,
}
