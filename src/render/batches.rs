//! Sums batches of samples into two halves on the device, for sampling rates that differ from pixel to pixel. The film
//! is divided into pages of whole rows that fit the device's buffers; each page has its own list of batches.

use super::batch_lists::{AtOnce, BatchFilm, Batches, Listed};
use super::batch_passes::BatchPasses;
use super::sample_pipeline::SamplePipeline;
use super::{Report, Resources};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::gpu::{Buffer, BufferUse, Gpu};
use crate::pack::{PackedScene, Schedule, filtered_mean};
use crate::sampling::HalfSums;
use crate::schema::layout::{PixelBatch, Slice};

/// Four floats for each half.
pub const PIXEL_BYTES: u64 = 32;
/// Bytes of a page of a film that the host reads after each pass.
const MAX_PAGE_BYTES: u64 = 64 << 20;
pub(super) struct Page {
    rows: Rect,
    pub(super) film: BatchFilm,
}

/// Takes batches of samples and holds their sums.
pub struct BatchSampler<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) passes: BatchPasses<'a>,
    pub(super) pages: Vec<Page>,
    pub(super) size: [u32; 2],
    /// The mean of the samples' signs, if they have any: the film then also holds sums of negative samples, and counts.
    pub(super) mean_sign: Option<f64>,
    /// Most samples that an invocation takes at once.
    pub(super) block: u32,
}

impl<'a> BatchSampler<'a> {
    /// Returns a sampler with sums of no samples, in a buffer of its own or one that is kept for the whole picture.
    pub fn new(
        gpu: &'a Gpu,
        pipeline: &'a SamplePipeline,
        resources: &'a Resources,
        scene: &PackedScene,
        kept: Option<&Buffer>,
    ) -> Result<BatchSampler<'a>> {
        let limits = &gpu.info().limits;
        let [width, height] = scene.header.film_size.to_array();
        let planes = if scene.mean_sign.is_some() { 3 } else { 1 };
        let row = u64::from(width) * PIXEL_BYTES * planes;
        let rows = match kept {
            Some(_) => height,
            None => {
                (MAX_PAGE_BYTES.min(limits.max_storage_buffer_range) / row).clamp(1, u64::from(height)) as u32
            }
        };
        let page = |rows: Rect| {
            let new = || gpu.buffer("film", row * u64::from(rows.height), BufferUse::Storage);
            let buffer = kept.cloned().map_or_else(new, Ok)?;
            Ok(Page { rows, film: film_of(rows, buffer) })
        };
        let pages = Rect::whole([width, height]).strips(rows).map(page).collect::<Result<Vec<_>>>()?;
        Ok(BatchSampler {
            gpu,
            passes: BatchPasses::new(gpu, pipeline, resources, width, scene.header.crop.to_array()),
            pages,
            size: [width, height],
            mean_sign: scene.mean_sign,
            block: scene.samples_at_once,
        })
    }

    /// Runs one workgroup of each pass without a batch, so that lazy compilation in the driver happens now.
    pub fn warm_up(&self) -> Result<()> {
        self.pages.first().map_or(Ok(()), |page| self.passes.warm_up(&page.film))
    }

    /// Takes all samples of a list, in rounds within the loop budget of an invocation.
    fn rounds(
        &mut self,
        index: usize,
        list: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let film = &self.pages[index].film;
        let (block, most) = (self.block, list.iter().map(|j| j.count).max().unwrap_or(0));
        if most <= block {
            return self.passes.run(film, &Batches::List(list), report, progress);
        }
        for done in (0..most).step_by(block as usize) {
            let rest = list.iter().filter(|j| j.count > done);
            let part =
                rest.map(|j| PixelBatch { first: j.first + done, count: block.min(j.count - done), ..*j });
            self.passes.run(film, &Batches::List(&part.collect::<Vec<_>>()), report, progress)?;
        }
        Ok(())
    }
}

