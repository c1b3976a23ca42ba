//! One beam a pixel on a device: first all pixels by beams, which flag those that they cannot tell, then
//! samples for these, by a pipeline that is built when the first of them turns up.

use std::cell::OnceCell;
use std::rc::Rc;
use std::time::Instant;

use super::film_buffer::FilmBuffer;
use super::jobs::{Binder, JobTracer};
use super::{Renderer, Report, Resources, slices};
use crate::adaptive::{Sums, Tracer, Trial};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::shaders::Shader;
use crate::gpu::{Gpu, Pipeline};
use crate::pack::PackedScene;
use crate::schema::layout::Job;

/// A beam takes as long as many samples.
const FIRST_TILES: f64 = 2.0;
/// A trial is on one tile of so many, of those first in line, which lie far apart.
const TRIAL_PART: u32 = 8;

/// What tells pixels by beams.
pub struct Teller<'a> {
    pub renderer: Renderer<'a>,
    pub film: Rc<FilmBuffer>,
}

impl Teller<'_> {
    /// Of each pixel red, green, blue and 0, or a last 1 where beams cannot tell.
    pub fn tell(&self, report: &mut Report, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let mut pixels = Vec::new();
        let mut plan = slices::Plan::starting_with(FIRST_TILES, 1, 1, self.film.tiles());
        for band in self.film.bands() {
            self.renderer.band(&band, &mut plan, report, progress)?;
            self.film.read_with(self.renderer.gpu, &band, |_, pixel| pixels.push(pixel.sum))?;
        }
        Ok(pixels)
    }

    /// The first tiles in line of the first band.
    pub fn trial(&self, report: &mut Report, progress: &dyn Progress) -> Result<Trial> {
        let Some(band) = self.film.bands().next() else { return Ok(Trial::default()) };
        let tiles = band.tiles.div_ceil(TRIAL_PART);
        let mut plan = slices::Plan::starting_with(FIRST_TILES, 1, 1, tiles.into());
        let clock = Instant::now();
        self.renderer.tiles(&band, tiles, &mut plan, report, progress)?;
        let seconds = clock.elapsed().as_secs_f64() * self.film.tiles() as f64 / f64::from(tiles);
        let tried: Vec<bool> = band.first_tiles(tiles);
        let mut pixels = Vec::new();
        self.film.read_with(self.renderer.gpu, &band, |i, pixel| {
            if tried[band.tile_of(i as u32, self.film.width())] {
                pixels.push((i as u32, pixel.sum[3] == 0.0));
            }
        })?;
        Ok(Trial { seconds, pixels })
    }
}

pub struct Beams<'a> {
    pub teller: Teller<'a>,
    /// Of the pixels that beams leave, once there were any.
    pub sampler: OnceCell<Sampler>,
}

/// The pipeline that samples by jobs.
pub struct Sampler {
    pub pipeline: Pipeline,
    pub shader: &'static Shader,
    pub groups_per_tile: u32,
}

impl Sampler {
    pub fn tracer<'a>(
        &'a self,
        gpu: &'a Gpu,
        resources: &'a Resources,
        scene: &PackedScene,
        report: &'a mut Report,
    ) -> Result<JobTracer<'a>> {
        let binder = Binder { resources, pipeline: &self.pipeline, shader: self.shader };
        JobTracer::new(gpu, binder, self.groups_per_tile, scene, report)
    }
}

/// What the samples of the flagged pixels need.
pub struct Fallback<'s> {
    pub resources: &'s Resources,
    pub scene: &'s PackedScene,
}

impl Beams<'_> {
    /// `build` makes the sampling pipeline; its time is compiling's, not rendering's.
    pub fn render(
        &self,
        gpu: &Gpu,
        [width, height]: [u32; 2],
        fallback: &Fallback<'_>,
        build: impl Fn() -> Result<Sampler>,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Film> {
        let clock = Instant::now();
        let samples = fallback.scene.samples;
        let mut film = Film::new(width, height, 1);
        let mut left: Vec<u32> = Vec::new();
        for (i, [r, g, b, sampled]) in (0..).zip(self.teller.tell(report, progress)?) {
            film.pixels[i as usize] = [r, g, b];
            if sampled != 0.0 {
                left.push(i);
            }
        }
        report.sampled_pixels = Some(left.len() as u64);
        report.seconds.render = clock.elapsed().as_secs_f64();
        if left.is_empty() {
            return Ok(film);
        }
        let clock = Instant::now();
        if self.sampler.get().is_none() {
            let sampler = build()?;
            sampler.tracer(gpu, fallback.resources, fallback.scene, &mut Report::default())?.warm_up()?;
            // Never set twice: it was empty just now.
            let _ = self.sampler.set(sampler);
        }
        let sampler = self.sampler.get().ok_or_else(|| Error::new("no pipeline for samples"))?;
        report.seconds.compile += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        let mut tracer = sampler.tracer(gpu, fallback.resources, fallback.scene, report)?;
        let job = |&i: &u32| Job { place: Job::place_of(i, width), part: 0, first: 0, count: samples };
        tracer.sample(&left.iter().map(job).collect::<Vec<_>>(), progress)?;
        let half = || vec![[0.0; 4]; film.pixels.len()];
        let mut sums = Sums { width, height, halves: [half(), half()] };
        tracer.read(&mut sums)?;
        for i in left {
            let sum = sums.halves[0][i as usize];
            film.pixels[i as usize] = std::array::from_fn(|c| sum[c] / samples as f32);
        }
        report.seconds.render += clock.elapsed().as_secs_f64();
        Ok(film)
    }
}
