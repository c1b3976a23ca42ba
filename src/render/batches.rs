//! Sums batches of samples into two halves on the device, for sampling rates that differ from pixel to pixel. The film
//! is divided into pages of whole rows that fit the device's buffers; each page has its own list of batches.

use super::dispatch_plan::{FIRST_SAMPLES, MAX_TILES, next_work};
use super::sample_pipeline::{Bindings, SamplePipeline};
use super::{Report, Resources};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::gpu::{Buffer, BufferUse, Gpu};
use crate::pack::{PackedScene, Schedule, filtered_mean};
use crate::sampling::HalfSums;
use crate::schema::layout::{PixelBatch, Slice, TILE};

/// Four floats for each half.
const PIXEL_BYTES: u64 = 32;
const MAX_PAGE_BYTES: u64 = 64 << 20;
/// Samples that one invocation takes of a batch that does not go to the film.
const PART_SAMPLES: u32 = 64;
/// Number of such batches whose sums one buffer holds.
const MAX_PARTS: usize = 1 << 20;
const BATCHES_PER_TILE: usize = (TILE * TILE) as usize;

struct Page {
    rows: Rect,
    film: Buffer,
}

/// Takes batches of samples and holds their sums.
pub struct BatchSampler<'a> {
    gpu: &'a Gpu,
    bindings: Bindings<'a>,
    groups_per_tile: u32,
    pages: Vec<Page>,
    size: [u32; 2],
    /// The mean of the samples' signs, if they have any: the film then also holds sums of negative samples, and counts.
    mean_sign: Option<f64>,
    /// Most samples that an invocation takes at once.
    block: u32,
    /// Samples of the next submission, learnt from the previous ones.
    next: f64,
}

