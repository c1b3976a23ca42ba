//! Sums batches of samples into two halves on the device, for sampling rates that differ from pixel to pixel. The film
//! is divided into pages of whole rows that fit the device's buffers; each page has its own list of batches.

use super::batch_passes::{BatchFilm, BatchPasses, Batches, halves};
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
const PIXEL_BYTES: u64 = 32;
const MAX_PAGE_BYTES: u64 = 64 << 20;
/// Samples that one invocation takes of a batch that does not go to the film.
const PART_SAMPLES: u32 = 64;
/// Number of such batches whose sums one buffer holds.
const MAX_PARTS: usize = 1 << 20;

struct Page {
    rows: Rect,
    film: BatchFilm,
}

/// Takes batches of samples and holds their sums.
pub struct BatchSampler<'a> {
    gpu: &'a Gpu,
    passes: BatchPasses<'a>,
    pages: Vec<Page>,
    size: [u32; 2],
    /// The mean of the samples' signs, if they have any: the film then also holds sums of negative samples, and counts.
    mean_sign: Option<f64>,
    /// Most samples that an invocation takes at once.
    block: u32,
}

/// A part of a batch that does not go to the film: the batch's index, and samples for one invocation.
type Part = (usize, PixelBatch);

/// Sums of each entry: of radiance, and if samples have signs also of negative samples, and the counts.
type Planes = Vec<Vec<[f32; 4]>>;

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
            let buffer = gpu.buffer("film", row * u64::from(rows.height), BufferUse::Storage)?;
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

    /// Takes parts by one pass. Returns their sums, and which ones are left.
    fn parts_apart(
        &mut self,
        pass: usize,
        parts: &[Part],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<(Planes, Vec<u32>)> {
        let list: Vec<PixelBatch> = parts.iter().map(|(_, batch)| *batch).collect();
        let planes = if self.mean_sign.is_some() { 3 } else { 1 };
        let plane = (list.len() * size_of::<[f32; 4]>()) as u64;
        let buffer = self.gpu.buffer("audit", planes * plane, BufferUse::Storage)?;
        // Positions are those of the whole picture.
        let film = film_of(Rect::whole(self.size), buffer);
        let left = self.passes.indices_left(pass, &film, &Batches::List(&list), report, progress)?;
        let read = |kind: u64| {
            let mut sums = vec![[0f32; 4]; list.len()];
            self.gpu.read_buffer(&film.buffer, kind * plane, bytemuck::cast_slice_mut(&mut sums))?;
            Ok(sums)
        };
        Ok(((0..planes).map(read).collect::<Result<_>>()?, left))
    }

    /// Adds parts of one sample to the sums of their batches, each part in a workgroup of its own.
    fn parts_alone(
        &mut self,
        parts: &[Part],
        sums: &mut [[[f64; 4]; 3]],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        for part in parts {
            let apart = self.passes.apart(&[part.1]);
            let list: Vec<Part> = apart.into_iter().map(|batch| (part.0, batch)).collect();
            let (planes, left) = self.parts_apart(self.passes.last(), &list, report, progress)?;
            if !left.is_empty() {
                let film = film_of(Rect::whole(self.size), self.pages[0].film.buffer.clone());
                return Err(self.passes.too_long(&film, &part.1));
            }
            add(&mut sums[part.0], &planes, 0);
        }
        Ok(())
    }
}

/// Adds one entry of the planes.
fn add(sums: &mut [[f64; 4]; 3], planes: &Planes, entry: usize) {
    for (sum, plane) in sums.iter_mut().zip(planes) {
        (0..4).for_each(|c| sum[c] += f64::from(plane[entry][c]));
    }
}

/// Returns a film of some rows.
fn film_of(rows: Rect, buffer: Buffer) -> BatchFilm {
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
fn weighed([sums, negative, [signs, samples, _, _]]: [[f64; 4]; 3], mean_sign: f64) -> [f32; 4] {
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
        let mut parts: Vec<Part> = Vec::new();
        for (i, batch) in batches.iter().enumerate() {
            let firsts = (0..batch.count).step_by(most as usize);
            parts.extend(firsts.map(|first| {
                (i, PixelBatch { first: batch.first + first, count: most.min(batch.count - first), ..*batch })
            }));
        }
        let mut sums = vec![[[0f64; 4]; 3]; batches.len()];
        let mut pass = 0;
        while !parts.is_empty() {
            let mut left: Vec<Part> = Vec::new();
            for parts in parts.chunks(MAX_PARTS) {
                let (planes, unfinished) = self.parts_apart(pass, parts, report, progress)?;
                let mut is_left = vec![false; parts.len()];
                unfinished.iter().for_each(|&at| is_left[at as usize] = true);
                for (at, &(i, batch)) in parts.iter().enumerate() {
                    if !is_left[at] {
                        add(&mut sums[i], &planes, at);
                    } else {
                        left.push((i, batch));
                    }
                }
            }
            if pass == self.passes.last() && !left.is_empty() {
                left = match halves(left.iter().map(|(_, batch)| batch)) {
                    Some(pairs) => {
                        let of =
                            left.iter().zip(pairs).flat_map(|(&(i, _), pair)| pair.map(|half| (i, half)));
                        of.filter(|(_, half)| half.count > 0).collect()
                    }
                    None => {
                        self.parts_alone(&left, &mut sums, report, progress)?;
                        Vec::new()
                    }
                };
            }
            parts = left;
            pass = self.passes.last().min(pass + 1);
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
