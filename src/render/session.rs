//! A scene on a device, rendered any number of times. In: a packed scene, whose shapes and texels go up
//! once. Out: for each choice of samples a pipeline, and from it films. Renders of one session share the
//! buffers of scene and film, so they take turns.

use std::cell::{Cell, OnceCell, RefCell};
use std::rc::Rc;
use std::time::Instant;

use crate::adaptive::{self, Goal};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::shaders::{self, Shader};
use crate::gpu::{Gpu, Pipeline};
use crate::pack::features::Features;
use crate::pack::{self, PackedScene, Schedule};
use crate::scene::model::{Algorithm, Scene};
use crate::schema::layout::{Header, Slice};

use super::beams::{Beams, Fallback, Sampler, Teller};
use super::film_buffer::FilmBuffer;
use super::jobs::JobTracer;
use super::loop_budget::samples_at_once;
use super::resources::{Resources, shader_for};
use super::texel_buffer;
use super::tile_culling::TileCulling;
use super::{Renderer, Report, Tuning, build_pipeline, slices, specialization, tuning};

pub struct Session<'a> {
    gpu: &'a Gpu,
    /// Without texels and their sums: the device has them.
    scene: PackedScene,
    resources: Resources,
    keep_everything: bool,
    /// Look-ups of method shader read images.
    image_source: bool,
    tuning: Tuning,
    /// What the device lacks.
    warnings: Vec<String>,
    /// What the scene buffer begins with now.
    header: Cell<Header>,
    /// Of a scene of many triangles.
    survey: OnceCell<TileCulling>,
    /// Films of this size, without compensation and with it.
    films: RefCell<[Option<Rc<FilmBuffer>>; 2]>,
    upload_seconds: f64,
}

/// A session's scene with one choice of samples.
pub struct Prepared<'s, 'a> {
    session: &'s Session<'a>,
    /// The session's with this choice.
    scene: PackedScene,
    work: Work<'a>,
    /// Of a render: its pipeline is compiled, nothing is rendered.
    report: Report,
}

