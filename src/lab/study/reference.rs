//! The reference of a study: a picture file, or the scene rendered with many samples in two
//! independent halves, on the device or by the oracle. The halves a and b also give the error of
//! their mean, RMSE(a, b) / 2.

use std::path::Path;
use std::time::Instant;

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::lab::metrics::{Halves, read_picture};
use crate::oracle;
use crate::output::{self, WriteOptions};
use crate::pack;
use crate::scene::MAX_SPP;
use crate::scene::model::{Pattern, Scene};
use crate::texture;

use super::identity::{self, Hash};
use super::limit::Limit;
use super::method::Method;
use super::plan::next_count;
use super::record::ReferenceRecord;
use super::session_cache::SessionCache;
use super::{Options, ReferenceChoice};

pub const FILE: &str = "reference.exr";
/// Samples of the reference relative to those of the longest point: since errors fall at least with
/// the root of the number, the reference's own is at most an eighth.
const SAMPLE_FACTOR: u32 = 64;
/// The fraction of a study's time that the reference may take.
const TIME_FRACTION: f64 = 0.25;
/// The deadlines of the first and the second attempt as fractions of the time, the second with
/// fewer samples.
const ATTEMPT_DEADLINES: [f64; 2] = [0.45, 0.6];
const FEWER: u32 = 4;
/// Offsets of the scene's seed, so that no half shares its samples with a measured point.
const SEED_OFFSETS: [u32; 2] = [1_000_003, 2_000_003];

pub struct Reference {
    pub film: Film,
    pub seen: PerceptualFeatures,
    pub record: ReferenceRecord,
    /// The progress of the study at this point.
    pub progress: f64,
}

pub fn obtain(
    sessions: &SessionCache<'_>,
    scene: &Scene,
    options: &Options,
    identity: &Hash,
    kept: Option<ReferenceRecord>,
    limit: &Limit,
    progress: &dyn Progress,
) -> Result<Reference> {
    if let ReferenceChoice::File(path) = &options.reference {
        return from_file(path, scene, identity);
    }
    let most = options.counts.iter().copied().max().unwrap_or(1);
    let wanted = most.saturating_mul(SAMPLE_FACTOR / 2).min(MAX_SPP);
    let oracle = options.reference == ReferenceChoice::Oracle;
    let hash = identity.text(if oracle { "oracle" } else { "device" }).text(&wanted.to_string()).hex();
    let path = options.out.join(FILE);
    if let Some(record) = kept.filter(|record| record.hash == hash)
        && let Some(film) = read_picture(&path).ok().filter(|film| fits(film, scene))
    {
        return Ok(finished(film, record, 0.0));
    }
    let allowed = (TIME_FRACTION * limit.seconds - limit.spent()).max(0.0);
    let (film, mut record, progress) = if oracle {
        let textures = scene.textures.iter().map(texture::load::load).collect::<Result<Vec<_>>>()?;
        let half = |samples: u32, seed: u32, progress: &dyn Progress| {
            oracle::backend::render(
                &pack::pack(&half_of(scene, samples, seed)?, textures.clone(), None)?,
                progress,
            )
        };
        in_halves(scene, &half, wanted, allowed, options, limit, progress)?
    } else {
        let half = |samples: u32, seed: u32, progress: &dyn Progress| {
            let scene = half_of(scene, samples, seed)?;
            let (prepared, _) =
                sessions.prepare(&scene, &Method::of_pattern(Pattern::Stratified), samples)?;
            prepared.render(progress).map(|(film, _)| film)
        };
        in_halves(scene, &half, wanted, allowed, options, limit, progress)?
    };
    output::write(&film, &path, &WriteOptions::default())?;
    let who = if oracle { "the float64 oracle" } else { "the device" };
    record.kind =
        format!("{} stratified samples a pixel by {who}, in two independent halves", record.samples);
    (record.hash, record.file) = (hash, path.display().to_string());
    Ok(finished(film, record, progress))
}

fn finished(film: Film, record: ReferenceRecord, progress: f64) -> Reference {
    Reference { seen: PerceptualFeatures::of(&film), film, record, progress }
}

fn fits(film: &Film, scene: &Scene) -> bool {
    (film.width, film.height) == (scene.width, scene.height)
}

