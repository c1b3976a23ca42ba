//! A scene on a device, rendered any number of times. Input: a packed scene, whose shapes and texels are uploaded once.
//! Output: a pipeline for each choice of samples, and films rendered by it. Renders of one session share the buffers of
//! scene and film, so only one runs at a time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

use crate::core::error::{Error, Result};
use crate::gpu::Gpu;
use crate::gpu::shaders::{self, Shader};
use crate::pack::features::Features;
use crate::pack::{self, PackedScene, Schedule};
use crate::scene::model::Scene;
use crate::schema::enums::{Quantity, TexelSource};
use crate::schema::layout::Header;

use super::batches::BatchSampler;
use super::beams::BeamPass;
use super::film_buffer::FilmBuffer;
use super::goal::GoalSteps;
use super::loop_budget::samples_at_once;
use super::resources::{Resources, shader_for};
use super::sample_pipeline::SamplePipeline;
use super::texel_buffer;
use super::tile_culling::TileCulling;
use super::tiles::{Rest, TileRenderer};
use super::unfinished::UnfinishedPixels;
use super::{Report, Tuning};

pub struct Session<'a> {
    pub(super) gpu: &'a Gpu,
    /// Without texels, their prefix sums and meshes, which are on the device.
    scene: PackedScene,
    pub(super) resources: Resources,
    keep_everything: bool,
    /// True if look-ups of method shader read images.
    image_source: bool,
    pub(super) tuning: Tuning,
    /// Warnings about features that the device lacks.
    warnings: Vec<String>,
    /// The current header of the scene buffer.
    header: Mutex<Header>,
    /// Set for a scene of many triangles.
    tile_culling: OnceLock<TileCulling>,
    /// Films of this size, without compensation and with it.
    films: Mutex<[Option<Arc<FilmBuffer>>; 2]>,
    /// True while a render writes those buffers.
    taken: AtomicBool,
    upload_seconds: f64,
}

/// The exclusive right to write the buffers that all renders of a session share.
pub(super) struct Turn<'s>(&'s AtomicBool);

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

/// A session's scene with one choice of samples.
pub struct Prepared<'s, 'a> {
    pub(super) session: &'s Session<'a>,
    /// The session's scene with this choice.
    pub(super) scene: PackedScene,
    pub(super) work: Work<'a>,
    /// The steps of sampling to a goal, where the device takes them itself.
    pub(super) goal: Option<GoalSteps>,
    /// The report of a render so far: its pipeline is compiled, nothing is rendered.
    pub(super) report: Report,
}

/// The pass that renders whole tiles, and its film.
pub(super) struct TilePass<'a> {
    pub(super) renderer: TileRenderer<'a>,
    pub(super) film: Arc<FilmBuffer>,
}