impl<'a> BatchSampler<'a> {
    pub fn new(
        gpu: &'a Gpu,
        pipeline: &'a SamplePipeline,
        resources: &'a Resources,
        scene: &PackedScene,
    ) -> Result<BatchSampler<'a>> {
        let limits = &gpu.info().limits;
        let [width, height] = scene.header.film_size.to_array();
        let planes = if scene.mean_sign.is_some() { 3 } else { 1 };
        let row = u64::from(width) * PIXEL_BYTES * planes;
        let rows =
            (MAX_PAGE_BYTES.min(limits.max_storage_buffer_range) / row).clamp(1, u64::from(height)) as u32;
        let page = |rows: Rect| {
            let film = gpu.buffer("film", row * u64::from(rows.height), BufferUse::Storage)?;
            Ok(Page { rows, film })
        };
        let pages = Rect::whole([width, height]).strips(rows).map(page).collect::<Result<Vec<_>>>()?;
        let SamplePipeline { pipeline, shader, groups_per_tile } = pipeline;
        Ok(BatchSampler {
            gpu,
            bindings: Bindings { resources, pipeline, shader },
            groups_per_tile: *groups_per_tile,
            pages,
            size: [width, height],
            mean_sign: scene.mean_sign,
            block: scene.samples_at_once,
            next: FIRST_SAMPLES,
        })
    }

    /// Runs one workgroup without a batch, so that lazy compilation in the driver happens now.
    pub fn warm_up(&self) -> Result<()> {
        let Some(page) = self.pages.first() else { return Ok(()) };
        let batches = self.gpu.upload_buffer(
            "batches",
            BufferUse::Storage,
            bytemuck::bytes_of(&PixelBatch::default()),
        )?;
        let group = self.bindings.bind(self.gpu, &page.film, Some(&batches))?;
        let slice = Slice { tiles: 1, ..page.slice() };
        self.gpu.run(self.bindings.pipeline, &group, bytemuck::bytes_of(&slice), [1, 1, 1])?;
        Ok(())
    }

    /// Takes all samples of a list, in rounds within the loop budget of an invocation.
    fn rounds(
        &mut self,
        index: usize,
        list: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let (block, most) = (self.block, list.iter().map(|j| j.count).max().unwrap_or(0));
        if most <= block {
            return self.page(index, list, report, progress);
        }
        for done in (0..most).step_by(block as usize) {
            let rest = list.iter().filter(|j| j.count > done);
            let part =
                rest.map(|j| PixelBatch { first: j.first + done, count: block.min(j.count - done), ..*j });
            self.page(index, &part.collect::<Vec<_>>(), report, progress)?;
        }
        Ok(())
    }

    /// Submits a list of batches in whole tiles.
    fn page(
        &mut self,
        index: usize,
        list: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let batches = self.gpu.upload_buffer("batches", BufferUse::Storage, bytemuck::cast_slice(list))?;
        let slice = Slice { tiles: list.len() as u32, ..self.pages[index].slice() };
        let costs = costs(list);
        let film = self.pages[index].film.clone();
        self.submit(&film, slice, Some(&batches), costs, report, progress)
    }

    /// Takes the same number of samples of both halves of all pixels of a page.
    fn whole_page(
        &mut self,
        index: usize,
        first: u32,
        count: u32,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let page = &self.pages[index];
        let batches = 2 * self.size[0] * page.rows.height;
        let slice = Slice { tiles: batches, first_sample: first, sample_count: count, ..page.slice() };
        let cost = (BATCHES_PER_TILE * count as usize) as f64;
        let costs = vec![cost; (batches as usize).div_ceil(BATCHES_PER_TILE)];
        let film = page.film.clone();
        self.submit(&film, slice, None, costs, report, progress)
    }

    /// Returns the sums of batches that do not go to the film, each short enough for one invocation: of radiance, and
    /// if samples have signs also of negative samples, and the counts.
    fn parts_apart(
        &mut self,
        parts: &[(usize, PixelBatch)],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Vec<Vec<[f32; 4]>>> {
        let list: Vec<PixelBatch> = parts.iter().map(|(_, batch)| *batch).collect();
        let planes = if self.mean_sign.is_some() { 3 } else { 1 };
        let plane = (list.len() * size_of::<[f32; 4]>()) as u64;
        let film = self.gpu.buffer("audit", planes * plane, BufferUse::Storage)?;
        let batches = self.gpu.upload_buffer("batches", BufferUse::Storage, bytemuck::cast_slice(&list))?;
        // Positions are those of the whole picture.
        let whole = Page { rows: Rect::whole(self.size), film: film.clone() };
        let slice = Slice { tiles: list.len() as u32, ..whole.slice() };
        self.submit(&film, slice, Some(&batches), costs(&list), report, progress)?;
        let read = |kind: u64| {
            let mut sums = vec![[0f32; 4]; list.len()];
            self.gpu.read_buffer(&film, kind * plane, bytemuck::cast_slice_mut(&mut sums))?;
            Ok(sums)
        };
        (0..planes).map(read).collect()
    }

    /// Submits tiles with these numbers of samples, as many at once as previous timings allow.
    fn submit(
        &mut self,
        film: &Buffer,
        slice: Slice,
        batches: Option<&Buffer>,
        costs: Vec<f64>,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let group = self.bindings.bind(self.gpu, film, batches)?;
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
            let groups = [self.groups_per_tile, tiles as u32, 1];
            let time = self.gpu.run(self.bindings.pipeline, &group, bytemuck::bytes_of(&slice), groups)?;
            self.next = next_work(samples, time.wall_seconds);
            report.add_slice(time);
            if progress.cancelled() {
                return Err(Error::Interrupted);
            }
            first += tiles;
        }
        Ok(())
    }
}

/// Returns the samples of each tile of batches.
fn costs(list: &[PixelBatch]) -> Vec<f64> {
    list.chunks(BATCHES_PER_TILE).map(|tile| tile.iter().map(|j| f64::from(j.count)).sum()).collect()
}

/// Returns sums of radiance as if no sample had a sign, from the signed sums, those of negative samples alone, the sum
/// of the signs and the number of samples.
fn weighed([sums, negative, [signs, samples, _, _]]: [[f64; 4]; 3], mean_sign: f64) -> [f32; 4] {
    let filtered = |c: usize| samples * filtered_mean(sums[c], negative[c], signs, samples, mean_sign);
    [filtered(0), filtered(1), filtered(2), sums[3]].map(|v| v as f32)
}

