//! A device as a backend: ranges, batches and beams of a prepared session. Input: an integrator's requests. Output:
//! sums and resolved pixels, and at the end the statistics of the device.

use std::sync::Arc;
use std::time::Instant;

use super::Report;
use super::batches::BatchSampler;
use super::beams::BeamPass;
use super::dispatch_plan::DispatchPlan;
use super::film_buffer::{Band, FilmBuffer};
use super::goal::{DevicePixels, GoalBackend};
use super::rivals::Rivals;
use super::session::{Prepared, TilePass, Turn, Work};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::{Range, Rect};
use crate::gpu::Gpu;
use crate::sampling::{Backend, Candidate, FilmSums, HalfSums, Made, PilotRun, Pixels, wall_seconds};
use crate::schema::layout::PixelBatch;

/// A prepared session while it renders.
pub struct DeviceBackend<'p> {
    pub(super) prepared: &'p Prepared<'p, 'p>,
    /// Set by the first request for batches.
    batches: Option<BatchSampler<'p>>,
    /// Set by a pilot run, for a scene that is sampled by batches.
    beams: Option<BeamPass<'p>>,
    /// Tile-samples of the next slice, learnt from the previous ones.
    pub(super) next: f64,
    pub(super) report: Report,
    begun: Instant,
    /// Seconds of compiling and uploading since then, which are told apart.
    pub(super) apart: f64,
    /// Opens sessions of other scenes that show the same; renders whole tiles of a scene that is sampled by batches; the
    /// backends of sessions that were opened.
    pub(super) rivals: Option<&'p dyn Rivals>,
    pub(super) even: Option<Arc<TilePass<'p>>>,
    /// True once whole tiles were rendered.
    pub(super) is_warm: bool,
    /// Seconds of a dispatch by itself, whatever it renders, once it was measured.
    pub(super) dispatch: Option<f64>,
    pub(super) opened: Vec<(Candidate, DeviceBackend<'p>)>,
    _turn: Turn<'p>,
}

