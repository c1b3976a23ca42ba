//! The device, or the oracle, that renders all pictures of the page in turn, in a thread of its own. Input: the queue of
//! refinements. Output: their pictures. A setting's scene is uploaded once, and kept while others have their turns; settings
//! that differ in their samples alone share it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Instant;

use super::queue::{Queue, Turn};
use super::refinement::Refinement;
use super::settings::Settings;
use super::shown::Shown;
use super::textures::Textures;
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::film::Film;
use crate::core::panics;
use crate::core::progress::Progress;
use crate::gpu::{DeviceSelect, Gpu};
use crate::oracle::backend::OracleBackend;
use crate::pack::{self, MipPlacement, PackedScene};
use crate::render::{FileStamp, MipChoice, On, Session, Tuning, integrator, oracle_driver, stamp};
use crate::scene::model::{Sampling, Scene};
use crate::scene::texture_advice::of_textures;

/// Scenes that are kept on the device.
const MAX_OPEN: usize = 4;

/// A scene that is ready to be rendered.
enum Ready<'g> {
    Device(Box<Session<'g>>),
    Oracle(Box<PackedScene>),
}

/// A scene that is rendered, for one refinement or several.
struct Open<'g> {
    numbers: Vec<u64>,
    origin: Origin,
    scene: Scene,
    ready: Ready<'g>,
    /// About its textures.
    warnings: Vec<String>,
    /// The refinement that was rendered last is done.
    is_over: bool,
}

/// What decides a scene on the device: all but its samples.
#[derive(PartialEq)]
struct Origin {
    settings: Settings,
    sampling: Sampling,
    files: Vec<FileStamp>,
}

impl Origin {
    /// Returns that of a refinement as its files are now.
    fn now(refinement: &Refinement) -> Origin {
        let Refinement { settings, scene, .. } = refinement;
        let textures = scene.textures.iter().flat_map(|texture| texture.content.files());
        let files = [&scene.path].into_iter().chain(&scene.sources).map(PathBuf::as_path).chain(textures);
        let Sampling { pattern, spp, shared, seed, .. } = Sampling::default();
        Origin {
            settings: settings.without_samples(),
            sampling: Sampling { pattern, spp, shared, seed, ..scene.sampling },
            files: files.map(stamp).collect(),
        }
    }
}

/// A picture and what was measured of it.
struct Made {
    film: Film,
    /// Samples a pixel, on average.
    samples: f64,
    seconds: f64,
    estimate: Option<f64>,
    warnings: Vec<String>,
}

/// What renders, by name.
pub struct Names {
    pub device: String,
    pub driver: String,
}

/// Renders what the queue has until it is stopped. Sends the device's names, or why there is none, and calls `changed`
/// after each picture.
pub fn work(on: &On, queue: &Queue, textures: &Textures, opened: &Sender<Result<Names>>, changed: &dyn Fn()) {
    let select = match on {
        On::Oracle => {
            let _ = opened.send(Ok(Names { device: "oracle".into(), driver: oracle_driver() }));
            return turns(None, queue, textures, changed);
        }
        On::Device(select) => select,
    };
    match Gpu::open(select) {
        Err(error) => {
            let _ = opened.send(Err(error));
        }
        Ok(gpu) => {
            let (device, driver) = (gpu.info().name.clone(), gpu.info().driver.clone());
            let _ = opened.send(Ok(Names { device, driver }));
            turns(Some(&gpu), queue, textures, changed);
            drop(gpu);
            again(select, queue, textures, changed);
        }
    }
}

/// Goes on with the device opened anew, if it was lost.
fn again(select: &DeviceSelect, queue: &Queue, textures: &Textures, changed: &dyn Fn()) {
    while !queue.is_stopped() {
        match Gpu::open(select) {
            Ok(gpu) => turns(Some(&gpu), queue, textures, changed),
            Err(error) => {
                let Some(refinement) = queue.take() else { return };
                refinement.fail(told(&error));
                changed();
            }
        }
    }
}

