//! A device, or float64 on the CPU, that renders scenes. In: options once, and scenes. Out: films, and what each render
//! did.

use super::options::{Place, RenderOptions};
use crate::adaptive::{self, Goal, Outcome};
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::film::Film;
use crate::core::progress::{NoProgress, Progress};
use crate::gpu::Gpu;
use crate::oracle;
use crate::pack::{self, Crop, MipPlacement, PackedScene, Schedule};
use crate::render::{self, MipChoice, Tuning};
use crate::scene::prune::prune;
use crate::scene::{Scene, advice, model, texture_advice};
use crate::texture::decode::Values;
use crate::texture::load::load_noted;

/// Renders scenes with one set of options.
///
/// ```
/// use moire::model::{Camera, Sphere};
/// use moire::{RenderOptions, Renderer, Scene};
///
/// # fn main() -> moire::Result<()> {
/// let mut scene = Scene::builder(Camera::looking([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 40.0), 16, 16);
/// scene.shape(Sphere::new([0.0, 0.0, 0.0], 1.0));
/// let renderer = Renderer::new(RenderOptions::new().device("oracle").samples(4))?;
/// let film = renderer.render(&scene.build()?)?;
/// assert_eq!([film.width, film.height], [16, 16]);
/// # Ok(())
/// # }
/// ```
pub struct Renderer {
    options: RenderOptions,
    /// None: the oracle.
    gpu: Option<Gpu>,
}

/// What a render did beside its film.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RenderReport {
    /// The device's name; `oracle` for float64 on the CPU.
    pub device: String,
    /// Wall seconds of rendering, without loading and compiling.
    pub seconds: f64,
    /// Samples a pixel, on average.
    pub samples: f64,
    /// Whether the goal was met; true where a number of samples was asked for.
    pub reached: bool,
    /// The estimate of the picture's RMSE, where samples differ from pixel to pixel.
    pub estimated_rmse: Option<f64>,
    /// What a person should know before looking at the picture.
    pub warnings: Vec<String>,
}

impl Renderer {
    /// Opens the device that the options select.
    pub fn new(options: RenderOptions) -> Result<Renderer> {
        let gpu = match options.place()? {
            Place::Oracle => None,
            Place::Device(select) => Some(Gpu::open(&select)?),
        };
        Ok(Renderer { options, gpu })
    }

    /// Returns the device's name; `oracle` for float64 on the CPU.
    pub fn device(&self) -> &str {
        self.gpu.as_ref().map_or("oracle", |gpu| &gpu.info().name)
    }

    /// Renders a scene. Its textures are read first.
    pub fn render(&self, scene: &Scene) -> Result<Film> {
        self.render_with(scene, &NoProgress).map(|(film, _)| film)
    }

    /// Renders a scene, tells how far it is, and stops where it shall. The error of a stopped render is of kind
    /// [`ErrorKind::Interrupted`].
    pub fn render_with(&self, scene: &Scene, progress: &dyn Progress) -> Result<(Film, RenderReport)> {
        let mut scene = scene.parts().clone();
        self.options.changes()?.apply(&mut scene)?;
        self.options.crop.map_or(Ok(()), |crop: Crop| crop.check(scene.width, scene.height))?;
        prune(&mut scene);
        let (packed, doubts) = self.load(&scene)?;
        let samples = packed.samples;
        let (film, outcome, seconds, warnings) = match &self.gpu {
            Some(gpu) => {
                let rendered = render::render_to_goal(
                    gpu,
                    packed,
                    false,
                    &Tuning::default(),
                    self.options.goal,
                    progress,
                );
                let (film, report) = rendered.map_err(|error| error.or_kind(ErrorKind::Unsupported))?;
                (film, report.outcome, report.seconds.render, report.warnings)
            }
            None => {
                let clock = std::time::Instant::now();
                let (film, outcome) = on_oracle(&packed, self.options.goal, progress)?;
                (film, outcome, clock.elapsed().as_secs_f64(), Vec::new())
            }
        };
        let report = RenderReport {
            device: self.device().to_owned(),
            seconds,
            samples: outcome.as_ref().map_or(f64::from(samples), |outcome| outcome.mean_samples),
            reached: outcome.as_ref().is_none_or(|outcome| outcome.reached),
            estimated_rmse: outcome.map(|outcome| outcome.estimated_rmse),
            warnings: [advice::of_scene(&scene), doubts, warnings].concat(),
        };
        Ok((film, report))
    }

    /// The scene to render, and what is doubtful about its textures.
    fn load(&self, scene: &model::Scene) -> Result<(PackedScene, Vec<String>)> {
        let values = if self.options.allow_nonfinite { Values::Any } else { Values::Finite };
        let loaded = scene.textures.iter().map(|t| load_noted(t, values)).collect::<Result<Vec<_>>>();
        let (textures, notes): (Vec<_>, Vec<_>) = loaded?.into_iter().unzip();
        let doubts = [notes.concat(), texture_advice::of_textures(scene, &textures)].concat();
        let mips = match &self.gpu {
            Some(gpu) if pack::reads_levels(scene) => MipChoice::Auto.mip_chains(gpu.info()),
            _ => MipPlacement::Host,
        };
        let packed = pack::pack_with(scene, textures, self.options.crop, mips);
        Ok((packed.map_err(|error: Error| error.or_kind(ErrorKind::Scene))?, doubts))
    }
}

fn on_oracle(
    packed: &PackedScene,
    goal: Option<Goal>,
    progress: &dyn Progress,
) -> Result<(Film, Option<Outcome>)> {
    if packed.schedule == Schedule::Jobs {
        let [width, height, _, _] = packed.header.size;
        let goal = goal.unwrap_or(Goal::Samples(packed.samples));
        let mut tracer = oracle::jobs::JobTracer::new(packed);
        let (film, outcome) = adaptive::run(&mut tracer, [width, height], goal, progress)?;
        return Ok((film, Some(outcome)));
    }
    if packed.beams {
        return oracle::render::render_beams(packed, progress).map(|(film, _)| (film, None));
    }
    oracle::render::render(packed, progress).map(|film| (film, None))
}
