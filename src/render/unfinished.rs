//! Takes the samples of the pixels that the first pass of a renderer leaves unfinished, pass by pass. Input: a band of the
//! film, where such pixels are marked, and a range of samples. Output: their sums in the film. Each pass takes a list of
//! pixels and no others: where lanes of finished pixels wait for the others, these would cost as much.

use std::sync::Arc;

use super::film_buffer::{Band, FilmBuffer};
use super::{Report, Resources};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::shaders::Shader;
use crate::gpu::{BindGroup, Buffer, BufferUse, Gpu, Pipeline};
use crate::schema::constants::UNFINISHED;
use crate::schema::layout::{PixelBatch, Slice, TILE};

/// Pixels that one submission takes: as many as a tile has.
const AT_ONCE: usize = (TILE * TILE) as usize;

/// Side of the squares whose pixels follow each other in a list.
const BLOCK: u32 = 8;

/// The passes after the first one, each by a list of the pixels that are left.
pub struct UnfinishedPixels {
    pipelines: Vec<Arc<Pipeline>>,
    /// The list of pixels, with room for `AT_ONCE`.
    list: Buffer,
    group: BindGroup,
    threads_per_group: u32,
    film: Arc<FilmBuffer>,
}

impl UnfinishedPixels {
    /// `pipelines`, of one shader, are the passes after the first one, in order.
    pub fn new(
        gpu: &Gpu,
        resources: &Resources,
        shader: &Shader,
        pipelines: Vec<Arc<Pipeline>>,
        threads_per_group: u32,
        film: &Arc<FilmBuffer>,
    ) -> Result<UnfinishedPixels> {
        let bytes = (AT_ONCE * size_of::<PixelBatch>()) as u64;
        let list = gpu.buffer("unfinished pixels", bytes, BufferUse::Storage)?;
        let group = resources.bind(gpu, &pipelines[0], shader, &film.buffer, Some(&list))?;
        Ok(UnfinishedPixels { pipelines, list, group, threads_per_group, film: film.clone() })
    }

    /// Runs each pipeline on a list without pixels, so that lazy compilation in the driver happens now.
    pub fn warm_up(&self, gpu: &Gpu, band: &Band) -> Result<()> {
        let slice = Slice { tiles: 0, sample_count: 1, ..band.slice() };
        for pipeline in &self.pipelines {
            gpu.run(pipeline, &self.group, bytemuck::bytes_of(&slice), [1, 1, 1])?;
        }
        Ok(())
    }

    /// Adds `count` samples from `first` on.
    pub fn finish(
        &self,
        gpu: &Gpu,
        band: &Band,
        [first, count]: [u32; 2],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        for pipeline in &self.pipelines {
            for pixels in self.marked(gpu, band)?.chunks(AT_ONCE) {
                let batch = |&place: &u32| PixelBatch { place, part: 0, first, count };
                let batches: Vec<PixelBatch> = pixels.iter().map(batch).collect();
                gpu.write_buffer(&self.list, 0, bytemuck::cast_slice(&batches))?;
                let entries = pixels.len() as u32;
                let slice =
                    Slice { tiles: entries, first_sample: first, sample_count: count, ..band.slice() };
                let groups = [entries.div_ceil(self.threads_per_group), 1, 1];
                let time = gpu.run(pipeline, &self.group, bytemuck::bytes_of(&slice), groups)?;
                report.add_slice(time);
                if progress.cancelled() {
                    return Err(Error::Interrupted);
                }
            }
        }
        Ok(())
    }

    /// Returns the places of the pixels that are marked, neighbours together: their rays go through the same nodes.
    fn marked(&self, gpu: &Gpu, band: &Band) -> Result<Vec<u32>> {
        let width = self.film.width();
        let first = (band.y * width) as usize;
        let mut places = Vec::new();
        self.film.read_with(gpu, band, |pixel, sums| {
            if sums[3] == UNFINISHED as f32 {
                places.push(PixelBatch::place_of((pixel - first) as u32, width));
            }
        })?;
        places.sort_by_key(|&place| (((place >> 16) / BLOCK) << 16) | ((place & 0xFFFF) / BLOCK));
        Ok(places)
    }
}