/// How samples reach the film.
enum Work<'a> {
    Tiles { renderer: Renderer<'a>, film: Rc<FilmBuffer> },
    Jobs { sampler: Sampler },
    Beams(Beams<'a>),
}

impl<'a> Session<'a> {
    /// The texels of `scene` leave the host's memory once the device has them.
    pub fn open(
        gpu: &'a Gpu,
        mut scene: PackedScene,
        keep_everything: bool,
        tuning: &Tuning,
    ) -> Result<Session<'a>> {
        let clock = Instant::now();
        let warnings = scene.suit_device(gpu.info().limits.float64).into_iter().collect();
        scene.chunk = samples_at_once(gpu.info(), &scene)?;
        let image_source = tuning.image_source(gpu, &scene);
        let features = Features::new(&scene, image_source, keep_everything);
        let resources = Resources::upload(gpu, &scene, &features, tuning.texel_words(gpu))?;
        let films = RefCell::new([None, None]);
        let survey = OnceCell::new();
        (scene.texels, scene.prefix_sums) = (Vec::new(), Vec::new());
        let header = Cell::new(scene.header);
        let upload_seconds = clock.elapsed().as_secs_f64();
        Ok(Session {
            gpu,
            scene,
            resources,
            keep_everything,
            image_source,
            tuning: *tuning,
            warnings,
            header,
            survey,
            films,
            upload_seconds,
        })
    }

    /// The scene as it was packed.
    pub fn prepare(&self) -> Result<Prepared<'_, 'a>> {
        self.prepare_packed(&self.scene)
    }

    /// With the samples of `scene`, which differs from the packed one in nothing else.
    pub fn prepare_sampling(&self, scene: &Scene) -> Result<Prepared<'_, 'a>> {
        let mut packed = self.scene.clone();
        packed.set_sampling(scene);
        self.prepare_packed(&packed)
    }

    fn prepare_packed(&self, scene: &PackedScene) -> Result<Prepared<'_, 'a>> {
        let features = self.features_of(scene);
        let mut report = Report {
            left_out: features.left_out.clone(),
            device_mips_seconds: self.resources.mips_seconds,
            double: features.double,
            warnings: self.warnings.clone(),
            ..Report::default()
        };
        let clock = Instant::now();
        self.write_header(&scene.header)?;
        report.seconds.upload = self.upload_seconds + clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        if scene.culls_tiles() && self.survey.get().is_none() {
            let survey = TileCulling::new(self.gpu, scene, &self.resources, &features)?;
            // Never set twice: both were empty just now.
            let _ = self.resources.survey.set(survey.buffer.clone());
            let _ = self.survey.set(survey);
        }
        let work = match scene.schedule {
            Schedule::Tiles if scene.beams => {
                Work::Beams(Beams { teller: self.teller(scene, features)?, sampler: OnceCell::new() })
            }
            Schedule::Tiles => {
                let (renderer, film) =
                    self.renderer(scene, &features, shader_for(scene.algorithm, &features))?;
                Work::Tiles { renderer, film }
            }
            Schedule::Jobs => Work::Jobs { sampler: self.sampler(scene, &features)? },
        };
        let mut prepared = Prepared { session: self, scene: scene.clone(), work, report };
        prepared.warm_up_jobs()?;
        prepared.report.seconds.compile = clock.elapsed().as_secs_f64();
        Ok(prepared)
    }

    /// Renders tile by tile; compiled.
    fn renderer(
        &self,
        scene: &PackedScene,
        features: &Features,
        shader: &'static Shader,
    ) -> Result<(Renderer<'a>, Rc<FilmBuffer>)> {
        let (pipeline, groups_per_tile) = self.pipeline(features, shader)?;
        let film = self.film(scene, features)?;
        let group = self.resources.bind(self.gpu, &pipeline, shader, &film.buffer, None)?;
        let renderer = Renderer { gpu: self.gpu, pipeline, group, groups_per_tile };
        renderer.warm_up(&film)?;
        Ok((renderer, film))
    }

    fn sampler(&self, scene: &PackedScene, features: &Features) -> Result<Sampler> {
        let shader = shader_for(scene.algorithm, features);
        let (pipeline, groups_per_tile) = self.pipeline(features, shader)?;
        Ok(Sampler { pipeline, shader, groups_per_tile })
    }

    /// And its workgroups a tile.
    fn pipeline(&self, features: &Features, shader: &'static Shader) -> Result<(Pipeline, u32)> {
        let group_size = self.tuning.group_size(self.gpu.info())?;
        let slots = self.resources.slots;
        let mut constants =
            specialization::constants(shader, features, &self.resources.sections, group_size, slots);
        if let Some(constant) = shader.constant("TABLES_IN_HEAD") {
            constants.push((constant.id, u32::from(Tuning::tables_in_head(self.gpu.info()))));
        }
        let pipeline = build_pipeline(self.gpu, shader, &constants, slots, size_of::<Slice>())?;
        Ok((pipeline, tuning::groups_per_tile(group_size)))
    }

    fn features_of(&self, scene: &PackedScene) -> Features {
        Features::new(scene, self.image_source, self.keep_everything)
    }

    pub(super) fn survey(&self) -> Option<&TileCulling> {
        self.survey.get()
    }

    /// What the survey found, of each cell `CELL_WORDS` words; none without one.
    pub fn survey_words(&self) -> Result<Option<Vec<u32>>> {
        self.survey().map(|survey| survey.words(self.gpu)).transpose()
    }

    /// What samples the pixels that beams leave.
    fn beside_beams(&self, scene: &PackedScene) -> Result<Sampler> {
        let scene = PackedScene { schedule: Schedule::Jobs, ..scene.clone() };
        self.sampler(&scene, &self.features_of(&scene))
    }

    /// What tells pixels beside samples; none for a scene that beams do not suit, or whose textures' sums the
    /// device cannot hold.
    pub(super) fn beside_samples(&self) -> Result<Option<Teller<'a>>> {
        let Some(textures) = &self.scene.beam_textures else { return Ok(None) };
        // Asked before they are made: of large textures they take far more memory than the texels.
        if !texel_buffer::fits(self.gpu, pack::prefix_sum_words(textures)) {
            return Ok(None);
        }
        self.resources.add_row_sums(self.gpu, &self.scene, || pack::prefix_sums(textures))?;
        let scene = PackedScene { schedule: Schedule::Tiles, beams: true, ..self.scene.clone() };
        let features = self.features_of(&scene);
        self.teller(&scene, features).map(Some)
    }

    fn teller(&self, scene: &PackedScene, features: Features) -> Result<Teller<'a>> {
        let features = Features { compensated: false, ..features };
        let (renderer, film) = self.renderer(
            scene,
            &features,
            if features.double { &shaders::BEAM_WIDE } else { &shaders::BEAM },
        )?;
        Ok(Teller { renderer, film })
    }

    fn film(&self, scene: &PackedScene, features: &Features) -> Result<Rc<FilmBuffer>> {
        let slot = &mut self.films.borrow_mut()[usize::from(features.compensated)];
        if let Some(film) = slot {
            return Ok(film.clone());
        }
        let film = Rc::new(FilmBuffer::new(self.gpu, scene, features)?);
        *slot = Some(film.clone());
        Ok(film)
    }

    fn write_header(&self, header: &Header) -> Result<()> {
        if self.header.get() != *header {
            self.resources.write_header(self.gpu, &self.scene, header)?;
            self.header.set(*header);
        }
        Ok(())
    }
}