/// Gives refinements their turns until the queue is stopped or the device is lost.
fn turns(gpu: Option<&Gpu>, queue: &Queue, textures: &Textures, changed: &dyn Fn()) {
    let mut open: Vec<Open<'_>> = Vec::new();
    while let Some(refinement) = queue.take() {
        let Some(count) = refinement.next() else { continue };
        let turn = Turn { queue, refinement: &refinement, count };
        let made = panics::contain(&"rendering", || step(gpu, &mut open, textures, &refinement, &turn));
        match made {
            Ok(()) | Err(Error::Interrupted) => {}
            Err(error) => {
                refinement.fail(told(&error));
                changed();
                if error.kind() == ErrorKind::DeviceLost {
                    return;
                }
            }
        }
        if let Some(own) = open.iter_mut().find(|own| own.numbers.contains(&refinement.number)) {
            own.is_over = refinement.next().is_none();
        }
        changed();
        queue.push(refinement);
    }
}

/// Returns the message of an error and its next step.
pub fn told(error: &Error) -> String {
    match error.help() {
        Some(help) => format!("{error}\n{help}"),
        None => error.to_string(),
    }
}

/// Renders the next picture of a refinement.
fn step<'g>(
    gpu: Option<&'g Gpu>,
    open: &mut Vec<Open<'g>>,
    textures: &Textures,
    refinement: &Arc<Refinement>,
    turn: &Turn<'_>,
) -> Result<()> {
    let at = match open.iter().position(|own| own.numbers.contains(&refinement.number)) {
        Some(at) => at,
        None => {
            let origin = Origin::now(refinement);
            let at = open.iter().position(|own| own.origin == origin).map_or_else(
                || {
                    // What is done makes room, and what was rendered longest ago.
                    open.retain(|own| !own.is_over);
                    open.truncate(MAX_OPEN - 1);
                    open.insert(0, open_scene(gpu, textures, refinement, origin, turn)?);
                    Ok::<usize, Error>(0)
                },
                Ok,
            )?;
            open[at].numbers.push(refinement.number);
            refinement.warn(open[at].warnings.clone());
            at
        }
    };
    open[..=at].rotate_right(1);
    open[0].scene.sampling = refinement.scene.sampling;
    if turn.cancelled() {
        return Err(Error::Interrupted);
    }
    let made = open[0].render(turn.count, turn)?;
    refinement.warn(made.warnings);
    refinement.add(Shown::new(turn.count, made.film), made.samples, made.seconds, made.estimate);
    Ok(())
}

/// Reads a scene's textures and uploads it. Ends between its parts when the setting is gone meanwhile.
fn open_scene<'g>(
    gpu: Option<&'g Gpu>,
    textures: &Textures,
    refinement: &Refinement,
    origin: Origin,
    turn: &Turn<'_>,
) -> Result<Open<'g>> {
    let go_on = || if turn.cancelled() { Err(Error::Interrupted) } else { Ok(()) };
    let scene = refinement.scene.clone();
    let (textures, notes) = textures.of(&scene)?;
    go_on()?;
    let warnings = notes.into_iter().chain(of_textures(&scene, &textures)).collect();
    let mips = match gpu {
        Some(gpu) if pack::reads_levels(&scene) => MipChoice::Auto.mip_chains(gpu.info()),
        _ => MipPlacement::Host,
    };
    let packed = pack::pack_with(&scene, textures, None, mips)?;
    go_on()?;
    let ready = match gpu {
        Some(gpu) => Ready::Device(Box::new(Session::open(gpu, packed, false, &Tuning::default())?)),
        None => Ready::Oracle(Box::new(packed)),
    };
    Ok(Open { numbers: Vec::new(), origin, scene, ready, warnings, is_over: false })
}

impl Open<'_> {
    /// Renders a picture of a number of samples, as `moire render` does.
    fn render(&mut self, count: u32, progress: &dyn Progress) -> Result<Made> {
        self.scene.sampling.spp = count;
        let (film, outcome, seconds, warnings) = match &mut self.ready {
            Ready::Device(session) => {
                let (film, report) = session.prepare_sampling(&self.scene)?.render(progress)?;
                (film, report.outcome, report.seconds.render, report.warnings)
            }
            Ready::Oracle(packed) => {
                packed.set_sampling(&self.scene);
                let clock = Instant::now();
                let film = Film::new(self.scene.width, self.scene.height, 0);
                let mut backend = OracleBackend::new(packed)?;
                let made = integrator(packed, None, false).render(&mut backend, film, progress)?;
                (made.film, made.outcome, clock.elapsed().as_secs_f64(), Vec::new())
            }
        };
        let samples = outcome.map_or(f64::from(film.samples), |outcome| outcome.mean_samples);
        let estimate = outcome.map(|outcome| outcome.estimated_rmse);
        Ok(Made { film, samples, seconds, estimate, warnings })
    }
}
