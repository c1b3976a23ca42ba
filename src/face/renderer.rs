//! Renderers: devices, or float64 on the CPU. Input: options once, and scenes. Output: films, and the statistics of
//! each render.

use super::options::RenderOptions;
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::film::Film;
use crate::core::progress::{NoProgress, Progress};
use crate::gpu::list_devices;
use crate::render::{On, render_scene};
use crate::scene::prune::prune;
use crate::scene::{Scene, advice};

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
#[derive(Clone, Debug)]
pub struct Renderer {
    options: RenderOptions,
    on: Vec<On>,
    device: String,
}

/// The statistics of a render.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RenderReport {
    /// The device's name; `oracle` for float64 on the CPU.
    pub device: String,
    /// Wall-clock seconds of rendering, without loading and compiling.
    pub seconds: f64,
    /// Samples per pixel, on average.
    pub samples: f64,
    /// True if the goal was met, or if a number of samples was requested.
    pub reached: bool,
    /// The estimated RMSE of the picture, if sampling rates differ from pixel to pixel.
    pub estimated_rmse: Option<f64>,
    /// Warnings for the user about the picture.
    pub warnings: Vec<String>,
}

impl Renderer {
    /// Opens the devices that the options select.
    pub fn new(options: RenderOptions) -> Result<Renderer> {
        let on = options.on()?;
        let mut names = Vec::with_capacity(on.len());
        for one in &on {
            names.push(match one {
                On::Oracle => "oracle".to_owned(),
                On::Device(select) => {
                    let devices = list_devices()?;
                    devices[select.choose(&devices)?].name.clone()
                }
            });
        }
        Ok(Renderer { options, on, device: names.join(" + ") })
    }

    /// Returns the device's name; `oracle` for float64 on the CPU. Several are joined by " + ".
    pub fn device(&self) -> &str {
        &self.device
    }

    /// Renders a scene. Its textures are read first.
    pub fn render(&self, scene: &Scene) -> Result<Film> {
        self.render_with(scene, &NoProgress).map(|(film, _)| film)
    }

    /// Renders a scene with progress reports and cancellation. The error of a cancelled render is of kind
    /// [`ErrorKind::Interrupted`].
    pub fn render_with(&self, scene: &Scene, progress: &dyn Progress) -> Result<(Film, RenderReport)> {
        let mut scene = scene.parts().clone();
        self.options.changes()?.apply(&mut scene)?;
        self.options.with.crop.map_or(Ok(()), |crop| crop.check_within([scene.width, scene.height]))?;
        prune(&mut scene);
        let picture = render_scene(&scene, &self.options.with, &self.on, progress);
        let picture = picture.map_err(|error: Error| error.or_kind(ErrorKind::Unsupported))?;
        let (film, outcome) = (picture.film, picture.report.outcome);
        let report = RenderReport {
            device: picture.device,
            seconds: picture.report.seconds.render,
            samples: outcome.as_ref().map_or(f64::from(film.samples), |outcome| outcome.mean_samples),
            reached: outcome.as_ref().is_none_or(|outcome| outcome.reached),
            estimated_rmse: outcome.map(|outcome| outcome.estimated_rmse),
            warnings: [advice::of_scene(&scene), picture.report.warnings].concat(),
        };
        Ok((film, report))
    }
}