/// Returns a film of some rows.
pub(super) fn film_of(rows: Rect, buffer: Buffer) -> BatchFilm {
    let slice = Slice {
        band_y: rows.y,
        band_height: rows.height,
        schedule: Schedule::Batches as u32,
        ..Default::default()
    };
    BatchFilm { buffer, slice }
}

/// Returns sums of radiance as if no sample had a sign, from the signed sums, those of negative samples alone, the sum
/// of the signs and the number of samples.
pub(super) fn weighed([sums, negative, [signs, samples, _, _]]: [[f64; 4]; 3], mean_sign: f64) -> [f32; 4] {
    let filtered = |c: usize| samples * filtered_mean(sums[c], negative[c], signs, samples, mean_sign);
    [filtered(0), filtered(1), filtered(2), sums[3]].map(|v| v as f32)
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
        for page in &self.pages {
            let pixels = self.size[0] * page.rows.height;
            for done in (0..count).step_by(self.block as usize) {
                let batches =
                    Batches::Equal { pixels, first: first + done, count: self.block.min(count - done) };
                self.passes.run(&page.film, &batches, report, progress)?;
            }
        }
        Ok(())
    }

    /// Adds the samples of batches that the device has listed, each to its pixel in its half. A film of several pages has
    /// none.
    pub fn sample_listed(
        &mut self,
        listed: &Listed,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        self.passes.run_listed(&self.pages[0].film, listed, report, progress)
    }

    /// Sums each of the batches that the device has listed into an entry of `sums` of its own.
    pub fn sample_listed_apart(
        &mut self,
        listed: &Listed,
        sums: &Buffer,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let film = film_of(Rect::whole(self.size), sums.clone());
        let left = self.passes.listed_left(&film, listed, report, progress)?;
        let batches: Vec<PixelBatch> = left.iter().map(|(_, batch)| *batch).collect();
        let taken = self.sample_apart(&batches, report, progress)?;
        for ((index, _), sum) in left.iter().zip(taken) {
            self.gpu.write_buffer(sums, 16 * u64::from(*index), bytemuck::bytes_of(&sum))?;
        }
        Ok(())
    }

    /// Returns the dispatch of the same number of samples of both halves of all pixels, if there is one.
    pub fn all_at_once(&self, first: u32, count: u32) -> Option<AtOnce> {
        let film = &self.pages[0].film;
        let batches = Batches::Equal { pixels: self.size[0] * self.size[1], first, count };
        let at_once = || self.passes.at_once(batches.slice(film.slice), &batches.costs());
        (count <= self.block).then(at_once).flatten()
    }

    /// Returns the dispatch of batches that the device has listed, if there is one.
    pub fn listed_at_once(&self, listed: &Listed) -> Option<AtOnce> {
        self.passes.at_once(listed.slice(self.pages[0].film.slice), &listed.costs())
    }

    /// Reads the sums of all batches so far.
    pub fn read(&self, sums: &mut HalfSums) -> Result<()> {
        for page in &self.pages {
            let pixels = page.rows.height as usize * sums.width as usize;
            let first = page.rows.y as usize * sums.width as usize;
            for (half, out) in sums.halves.iter_mut().enumerate() {
                let out = &mut out[first..first + pixels];
                let offset = |plane: usize| (plane * pixels * size_of::<[f32; 4]>()) as u64;
                self.gpu.read_buffer(&page.film.buffer, offset(half), bytemuck::cast_slice_mut(out))?;
                if let Some(mean) = self.mean_sign {
                    let [mut negative, mut counts] = [(); 2].map(|()| vec![[0f32; 4]; pixels]);
                    for (kind, plane) in [&mut negative, &mut counts].into_iter().enumerate() {
                        let offset = offset(2 * (1 + kind) + half);
                        self.gpu.read_buffer(&page.film.buffer, offset, bytemuck::cast_slice_mut(plane))?;
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
