//! The film on the device: sums of radiance, four floats per pixel, and as many more for compensated summation and for
//! a pixel filter with negative lobes. A picture larger than the device's buffers is rendered in bands of whole tile
//! rows that share one buffer; each band is read back as sums.

use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelExtend, ParallelIterator};

use crate::core::error::{Error, Result};
use crate::core::range::{Range, Rect};
use crate::gpu::{Buffer, BufferUse, DeviceKind, Gpu};
use crate::pack::PackedScene;
use crate::pack::features::Features;
use crate::sampling::{Block, Signed};
use crate::schema::layout::{Slice, TILE};

use super::dispatch_plan::tile_stride;

const PIXEL_BYTES: u64 = 16;
/// Larger films gain nothing: on a CPU device this is host memory, on a GPU it is read back anyway.
const MAX_BYTES_CPU: u64 = 64 << 20;
const MAX_BYTES_GPU: u64 = 1 << 30;

pub struct FilmBuffer {
    pub buffer: Buffer,
    width: u32,
    height: u32,
    band_rows: u32,
    compensated: bool,
    /// The mean of the samples' signs, if they have any: a pixel's fourth float is then the sum of the signs, and
    /// samples with negative sign have a sum of their own.
    mean_sign: Option<f64>,
}

/// A band of rows of the picture.
pub struct Band {
    pub y: u32,
    pub height: u32,
    pub tiles_x: u32,
    pub tiles: u32,
}

impl Band {
    /// Returns the push constants of a slice, except for its tiles and samples.
    pub fn slice(&self) -> Slice {
        Slice {
            tiles_x: self.tiles_x,
            tiles: self.tiles,
            tile_stride: tile_stride(self.tiles),
            band_y: self.y,
            band_height: self.height,
            ..Default::default()
        }
    }

    /// Returns for each tile of the band true if it is among the first `count` in tile order (`film_pixel` of
    /// `slice.glsl`).
    pub fn first_tiles(&self, count: u32) -> Vec<bool> {
        let stride = tile_stride(self.tiles);
        let mut first = vec![false; self.tiles as usize];
        (0..count).for_each(|k| first[(k * stride % self.tiles) as usize] = true);
        first
    }

    /// Returns the tile of a pixel of the picture.
    pub fn tile_of(&self, pixel: u32, width: u32) -> usize {
        let (x, y) = (pixel % width, pixel / width - self.y);
        (y / TILE * self.tiles_x + x / TILE) as usize
    }
}

/// The film's values for some pixels; planes that the film does not have are empty.
struct Planes<'a> {
    sum: &'a [[f32; 4]],
    lost: &'a [[f32; 4]],
    negative: &'a [[f32; 4]],
}

impl FilmBuffer {
    pub fn new(gpu: &Gpu, scene: &PackedScene, features: &Features) -> Result<FilmBuffer> {
        let [width, height] = scene.header.film_size.to_array();
        let limits = &gpu.info().limits;
        let cap = if gpu.info().kind == DeviceKind::Cpu { MAX_BYTES_CPU } else { MAX_BYTES_GPU };
        let cap = cap.min(limits.max_storage_buffer_range).min(limits.heap_bytes / 4);
        let planes = 1 + u64::from(features.compensated) + u64::from(scene.mean_sign.is_some());
        let row = u64::from(width) * PIXEL_BYTES * planes;
        let tile_rows = cap / (row * u64::from(TILE));
        if tile_rows == 0 {
            return Err(Error::with_help(
                format!(
                    "a picture {width} pixels wide: {TILE} rows of film take {} MiB, device \"{}\" allows {} MiB at once",
                    (row * u64::from(TILE)) >> 20,
                    gpu.info().name,
                    cap >> 20
                ),
                "render it in parts (crop), or smaller (size)",
            ));
        }
        let band_rows = (tile_rows * u64::from(TILE)).min(u64::from(height)) as u32;
        let buffer = gpu.buffer("film", row * u64::from(band_rows), BufferUse::Storage)?;
        let (compensated, mean_sign) = (features.compensated, scene.mean_sign);
        Ok(FilmBuffer { buffer, width, height, band_rows, compensated, mean_sign })
    }

    /// Returns the bands of some rows of the picture.
    pub fn bands(&self, rows: Rect) -> impl Iterator<Item = Band> + use<> {
        let tiles_x = self.width.div_ceil(TILE);
        rows.strips(self.band_rows).map(move |Rect { y, height, .. }| Band {
            y,
            height,
            tiles_x,
            tiles: tiles_x * height.div_ceil(TILE),
        })
    }

