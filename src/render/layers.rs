//! Layers of a picture: properties of what each pixel sees, beside its colour. Input: a scene, and which layers. Output:
//! one value or vector a pixel. Most are those of one ray through the pixel's centre, with the footprint of the whole
//! pixel; some count or average the pixel's samples.

pub use super::aov::Aov;
use super::backend::DeviceBackend;
use super::kept::Kept;
use super::layer_samples::estimates;
pub use super::layer_surfaces::MAX_SURFACES;
use super::layer_surfaces::{Take, count_surfaces, looking};
use super::load::load;
use super::options::{On, Options};
use super::picture::Picture;
use super::session::Session;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::layer::{Channel, Layer};
use crate::core::progress::{Progress, SubProgress};
use crate::gpu::Gpu;
use crate::integrators::{Fixed, Integrator};
use crate::oracle::backend::OracleBackend;
use crate::pack::PackedScene;
use crate::sampling::Backend;
use crate::scene::cone::freeze_time;
use crate::scene::model::{Algorithm, Pattern, PixelFilter, Quantity, Scene};

/// Returns the layers, in the order in which they are named. `picture` is the scene's picture, if it was rendered; one is
/// rendered if a layer needs it.
pub fn render_layers(
    scene: &Scene,
    options: &Options,
    on: &[On],
    wanted: &[Aov],
    picture: Option<&Picture>,
    progress: &dyn Progress,
) -> Result<Vec<Layer>> {
    wanted.iter().try_for_each(|aov| aov.check(scene))?;
    // One device takes all of them.
    let on = &on[..on.len().min(1)];
    let mut kept = Kept::default();
    let mut steps = Steps { progress, done: 0, all: wanted.len() };
    let mut found: Vec<(Aov, Layer)> = Vec::with_capacity(wanted.len());
    let centres: Vec<Aov> = wanted.iter().copied().filter(|aov| aov.at_centre().is_some()).collect();
    if !centres.is_empty() {
        let packed = load(&at_centres(scene), options, on, &mut kept)?.packed;
        let mut measuring = Measuring::open(packed, &kept, options)?;
        for aov in centres {
            let quantity = aov.at_centre().unwrap_or_default();
            let film = measuring.measure(quantity, &mut |backend, size| {
                Ok(Fixed { samples: 1 }.render(backend, Film::new(size[0], size[1], 0), &steps.next())?.film)
            })?;
            found.push((aov, layer(aov, &film)));
            steps.done += 1;
        }
    }
    for &aov in wanted.iter().filter(|aov| aov.at_centre().is_none()) {
        let made = match aov {
            Aov::Albedo => {
                let lightless = lightless(scene);
                let samples = lightless.sampling.samples();
                let packed = load(&lightless, options, on, &mut kept)?.packed;
                let mut measuring = Measuring::open(packed, &kept, options)?;
                let film = measuring.measure(Quantity::Albedo, &mut |backend, size| {
                    Ok(Fixed { samples }.render(backend, Film::new(size[0], size[1], 0), &steps.next())?.film)
                })?;
                layer(aov, &film)
            }
            Aov::Surfaces => {
                let looking = looking(lightless(scene));
                let packed = load(&looking, options, on, &mut kept)?.packed;
                let mut measuring = Measuring::open(packed, &kept, options)?;
                let film = measuring.surfaces(&looking, &steps.next())?;
                layer(aov, &film)
            }
            _ => estimates(aov, scene, options, on, picture, &steps.next())?,
        };
        found.push((aov, made));
        steps.done += 1;
    }
    let of = |aov: &Aov| found.iter().find(|(other, _)| other == aov).map(|(_, layer)| layer.clone());
    Ok(wanted.iter().filter_map(of).collect())
}

/// Returns the packed scene whose camera rays, one through each pixel's centre, have the footprint of the whole pixel.
pub fn packed_at_centres(scene: &Scene, options: &Options) -> Result<PackedScene> {
    Ok(load(&at_centres(scene), options, &[On::Oracle], &mut Kept::default())?.packed)
}

/// Returns the scene whose camera rays are those of the scene's samples, with the footprints of layers; paths end at their
/// first hit.
pub fn for_rays(scene: &Scene) -> Scene {
    let mut scene = lightless(scene);
    scene.sampling.quantity = Quantity::Texels;
    scene
}

/// The progress of one layer after the other.
struct Steps<'p> {
    progress: &'p dyn Progress,
    done: usize,
    all: usize,
}

