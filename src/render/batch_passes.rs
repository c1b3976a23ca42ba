//! Takes lists of batches by the passes of a scene. Input: batches, and the film to which their sums go. Output: none of them
//! is left, or which ones one pass leaves. What the last pass leaves, as its loops were ended, is taken again in halves.

use std::iter::{once, repeat_n};

use super::dispatch_plan::{FIRST_SAMPLES, MAX_TILES, next_work};
use super::sample_pipeline::SamplePipeline;
use super::unfinished::NOWHERE;
use super::unfinished_list::too_long;
use super::{Report, Resources};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::{Buffer, BufferUse, Gpu};
use crate::schema::layout::{PixelBatch, Slice, TILE};

const BATCHES_PER_TILE: usize = (TILE * TILE) as usize;

/// The batches of one call.
pub enum Batches<'b> {
    List(&'b [PixelBatch]),
    /// `count` samples from `first` on in both halves of `pixels` pixels.
    Equal {
        pixels: u32,
        first: u32,
        count: u32,
    },
}

impl Batches<'_> {
    /// Returns the samples of each tile of batches.
    fn costs(&self) -> Vec<f64> {
        match *self {
            Batches::List(list) => list
                .chunks(BATCHES_PER_TILE)
                .map(|tile| tile.iter().map(|j| f64::from(j.count)).sum())
                .collect(),
            Batches::Equal { pixels, count, .. } => {
                let cost = (BATCHES_PER_TILE * count as usize) as f64;
                vec![cost; (2 * pixels as usize).div_ceil(BATCHES_PER_TILE)]
            }
        }
    }

    /// Returns one of them; a film is `width` pixels wide.
    fn batch(&self, index: u32, width: u32) -> PixelBatch {
        match *self {
            Batches::List(list) => list[index as usize],
            Batches::Equal { first, count, .. } => {
                let place = PixelBatch::place_of(index / 2, width);
                PixelBatch { place, part: PixelBatch::part_of(index % 2), first, count }
            }
        }
    }

    /// Returns the push constants of all, where those of the film are `film`.
    fn slice(&self, film: Slice) -> Slice {
        match *self {
            Batches::List(list) => Slice { tiles: list.len() as u32, listed: 1, ..film },
            Batches::Equal { pixels, first, count } => {
                Slice { tiles: 2 * pixels, first_sample: first, sample_count: count, ..film }
            }
        }
    }
}

/// Returns the halves of batches, of which the second one is empty if there is a single sample: threads beside it may have had
/// more. If none has more, returns `None`: each has to be alone in its workgroup.
pub fn halves<'b>(batches: impl Iterator<Item = &'b PixelBatch> + Clone) -> Option<Vec<[PixelBatch; 2]>> {
    if batches.clone().all(|batch| batch.count == 1) {
        return None;
    }
    let of = |batch: &PixelBatch| {
        let half = batch.count.div_ceil(2);
        let second = PixelBatch { first: batch.first + half, count: batch.count - half, ..*batch };
        [PixelBatch { count: half, ..*batch }, second]
    };
    Some(batches.map(of).collect())
}

/// A film of batches, with the push constants of its submissions.
#[derive(Clone)]
pub struct BatchFilm {
    pub buffer: Buffer,
    pub slice: Slice,
}

/// The passes of batches on a device.
pub struct BatchPasses<'a> {
    pub gpu: &'a Gpu,
    resources: &'a Resources,
    pipeline: &'a SamplePipeline,
    /// Of the film.
    width: u32,
    /// Its corner in the picture.
    corner: [u32; 2],
    /// Samples of the next submission, learnt from the previous ones.
    next: f64,
}

