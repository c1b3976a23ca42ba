//! The film on the device: sums of radiance, four floats a pixel, twice that with compensation. A
//! picture larger than the device's buffers is rendered in bands of whole tile rows, one buffer
//! serving all; each band is read back into the host's film as means.

use crate::error::{Error, Result};
use crate::features::Features;
use crate::film::Film;
use crate::gpu::{Buffer, BufferUse, DeviceKind, Gpu};
use crate::layout::{Slice, TILE};
use crate::pack::{PackedScene, divisor};

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
    /// Mean of the samples' signs, where they have any: a pixel's fourth float is their sum.
    mean_sign: Option<f64>,
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
        let row = u64::from(width) * PIXEL_BYTES * if features.compensated { 2 } else { 1 };
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
        self.read_with(gpu, band, |i, sum, lost| {
            fourth += f64::from(sum[3]);
            let by = self.mean_sign.map_or(samples, |mean| divisor(f64::from(sum[3]), samples, mean));
            film.pixels[i] = std::array::from_fn(|c| ((f64::from(sum[c]) - f64::from(lost[c])) / by) as f32);
        })?;
        Ok(fourth)
    }

    /// Each pixel of a band by its place in the picture, with what rounding has lost of it; a few rows at a
    /// time.
    pub fn read_with(
        &self,
        gpu: &Gpu,
        band: &Band,
        mut each: impl FnMut(usize, [f32; 4], [f32; 4]),
    ) -> Result<()> {
        let row_bytes = u64::from(self.width) * PIXEL_BYTES;
        let rows_at_once = ((4 << 20) / row_bytes).clamp(1, u64::from(band.height)) as u32;
        let mut sums = vec![[0f32; 4]; (self.width * rows_at_once) as usize];
        let mut lost = if self.compensated { sums.clone() } else { Vec::new() };
        for y in (0..band.height).step_by(rows_at_once as usize) {
            let count = (rows_at_once.min(band.height - y) * self.width) as usize;
            gpu.read_buffer(
                &self.buffer,
                u64::from(y) * row_bytes,
                bytemuck::cast_slice_mut(&mut sums[..count]),
            )?;
            if self.compensated {
                let second = u64::from(band.height + y) * row_bytes;
                gpu.read_buffer(&self.buffer, second, bytemuck::cast_slice_mut(&mut lost[..count]))?;
            }
            let first = (band.y + y) as usize * self.width as usize;
            for (i, &sum) in sums[..count].iter().enumerate() {
                each(first + i, sum, lost.get(i).copied().unwrap_or_default());
            }
        }
        Ok(())
    }
}
