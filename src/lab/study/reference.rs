//! The reference of a study: a picture file, or the scene rendered with many samples in two
//! independent halves (`halves.rs`), on the device or by the oracle.

use std::path::Path;

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::lab::metrics::read_picture;
use crate::oracle;
use crate::output::{self, WriteOptions};
use crate::pack;
use crate::scene::MAX_SPP;
use crate::scene::model::{Pattern, Scene};
use crate::texture;

use super::halves::Halves;
use super::identity::{self, Hash};
use super::limit::Limit;
use super::method::Method;
use super::record::ReferenceRecord;
use super::refine::COARSE;
use super::session_cache::SessionCache;
use super::{Options, ReferenceChoice, plan};

pub const FILE: &str = "reference.exr";
/// Samples of the reference relative to those of the longest point: since errors fall at least with
/// the root of the number, the reference's own is at most an eighth.
const SAMPLE_FACTOR: u32 = 64;
/// So many methods are expected to go on after a coarse pass.
const GOING_ON: f64 = 4.0;

pub struct Reference {
    pub film: Film,
    pub seen: PerceptualFeatures,
    pub record: ReferenceRecord,
    /// The progress of the study at this point.
    pub progress: f64,
    /// A sentence if it has fewer samples than it should have.
    pub note: Option<String>,
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
        let note = few(record.samples, wanted, limit);
        return Ok(Reference { note, ..finished(film, record, 0.0) });
    }
    let [renders, rest] = planned(scene, options)?;
    let halves = Halves { wanted, rest, renders, limit };
    let (film, mut record, progress) = if oracle {
        let textures = scene.textures.iter().map(texture::load::load).collect::<Result<Vec<_>>>()?;
        let half = |samples: u32, seed: u32, progress: &dyn Progress| {
            oracle::backend::render(
                &pack::pack(&half_of(scene, samples, seed)?, textures.clone(), None)?,
                progress,
            )
        };
        halves.render(&half, progress)?
    } else {
        let half = |samples: u32, seed: u32, progress: &dyn Progress| {
            let scene = half_of(scene, samples, seed)?;
            let (prepared, _) =
                sessions.prepare(&scene, &Method::of_pattern(Pattern::Stratified), samples)?;
            prepared.render(progress).map(|(film, _)| film)
        };
        halves.render(&half, progress)?
    };
    output::write(&film, &path, &WriteOptions::default())?;
    let who = if oracle { "the float64 oracle" } else { "the device" };
    record.kind =
        format!("{} stratified samples a pixel by {who}, in two independent halves", record.samples);
    (record.hash, record.file) = (hash, path.display().to_string());
    let note = few(record.samples, wanted, limit);
    Ok(Reference { note, ..finished(film, record, progress) })
}

/// Returns a note if there are fewer samples than in two halves of `wanted`.
fn few(samples: u32, wanted: u32, limit: &Limit) -> Option<String> {
    let all = wanted.saturating_mul(2);
    (samples < all).then(|| {
        format!(
            "the reference has {samples} samples a pixel instead of {all}: \
             no room within --seconds {}",
            limit.seconds
        )
    })
}

/// Returns the renders of the study, and the camera rays a pixel of all of them.
fn planned(scene: &Scene, options: &Options) -> Result<[f64; 2]> {
    let methods = options.methods.clone().unwrap_or_else(|| Method::all_for(scene).0);
    let of = |counts: &[u32]| -> Result<[f64; 2]> {
        let points = plan::points(&methods, scene, counts)?;
        Ok([points.len() as f64, points.iter().map(|point| f64::from(point.samples)).sum()])
    };
    let all = of(&options.counts)?.map(|value| value * f64::from(options.repeats));
    if !options.best {
        return Ok(all);
    }
    let few: Vec<u32> = options.counts.iter().copied().filter(|count| *count <= COARSE).collect();
    let coarse = of(&few)?;
    let part = (GOING_ON / methods.len().max(1) as f64).min(1.0);
    Ok([0, 1].map(|i| coarse[i] + part * all[i]))
}

fn finished(film: Film, record: ReferenceRecord, progress: f64) -> Reference {
    Reference { seen: PerceptualFeatures::of(&film), film, record, progress, note: None }
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