fn from_file(path: &Path, scene: &Scene, identity: &Hash) -> Result<Reference> {
    let film = read_picture(path)?;
    if !fits(&film, scene) {
        return Err(Error::with_help(
            format!(
                "reference {}: {}×{} pixels, and the study renders {}×{}",
                path.display(),
                film.width,
                film.height,
                scene.width,
                scene.height
            ),
            "name a reference of the same size, or set the study's with --size",
        ));
    }
    let record = ReferenceRecord {
        hash: identity::file(*identity, path)?.hex(),
        kind: "a given picture".into(),
        file: path.display().to_string(),
        ..ReferenceRecord::default()
    };
    Ok(finished(film, record, 0.0))
}

/// Returns the scene without any footprint, with independent jittered samples in each pixel.
fn half_of(scene: &Scene, samples: u32, seed: u32) -> Result<Scene> {
    let mut scene = scene.clone();
    scene.sampling.shared = false;
    scene.sampling.seed = scene.sampling.seed.wrapping_add(seed);
    Method::of_pattern(Pattern::Stratified).apply(&scene, samples)
}

type Half<'a> = dyn Fn(u32, u32, &dyn Progress) -> Result<Film> + 'a;

/// Renders as many samples as wanted, or as the time allows.
fn in_halves(
    scene: &Scene,
    half: &Half<'_>,
    wanted: u32,
    allowed: f64,
    options: &Options,
    limit: &Limit,
    progress: &dyn Progress,
) -> Result<(Film, ReferenceRecord, f64)> {
    let clock = Instant::now();
    let rate = seconds_per_sample(half, wanted, &SubProgress { whole: progress, from: 0.0, to: 0.0 })?;
    let fitting = (0.5 * (allowed - clock.elapsed().as_secs_f64()).max(0.0) / rate)
        .clamp(1.0, f64::from(wanted)) as u32;
    let mut samples = match next_count(Pattern::Stratified, fitting) {
        Some(next) if fitting == wanted => next,
        _ => fitting.isqrt().pow(2),
    };
    // The expected time of the points, if all methods are alike.
    let points: u32 = options.counts.iter().fold(0, |sum, n| sum.saturating_add(*n));
    let methods = options.methods.as_ref().map_or_else(|| Method::all_for(scene).0.len(), Vec::len);
    let rest = f64::from(points) * f64::from(options.repeats) * methods as f64;
    let end = f64::from(2 * samples) / (f64::from(2 * samples) + rest);
    let both = |samples: u32, progress: &dyn Progress| {
        let a = half(samples, SEED_OFFSETS[0], &SubProgress { whole: progress, from: 0.0, to: 0.5 * end })?;
        let b = half(samples, SEED_OFFSETS[1], &SubProgress { whole: progress, from: 0.5 * end, to: end })?;
        Ok(Halves { a, b })
    };
    // A machine that has become slower gets fewer samples, but at least one per half.
    let mut halves = None;
    for share in ATTEMPT_DEADLINES {
        if halves.is_none() && samples > 1 {
            halves = limit.until(share * limit.seconds, progress, |progress| both(samples, progress))?;
            samples = if halves.is_none() { (samples.isqrt() / FEWER).max(1).pow(2) } else { samples };
        }
    }
    let halves = match halves {
        Some(halves) => halves,
        None => {
            samples = 1;
            both(samples, progress)?
        }
    };
    let record = ReferenceRecord {
        samples: 2 * samples,
        seconds: clock.elapsed().as_secs_f64(),
        rmse: Some(halves.rmse()?),
        ..ReferenceRecord::default()
    };
    Ok((halves.mean(), record, end))
}

/// Estimates the time from renders of 1, 4, 16, … samples, until they take so long that neither the
/// constant overhead nor a short disturbance of the machine matters.
fn seconds_per_sample(half: &Half<'_>, wanted: u32, progress: &dyn Progress) -> Result<f64> {
    const CLEAR: f64 = 0.1;
    let timed = |samples: u32| {
        let clock = Instant::now();
        half(samples, 0, progress).map(|_| clock.elapsed().as_secs_f64())
    };
    let one = timed(1)?;
    let mut samples = 4;
    loop {
        let more = timed(samples)? - one;
        if more >= CLEAR || samples >= wanted.isqrt().pow(2) {
            return Ok(more.max(1e-9) / f64::from(samples - 1));
        }
        samples *= 4;
    }
}