impl<'a> BatchPasses<'a> {
    pub fn new(
        gpu: &'a Gpu,
        pipeline: &'a SamplePipeline,
        resources: &'a Resources,
        width: u32,
        corner: [u32; 2],
    ) -> BatchPasses<'a> {
        BatchPasses { gpu, resources, pipeline, width, corner, next: FIRST_SAMPLES }
    }

    /// Returns the index of the last pass.
    pub fn last(&self) -> usize {
        self.pipeline.pipelines.len() - 1
    }

    /// Runs one workgroup of each pass without a batch, so that lazy compilation in the driver happens now.
    pub fn warm_up(&self, film: &BatchFilm) -> Result<()> {
        let empty = [PixelBatch::default()];
        let batches = self.gpu.upload_buffer("batches", BufferUse::Storage, bytemuck::cast_slice(&empty))?;
        let group = self.pipeline.bind(self.gpu, self.resources, &film.buffer, Some(&batches))?;
        let slice = Slice { tiles: 0, listed: 1, ..film.slice };
        for pipeline in &self.pipeline.pipelines {
            self.gpu.run(pipeline, &group, bytemuck::bytes_of(&slice), [1, 1, 1])?;
        }
        Ok(())
    }

    /// Adds all samples of some batches to a film.
    pub fn run(
        &mut self,
        film: &BatchFilm,
        batches: &Batches,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let mut left = self.pass(0, film, batches, report, progress)?;
        for pass in 1..=self.last() {
            left = self.pass(pass, film, &Batches::List(&left), report, progress)?;
        }
        self.in_parts(film, &left, report, progress)
    }

    /// Takes the samples of batches in two parts, one after the other, and each of these likewise if it must be.
    fn in_parts(
        &mut self,
        film: &BatchFilm,
        batches: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        if batches.is_empty() {
            return Ok(());
        }
        let Some(pairs) = halves(batches.iter()) else {
            let alone = self.apart(batches);
            let left = self.pass(self.last(), film, &Batches::List(&alone), report, progress)?;
            return left.first().map_or(Ok(()), |batch| Err(self.too_long(film, batch)));
        };
        for half in [0, 1] {
            let part: Vec<PixelBatch> =
                pairs.iter().map(|pair| pair[half]).filter(|batch| batch.count > 0).collect();
            let left = self.pass(self.last(), film, &Batches::List(&part), report, progress)?;
            self.in_parts(film, &left, report, progress)?;
        }
        Ok(())
    }

    /// Returns the batches, each followed by as many without a pixel as fill its workgroup.
    pub fn apart(&self, batches: &[PixelBatch]) -> Vec<PixelBatch> {
        let threads = BATCHES_PER_TILE / self.pipeline.groups_per_tile as usize;
        let nothing = PixelBatch { place: NOWHERE, ..PixelBatch::default() };
        batches.iter().flat_map(|&batch| once(batch).chain(repeat_n(nothing, threads - 1))).collect()
    }

    /// Returns the error of a batch of one sample that is left when it is alone.
    pub fn too_long(&self, film: &BatchFilm, batch: &PixelBatch) -> Error {
        let ([left, top], [x, y]) = (self.corner, batch.column_and_row());
        too_long(self.gpu, [left + x, top + film.slice.band_y + y])
    }

    /// Takes batches by one pass; returns those that it leaves.
    fn pass(
        &mut self,
        pass: usize,
        film: &BatchFilm,
        batches: &Batches,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Vec<PixelBatch>> {
        let left = self.indices_left(pass, film, batches, report, progress)?;
        Ok(left.into_iter().map(|index| batches.batch(index, self.width)).collect())
    }

    /// Submits batches in whole tiles to one pass, as many at once as previous timings allow. Returns the indices of those
    /// that it leaves.
    pub fn indices_left(
        &mut self,
        pass: usize,
        film: &BatchFilm,
        batches: &Batches,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Vec<u32>> {
        let list = match batches {
            Batches::List([]) => return Ok(Vec::new()),
            Batches::List(list) => {
                Some(self.gpu.upload_buffer("batches", BufferUse::Storage, bytemuck::cast_slice(list))?)
            }
            Batches::Equal { .. } => None,
        };
        let SamplePipeline { pipelines, groups_per_tile, .. } = self.pipeline;
        let group = self.pipeline.bind(self.gpu, self.resources, &film.buffer, list.as_ref())?;
        let (slice, costs) = (batches.slice(film.slice), batches.costs());
        let mut first = 0;
        while first < costs.len() {
            let (mut tiles, mut samples) = (1, costs[first]);
            while first + tiles < costs.len()
                && tiles < MAX_TILES as usize
                && samples + costs[first + tiles] <= self.next
            {
                samples += costs[first + tiles];
                tiles += 1;
            }
            let slice = Slice { first_tile: first as u32, ..slice };
            let groups = [*groups_per_tile, tiles as u32, 1];
            let time = self.gpu.run(&pipelines[pass], &group, bytemuck::bytes_of(&slice), groups)?;
            self.next = next_work(samples, time.wall_seconds);
            report.add_slice(time);
            if progress.cancelled() {
                return Err(Error::Interrupted);
            }
            first += tiles;
        }
        self.resources.unfinished.as_ref().map_or(Ok(Vec::new()), |list| list.take(self.gpu))
    }
}