impl<'p> DeviceBackend<'p> {
    /// Sets up the device's state for a render. Fails while another render of the session is not finished.
    pub fn new(prepared: &'p Prepared<'p, 'p>) -> Result<DeviceBackend<'p>> {
        let session = prepared.session;
        let turn = session.turn()?;
        session.write_header(&prepared.scene.header)?;
        let mut report = prepared.report.clone();
        if let Some(diagnostics) = &session.resources.diagnostics {
            diagnostics.clear(session.gpu)?;
        }
        if let Some(unfinished) = &session.resources.unfinished {
            unfinished.clear(session.gpu)?;
        }
        let begun = Instant::now();
        if let Some(tile_culling) = session.tile_culling().filter(|_| prepared.scene.culls_tiles()) {
            tile_culling.run(session.gpu, &mut report)?;
            report.seconds.render = begun.elapsed().as_secs_f64();
        }
        Ok(DeviceBackend {
            prepared,
            batches: None,
            beams: None,
            next: DispatchPlan::FIRST,
            report,
            begun,
            apart: 0.0,
            rivals: None,
            even: None,
            is_warm: false,
            dispatch: None,
            opened: Vec::new(),
            _turn: turn,
        })
    }

    /// Makes the pictures of other scenes that show the same eligible.
    pub(super) fn with_rivals(self, rivals: &'p dyn Rivals) -> DeviceBackend<'p> {
        DeviceBackend { rivals: Some(rivals), ..self }
    }

    /// Ends the render and returns the statistics of the device.
    pub fn finish(self) -> Result<Report> {
        drop((self.batches, self.beams));
        let mut report = self.report;
        let elapsed = self.begun.elapsed().as_secs_f64() - self.apart;
        for (_, rival) in self.opened {
            report.add_rival(rival.finish()?);
        }
        match self.prepared.work {
            // Sums and means of what was read are the host's.
            Work::Tiles(_) => report.seconds.readback = elapsed - report.seconds.render,
            _ => report.seconds.render = elapsed - report.seconds.readback,
        }
        let session = self.prepared.session;
        report.diagnostics = session
            .resources
            .diagnostics
            .as_ref()
            .map(|diagnostics| diagnostics.read(session.gpu))
            .transpose()?;
        report.device_bytes = session.gpu.memory_in_use();
        Ok(report)
    }

    /// Returns the sampler of batches, built on first use, and the report.
    fn batches(&mut self) -> Result<(&mut BatchSampler<'p>, &mut Report)> {
        let Prepared { session, scene, work, .. } = self.prepared;
        if self.batches.is_none() {
            self.batches = Some(match work {
                Work::Batches(pipeline) => self.prepared.sampler(pipeline)?,
                Work::Beams(_, pipeline) => {
                    let clock = Instant::now();
                    if pipeline.get().is_none() {
                        let built = session.samples_beside_beams(scene)?;
                        self.prepared.sampler(&built)?.warm_up()?;
                        // Never set twice: it was empty just now.
                        let _ = pipeline.set(built);
                    }
                    let seconds = clock.elapsed().as_secs_f64();
                    self.report.seconds.compile += seconds;
                    self.apart += seconds;
                    let built = pipeline.get().ok_or_else(|| Error::new("no pipeline for samples"))?;
                    self.prepared.sampler(built)?
                }
                Work::Tiles(_) => {
                    return Err(Error::new("a scene that is rendered tile by tile has no batches"));
                }
            });
        }
        let batches = self.batches.as_mut().ok_or_else(|| Error::new("no pipeline for samples"))?;
        Ok((batches, &mut self.report))
    }

    /// Sums a range of samples band by band, and passes each band's sums to `read` while they are on the device.
    fn sum_bands(
        &mut self,
        range: &Range,
        progress: &dyn Progress,
        mut read: impl FnMut(&Gpu, &FilmBuffer, &Band) -> Result<()>,
    ) -> Result<()> {
        self.check(&range.pixels, range.samples.end)?;
        let Prepared { session, scene, .. } = self.prepared;
        let pass = self.tiles()?;
        let TilePass { renderer, film } = &*pass;
        let tiles = film.tiles(range.pixels);
        let mut plan = DispatchPlan::new(self.next, range.samples.clone(), scene.samples_at_once, tiles);
        for band in film.bands(range.pixels) {
            let clock = Instant::now();
            if range.samples.start > 0 {
                film.clear(session.gpu, &band)?;
            }
            renderer.tiles(&band, band.tiles, &mut plan, &mut self.report, progress)?;
            self.report.seconds.render += clock.elapsed().as_secs_f64();
            read(session.gpu, film, &band)?;
        }
        self.next = plan.next();
        Ok(())
    }

    pub(super) fn tiles(&self) -> Result<Arc<TilePass<'p>>> {
        match (&self.prepared.work, &self.even) {
            (Work::Tiles(pass), _) => Ok(pass.clone()),
            (_, Some(pass)) => Ok(pass.clone()),
            _ => Err(Error::new("a scene that is packed for batches or beams has no sums of tiles")),
        }
    }

    /// Fails unless the pixels are whole rows of the picture and the samples those for which the scene was packed.
    fn check(&self, pixels: &Rect, samples_end: u32) -> Result<()> {
        let [width, height] = self.prepared.scene.header.film_size.to_array();
        let rows = pixels.x == 0 && pixels.width == width && pixels.y + pixels.height <= height;
        if rows && samples_end <= self.prepared.scene.samples {
            return Ok(());
        }
        Err(Error::new(format!(
            "devices take whole rows of the picture of {width}×{height} pixels and at most {} samples, not {pixels:?} \
             up to sample {samples_end}",
            self.prepared.scene.samples
        )))
    }
}

impl<'p> GoalBackend<'p> for DeviceBackend<'p> {
    fn gpu(&self) -> &'p Gpu {
        self.prepared.session.gpu
    }

    fn sampler(&mut self) -> Result<(&mut BatchSampler<'p>, &mut Report)> {
        self.batches()
    }

    fn first_samples_differ(&self) -> bool {
        self.prepared.session.tile_culling().is_some()
    }
}

