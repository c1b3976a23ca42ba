//! The device, or the oracle, that renders all pictures of the page in turn, in a thread of its own. Input: the queue of
//! refinements. Output: their pictures. A setting's scene is uploaded once, and kept while others have their turns.

use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Instant;

use super::queue::{Queue, Turn};
use super::refinement::Refinement;
use super::shown::Shown;
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::film::Film;
use crate::core::panics;
use crate::core::progress::Progress;
use crate::gpu::{DeviceSelect, Gpu};
use crate::oracle::backend::OracleBackend;
use crate::pack::{self, MipPlacement, PackedScene};
use crate::render::{KeptTextures, MipChoice, On, Session, Tuning, integrator};
use crate::scene::model::Scene;
use crate::texture::decode::AllowedFloats;

/// Scenes that are kept on the device.
const MAX_OPEN: usize = 4;

/// A scene that is ready to be rendered.
enum Ready<'g> {
    Device(Box<Session<'g>>),
    Oracle(Box<PackedScene>),
}

/// A refinement's scene.
struct Open<'g> {
    number: u64,
    scene: Scene,
    ready: Ready<'g>,
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

/// Renders what the queue has until it is stopped. Sends the device's name, or why there is none, and calls `changed`
/// after each picture.
pub fn work(on: &On, queue: &Queue, opened: &Sender<Result<String>>, changed: &dyn Fn()) {
    let select = match on {
        On::Oracle => {
            let _ = opened.send(Ok("oracle".into()));
            return turns(None, queue, changed);
        }
        On::Device(select) => select,
    };
    match Gpu::open(select) {
        Err(error) => {
            let _ = opened.send(Err(error));
        }
        Ok(gpu) => {
            let _ = opened.send(Ok(gpu.info().name.clone()));
            turns(Some(&gpu), queue, changed);
            drop(gpu);
            again(select, queue, changed);
        }
    }
}

/// Goes on with the device opened anew, if it was lost.
fn again(select: &DeviceSelect, queue: &Queue, changed: &dyn Fn()) {
    while !queue.is_stopped() {
        match Gpu::open(select) {
            Ok(gpu) => turns(Some(&gpu), queue, changed),
            Err(error) => {
                let Some(refinement) = queue.take() else { return };
                refinement.fail(told(&error));
                changed();
            }
        }
    }
}

/// Gives refinements their turns until the queue is stopped or the device is lost.
fn turns(gpu: Option<&Gpu>, queue: &Queue, changed: &dyn Fn()) {
    let mut open: Vec<Open<'_>> = Vec::new();
    // Settings of one scene mostly read the same textures.
    let mut kept = KeptTextures::of_last_scene();
    while let Some(refinement) = queue.take() {
        let Some(count) = refinement.next() else { continue };
        let turn = Turn { queue, refinement: &refinement, count };
        let made = panics::contain(&"rendering", || step(gpu, &mut open, &mut kept, &refinement, &turn));
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
        if refinement.next().is_none() {
            open.retain(|own| own.number != refinement.number);
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
    kept: &mut KeptTextures,
    refinement: &Arc<Refinement>,
    turn: &Turn<'_>,
) -> Result<()> {
    let at = match open.iter().position(|own| own.number == refinement.number) {
        Some(at) => at,
        None => {
            // The one that was rendered longest ago makes room.
            open.truncate(MAX_OPEN - 1);
            let (opened, warnings) = open_scene(gpu, kept, refinement)?;
            refinement.warn(warnings);
            open.insert(0, opened);
            0
        }
    };
    open[..=at].rotate_right(1);
    if turn.cancelled() {
        return Err(Error::Interrupted);
    }
    let made = open[0].render(turn.count, turn)?;
    refinement.warn(made.warnings);
    refinement.add(Shown::new(turn.count, made.film), made.samples, made.seconds, made.estimate);
    Ok(())
}

/// Reads a scene's textures and uploads it; returns warnings about the textures, too.
fn open_scene<'g>(
    gpu: Option<&'g Gpu>,
    kept: &mut KeptTextures,
    refinement: &Refinement,
) -> Result<(Open<'g>, Vec<String>)> {
    let scene = refinement.scene.clone();
    let (textures, warnings) = kept.read(&scene, AllowedFloats::Finite)?;
    let mips = match gpu {
        Some(gpu) if pack::reads_levels(&scene) => MipChoice::Auto.mip_chains(gpu.info()),
        _ => MipPlacement::Host,
    };
    let packed = pack::pack_with(&scene, textures, None, mips)?;
    let ready = match gpu {
        Some(gpu) => Ready::Device(Box::new(Session::open(gpu, packed, false, &Tuning::default())?)),
        None => Ready::Oracle(Box::new(packed)),
    };
    Ok((Open { number: refinement.number, scene, ready }, warnings))
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
