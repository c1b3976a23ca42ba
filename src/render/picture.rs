//! Renders a scene from its texture files to the film; every caller that renders a scene once uses it. Input: a scene,
//! options, and the backends that take the samples. Output: the film and statistics.

use std::collections::HashSet;
use std::sync::mpsc;
use std::time::Instant;

use super::backend::DeviceBackend;
use super::plan::integrator;
use super::session::{Prepared, Session};
use super::{MipChoice, Report, Tuning};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::gpu::{self, DeviceInfo, DeviceSelect, Gpu};
use crate::integrators::adaptive::{Goal, PixelEstimates};
use crate::oracle::backend::OracleBackend;
use crate::pack::{self, MipPlacement, PackedScene};
use crate::sampling::{Backend, Scheduler};
use crate::scene::model::Scene;
use crate::scene::texture_advice::of_textures;
use crate::texture::decode::AllowedFloats;
use crate::texture::load::load_with_notes;

/// A backend that takes samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum On {
    Device(DeviceSelect),
    /// The float64 renderer on the CPU.
    Oracle,
}

impl On {
    /// Parses `oracle`, or the syntax of [`DeviceSelect::parse`].
    pub fn parse(text: &str) -> Result<On> {
        if text == "oracle" { Ok(On::Oracle) } else { DeviceSelect::parse(text).map(On::Device) }
    }
}

/// Rendering options that are not part of the scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// The part of the picture that is rendered; `None` is the whole.
    pub crop: Option<Rect>,
    /// The end of adaptive sampling; `None` is the scene's number of samples.
    pub goal: Option<Goal>,
    /// Accepts textures with NaN and infinite texels.
    pub allow_nonfinite: bool,
    /// Keeps all features in the pipelines.
    pub keep_everything: bool,
    /// Counts on the device how often limits are exceeded.
    pub diagnosed: bool,
    pub mips: MipChoice,
    pub tuning: Tuning,
}

impl Default for Options {
    /// Renders the whole picture with the choices that measure best.
    fn default() -> Options {
        Options {
            crop: None,
            goal: None,
            allow_nonfinite: false,
            keep_everything: false,
            diagnosed: false,
            mips: MipChoice::Auto,
            tuning: Tuning::default(),
        }
    }
}

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
    /// Samples and errors of single pixels, of adaptive sampling.
    pub estimates: Option<PixelEstimates>,
    /// For each texture its name and the number of texels that are NaN or infinite.
    pub nonfinite: Vec<(String, u64)>,
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
    fn begin(&self) -> Result<Working<'_>> {
        match self {
            Ready::Device(prepared) => {
                DeviceBackend::new(prepared).map(|backend| Working::Device(Box::new(backend)))
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
    let Loaded { gpus, mut packed, doubts, startup, load } = load(scene, options, on)?;
    packed.diagnosed = options.diagnosed;
    let [width, height] = packed.header.film_size.to_array();
    let texture_lines = packed.texture_lines();
    let nonfinite =
        packed.texture_names.iter().cloned().zip(packed.nonfinite_texels.iter().copied()).collect();
    let integrator = integrator(&packed, options.goal);
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
    let clock = Instant::now();
    let mut backends = Vec::with_capacity(on.len());
    for ready in &prepared {
        backends.push(ready.begin()?);
    }
    let mut scheduler = Scheduler::new(backends.iter_mut().map(Working::backend).collect())?;
    let mut integrated = integrator.render(&mut scheduler, [width, height], progress)?;
    let estimates = integrated.estimates.take();
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
    (report.seconds.startup, report.seconds.load) = (startup, load);
    report.warnings.splice(..0, doubts);
    let film = report.take(integrated);
    Ok(Picture {
        film,
        report,
        device,
        driver: drivers(on, &gpus),
        devices: gpus.iter().map(|gpu| gpu.info().clone()).collect(),
        messages: gpus.iter().flat_map(Gpu::messages).collect(),
        texture_lines,
        estimates,
        nonfinite,
    })
}

/// The inputs of a render, before anything is uploaded.
pub(super) struct Loaded {
    /// The devices among the backends, in order.
    pub(super) gpus: Vec<Gpu>,
    pub(super) packed: PackedScene,
    /// Warnings about the textures.
    doubts: Vec<String>,
    startup: f64,
    load: f64,
}

/// Opens the devices while the textures are read, as both mostly wait.
pub(super) fn load(scene: &Scene, options: &Options, on: &[On]) -> Result<Loaded> {
    std::thread::scope(|scope| {
        let start = Instant::now();
        let (tell, told) = mpsc::channel();
        let loading = scope.spawn(move || {
            let packed = pack(scene, options, || told.recv().unwrap_or_default());
            (packed, start.elapsed().as_secs_f64())
        });
        let selects = on.iter().filter_map(|on| match on {
            On::Device(select) => Some(select),
            On::Oracle => None,
        });
        let gpus: Result<Vec<Gpu>> = selects.map(Gpu::open).collect();
        // Several backends, or the oracle, read the same levels: those that the host generates.
        let mip_chains = match gpus.as_deref() {
            Ok([gpu]) if on.len() == 1 => options.mips.mip_chains(gpu.info()),
            _ => MipPlacement::Host,
        };
        // The receiver is gone if the scene does not need it.
        let _ = tell.send(mip_chains);
        let startup = if on == [On::Oracle] { 0.0 } else { start.elapsed().as_secs_f64() };
        let (packed, load) = loading.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // An error in the scene takes precedence over one of the machine.
        packed.and_then(|(packed, doubts)| Ok(Loaded { gpus: gpus?, packed, doubts, startup, load }))
    })
}

/// Returns the packed scene, and warnings about its textures. `mip_chains` decides where levels are generated, and may
/// wait until a device is open.
fn pack(
    scene: &Scene,
    options: &Options,
    mip_chains: impl FnOnce() -> MipPlacement,
) -> Result<(PackedScene, Vec<String>)> {
    let values = if options.allow_nonfinite { AllowedFloats::Any } else { AllowedFloats::Finite };
    let textures = scene.textures.iter().map(|t| load_with_notes(t, values)).collect::<Result<Vec<_>>>()?;
    let (textures, notes): (Vec<_>, Vec<_>) = textures.into_iter().unzip();
    // Several textures may be of one file.
    let mut told = HashSet::new();
    let notes = notes.into_iter().flatten().filter(|note| told.insert(note.clone()));
    let doubts: Vec<String> = notes.chain(of_textures(scene, &textures)).collect();
    let mip_chains = if pack::reads_levels(scene) { mip_chains() } else { MipPlacement::Host };
    Ok((pack::pack_with(scene, textures, options.crop, mip_chains)?, doubts))
}

fn drivers(on: &[On], gpus: &[Gpu]) -> String {
    let mut gpus = gpus.iter();
    let driver = |on: &On| match on {
        On::Device(_) => gpus.next().map(|gpu| gpu.info().driver.clone()).unwrap_or_default(),
        On::Oracle => format!("moire {} in float64", env!("CARGO_PKG_VERSION")),
    };
    on.iter().map(driver).collect::<Vec<_>>().join(" + ")
}
