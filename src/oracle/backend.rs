//! The oracle as a backend: sums ranges and batches of samples in f64 on all cores. Twin of the tiles and lists of
//! batches of `glsl/shared/render_main.glsl`.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::beam::beam;
use super::cone_shade;
use super::pixel_filter::filter_width;
use super::render::{PixelSums, pixel, sums};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::{Range, Rect};
use crate::pack::{PackedScene, filtered_mean};
use crate::sampling::{Backend, Block, FilmSums, HalfSums, PilotRun, Signed};
use crate::scene::model::Algorithm;
use crate::schema::layout::{BATCH_BARE, PixelBatch};

pub struct OracleBackend<'a> {
    scene: &'a PackedScene,
    /// For each half and pixel the sums of its batches, and their number of samples; empty before the first batch.
    halves: [Vec<(PixelSums, f64)>; 2],
}

impl OracleBackend<'_> {
    /// Opens a scene; fails if the levels of a texture were left to a device.
    pub fn new(scene: &PackedScene) -> Result<OracleBackend<'_>> {
        if let Some(&texture) = scene.device_levels.first() {
            return Err(Error::new(format!(
                "the levels of texture \"{}\" are left to a device: the oracle reads what the host made",
                scene.texture_names[texture]
            )));
        }
        Ok(OracleBackend { scene, halves: [Vec::new(), Vec::new()] })
    }

    /// Evaluates the pixels of a rectangle, row by row; rows are distributed over the cores, which does not affect the
    /// result.
    fn pixels<T: Send>(
        &self,
        pixels: Rect,
        progress: &dyn Progress,
        pixel: impl Fn(u32, u32) -> T + Sync,
    ) -> Result<Vec<T>> {
        let done = AtomicUsize::new(0);
        let row = |y: u32| {
            // A row can take minutes if a pixel has very many samples.
            let row = pixels.columns().map_while(|x| (!progress.cancelled()).then(|| pixel(x, y)));
            let row: Vec<T> = row.collect();
            let rows = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.advance(rows as f64 / f64::from(pixels.height));
            row
        };
        let rows: Vec<Vec<T>> = pixels.rows().into_par_iter().map(row).collect();
        if progress.cancelled() { Err(Error::Interrupted) } else { Ok(rows.into_iter().flatten().collect()) }
    }

    fn of_batches(&self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<PixelSums>> {
        let of_batch = |batch: &PixelBatch| {
            let mut header = self.scene.header;
            let samples = 2.0 * f64::from(batch.first + batch.count);
            let share = filter_width(&header) / samples.sqrt();
            header.sample_side = if batch.part & BATCH_BARE != 0 { 0.0 } else { share };
            let range = batch.first..batch.first + batch.count;
            sums(self.scene, &header, batch.column_and_row(), batch.stream(), range)
        };
        let of = |batch| if progress.cancelled() { PixelSums::default() } else { of_batch(batch) };
        let sums = batches.par_iter().map(of).collect();
        if progress.cancelled() { Err(Error::Interrupted) } else { Ok(sums) }
    }

    /// Returns red, green, blue, weighted by the samples' signs, and the mean of their squares.
    fn radiance(&self, sums: &PixelSums, samples: f64) -> [f32; 4] {
        let PixelSums { sum, squares, negative, signs } = *sums;
        let channel = |c: usize| match self.scene.mean_sign.filter(|_| samples > 0.0) {
            Some(mean) => samples * filtered_mean(sum[c], negative[c], signs, samples, mean),
            None => sum[c],
        };
        [channel(0), channel(1), channel(2), squares].map(|v| v as f32)
    }
}

/// Renders the whole film with the number of samples for which the scene was packed, or by beams if it was packed for
/// those.
pub fn render(scene: &PackedScene, progress: &dyn Progress) -> Result<Film> {
    let [width, height] = scene.header.film_size.to_array();
    let whole = Rect::whole([width, height]);
    let mut backend = OracleBackend::new(scene)?;
    let range = Range { pixels: whole, samples: 0..scene.samples };
    if !scene.beams {
        return backend.sum(&range, progress)?.to_film([width, height], scene.samples);
    }
    let mut film = Film::new(width, height, scene.samples);
    let places = whole.rows().flat_map(|y| whole.columns().map(move |x| (x, y)));
    let resolved = backend.resolve(whole, progress)?;
    for ((out, [r, g, b, sampled]), (x, y)) in film.pixels.iter_mut().zip(resolved).zip(places) {
        *out = if sampled == 0.0 { [r, g, b] } else { pixel(scene, x, y).as_vec3().to_array() };
    }
    Ok(film)
}

impl Backend for OracleBackend<'_> {
    fn name(&self) -> String {
        "oracle".into()
    }

    fn prefilters(&self) -> bool {
        self.scene.prefilters()
    }

    fn bright_share(&self) -> f64 {
        self.scene.bright_share.unwrap_or(1.0)
    }

    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums> {
        let scene = self.scene;
        let mut block = Block::new(range.clone());
        if scene.algorithm == Algorithm::Cone {
            for (radiance, dropped) in
                self.pixels(range.pixels, progress, |x, y| cone_shade::pixel(scene, x, y))?
            {
                block.sums.push(radiance.to_array());
                block.dropped += dropped;
            }
            return Ok(block.into());
        }
        let pixel = |x, y| sums(scene, &scene.header, [x, y], 0, range.samples.clone());
        let pixels = self.pixels(range.pixels, progress, pixel)?;
        block.sums = pixels.iter().map(|p| p.sum.to_array()).collect();
        block.signed = scene.mean_sign.map(|mean_sign| Signed {
            mean_sign,
            negative: pixels.iter().map(|p| p.negative.to_array()).collect(),
            weights: pixels.iter().map(|p| p.signs).collect(),
        });
        Ok(block.into())
    }

    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let scene = self.scene;
        let resolve = |x, y| match beam(scene, [x, y]) {
            Some(color) => color.as_vec3().extend(0.0).to_array(),
            None => [0.0, 0.0, 0.0, 1.0],
        };
        if scene.beams { self.pixels(pixels, progress, resolve) } else { Ok(Vec::new()) }
    }

    fn pilot(&mut self, _: &dyn Progress) -> Result<Option<PilotRun>> {
        Ok(None)
    }

    fn sample(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<()> {
        let [width, height] = self.scene.header.film_size.to_array();
        let sums = self.of_batches(batches, progress)?;
        for half in self.halves.iter_mut().filter(|half| half.is_empty()) {
            half.resize(width as usize * height as usize, (PixelSums::default(), 0.0));
        }
        for (batch, own) in batches.iter().zip(sums) {
            let [x, y] = batch.column_and_row();
            let (total, samples) = &mut self.halves[(batch.part & 1) as usize][(y * width + x) as usize];
            if batch.first == 0 {
                (*total, *samples) = (own, f64::from(batch.count));
            } else {
                total.sum += own.sum;
                total.squares += own.squares;
                total.negative += own.negative;
                total.signs += own.signs;
                *samples += f64::from(batch.count);
            }
        }
        Ok(())
    }

    fn sample_apart(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let sums = self.of_batches(batches, progress)?;
        Ok(sums
            .iter()
            .zip(batches)
            .map(|(sums, batch)| self.radiance(sums, f64::from(batch.count)))
            .collect())
    }

    fn read(&mut self, sums: &mut HalfSums) -> Result<()> {
        for (out, half) in sums.halves.iter_mut().zip(&self.halves) {
            out.iter_mut().zip(half).for_each(|(out, (sum, samples))| *out = self.radiance(sum, *samples));
        }
        Ok(())
    }
}
