//! Takes the samples of the pixels that the first pass of a renderer leaves unfinished, pass by pass. Input: a band of the
//! film and a range of samples. Output: their sums in the film. Each pass takes a list of pixels and no others: where lanes
//! of finished pixels wait for the others, these would cost as much. What the last pass leaves, as its loops were ended, it
//! takes again with half as many samples at once; and where one is too much, as threads of a subgroup share the limit, by
//! workgroups of one pixel.

use std::iter::{once, repeat_n};
use std::sync::Arc;

use super::film_buffer::{Band, FilmBuffer};
use super::unfinished_list::{UnfinishedList, too_long};
use super::{Report, Resources};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::shaders::Shader;
use crate::gpu::{BindGroup, Buffer, BufferUse, Gpu, Pipeline};
use crate::schema::layout::{PixelBatch, Slice, TILE};

/// Pixels that one submission takes: as many as a tile has.
const AT_ONCE: usize = (TILE * TILE) as usize;

/// A place outside of any film.
pub const NOWHERE: u32 = u32::MAX;

/// Side of the squares whose pixels follow each other in a list.
const BLOCK: u32 = 8;

/// The passes after the first one, each by a list of the pixels that are left.
pub struct UnfinishedPixels {
    later: Vec<Arc<Pipeline>>,
    /// The last pass, which may be the first one.
    last: Arc<Pipeline>,
    /// The list of pixels, with room for `AT_ONCE`.
    list: Buffer,
    group: BindGroup,
    threads_per_group: u32,
    film: Arc<FilmBuffer>,
    /// Corner of the film in the picture.
    corner: [u32; 2],
}

/// Some samples of pixels of a band.
struct Run<'r> {
    gpu: &'r Gpu,
    unfinished: &'r UnfinishedList,
    band: &'r Band,
    report: &'r mut Report,
    progress: &'r dyn Progress,
}

impl UnfinishedPixels {
    /// `pipelines`, of one shader, are all passes, in order.
    pub fn new(
        gpu: &Gpu,
        resources: &Resources,
        shader: &Shader,
        pipelines: &[Arc<Pipeline>],
        threads_per_group: u32,
        film: &Arc<FilmBuffer>,
        corner: [u32; 2],
    ) -> Result<UnfinishedPixels> {
        let last = pipelines.last().ok_or_else(|| Error::new("a renderer without a pass"))?.clone();
        let bytes = (AT_ONCE * size_of::<PixelBatch>()) as u64;
        let list = gpu.buffer("unfinished pixels", bytes, BufferUse::Storage)?;
        let group = resources.bind(gpu, &last, shader, &film.buffer, Some(&list))?;
        let later = pipelines[1..].to_vec();
        Ok(UnfinishedPixels { later, last, list, group, threads_per_group, film: film.clone(), corner })
    }

    /// Runs each later pipeline on a list without pixels, so that lazy compilation in the driver happens now.
    pub fn warm_up(&self, gpu: &Gpu, band: &Band) -> Result<()> {
        let slice = Slice { tiles: 0, listed: 1, sample_count: 1, ..band.slice() };
        for pipeline in &self.later {
            gpu.run(pipeline, &self.group, bytemuck::bytes_of(&slice), [1, 1, 1])?;
        }
        Ok(())
    }

    /// Adds `count` samples from `first` on to the pixels that the first pass has left.
    pub fn finish(
        &self,
        gpu: &Gpu,
        unfinished: &UnfinishedList,
        band: &Band,
        [first, count]: [u32; 2],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        let mut run = Run { gpu, unfinished, band, report, progress };
        let width = self.film.width();
        let mut pixels = unfinished.take(gpu)?;
        pixels.iter_mut().for_each(|pixel| *pixel = PixelBatch::place_of(*pixel, width));
        // Neighbours together: their rays go through the same nodes.
        pixels.sort_by_key(|&place| (((place >> 16) / BLOCK) << 16) | ((place & 0xFFFF) / BLOCK));
        for pipeline in &self.later {
            pixels = self.sample(&mut run, pipeline, &pixels, [first, count])?;
        }
        self.sample_in_parts(&mut run, &pixels, [first, count])
    }

    /// Takes the samples in two parts, one after the other, and each of these likewise if it must be.
    fn sample_in_parts(&self, run: &mut Run, pixels: &[u32], [first, count]: [u32; 2]) -> Result<()> {
        if pixels.is_empty() {
            return Ok(());
        }
        let half = count / 2;
        if half == 0 {
            let apart = self.apart(pixels);
            let left = self.sample(run, &self.last, &apart, [first, count])?;
            return match left.first() {
                Some(place) => {
                    let [x, y] = self.corner;
                    Err(too_long(run.gpu, [x + (place & 0xFFFF), y + (place >> 16) + run.band.y]))
                }
                None => Ok(()),
            };
        }
        for part in [[first, half], [first + half, count - half]] {
            let left = self.sample(run, &self.last, pixels, part)?;
            self.sample_in_parts(run, &left, part)?;
        }
        Ok(())
    }

    /// Returns the pixels, each followed by as many places outside of the film as fill its workgroup.
    fn apart(&self, pixels: &[u32]) -> Vec<u32> {
        let rest = self.threads_per_group as usize - 1;
        pixels.iter().flat_map(|&place| once(place).chain(repeat_n(NOWHERE, rest))).collect()
    }

    /// Takes samples of pixels by their places; returns those that are left unfinished.
    fn sample(
        &self,
        run: &mut Run,
        pipeline: &Pipeline,
        pixels: &[u32],
        [first, count]: [u32; 2],
    ) -> Result<Vec<u32>> {
        let mut left = Vec::new();
        for pixels in pixels.chunks(AT_ONCE) {
            let batch = |&place: &u32| PixelBatch { place, part: 0, first, count };
            let batches: Vec<PixelBatch> = pixels.iter().map(batch).collect();
            run.gpu.write_buffer(&self.list, 0, bytemuck::cast_slice(&batches))?;
            let entries = pixels.len() as u32;
            let slice = Slice {
                tiles: entries,
                listed: 1,
                first_sample: first,
                sample_count: count,
                ..run.band.slice()
            };
            let groups = [entries.div_ceil(self.threads_per_group), 1, 1];
            let time = run.gpu.run(pipeline, &self.group, bytemuck::bytes_of(&slice), groups)?;
            run.report.add_slice(time);
            if run.progress.cancelled() {
                return Err(Error::Interrupted);
            }
            left.extend(run.unfinished.take(run.gpu)?.into_iter().map(|at| pixels[at as usize]));
        }
        Ok(left)
    }
}
