//! Candidates on a device: their costs on a part of the picture, and pictures by them. Input: a candidate and a number of
//! samples. Output: seconds, or the film. Sessions of prefiltered scenes are opened when they are first asked for; that
//! time is told apart from rendering.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use super::backend::DeviceBackend;
use super::dispatch_plan::DispatchPlan;
use super::film_buffer::Band;
use super::session::{Prepared, TilePass, Work};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::{NoProgress, Progress};
use crate::sampling::{Backend, Candidate, Made};
use crate::schema::layout::{Header, PixelBatch, TILE};

/// A cost is measured on one of this many tiles, but at least so many.
const PART: u32 = 32;
const MIN_TILES: u32 = 2;
/// Most of the time of a tile's dispatch that is assumed to be the dispatch's own.
const MAX_OVERHEAD: f64 = 0.7;
/// Most samples a pixel: f32 sums of this many are still accurate enough.
const MAX_SAMPLES: u32 = 1 << 16;
/// More samples are worth a further pass, which sets up all pixels again, if they are at least this share of those that were
/// taken.
const WORTH_MORE: f64 = 0.08;

/// Returns the largest number up to this one with four significant bits: the points of a net in base 2 are spread
/// the more evenly the more zeros their number ends with.
fn rounded_down(samples: u32) -> u32 {
    let unit = 1 << samples.max(8).ilog2().saturating_sub(3);
    samples - samples % unit
}

/// Returns the tiles of a band on which costs are measured: neighbours in tile order, which lie far apart. Not the first
/// ones, which are in the corner of the picture; these are in its middle.
fn trial_tiles(band: &Band) -> Range<u32> {
    let tiles = band.tiles.div_ceil(PART).max(MIN_TILES).min(band.tiles);
    let start = (band.tiles - tiles) / 2;
    start..start + tiles
}

