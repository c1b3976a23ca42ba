//! Renders a scene from its texture files to the film; every caller that renders a scene once uses it. Input: a scene,
//! options, and the backends that take the samples. Output: the film and statistics.

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Instant;

use super::Report;
use super::backend::DeviceBackend;
use super::kept::Kept;
use super::load::{Loaded, load_with_film};
use super::options::{On, Options};
use super::plan::integrator;
use super::rivals::{PreparedRivals, RivalScenes, RivalSessions, Rivals};
use super::session::{Prepared, Session};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::{self, DeviceInfo, DeviceSelect, Gpu};
use crate::integrators::Integrated;
use crate::integrators::adaptive::PixelEstimates;
use crate::oracle::backend::OracleBackend;
use crate::pack::{self, PackedScene};
use crate::sampling::{Backend, Scheduler};
use crate::scene::model::Scene;
use crate::texture::data::TextureData;

/// A film, and the statistics of its render.
#[derive(Clone, Debug)]
pub struct Picture {
    pub film: Film,
    pub report: Report,
    /// Names of the backends and of their drivers, several joined by " + ".
    pub device: String,
    pub driver: String,
    /// The devices among the backends.
    pub devices: Vec<DeviceInfo>,
    /// The messages of the validation layer.
    pub messages: Vec<String>,
    /// A line on how each texture is stored.
    pub texture_lines: Vec<String>,
    /// Samples and errors of single pixels, of adaptive sampling, if they were asked for.
    pub estimates: Option<PixelEstimates>,
    /// For each texture its name and the number of texels that are NaN or infinite.
    pub nonfinite: Vec<(String, u64)>,
    /// Held until the picture is written, unless the devices are kept.
    _closing: Arc<Closing>,
}

/// The state from which a backend renders.
enum Member<'g> {
    Device(Box<Session<'g>>),
    Oracle(Box<PackedScene>),
}

/// A member with its pipelines built.
enum Ready<'m> {
    Device(Box<Prepared<'m, 'm>>),
    Oracle(&'m PackedScene),
}

/// A backend that is rendering.
enum Working<'p> {
    Device(Box<DeviceBackend<'p>>),
    Oracle(OracleBackend<'p>),
}

impl Member<'_> {
    fn prepare(&self) -> Result<Ready<'_>> {
        match self {
            Member::Device(session) => session.prepare().map(|prepared| Ready::Device(Box::new(prepared))),
            Member::Oracle(scene) => Ok(Ready::Oracle(scene)),
        }
    }
}

impl Ready<'_> {
    fn begin<'p>(&'p self, rivals: &'p dyn Rivals) -> Result<Working<'p>> {
        match self {
            Ready::Device(prepared) => {
                let backend = DeviceBackend::new(prepared)?.with_rivals(rivals);
                Ok(Working::Device(Box::new(backend)))
            }
            Ready::Oracle(scene) => OracleBackend::new(scene).map(Working::Oracle),
        }
    }
}

impl Working<'_> {
    fn backend(&mut self) -> &mut dyn Backend {
        match self {
            Working::Device(backend) => &mut **backend,
            Working::Oracle(backend) => backend,
        }
    }
}

/// Renders a scene on one backend, or on several at once. Strips of the picture are assigned to the backends
/// round-robin, so that the picture does not depend on their speed; see [`Scheduler`].
pub fn render_scene(scene: &Scene, options: &Options, on: &[On], progress: &dyn Progress) -> Result<Picture> {
    let mut kept = Kept::default();
    let mut picture = render_kept(scene, options, on, &mut kept, progress)?;
    picture._closing = Arc::new(Closing::begin(kept.gpus));
    Ok(picture)
}

/// Renders as [`render_scene`] does, with the devices and textures of earlier renders on the same backends.
pub fn render_kept(
    scene: &Scene,
    options: &Options,
    on: &[On],
    kept: &mut Kept,
    progress: &dyn Progress,
) -> Result<Picture> {
    let (loaded, film) = load_with_film(scene, options, on, kept)?;
    let Loaded { mut packed, doubts, rivals, startup, load } = loaded;
    let gpus = &kept.gpus[..];
    packed.diagnosed = options.diagnosed;
    let texture_lines = packed.texture_lines();
    let nonfinite =
        packed.texture_names.iter().cloned().zip(packed.nonfinite_texels.iter().copied()).collect();
    let Integration { mut integrated, mut report, device } =
        integrate(packed, rivals, film, options, on, gpus, progress)?;
    (report.seconds.startup, report.seconds.load) = (startup, load);
    report.warnings.splice(..0, doubts);
    let estimates = integrated.estimates.take();
    Ok(Picture {
        film: report.take(integrated),
        report,
        device,
        driver: drivers(on, gpus),
        devices: gpus.iter().map(|gpu| gpu.info().clone()).collect(),
        messages: gpus.iter().flat_map(Gpu::messages).collect(),
        texture_lines,
        estimates,
        nonfinite,
        _closing: Arc::default(),
    })
}