impl Steps<'_> {
    /// Returns the progress of the next layer.
    fn next(&self) -> SubProgress<'_> {
        let part = |n: usize| n as f64 / self.all as f64;
        SubProgress { whole: self.progress, from: part(self.done), to: part(self.done + 1) }
    }
}

/// Returns the scene with one ray through the centre of each pixel: no lens, nothing moves, no light.
fn at_centres(scene: &Scene) -> Scene {
    let mut scene = lightless(&freeze_time(scene));
    scene.pixel_filter = PixelFilter::default();
    scene.sampling.pattern = Pattern::Center;
    scene.sampling.shared = false;
    scene.sampling.quantity = Quantity::Texels;
    scene
}

/// Returns the scene whose paths end at their first hit.
fn lightless(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.lights.clear();
    let sampling = &mut scene.sampling;
    (sampling.algorithm, sampling.max_depth, sampling.quantity) = (Algorithm::Samples, 0, Quantity::Albedo);
    scene
}

/// Takes the samples of a picture of that size from a backend.
type TakeFilm<'t> = dyn FnMut(&mut dyn Backend, [u32; 2]) -> Result<Film> + 't;

/// A scene that is open for measurements.
enum Measuring<'g> {
    Device(Box<Session<'g>>),
    Oracle(Box<PackedScene>),
}

impl<'g> Measuring<'g> {
    fn open(packed: PackedScene, kept: &'g Kept, options: &Options) -> Result<Measuring<'g>> {
        match kept.gpus.first() {
            Some(gpu) => Measuring::on(gpu, packed, options),
            None => Ok(Measuring::Oracle(Box::new(packed))),
        }
    }

    fn on(gpu: &'g Gpu, packed: PackedScene, options: &Options) -> Result<Measuring<'g>> {
        let session = Session::open(gpu, packed, options.keep_everything, &options.tuning)?;
        Ok(Measuring::Device(Box::new(session)))
    }

    /// Hands a backend that measures this quantity to `take`, with the size of the picture.
    fn measure(&mut self, quantity: Quantity, take: &mut TakeFilm<'_>) -> Result<Film> {
        match self {
            Measuring::Device(session) => {
                let prepared = session.prepare_quantity(quantity)?;
                let mut backend = DeviceBackend::new(&prepared)?;
                let film = take(&mut backend, prepared.film_size());
                backend.finish()?;
                film
            }
            Measuring::Oracle(scene) => {
                scene.header.quantity = quantity;
                take(&mut OracleBackend::new(scene)?, scene.header.film_size.to_array())
            }
        }
    }
}

impl Measuring<'_> {
    /// Counts surfaces; the scene is the one that was opened.
    fn surfaces(&mut self, scene: &Scene, progress: &dyn Progress) -> Result<Film> {
        match self {
            Measuring::Device(session) => {
                let facets = session.prepare_quantity(Quantity::Facet)?;
                let places = session.prepare_quantity(Quantity::Place)?;
                let size = facets.film_size();
                let mut measure = |quantity: Quantity, take: &mut Take<'_>| {
                    // One at a time, as they share the session's buffers.
                    let prepared = if quantity == Quantity::Facet { &facets } else { &places };
                    let mut backend = DeviceBackend::new(prepared)?;
                    let taken = take(&mut backend);
                    backend.finish()?;
                    taken
                };
                count_surfaces(&mut measure, scene, size, progress)
            }
            Measuring::Oracle(packed) => {
                let size = packed.header.film_size.to_array();
                let mut measure = |quantity: Quantity, take: &mut Take<'_>| {
                    packed.header.quantity = quantity;
                    take(&mut OracleBackend::new(packed)?)
                };
                count_surfaces(&mut measure, scene, size, progress)
            }
        }
    }
}

/// Returns the layer of a film of measurements: up to two values and 1 where there are any, or a vector.
fn layer(aov: Aov, film: &Film) -> Layer {
    let channel = |(i, name): (usize, &&'static str)| Channel {
        name,
        values: film.pixels.iter().map(|pixel| pixel[i]).collect(),
    };
    let present = |pixel: &[f32; 3]| match aov {
        Aov::Normal => *pixel != [0.0; 3],
        Aov::Albedo => true,
        _ => pixel[2] != 0.0,
    };
    Layer {
        name: aov.name(),
        channels: aov.channels().iter().enumerate().map(channel).collect(),
        present: film.pixels.iter().map(present).collect(),
    }
}
