//! The same number of samples in each pixel, or one cone. The picture is rendered in ranges of a few rows, whose sums
//! become means at once: at most one range's sums are in memory at a time.

use std::ops;

use super::{Integrated, Integrator};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::core::range::{Range, Rect};
use crate::sampling::Backend;
use crate::schema::layout::TILE;

/// Pixels of a range, rounded to whole rows of tiles: 100 MB of sums where there are any, and few enough ranges that the
/// submissions of each do not show on a fast device.
const MAX_PIXELS: u32 = 1 << 22;

/// The mean of the same number of samples per pixel.
#[derive(Clone, Copy, Debug)]
pub struct Fixed {
    pub samples: u32,
}

/// The mean of a run of the samples of each pixel, of which there are more.
#[derive(Clone, Debug)]
pub struct Run {
    pub samples: ops::Range<u32>,
}

/// One cone per pixel; `samples` is the number for which the scene was packed.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub samples: u32,
}

impl Integrator for Fixed {
    fn render(&self, backend: &mut dyn Backend, film: Film, progress: &dyn Progress) -> Result<Integrated> {
        means(backend, film, 0..self.samples, progress).map(|(film, _)| film.into())
    }
}

impl Integrator for Run {
    fn render(&self, backend: &mut dyn Backend, film: Film, progress: &dyn Progress) -> Result<Integrated> {
        means(backend, film, self.samples.clone(), progress).map(|(film, _)| film.into())
    }
}

impl Integrator for Cone {
    fn render(&self, backend: &mut dyn Backend, film: Film, progress: &dyn Progress) -> Result<Integrated> {
        let (film, dropped) = means(backend, film, 0..self.samples, progress)?;
        let dropped = Some(dropped / film.pixels.len() as f64);
        Ok(Integrated { dropped, ..Integrated::from(film) })
    }
}

/// Returns the film, and the weight that cones dropped, summed over all pixels.
fn means(
    backend: &mut dyn Backend,
    mut film: Film,
    samples: ops::Range<u32>,
    progress: &dyn Progress,
) -> Result<(Film, f64)> {
    let [width, height] = [film.width, film.height];
    film.samples = samples.end - samples.start;
    let mut dropped = 0.0;
    let tiles = MAX_PIXELS / TILE / width.max(1);
    for pixels in Rect::whole([width, height]).strips(TILE * tiles.max(1)) {
        let done = |rows: u32| f64::from(rows) / f64::from(height);
        let part = SubProgress { whole: progress, from: done(pixels.y), to: done(pixels.y + pixels.height) };
        dropped += backend.means(&Range { pixels, samples: samples.clone() }, &mut film, &part)?;
    }
    Ok((film, dropped))
}