impl<'p> DeviceBackend<'p> {
    /// Returns the backend of a candidate that has a session of its own.
    pub(super) fn rival(&mut self, candidate: Candidate) -> Result<Option<&mut DeviceBackend<'p>>> {
        let Some(rivals) = self.rivals else { return Ok(None) };
        if let Some(at) = self.opened.iter().position(|(own, _)| *own == candidate) {
            return Ok(Some(&mut self.opened[at].1));
        }
        let clock = Instant::now();
        let Some(prepared) = rivals.open(candidate)? else { return Ok(None) };
        let mut backend = DeviceBackend::new(prepared)?;
        backend.build_tiles()?;
        backend.dispatch = self.dispatch;
        let (seconds, own) = (&mut self.report.seconds, backend.report.seconds);
        seconds.upload += own.upload;
        seconds.compile += own.compile;
        self.apart += clock.elapsed().as_secs_f64();
        self.opened.push((candidate, backend));
        Ok(self.opened.last_mut().map(|(_, backend)| backend))
    }

    /// Builds what renders whole tiles of a scene that is packed for batches, and runs it once on the tiles of trials: the
    /// first dispatches of a pipeline, and of a tile, take longer.
    fn build_tiles(&mut self) -> Result<()> {
        if self.is_warm {
            return Ok(());
        }
        let clock = Instant::now();
        if let Work::Batches(_) = self.prepared.work {
            let Prepared { session, scene, .. } = self.prepared;
            self.even = Some(Arc::new(session.tiles_beside_batches(scene)?));
        }
        if let Ok(pass) = self.tiles()
            && let Some(band) = pass.film.bands(pass.film.whole()).next()
        {
            self.take(&pass, &band, trial_tiles(&band), 0..1, &NoProgress)?;
        }
        self.is_warm = true;
        let seconds = clock.elapsed().as_secs_f64();
        self.report.seconds.compile += seconds;
        self.apart += seconds;
        Ok(())
    }

    /// Returns the backend that renders by a candidate.
    fn maker(&mut self, candidate: Candidate) -> Result<Option<&mut DeviceBackend<'p>>> {
        if candidate != Candidate::Samples {
            return self.rival(candidate);
        }
        self.build_tiles()?;
        Ok(self.tiles().is_ok().then_some(self))
    }

    pub(super) fn candidate_cost(
        &mut self,
        candidate: Candidate,
        samples: u32,
        progress: &dyn Progress,
    ) -> Result<Option<f64>> {
        self.maker(candidate)?.map(|maker| maker.part(samples, progress)).transpose()
    }

    pub(super) fn render_candidate(
        &mut self,
        candidate: Candidate,
        samples: u32,
        seconds: f64,
        film: &mut Film,
        progress: &dyn Progress,
    ) -> Result<Made> {
        let seconds = if candidate == Candidate::Samples { seconds } else { 0.0 };
        match self.maker(candidate)? {
            Some(maker) => maker.fill(samples, seconds, film, progress),
            None => Err(Error::new("the scene does not have that candidate")),
        }
    }

    /// Takes one sample of each batch that stands for its whole pixel. Those of batches stand for one of two halves, so the
    /// pixel's side, by which nothing but footprints is measured, is made as much larger.
    pub(super) fn whole_pixels_apart(
        &mut self,
        batches: &[PixelBatch],
        progress: &dyn Progress,
    ) -> Result<Vec<[f32; 4]>> {
        let Prepared { session, scene, .. } = self.prepared;
        let pixel_side = scene.header.pixel_side * std::f64::consts::SQRT_2;
        session.write_header(&Header { pixel_side, ..scene.header })?;
        let sums = self.sample_apart(batches, progress)?;
        session.write_header(&scene.header)?;
        Ok(sums)
    }

    /// Measures some tiles of the first band; returns the seconds of the whole picture.
    fn part(&mut self, samples: u32, progress: &dyn Progress) -> Result<f64> {
        let pass = self.tiles()?;
        let film = &pass.film;
        let whole = film.whole();
        let Some(band) = film.bands(whole).next() else { return Ok(0.0) };
        let tiles = trial_tiles(&band);
        let mut seconds = None;
        if self.dispatch.is_none() {
            let two = tiles.start..(tiles.start + 2).min(band.tiles);
            let one = self.timed(&pass, &band, two.start..two.start + 1, 0..samples, progress)?;
            let both = self.timed(&pass, &band, two.clone(), 0..samples, progress)?;
            self.dispatch = Some((2.0 * one - both).clamp(0.0, MAX_OVERHEAD * one));
            seconds = (two == tiles).then_some(both);
        }
        let seconds = match seconds {
            Some(seconds) => seconds,
            None => self.timed(&pass, &band, tiles.clone(), 0..samples, progress)?,
        };
        let rendering = (seconds - self.dispatch.unwrap_or(0.0)).max((1.0 - MAX_OVERHEAD) * seconds);
        // Of the tiles at the borders only a part is in the picture.
        let tiled = f64::from(TILE * TILE) * tiles.len() as f64;
        Ok(rendering * whole.area() as f64 / tiled.min(whole.area() as f64))
    }

    /// Adds samples to some tiles of a band; returns their seconds on the device, if it tells them, else those until the
    /// host knew.
    fn timed(
        &mut self,
        pass: &TilePass<'p>,
        band: &Band,
        tiles: Range<u32>,
        samples: Range<u32>,
        progress: &dyn Progress,
    ) -> Result<f64> {
        let before = self.report.device_render_seconds;
        let waited = self.take(pass, band, tiles, samples, progress)?;
        let own = self.report.device_render_seconds - before;
        Ok(if own > 0.0 { own } else { waited })
    }

    /// Renders all tiles: `samples` samples a pixel, and more as long as they fit into `seconds`.
    fn fill(&mut self, samples: u32, seconds: f64, film: &mut Film, progress: &dyn Progress) -> Result<Made> {
        let begun = Instant::now();
        let pass = self.tiles()?;
        let gpu = self.prepared.session.gpu;
        let whole = pass.film.whole();
        let (samples, mut made, mut taken) = (rounded_down(samples), Made::default(), 0);
        for (index, band) in pass.film.bands(whole).enumerate() {
            if index > 0 {
                // As many as the first one.
                self.take(&pass, &band, 0..band.tiles, 0..taken, progress)?;
            } else {
                let share = f64::from(band.height) / f64::from(whole.height);
                let mut more = samples;
                while more > 0 {
                    let took = self.take(&pass, &band, 0..band.tiles, taken..taken + more, progress)?;
                    taken += more;
                    let left = seconds * share - begun.elapsed().as_secs_f64();
                    let fits = (left * f64::from(more) / took.max(1e-9)).max(0.0) as u32;
                    let fits = rounded_down(taken + fits.min(MAX_SAMPLES.saturating_sub(taken)))
                        .saturating_sub(taken);
                    more = if f64::from(fits) < WORTH_MORE * f64::from(taken) { 0 } else { fits };
                }
            }
            pass.film.read_means(gpu, &band, taken, film, &mut made.dropped)?;
        }
        made.samples = taken;
        Ok(made)
    }

    /// Adds samples to some tiles of a band; returns their seconds.
    fn take(
        &mut self,
        pass: &TilePass<'p>,
        band: &Band,
        tiles: Range<u32>,
        samples: Range<u32>,
        progress: &dyn Progress,
    ) -> Result<f64> {
        let mut plan =
            DispatchPlan::new(self.next, samples, self.prepared.scene.samples_at_once, tiles.len() as u64);
        let clock = Instant::now();
        pass.renderer.range(band, tiles, &mut plan, &mut self.report, progress)?;
        self.next = plan.next();
        Ok(clock.elapsed().as_secs_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::rounded_down;

    #[test]
    fn counts_are_rounded_down_to_four_significant_bits() {
        let counts = [1, 7, 15, 17, 38, 41, 213, 1000].map(rounded_down);
        assert_eq!(counts, [1, 7, 15, 16, 36, 40, 208, 960]);
    }
}