impl Backend for DeviceBackend<'_> {
    fn name(&self) -> String {
        self.prepared.session.gpu.info().name.clone()
    }

    fn prefilters(&self) -> bool {
        self.prepared.scene.prefilters()
    }

    /// Compiling and uploading are told apart from rendering.
    fn seconds(&self) -> f64 {
        wall_seconds() - self.apart
    }

    fn bright_share(&self) -> f64 {
        self.prepared.scene.bright_share.unwrap_or(1.0)
    }

    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums> {
        let mut block = self.tiles()?.film.block(range.clone());
        self.sum_bands(range, progress, |gpu, film, band| film.read(gpu, band, &mut block))?;
        Ok(block.into())
    }

    fn means(&mut self, range: &Range, film: &mut Film, progress: &dyn Progress) -> Result<f64> {
        let mut dropped = 0.0;
        self.sum_bands(range, progress, |gpu, sums, band| {
            sums.read_means(gpu, band, range.depth(), film, &mut dropped)
        })?;
        Ok(dropped)
    }

    fn cost(&mut self, candidate: Candidate, samples: u32, progress: &dyn Progress) -> Result<Option<f64>> {
        self.candidate_cost(candidate, samples, progress)
    }

    fn prefiltered_apart(
        &mut self,
        batches: &[PixelBatch],
        progress: &dyn Progress,
    ) -> Result<Option<Vec<[f32; 4]>>> {
        self.rival(Candidate::Prefiltered)?
            .map(|rival| rival.whole_pixels_apart(batches, progress))
            .transpose()
    }

    fn render_by(
        &mut self,
        candidate: Candidate,
        samples: u32,
        seconds: f64,
        film: &mut Film,
        progress: &dyn Progress,
    ) -> Result<Made> {
        self.render_candidate(candidate, samples, seconds, film, progress)
    }

    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        self.check(&pixels, 0)?;
        let pass = match &self.prepared.work {
            Work::Beams(pass, _) => Some(&**pass),
            _ => self.beams.as_ref(),
        };
        pass.map_or(Ok(Vec::new()), |pass| pass.resolve(pixels, &mut self.report, progress))
    }

    fn pilot(&mut self, progress: &dyn Progress) -> Result<Option<PilotRun>> {
        let clock = Instant::now();
        self.beams = self.prepared.session.beams_beside_samples()?;
        let seconds = clock.elapsed().as_secs_f64();
        self.report.seconds.compile += seconds;
        self.apart += seconds;
        self.beams.as_ref().map(|pass| pass.pilot(&mut self.report, progress)).transpose()
    }

    fn sample(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<()> {
        let (sampler, report) = self.batches()?;
        sampler.sample(batches, report, progress)
    }

    fn sample_all(&mut self, _: [u32; 2], first: u32, count: u32, progress: &dyn Progress) -> Result<()> {
        let (sampler, report) = self.batches()?;
        sampler.sample_all(first, count, report, progress)
    }

    fn sample_apart(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let (sampler, report) = self.batches()?;
        sampler.sample_apart(batches, report, progress)
    }

    fn read(&mut self, sums: &mut HalfSums) -> Result<()> {
        self.batches()?.0.read(sums)
    }

    fn keeps_pixels(&self) -> bool {
        self.prepared.goal.is_some()
    }

    fn kept_pixels(&mut self) -> Result<Option<Box<dyn Pixels + '_>>> {
        match &self.prepared.goal {
            Some(steps) => Ok(Some(Box::new(DevicePixels::new(self, steps)?))),
            None => Ok(None),
        }
    }

    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        let Prepared { session, scene, .. } = self.prepared;
        let [width, height] = scene.header.film_size.to_array();
        match session.tile_culling() {
            Some(tile_culling) => tile_culling.first_samples(session.gpu, [width, height], most),
            None => Ok(vec![most; pixels]),
        }
    }
}