/// The way in which samples reach the film.
pub(super) enum Work<'a> {
    Tiles(Arc<TilePass<'a>>),
    Batches(SamplePipeline),
    /// The second field is the pipeline for pixels that beams cannot resolve, built on first use.
    Beams(Box<BeamPass<'a>>, OnceLock<SamplePipeline>),
}

impl<'a> Session<'a> {
    /// Uploads a scene. Its texels and meshes are freed on the host once the device has them.
    pub fn open(
        gpu: &'a Gpu,
        mut scene: PackedScene,
        keep_everything: bool,
        tuning: &Tuning,
    ) -> Result<Session<'a>> {
        let clock = Instant::now();
        let warnings = scene.adapt_to_device(gpu.info().limits.float64).into_iter().collect();
        scene.samples_at_once = tuning.samples_at_once.unwrap_or_else(|| samples_at_once(gpu.info(), &scene));
        let image_source = tuning.image_source(gpu, &scene);
        let features = Features::new(&scene, image_source, keep_everything);
        let meshes = std::mem::take(&mut scene.mesh_texels);
        let resources = Resources::upload(gpu, &scene, meshes, &features, tuning.texel_words(gpu))?;
        let films = Mutex::new([None, None]);
        let tile_culling = OnceLock::new();
        (scene.texels, scene.prefix_sums) = Default::default();
        let header = Mutex::new(scene.header);
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
            tile_culling,
            films,
            taken: AtomicBool::new(false),
            upload_seconds,
        })
    }

    /// Prepares the scene as it was packed.
    pub fn prepare(&self) -> Result<Prepared<'_, 'a>> {
        self.prepare_packed(&self.scene)
    }

    /// Prepares with the samples of `scene`, which differs from the packed one in nothing else.
    pub fn prepare_sampling(&self, scene: &Scene) -> Result<Prepared<'_, 'a>> {
        let mut packed = self.scene.clone();
        packed.set_sampling(scene);
        self.prepare_packed(&packed)
    }

    /// Prepares to measure another quantity with the samples of the packed scene.
    pub fn prepare_quantity(&self, quantity: Quantity) -> Result<Prepared<'_, 'a>> {
        let mut packed = self.scene.clone();
        packed.header.quantity = quantity;
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
        let turn = self.turn()?;
        let clock = Instant::now();
        self.write_header(&scene.header)?;
        report.seconds.upload = self.upload_seconds + clock.elapsed().as_secs_f64();

        let clock = Instant::now();
        if scene.culls_tiles() && self.tile_culling.get().is_none() {
            let tile_culling = self.new_tile_culling(scene, &features)?;
            // Never set twice: both were empty just now.
            let _ = self.resources.tile_lists.set(tile_culling.buffer.clone());
            let _ = self.tile_culling.set(tile_culling);
        }
        let work = match scene.schedule {
            Schedule::Tiles if scene.beams => {
                Work::Beams(Box::new(self.beam_pass(scene, features)?), OnceLock::new())
            }
            Schedule::Tiles => {
                let (renderer, film) =
                    self.renderer(scene, &features, shader_for(scene.algorithm, &features)?)?;
                Work::Tiles(Arc::new(TilePass { renderer, film }))
            }
            Schedule::Batches => Work::Batches(self.sample_pipeline(scene, &features)?),
        };
        let goal = match work {
            Work::Batches(_) if self.tuning.device_estimates(self.gpu.info()) => {
                GoalSteps::new(self.gpu, scene)?
            }
            _ => None,
        };
        let mut prepared = Prepared { session: self, scene: scene.clone(), work, goal, report };
        prepared.warm_up()?;
        drop(turn);
        prepared.report.seconds.compile = clock.elapsed().as_secs_f64();
        Ok(prepared)
    }

    /// Returns a compiled renderer of tiles, and its film.
    fn renderer(
        &self,
        scene: &PackedScene,
        features: &Features,
        shader: &'static Shader,
    ) -> Result<(TileRenderer<'a>, Arc<FilmBuffer>)> {
        let (pipelines, groups_per_tile) = self.pipelines(scene, features, shader)?;
        let film = self.film(scene, features)?;
        let [x, y] = self.tuning.group_size(self.gpu.info())?;
        let corner = scene.header.crop.to_array();
        let rest = match (&self.resources.unfinished, pipelines.get(1)) {
            (Some(unfinished), _) => {
                let pixels = UnfinishedPixels::new(
                    self.gpu,
                    &self.resources,
                    shader,
                    &pipelines,
                    x * y,
                    &film,
                    corner,
                )?;
                Rest::Lists(unfinished.clone(), pixels)
            }
            (None, Some(second)) => Rest::Tiles(second.clone()),
            (None, None) => Rest::Nothing,
        };
        let pipeline = pipelines[0].clone();
        let group = self.resources.bind(self.gpu, &pipeline, shader, &film.buffer, None)?;
        let renderer = TileRenderer { gpu: self.gpu, pipeline, rest, group, groups_per_tile };
        renderer.warm_up(&film)?;
        Ok((renderer, film))
    }

    fn features_of(&self, scene: &PackedScene) -> Features {
        Features::new(scene, self.image_source, self.keep_everything)
    }

    pub(super) fn tile_culling(&self) -> Option<&TileCulling> {
        self.tile_culling.get()
    }

    /// Returns the `CELL_WORDS` words of each cell of tile culling; `None` without it.
    pub fn tile_list_words(&self) -> Result<Option<Vec<u32>>> {
        self.tile_culling().map(|tile_culling| tile_culling.words(self.gpu)).transpose()
    }

    /// Builds the pipeline that samples the pixels that beams cannot resolve.
    pub(super) fn samples_beside_beams(&self, scene: &PackedScene) -> Result<SamplePipeline> {
        let scene = PackedScene { schedule: Schedule::Batches, ..scene.clone() };
        self.sample_pipeline(&scene, &self.features_of(&scene))
    }

    /// Builds the beam pass for a scene that is packed for samples; `None` if beams do not support the scene, or if the
    /// device cannot hold the prefix sums of its textures. Nor are they tried on meshes: a beam that meets hundreds of
    /// triangles takes up to a second alone, which a pilot run on a few tiles does not foretell.
    pub(super) fn beams_beside_samples(&self) -> Result<Option<BeamPass<'a>>> {
        let textures = self.scene.beam_textures.as_ref().filter(|_| !self.scene.has_concave_shapes());
        let Some(textures) = textures else { return Ok(None) };
        // Checked before they are computed: for large textures they take far more memory than the texels.
        if !texel_buffer::fits(self.gpu, pack::prefix_sum_words(textures)) {
            return Ok(None);
        }
        self.resources.add_row_sums(self.gpu, &self.scene, || pack::prefix_sums(textures))?;
        let scene = PackedScene { schedule: Schedule::Tiles, beams: true, ..self.scene.clone() };
        let features = self.features_of(&scene);
        self.beam_pass(&scene, features).map(Some)
    }

    /// Builds the pass that renders whole tiles of a scene that is packed for batches, in blocks of as many samples as a
    /// thread takes at once.
    pub(super) fn tiles_beside_batches(&self, scene: &PackedScene) -> Result<TilePass<'a>> {
        // Later samples are added to earlier ones: films do so if they are compensated, or the device may end loops.
        let samples = scene.samples_at_once + u32::from(!Tuning::loops_end(self.gpu.info()));
        let scene = PackedScene { schedule: Schedule::Tiles, samples, ..scene.clone() };
        let features = self.features_of(&scene);
        let (renderer, film) = self.renderer(&scene, &features, shader_for(scene.algorithm, &features)?)?;
        Ok(TilePass { renderer, film })
    }

    fn beam_pass(&self, scene: &PackedScene, features: Features) -> Result<BeamPass<'a>> {
        let features = Features { compensated: false, ..features };
        let shader = shaders::BEAM_FAMILY.shader(TexelSource::None, features.records())?;
        let (renderer, film) = self.renderer(scene, &features, shader)?;
        Ok(BeamPass { renderer, film })
    }

    fn film(&self, scene: &PackedScene, features: &Features) -> Result<Arc<FilmBuffer>> {
        let mut films = self.films.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = &mut films[usize::from(features.compensated)];
        if let Some(film) = slot {
            return Ok(film.clone());
        }
        let film = Arc::new(FilmBuffer::new(self.gpu, scene, features)?);
        *slot = Some(film.clone());
        Ok(film)
    }

    pub(super) fn write_header(&self, header: &Header) -> Result<()> {
        let mut there = self.header.lock().unwrap_or_else(PoisonError::into_inner);
        if *there != *header {
            self.resources.write_header(self.gpu, &self.scene, header)?;
            *there = *header;
        }
        Ok(())
    }

    /// Claims the session's buffers; fails while another render uses them.
    pub(super) fn turn(&self) -> Result<Turn<'_>> {
        if self.taken.swap(true, Ordering::Acquire) {
            return Err(Error::with_help(
                "renders of one session share its buffers: one is not finished",
                "finish it first, or open a second session",
            ));
        }
        Ok(Turn(&self.taken))
    }
}

impl Prepared<'_, '_> {
    pub(super) fn film_size(&self) -> [u32; 2] {
        self.scene.header.film_size.to_array()
    }

    pub fn compile_seconds(&self) -> f64 {
        self.report.seconds.compile
    }

    /// Returns the sampler of batches for a pipeline of this choice of samples.
    pub(super) fn sampler<'a>(&'a self, pipeline: &'a SamplePipeline) -> Result<BatchSampler<'a>> {
        let kept = self.goal.as_ref().map(|steps| &steps.film);
        BatchSampler::new(self.session.gpu, pipeline, &self.session.resources, &self.scene, kept)
    }

    /// Runs the pipeline once, so that lazy compilation in the driver happens now.
    fn warm_up(&self) -> Result<()> {
        match &self.work {
            // The renderer has done so.
            Work::Tiles(_) | Work::Beams(..) => Ok(()),
            Work::Batches(pipeline) => self.sampler(pipeline)?.warm_up(),
        }
    }
}
