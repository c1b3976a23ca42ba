//! The film on the device: sums of radiance, four floats a pixel, as many more with compensation and with a pixel
//! filter that has negative lobes. A picture larger than the device's buffers is rendered in bands of whole tile rows, one buffer
//! serving all; each band is read back as sums.

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
                "render it in parts with --crop, or smaller with --size",
            ));
        }
        let band_rows = (tile_rows * u64::from(TILE)).min(u64::from(height)) as u32;
        let buffer = gpu.buffer("film", row * u64::from(band_rows), BufferUse::Storage)?;
        let (compensated, mean_sign) = (features.compensated, scene.mean_sign);
        Ok(FilmBuffer { buffer, width, height, band_rows, compensated, mean_sign })
    }

    /// The bands of some rows of the picture.
    pub fn bands(&self, rows: Rect) -> impl Iterator<Item = Band> + use<> {
        let tiles_x = self.width.div_ceil(TILE);
        rows.strips(self.band_rows).map(move |Rect { y, height, .. }| Band {
            y,
            height,
            tiles_x,
            tiles: tiles_x * height.div_ceil(TILE),
        })
    }

    /// The whole picture.
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

    /// Sets all sums of a band to 0. Sums that begin with a first sample need not be.
    pub fn clear(&self, gpu: &Gpu, band: &Band) -> Result<()> {
        let planes = 1 + u64::from(self.compensated) + u64::from(self.mean_sign.is_some());
        let bytes = u64::from(self.width) * u64::from(band.height) * PIXEL_BYTES * planes;
        gpu.write_buffer(&self.buffer, 0, &vec![0; bytes as usize])
    }

    /// No sums yet, of samples as this film has them.
    pub fn block(&self, range: Range) -> Block {
        let signed = |mean_sign| Signed { mean_sign, negative: Vec::new(), weights: Vec::new() };
        Block { signed: self.mean_sign.map(signed), ..Block::new(range) }
    }

    /// Appends the sums of a band's pixels.
    pub fn read(&self, gpu: &Gpu, band: &Band, block: &mut Block) -> Result<()> {
        self.read_with(gpu, band, |_, sums| {
            let of = |floats: [f32; 4]| floats.map(f64::from);
            let (sum, lost, negative) = (of(sums.sum), of(sums.lost), of(sums.negative));
            block.sums.push([0, 1, 2].map(|c| sum[c] - lost[c]));
            match &mut block.signed {
                Some(signed) => {
                    signed.negative.push([negative[0], negative[1], negative[2]]);
                    signed.weights.push(sum[3]);
                }
                // Cones keep here what they drop.
                None => block.dropped += sum[3],
            }
        })
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
