//! Renders the tiles of a band on a device, in slices as long as the plan allows. Input: a pipeline with its bindings,
//! and a range of samples. Output: sums in the film's buffer.

use std::ops::Range;
use std::sync::Arc;

use super::Report;
use super::dispatch_plan::DispatchPlan;
use super::film_buffer::{Band, FilmBuffer};
use super::unfinished::UnfinishedPixels;
use super::unfinished_list::UnfinishedList;
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::{BindGroup, Gpu, Pipeline};
use crate::schema::constants::TEAM_SQUARES;
use crate::schema::layout::Slice;

/// What takes the samples of the pixels that a first pipeline leaves unfinished.
pub enum Rest {
    Nothing,
    Lists(Arc<UnfinishedList>, UnfinishedPixels),
    /// A second pipeline, which skips the others by itself.
    Tiles(Arc<Pipeline>),
}

pub struct TileRenderer<'a> {
    pub gpu: &'a Gpu,
    pub pipeline: Arc<Pipeline>,
    pub rest: Rest,
    pub group: BindGroup,
    pub groups_per_tile: u32,
}

impl TileRenderer<'_> {
    /// Runs one workgroup of the first slice, so that lazy compilation in the driver happens now.
    pub fn warm_up(&self, film: &FilmBuffer) -> Result<()> {
        if let Some(band) = film.bands(film.whole()).next() {
            let slice = Slice { sample_count: 1, ..band.slice() };
            self.run(&slice, [1, 1, 1], &mut Report::default())?;
            if let Rest::Lists(_, rest) = &self.rest {
                rest.warm_up(self.gpu, &band)?;
            }
        }
        Ok(())
    }

    /// Renders a slice, but for the pixels of lists; returns the wall time.
    fn run(&self, slice: &Slice, groups: [u32; 3], report: &mut Report) -> Result<f64> {
        let second = match &self.rest {
            Rest::Tiles(pipeline) => Some(pipeline),
            _ => None,
        };
        let mut seconds = 0.0;
        let second = second.map(|pipeline| (pipeline, [groups[0], groups[1], TEAM_SQUARES]));
        for (pipeline, groups) in [(&self.pipeline, groups)].into_iter().chain(second) {
            let time = self.gpu.run(pipeline, &self.group, bytemuck::bytes_of(slice), groups)?;
            report.add_slice(time);
            seconds += time.wall_seconds;
        }
        Ok(seconds)
    }

    /// Renders the first `count` tiles of a band, in tile order.
    pub fn tiles(
        &self,
        band: &Band,
        count: u32,
        plan: &mut DispatchPlan,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        self.range(band, 0..count, plan, report, progress)
    }

    /// Renders some tiles of a band, by their places in tile order.
    pub fn range(
        &self,
        band: &Band,
        range: Range<u32>,
        plan: &mut DispatchPlan,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        for (first_sample, sample_count) in plan.blocks() {
            let mut first_tile = range.start;
            while first_tile < range.end {
                let tiles = plan.tiles(range.end - first_tile, sample_count);
                let slice = Slice { first_tile, first_sample, sample_count, ..band.slice() };
                let groups = [self.groups_per_tile, tiles, 1];
                let seconds = self.run(&slice, groups, report)?;
                plan.learn(tiles, sample_count, seconds);
                progress.advance(plan.done());
                if progress.cancelled() {
                    return Err(Error::Interrupted);
                }
                first_tile += tiles;
            }
            if let Rest::Lists(unfinished, rest) = &self.rest {
                rest.finish(self.gpu, unfinished, band, [first_sample, sample_count], report, progress)?;
            }
        }
        Ok(())
    }
}
