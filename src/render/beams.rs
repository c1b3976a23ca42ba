//! One beam per pixel on a device. Input: rows of a picture. Output: their pixels, with a flag for those that a beam
//! cannot resolve.

use std::sync::Arc;
use std::time::Instant;

use super::Report;
use super::dispatch_plan::DispatchPlan;
use super::film_buffer::FilmBuffer;
use super::tiles::TileRenderer;
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::sampling::PilotRun;

/// Tiles of the first slice: a beam takes as long as many samples.
const FIRST_TILES: f64 = 2.0;
/// A pilot run renders one of this many tiles, and at least some, taken from the start of the tile order, whose neighbours
/// are far apart.
const PILOT_PART: u32 = 16;
const MIN_PILOT_TILES: u32 = 4;

/// The pass that resolves pixels by beams.
pub struct BeamPass<'a> {
    pub renderer: TileRenderer<'a>,
    pub film: Arc<FilmBuffer>,
}

impl BeamPass<'_> {
    /// Resolves some rows. Returns red, green, blue and 0 for each pixel, or 1 in the fourth place if it needs samples.
    pub fn resolve(&self, rows: Rect, report: &mut Report, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let mut pixels = Vec::with_capacity(rows.area());
        let mut plan = DispatchPlan::new(FIRST_TILES, 0..1, 1, self.film.tiles(rows));
        for band in self.film.bands(rows) {
            self.renderer.tiles(&band, band.tiles, &mut plan, report, progress)?;
            self.film.read_with(self.renderer.gpu, &band, |_, sum| pixels.push(sum))?;
        }
        Ok(pixels)
    }

    /// Resolves the first tiles, in tile order, of the first band.
    pub fn pilot(&self, report: &mut Report, progress: &dyn Progress) -> Result<PilotRun> {
        let whole = self.film.whole();
        let Some(band) = self.film.bands(whole).next() else { return Ok(PilotRun::default()) };
        let tiles = band.tiles.div_ceil(PILOT_PART).max(MIN_PILOT_TILES).min(band.tiles);
        let mut plan = DispatchPlan::new(FIRST_TILES, 0..1, 1, tiles.into());
        let clock = Instant::now();
        self.renderer.tiles(&band, tiles, &mut plan, report, progress)?;
        let seconds = clock.elapsed().as_secs_f64() * self.film.tiles(whole) as f64 / f64::from(tiles);
        let tried: Vec<bool> = band.first_tiles(tiles);
        let mut pixels = Vec::new();
        self.film.read_with(self.renderer.gpu, &band, |i, sum| {
            if tried[band.tile_of(i as u32, self.film.width())] {
                pixels.push((i as u32, sum[3] == 0.0));
            }
        })?;
        Ok(PilotRun { seconds, pixels })
    }
}
