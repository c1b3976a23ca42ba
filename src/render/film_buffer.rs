//! The film on the device: sums of radiance, four floats a pixel, as many more with compensation and with a pixel
//! filter that has negative lobes. A picture larger than the device's buffers is rendered in bands of whole tile rows, one buffer
//! serving all; each band is read back into the host's film as means.

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::gpu::{Buffer, BufferUse, DeviceKind, Gpu};
use crate::pack::features::Features;
use crate::pack::{PackedScene, filtered_mean};
use crate::schema::layout::{Slice, TILE};

use super::slices::tile_stride;

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
    /// Mean of the samples' signs, where they have any: a pixel's fourth float is their sum, and samples whose sign
    /// is negative have a sum of their own.
    mean_sign: Option<f64>,
}

/// What the film holds of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSums {
    pub sum: [f32; 4],
    /// What rounding has added to the sum.
    lost: [f32; 4],
    /// Of samples whose sign is negative.
    negative: [f32; 4],
}

/// Some rows of the picture.
pub struct Band {
    pub y: u32,
    pub height: u32,
    pub tiles_x: u32,
    pub tiles: u32,
}

impl Band {
    /// The push constants of a slice, but for which tiles and samples.
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

    /// Of each tile by its place in the band, whether it is one of the first `count` in line (`film_pixel` of
    /// `slice.glsl`).
    pub fn first_tiles(&self, count: u32) -> Vec<bool> {
        let stride = tile_stride(self.tiles);
        let mut first = vec![false; self.tiles as usize];
        (0..count).for_each(|k| first[(k * stride % self.tiles) as usize] = true);
        first
    }

    /// The tile of a pixel of the picture.
    pub fn tile_of(&self, pixel: u32, width: u32) -> usize {
        let (x, y) = (pixel % width, pixel / width - self.y);
        (y / TILE * self.tiles_x + x / TILE) as usize
    }
}

impl FilmBuffer {
    pub fn new(gpu: &Gpu, scene: &PackedScene, features: &Features) -> Result<FilmBuffer> {
        let [width, height, _, _] = scene.header.size;
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
                "render it in parts with --crop, or smaller with --size",
            ));
        }
        let band_rows = (tile_rows * u64::from(TILE)).min(u64::from(height)) as u32;
        let buffer = gpu.buffer("film", row * u64::from(band_rows), BufferUse::Storage)?;
        let (compensated, mean_sign) = (features.compensated, scene.mean_sign);
        Ok(FilmBuffer { buffer, width, height, band_rows, compensated, mean_sign })
    }

    pub fn bands(&self) -> impl Iterator<Item = Band> + use<> {
        let (width, height, rows) = (self.width, self.height, self.band_rows);
        (0..height).step_by(rows as usize).map(move |y| {
            let height = rows.min(height - y);
            let tiles_x = width.div_ceil(TILE);
            Band { y, height, tiles_x, tiles: tiles_x * height.div_ceil(TILE) }
        })
    }

    pub fn width(&self) -> u32 {
        self.width
    }

    /// Tiles of the whole picture.
    pub fn tiles(&self) -> u64 {
        self.bands().map(|b| u64::from(b.tiles)).sum()
    }

    /// Sums of a band → means of its rows. The sum of the fourth floats is the answer: what cones dropped.
    pub fn read(&self, gpu: &Gpu, band: &Band, film: &mut Film) -> Result<f64> {
        let samples = f64::from(film.samples);
        let mut fourth = 0.0;
        self.read_with(gpu, band, |i, sums| {
            let of = |floats: [f32; 4]| floats.map(f64::from);
            let (sum, lost, negative) = (of(sums.sum), of(sums.lost), of(sums.negative));
            fourth += sum[3];
            let mean = |c: usize| match self.mean_sign {
                None => (sum[c] - lost[c]) / samples,
                Some(mean) => filtered_mean(sum[c] - lost[c], negative[c], sum[3], samples, mean),
            };
            film.pixels[i] = [0, 1, 2].map(|c| mean(c) as f32);
        })?;
        Ok(fourth)
    }

    /// Each pixel of a band by its place in the picture; a few rows at a time.
    pub fn read_with(&self, gpu: &Gpu, band: &Band, mut each: impl FnMut(usize, &PixelSums)) -> Result<()> {
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
            let of = |floats: &[[f32; 4]], i: usize| floats.get(i).copied().unwrap_or_default();
            for i in 0..count {
                let [sum, lost, negative] = [&sums, &lost, &negative].map(|floats| of(floats, i));
                each(first + i, &PixelSums { sum, lost, negative });
            }
        }
        Ok(())
    }
}
