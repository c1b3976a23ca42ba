//! Takes lists of batches by the passes of a scene. Input: batches, and the film to which their sums go. Output: none of them
//! is left, or which ones one pass leaves. What the last pass leaves, as its loops were ended, is taken again in halves.

use std::iter::{once, repeat_n};

use super::batch_lists::{AtOnce, BATCHES_PER_TILE, BatchFilm, Batches, Listed, halves};
use super::dispatch_plan::{FIRST_SAMPLES, FIRST_SAMPLES_GPU, MAX_TILES, next_work};
use super::sample_pipeline::SamplePipeline;
use super::unfinished::NOWHERE;
use super::unfinished_list::too_long;
use super::{Report, Resources};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::{BindGroup, Buffer, BufferUse, DeviceKind, Gpu, RunTime};
use crate::schema::layout::{PixelBatch, Slice};

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
    /// Room for a list of batches, kept for the next one.
    list: Option<Buffer>,
}

impl<'a> BatchPasses<'a> {
    pub fn new(
        gpu: &'a Gpu,
        pipeline: &'a SamplePipeline,
        resources: &'a Resources,
        width: u32,
        corner: [u32; 2],
    ) -> BatchPasses<'a> {
        let next = if gpu.info().kind == DeviceKind::Cpu { FIRST_SAMPLES } else { FIRST_SAMPLES_GPU };
        BatchPasses { gpu, resources, pipeline, width, corner, next, list: None }
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
        let left = self.pass(0, film, batches, report, progress)?;
        self.later_passes(film, left, report, progress)
    }

    /// Adds the samples of batches that the first pass leaves.
    fn later_passes(
        &mut self,
        film: &BatchFilm,
        mut left: Vec<PixelBatch>,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
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
            Batches::List(list) => Some(self.upload(list)?),
            Batches::Equal { .. } => None,
        };
        let group = self.pipeline.bind(self.gpu, self.resources, &film.buffer, list.as_ref())?;
        self.submit(pass, &group, &batches.slice(film.slice), &batches.costs(), report, progress)?;
        self.left()
    }

    /// Returns a buffer that begins with these batches.
    fn upload(&mut self, batches: &[PixelBatch]) -> Result<Buffer> {
        let bytes = size_of_val(batches) as u64;
        let list = match self.list.take().filter(|list| list.bytes() >= bytes) {
            Some(list) => list,
            None => self.gpu.buffer("batches", bytes, BufferUse::Storage)?,
        };
        self.gpu.write_buffer(&list, 0, bytemuck::cast_slice(batches))?;
        self.list = Some(list.clone());
        Ok(list)
    }

    /// Returns the indices of the entries that the last submissions have left.
    fn left(&self) -> Result<Vec<u32>> {
        self.resources.unfinished.as_ref().map_or(Ok(Vec::new()), |list| list.take(self.gpu))
    }

    /// Adds all samples of batches that the device has listed.
    pub fn run_listed(
        &mut self,
        film: &BatchFilm,
        listed: &Listed,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let left = self.listed_left(film, listed, report, progress)?;
        let left = left.into_iter().map(|(_, batch)| batch).collect();
        self.later_passes(film, left, report, progress)
    }

    /// Submits batches that the device has listed to the first pass. Returns those that it leaves, and their indices.
    pub fn listed_left(
        &mut self,
        film: &BatchFilm,
        listed: &Listed,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Vec<(u32, PixelBatch)>> {
        let group = self.pipeline.bind(self.gpu, self.resources, &film.buffer, Some(listed.batches))?;
        let slice = listed.slice(film.slice);
        self.submit(0, &group, &slice, &listed.costs(), report, progress)?;
        let left = self.left()?;
        if left.is_empty() {
            return Ok(Vec::new());
        }
        let mut list = vec![PixelBatch::default(); listed.count() as usize];
        self.gpu.read_buffer(listed.batches, 0, bytemuck::cast_slice_mut(&mut list))?;
        Ok(left.into_iter().map(|index| (index, list[index as usize])).collect())
    }

    /// Returns the dispatch of batches with these costs, unless they take several submissions or some of them may be left.
    pub fn at_once(&self, slice: Slice, costs: &[f64]) -> Option<AtOnce> {
        let samples = costs.iter().sum::<f64>();
        let fits = samples <= self.next && costs.len() <= MAX_TILES as usize;
        let pipeline = self.pipeline.pipelines[0].clone();
        let groups = [self.pipeline.groups_per_tile, costs.len() as u32, 1];
        (fits && self.resources.unfinished.is_none()).then_some(AtOnce { pipeline, slice, groups, samples })
    }

    /// Binds a film and a list of batches.
    pub fn bind(&self, film: &Buffer, list: &Buffer) -> Result<BindGroup> {
        self.pipeline.bind(self.gpu, self.resources, film, Some(list))
    }

    /// Records the time of a submission with this number of samples.
    pub fn learn(&mut self, samples: f64, time: RunTime) {
        self.next = next_work(samples, time.wall_seconds);
    }

    /// Submits batches to one pass, as many tiles of them at once as previous timings allow.
    fn submit(
        &mut self,
        pass: usize,
        group: &BindGroup,
        slice: &Slice,
        costs: &[f64],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let SamplePipeline { pipelines, groups_per_tile, .. } = self.pipeline;
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
            let slice = Slice { first_tile: first as u32, ..*slice };
            let groups = [*groups_per_tile, tiles as u32, 1];
            let time = self.gpu.run(&pipelines[pass], group, bytemuck::bytes_of(&slice), groups)?;
            self.learn(samples, time);
            report.add_slice(time);
            if progress.cancelled() {
                return Err(Error::Interrupted);
            }
            first += tiles;
        }
        Ok(())
    }
}
