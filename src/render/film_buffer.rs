//! The film on the device: sums of radiance, four floats per pixel, and as many more for compensated summation and for
//! a pixel filter with negative lobes. A picture larger than the device's buffers is rendered in bands of whole tile
//! rows that share one buffer; each band is read back as sums, or as means right into a film of the host.

use rayon::prelude::*;

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::range::{Range, Rect};
use crate::gpu::{Buffer, BufferUse, DeviceKind, Gpu};
use crate::pack::PackedScene;
use crate::pack::features::Features;
use crate::sampling::{Block, PixelSums, Signed};
use crate::scene::model::Algorithm;
use crate::schema::layout::{Slice, TILE};

use super::dispatch_plan::tile_stride;

const PIXEL_BYTES: u64 = 16;
/// Pixels that a thread reads at once.
const PIXELS_AT_ONCE: usize = 4096;
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
    /// True if a pixel's fourth float is the weight that cones dropped.
    holds_dropped: bool,
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

impl Planes<'_> {
    /// Returns the sums of a pixel of `samples` samples.
    #[inline(always)]
    fn pixel(&self, i: usize, samples: u32) -> PixelSums {
        let [x, y, z, weight] = self.sum[i].map(f64::from);
        let mut pixel = PixelSums { sum: [x, y, z], negative: [0.0; 3], weight, samples: f64::from(samples) };
        if let Some(lost) = self.lost.get(i) {
            (0..3).for_each(|c| pixel.sum[c] -= f64::from(lost[c]));
        }
        if let Some(negative) = self.negative.get(i) {
            (0..3).for_each(|c| pixel.negative[c] = f64::from(negative[c]));
        }
        pixel
    }
}

impl FilmBuffer {
    pub fn new(gpu: &Gpu, scene: &PackedScene, features: &Features) -> Result<FilmBuffer> {
        let [width, height] = scene.header.film_size.to_array();
        let limits = &gpu.info().limits;
        let cap = if gpu.info().kind == DeviceKind::Cpu { MAX_BYTES_CPU } else { MAX_BYTES_GPU };
        let cap = cap.min(limits.max_storage_buffer_range).min(limits.heap_bytes / 4);
        let (compensated, mean_sign) = (features.compensated, scene.mean_sign);
        let planes = 1 + u64::from(compensated) + u64::from(mean_sign.is_some());
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
        let holds_dropped = scene.algorithm == Algorithm::Cone;
        Ok(FilmBuffer { buffer, width, height, band_rows, compensated, mean_sign, holds_dropped })
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
        let bytes = u64::from(self.width) * u64::from(band.height) * PIXEL_BYTES * self.plane_count();
        gpu.write_buffer(&self.buffer, 0, &vec![0; bytes as usize])
    }

    /// Returns an empty block of sums, signed if the film's samples are.
    pub fn block(&self, range: Range) -> Block {
        let signed = |mean_sign| Signed { mean_sign, negative: Vec::new(), weights: Vec::new() };
        Block { signed: self.mean_sign.map(signed), ..Block::new(range) }
    }

    /// Appends the sums of a band's pixels.
    pub fn read(&self, gpu: &Gpu, band: &Band, block: &mut Block) -> Result<()> {
        let samples = block.range.depth();
        self.read_planes(gpu, band, |_, planes| {
            let pixels = || (0..planes.sum.len()).into_par_iter().map(|i| planes.pixel(i, samples));
            block.sums.par_extend(pixels().map(|pixel| pixel.sum));
            if let Some(signed) = &mut block.signed {
                signed.negative.par_extend(pixels().map(|pixel| pixel.negative));
                signed.weights.par_extend(pixels().map(|pixel| pixel.weight));
            }
            self.add_dropped(&planes, &mut block.dropped);
        })
    }

    /// Writes the means of a band's pixels into a film of the whole picture. Adds the weight that cones dropped.
    pub fn read_means(
        &self,
        gpu: &Gpu,
        band: &Band,
        samples: u32,
        film: &mut Film,
        dropped: &mut f64,
    ) -> Result<()> {
        self.read_planes(gpu, band, |first, planes| {
            let pixels = &mut film.pixels[first..][..planes.sum.len()];
            pixels.par_chunks_mut(PIXELS_AT_ONCE).enumerate().for_each(|(chunk, pixels)| {
                for (pixel, i) in pixels.iter_mut().zip(chunk * PIXELS_AT_ONCE..) {
                    *pixel = planes.pixel(i, samples).mean(self.mean_sign);
                }
            });
            self.add_dropped(&planes, dropped);
        })
    }

    fn add_dropped(&self, planes: &Planes<'_>, dropped: &mut f64) {
        if self.holds_dropped {
            planes.sum.iter().for_each(|sum| *dropped += f64::from(sum[3]));
        }
    }

    /// Passes the sums of each pixel of a band to `each`, with its index in the picture.
    pub fn read_with(&self, gpu: &Gpu, band: &Band, mut each: impl FnMut(usize, [f32; 4])) -> Result<()> {
        self.read_planes(gpu, band, |first, planes| {
            planes.sum.iter().zip(first..).for_each(|(sum, pixel)| each(pixel, *sum));
        })
    }

    /// Passes some pixels of a band at a time to `each`, with the index of the first one in the picture.
    fn read_planes(&self, gpu: &Gpu, band: &Band, mut each: impl FnMut(usize, Planes<'_>)) -> Result<()> {
        let mut first = band.y as usize * self.width as usize;
        let bytes = band.height as usize * self.width as usize * PIXEL_BYTES as usize;
        let starts: Vec<u64> = (0..self.plane_count()).map(|plane| plane * bytes as u64).collect();
        gpu.read_parts(&self.buffer, &starts, [bytes, PIXEL_BYTES as usize], &mut |parts| {
            let mut parts = parts.iter().map(|bytes| bytemuck::cast_slice(bytes));
            let mut plane = |exists: bool| if exists { parts.next().unwrap_or_default() } else { &[] };
            let [sum, lost, negative] = [true, self.compensated, self.mean_sign.is_some()].map(&mut plane);
            each(first, Planes { sum, lost, negative });
            first += sum.len();
        })
    }

    fn plane_count(&self) -> u64 {
        1 + u64::from(self.compensated) + u64::from(self.mean_sign.is_some())
    }
}