impl Prepared<'_, '_> {
    pub fn compile_seconds(&self) -> f64 {
        self.report.seconds.compile
    }

    /// Renders once more. The report's times of loading and compiling are those of the first.
    pub fn render(&self, progress: &dyn Progress) -> Result<(Film, Report)> {
        self.render_to_goal(None, progress)
    }

    /// The same; where samples go to the film by jobs, until the goal is met, by default the number of
    /// samples.
    pub fn render_to_goal(&self, goal: Option<Goal>, progress: &dyn Progress) -> Result<(Film, Report)> {
        self.session.write_header(&self.scene.header)?;
        let mut report = self.report.clone();
        let [width, height, _, _] = self.scene.header.size;
        if let Some(guards) = &self.session.resources.guards {
            guards.clear(self.session.gpu)?;
        }
        let clock = Instant::now();
        if let Some(survey) = self.session.survey().filter(|_| self.scene.culls_tiles()) {
            survey.run(self.session.gpu, &mut report)?;
        }
        let surveying = clock.elapsed().as_secs_f64();
        let film = match &self.work {
            Work::Tiles { renderer, film: buffer } => {
                let mut film = Film::new(width, height, self.scene.samples);
                let mut dropped = 0.0;
                let mut plan = slices::Plan::new(self.scene.samples, self.scene.chunk, buffer.tiles());
                for band in buffer.bands() {
                    let clock = Instant::now();
                    renderer.band(&band, &mut plan, &mut report, progress)?;
                    report.seconds.render += clock.elapsed().as_secs_f64();
                    let clock = Instant::now();
                    dropped += buffer.read(self.session.gpu, &band, &mut film)?;
                    report.seconds.readback += clock.elapsed().as_secs_f64();
                }
                let cones = self.scene.algorithm == Algorithm::Cone;
                report.dropped = cones.then(|| dropped / film.pixels.len() as f64);
                film
            }
            Work::Beams(beams) => {
                let session = self.session;
                let fallback = Fallback { resources: &session.resources, scene: &self.scene };
                let build = || session.beside_beams(&self.scene);
                beams.render(session.gpu, [width, height], &fallback, build, &mut report, progress)?
            }
            Work::Jobs { .. } => {
                let clock = Instant::now();
                let goal = goal.unwrap_or(Goal::Samples(self.scene.samples));
                let compiled = report.seconds.compile;
                let mut tracer = self.tracer(&mut report)?;
                let (film, outcome) = adaptive::run(&mut tracer, [width, height], goal, progress)?;
                let compiling = report.seconds.compile - compiled;
                report.seconds.render = clock.elapsed().as_secs_f64() - compiling;
                report.outcome = Some(outcome);
                film
            }
        };
        report.seconds.render += surveying;
        let guards = self.session.resources.guards.as_ref();
        report.guards = guards.map(|guards| guards.read(self.session.gpu)).transpose()?;
        report.device_bytes = self.session.gpu.memory_in_use();
        Ok((film, report))
    }

    /// Whatever the driver compiles late, it compiles now.
    fn warm_up_jobs(&self) -> Result<()> {
        match self.work {
            Work::Tiles { .. } | Work::Beams(_) => Ok(()),
            Work::Jobs { .. } => self.tracer(&mut Report::default())?.warm_up(),
        }
    }

    fn tracer<'t>(&'t self, report: &'t mut Report) -> Result<JobTracer<'t>> {
        let Work::Jobs { sampler } = &self.work else {
            return Err(Error::new("a scene that is rendered tile by tile has no jobs"));
        };
        let session = self.session;
        let mut tracer = sampler.tracer(session.gpu, &session.resources, &self.scene, report)?;
        tracer.session = Some(session);
        Ok(tracer)
    }
}