/// Renders a scene whose textures are loaded on a device that is open, to the goal of the options.
pub fn render_on(
    gpu: &Gpu,
    scene: &Scene,
    textures: Vec<TextureData>,
    options: &Options,
    progress: &dyn Progress,
) -> Result<(Film, Report)> {
    let mut rivals = RivalScenes::of(scene, options);
    let kept = (!rivals.is_empty()).then(|| textures.clone());
    let packed = pack::pack_with(scene, textures, options.crop, options.mips.mip_chains(gpu.info()))?;
    rivals.textures = packed.beam_textures.clone().or(kept.map(Arc::new));
    let [width, height] = packed.header.film_size.to_array();
    // The choice of the device is made: it is the open one.
    let on = [On::Device(DeviceSelect::Default)];
    let film = Film::new(width, height, 0);
    let gpus = std::slice::from_ref(gpu);
    let Integration { integrated, mut report, .. } =
        integrate(packed, rivals, film, options, &on, gpus, progress)?;
    Ok((report.take(integrated), report))
}

/// What remains of sessions and backends when they are done.
struct Integration {
    integrated: Integrated,
    report: Report,
    device: String,
}

/// Opens the sessions, builds their pipelines and renders.
fn integrate(
    packed: PackedScene,
    rivals: RivalScenes,
    film: Film,
    options: &Options,
    on: &[On],
    gpus: &[Gpu],
    progress: &dyn Progress,
) -> Result<Integration> {
    let integrator = integrator(&packed, options.goal, options.tells_pixels);
    let (double, has_meshes) = (packed.double, !packed.mesh_texels.is_empty());
    // The last backend takes the scene itself, the others copies.
    let mut scenes = vec![packed.clone(); on.len().saturating_sub(1)];
    scenes.push(packed);
    let mut free = gpus.iter().peekable();
    let mut members = Vec::with_capacity(on.len());
    for (on, scene) in on.iter().zip(scenes) {
        members.push(match (on, free.next_if(|_| matches!(on, On::Device(_)))) {
            (On::Device(_), Some(gpu)) => {
                Member::Device(Box::new(Session::open(gpu, scene, options.keep_everything, &options.tuning)?))
            }
            _ => Member::Oracle(Box::new(scene)),
        });
    }
    let mut prepared = Vec::with_capacity(on.len());
    for member in &members {
        prepared.push(member.prepare()?);
    }
    if has_meshes {
        // What their trees and the driver's compiler took, before sums and film take theirs.
        gpu::give_back_host_memory();
    }
    let rivals = RivalSessions::new(gpus.first(), rivals, options);
    let rivals = PreparedRivals::new(&rivals);
    let clock = Instant::now();
    let mut backends = Vec::with_capacity(on.len());
    for ready in &prepared {
        backends.push(ready.begin(&rivals)?);
    }
    let mut scheduler = Scheduler::new(backends.iter_mut().map(Working::backend).collect())?;
    let integrated = integrator.render(&mut scheduler, film, progress)?;
    let device = scheduler.name();
    let rendering = clock.elapsed().as_secs_f64();

    let mut reports = backends.into_iter().map(|backend| match backend {
        Working::Device(backend) => backend.finish(),
        Working::Oracle(_) => {
            let mut report = Report { double, ..Report::default() };
            report.seconds.render = rendering;
            Ok(report)
        }
    });
    let mut report = reports.next().unwrap_or_else(|| Ok(Report::default()))?;
    reports.try_for_each(|other| other.map(|other| report.join(&other)))?;
    Ok(Integration { integrated, report, device })
}

/// Devices that are closed while their picture is written: some drivers take a while.
#[derive(Debug, Default)]
struct Closing(Option<JoinHandle<()>>);

impl Closing {
    fn begin(gpus: Vec<Gpu>) -> Closing {
        // Without a thread they are closed at once.
        Closing(std::thread::Builder::new().spawn(move || drop(gpus)).ok())
    }
}

impl Drop for Closing {
    fn drop(&mut self) {
        // The process must not end meanwhile. A panic there was reported, and changes no picture.
        let _ = self.0.take().map(JoinHandle::join);
    }
}

fn drivers(on: &[On], gpus: &[Gpu]) -> String {
    let mut gpus = gpus.iter();
    let driver = |on: &On| match on {
        On::Device(_) => gpus.next().map(|gpu| gpu.info().driver.clone()).unwrap_or_default(),
        On::Oracle => oracle_driver(),
    };
    on.iter().map(driver).collect::<Vec<_>>().join(" + ")
}

/// Returns the name of what stands for a driver where the oracle renders.
pub fn oracle_driver() -> String {
    format!("moire {} in float64", env!("CARGO_PKG_VERSION"))
}