impl Page {
    fn slice(&self) -> Slice {
        Slice {
            band_y: self.rows.y,
            band_height: self.rows.height,
            schedule: Schedule::Batches as u32,
            ..Default::default()
        }
    }
}

impl BatchSampler<'_> {
    /// Adds the samples of each batch to its pixel in its half.
    pub fn sample(
        &mut self,
        batches: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        if let [page] = self.pages.as_slice() {
            debug_assert_eq!(page.rows.y, 0);
            return self.rounds(0, batches, report, progress);
        }
        for index in 0..self.pages.len() {
            let rows = self.pages[index].rows;
            let own = batches.iter().filter(|j| rows.rows().contains(&(j.place >> 16)));
            let list: Vec<PixelBatch> =
                own.map(|j| PixelBatch { place: j.place - (rows.y << 16), ..*j }).collect();
            if !list.is_empty() {
                self.rounds(index, &list, report, progress)?;
            }
        }
        Ok(())
    }

    /// Adds the same number of samples to both halves of all pixels.
    pub fn sample_all(
        &mut self,
        first: u32,
        count: u32,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        for index in 0..self.pages.len() {
            for done in (0..count).step_by(self.block as usize) {
                self.whole_page(index, first + done, self.block.min(count - done), report, progress)?;
            }
        }
        Ok(())
    }

    /// Sums each batch separately, without adding it to the film.
    pub fn sample_apart(
        &mut self,
        batches: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Vec<[f32; 4]>> {
        // Each part that an invocation takes has a slot of its own. Parts are short, so that neighbouring invocations
        // work on one pixel and follow the same paths.
        let most = self.block.min(PART_SAMPLES);
        let mut parts: Vec<(usize, PixelBatch)> = Vec::new();
        for (i, batch) in batches.iter().enumerate() {
            let firsts = (0..batch.count).step_by(most as usize);
            parts.extend(firsts.map(|first| {
                (i, PixelBatch { first: batch.first + first, count: most.min(batch.count - first), ..*batch })
            }));
        }
        let mut sums = vec![[[0f64; 4]; 3]; batches.len()];
        for parts in parts.chunks(MAX_PARTS) {
            for (kind, plane) in self.parts_apart(parts, report, progress)?.iter().enumerate() {
                for (&(i, _), sum) in parts.iter().zip(plane) {
                    (0..4).for_each(|c| sums[i][kind][c] += f64::from(sum[c]));
                }
            }
        }
        let finish = |sums: [[f64; 4]; 3]| match self.mean_sign {
            Some(mean) => weighed(sums, mean),
            None => sums[0].map(|v| v as f32),
        };
        Ok(sums.into_iter().map(finish).collect())
    }

    /// Reads the sums of all batches so far.
    pub fn read(&self, sums: &mut HalfSums) -> Result<()> {
        for page in &self.pages {
            let pixels = page.rows.height as usize * sums.width as usize;
            let first = page.rows.y as usize * sums.width as usize;
            for (half, out) in sums.halves.iter_mut().enumerate() {
                let out = &mut out[first..first + pixels];
                let offset = |plane: usize| (plane * pixels * size_of::<[f32; 4]>()) as u64;
                self.gpu.read_buffer(&page.film, offset(half), bytemuck::cast_slice_mut(out))?;
                if let Some(mean) = self.mean_sign {
                    let [mut negative, mut counts] = [(); 2].map(|()| vec![[0f32; 4]; pixels]);
                    for (kind, plane) in [&mut negative, &mut counts].into_iter().enumerate() {
                        let offset = offset(2 * (1 + kind) + half);
                        self.gpu.read_buffer(&page.film, offset, bytemuck::cast_slice_mut(plane))?;
                    }
                    for ((sums, negative), counts) in out.iter_mut().zip(&negative).zip(&counts) {
                        *sums = weighed([*sums, *negative, *counts].map(|v| v.map(f64::from)), mean);
                    }
                }
            }
        }
        Ok(())
    }
}
