//! What a render needs before anything is uploaded. Input: a scene, options, and the backends. Output: open devices among
//! what is kept, the packed scene with its textures, and an empty film; all are made at the same time, as each of them
//! mostly waits.

use std::sync::{Arc, mpsc};
use std::time::Instant;

use rayon::prelude::*;

use super::kept::{Kept, KeptTextures};
use super::options::{On, Options};
use super::rivals::RivalScenes;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::gpu::Gpu;
use crate::pack::{self, MipPlacement, PackedScene};
use crate::scene::model::Scene;
use crate::texture::decode::AllowedFloats;

/// Pixels of films whose memory is made present beforehand, and of a page of that memory.
const LARGE_FILM: usize = 1 << 16;
const PIXELS_OF_PAGE: usize = 4096 / size_of::<[f32; 3]>();

/// The inputs of a render, before anything is uploaded.
pub(super) struct Loaded {
    pub(super) packed: PackedScene,
    /// Warnings about the textures.
    pub(super) doubts: Vec<String>,
    /// Other scenes that show the same, if one may be chosen.
    pub(super) rivals: RivalScenes,
    pub(super) startup: f64,
    pub(super) load: f64,
}

/// Loads the scene while the devices open, unless they are kept.
pub(super) fn load(scene: &Scene, options: &Options, on: &[On], kept: &mut Kept) -> Result<Loaded> {
    let Kept { gpus: open, textures } = kept;
    std::thread::scope(|scope| {
        let start = Instant::now();
        let (tell, told) = mpsc::channel();
        let loading = scope.spawn(move || {
            let rivals = if on.len() == 1 { RivalScenes::of(scene, options) } else { RivalScenes::default() };
            let packed = pack(scene, options, rivals, textures, || told.recv().unwrap_or_default());
            (packed, start.elapsed().as_secs_f64())
        });
        let selects = on.iter().filter_map(|on| match on {
            On::Device(select) => Some(select),
            On::Oracle => None,
        });
        let opened: Result<()> = match open.is_empty() {
            true => selects.map(Gpu::open).collect::<Result<_>>().map(|gpus| *open = gpus),
            false => Ok(()),
        };
        let startup = if on == [On::Oracle] { 0.0 } else { start.elapsed().as_secs_f64() };
        // Several backends, or the oracle, read the same levels: those that the host generates.
        let mip_chains = match &open[..] {
            [gpu] if on.len() == 1 => options.mips.mip_chains(gpu.info()),
            _ => MipPlacement::Host,
        };
        // The receiver is gone if the scene does not need it.
        let _ = tell.send(mip_chains);
        let (packed, load) = loading.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // An error in the scene takes precedence over one of the machine.
        packed.and_then(|packed| {
            let Packed { packed, doubts, rivals } = packed;
            opened.map(|()| Loaded { packed, doubts, rivals, startup, load })
        })
    })
}

/// A packed scene, and what was found on the way.
struct Packed {
    packed: PackedScene,
    doubts: Vec<String>,
    rivals: RivalScenes,
}

/// Returns the packed scene, and warnings about its textures. `mip_chains` decides where levels are generated, and may
/// wait until a device is open.
fn pack(
    scene: &Scene,
    options: &Options,
    mut rivals: RivalScenes,
    kept: &mut KeptTextures,
    mip_chains: impl FnOnce() -> MipPlacement,
) -> Result<Packed> {
    let values = if options.allow_nonfinite { AllowedFloats::Any } else { AllowedFloats::Finite };
    let (textures, doubts) = kept.read(scene, values)?;
    let mip_chains = if pack::reads_levels(scene) { mip_chains() } else { MipPlacement::Host };
    let copies = (!rivals.is_empty()).then(|| textures.clone());
    let packed = pack::pack_by(scene, textures, options.crop, mip_chains, kept)?;
    // Beams may have kept them already.
    rivals.textures = packed.beam_textures.clone().or(copies.map(Arc::new));
    Ok(Packed { packed, doubts, rivals })
}

/// Loads as [`load`] does, and makes an empty film of the picture meanwhile.
pub(super) fn load_with_film(
    scene: &Scene,
    options: &Options,
    on: &[On],
    kept: &mut Kept,
) -> Result<(Loaded, Film)> {
    std::thread::scope(|scope| {
        let film = scope.spawn(|| {
            let whole = [scene.width, scene.height];
            let crop = options.crop.filter(|crop| crop.check_within(whole).is_ok());
            let size = crop.map_or(whole, |crop| [crop.width, crop.height]);
            empty_film(size)
        });
        let loaded = load(scene, options, on, kept);
        let film = film.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        loaded.map(|loaded| (loaded, film))
    })
}

/// Returns a black film. The system gives memory page by page as it is written: all of a large film is there already when
/// the picture is read back.
fn empty_film([width, height]: [u32; 2]) -> Film {
    let mut film = Film::new(width, height, 0);
    if film.pixels.len() >= LARGE_FILM {
        film.pixels.par_chunks_mut(256 * PIXELS_OF_PAGE).for_each(|pixels| {
            for page in pixels.chunks_mut(PIXELS_OF_PAGE) {
                *std::hint::black_box(&mut page[0]) = [0.0; 3];
            }
        });
    }
    film
}