    /// Returns the rectangle of the whole picture.
    pub fn whole(&self) -> Rect {
        Rect::whole([self.width, self.height])
    }

    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of tiles of some rows.
    pub fn tiles(&self, rows: Rect) -> u64 {
        self.bands(rows).map(|b| u64::from(b.tiles)).sum()
    }

    /// Sets all sums of a band to 0, which is needed unless the first sample is rendered next.
    pub fn clear(&self, gpu: &Gpu, band: &Band) -> Result<()> {
        let planes = 1 + u64::from(self.compensated) + u64::from(self.mean_sign.is_some());
        let bytes = u64::from(self.width) * u64::from(band.height) * PIXEL_BYTES * planes;
        gpu.write_buffer(&self.buffer, 0, &vec![0; bytes as usize])
    }

    /// Returns an empty block of sums, signed if the film's samples are.
    pub fn block(&self, range: Range) -> Block {
        let signed = |mean_sign| Signed { mean_sign, negative: Vec::new(), weights: Vec::new() };
        Block { signed: self.mean_sign.map(signed), ..Block::new(range) }
    }

    /// Appends the sums of a band's pixels.
    pub fn read(&self, gpu: &Gpu, band: &Band, block: &mut Block) -> Result<()> {
        self.read_rows(gpu, band, |_, planes| {
            let of = |floats: &[f32; 4]| floats.map(f64::from);
            let color = |floats: &[f32; 4]| [0, 1, 2].map(|c| f64::from(floats[c]));
            if planes.lost.is_empty() {
                block.sums.par_extend(planes.sum.par_iter().map(color));
            } else {
                let both = planes.sum.par_iter().zip(planes.lost);
                block.sums.par_extend(both.map(|(sum, lost)| {
                    let (sum, lost) = (of(sum), of(lost));
                    [0, 1, 2].map(|c| sum[c] - lost[c])
                }));
            }
            match &mut block.signed {
                Some(signed) => {
                    signed.negative.par_extend(planes.negative.par_iter().map(color));
                    signed.weights.par_extend(planes.sum.par_iter().map(|sum| f64::from(sum[3])));
                }
                // Cones store here the weight that they drop.
                None => planes.sum.iter().for_each(|sum| block.dropped += f64::from(sum[3])),
            }
        })
    }

    /// Passes the sums of each pixel of a band to `each`, with its index in the picture.
    pub fn read_with(&self, gpu: &Gpu, band: &Band, mut each: impl FnMut(usize, [f32; 4])) -> Result<()> {
        self.read_rows(gpu, band, |first, planes| {
            planes.sum.iter().zip(first..).for_each(|(sum, pixel)| each(pixel, *sum));
        })
    }

    /// Passes a few rows of a band at a time to `each`, with the index of their first pixel in the picture.
    fn read_rows(&self, gpu: &Gpu, band: &Band, mut each: impl FnMut(usize, Planes<'_>)) -> Result<()> {
        let row_bytes = u64::from(self.width) * PIXEL_BYTES;
        let rows_at_once = ((4 << 20) / row_bytes).clamp(1, u64::from(band.height)) as u32;
        let plane = || vec![[0f32; 4]; (self.width * rows_at_once) as usize];
        let mut sums = plane();
        let mut lost = if self.compensated { plane() } else { Vec::new() };
        let mut negative = if self.mean_sign.is_some() { plane() } else { Vec::new() };
        for y in (0..band.height).step_by(rows_at_once as usize) {
            let count = (rows_at_once.min(band.height - y) * self.width) as usize;
            let planes = [&mut sums, &mut lost, &mut negative].into_iter().filter(|p| !p.is_empty());
            for (plane, floats) in (0..).zip(planes) {
                let first = u64::from(plane * band.height + y) * row_bytes;
                gpu.read_buffer(&self.buffer, first, bytemuck::cast_slice_mut(&mut floats[..count]))?;
            }
            let first = (band.y + y) as usize * self.width as usize;
            let of = |floats: &'_ [[f32; 4]]| floats.len().min(count);
            each(
                first,
                Planes {
                    sum: &sums[..count],
                    lost: &lost[..of(&lost)],
                    negative: &negative[..of(&negative)],
                },
            );
        }
        Ok(())
    }
}
