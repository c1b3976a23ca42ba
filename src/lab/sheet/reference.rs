//! The references of a sheet: pictures by equal samples without a prefilter, in two independent halves whose difference
//! tells their own error. Input: a scene, and how many samples or how much time a reference may take. Output: both
//! halves, and their mean.

use std::time::Instant;

use super::record::ReferenceRecord;
use super::sessions::Sessions;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::lab::metrics::{Estimate, Halves, compare};
use crate::render::Prepared;
use crate::scene::model::Scene;

/// Offsets of the scene's seed, so that no half shares its samples with a cell.
const SEED_OFFSETS: [u32; 2] = [1_000_003, 2_000_003];
/// Samples of each half in the first run; each further one doubles their number.
const FIRST_RUN: u32 = 4;
/// The share of the samples so far below which a last, shorter run is not worth its while.
const MIN_SHARE: f64 = 0.1;

/// How far a reference goes.
#[derive(Clone, Copy)]
pub(super) enum Extent<'a> {
    /// So many samples in each half.
    Samples(u32),
    /// Until it is good enough, but about so many seconds.
    Enough { seconds: f64, is_enough: &'a dyn Fn(&Halves) -> Result<bool> },
}

pub(super) struct Reference {
    pub(super) film: Film,
    pub(super) features: PerceptualFeatures,
    pub(super) record: ReferenceRecord,
    /// What it is the mean of, unless it is a file.
    pub(super) halves: Option<Halves>,
}

impl Reference {
    pub(super) fn of_file(name: &str, film: &Film) -> Reference {
        let record = ReferenceRecord { kind: name.to_owned(), samples: film.samples, ..Default::default() };
        Reference { features: PerceptualFeatures::of(film), film: film.clone(), record, halves: None }
    }

    /// Renders a scene in two halves, each by samples of its own. The scene's number of samples is the most of a half.
    pub(super) fn render(
        sessions: &mut Sessions<'_>,
        scene: &Scene,
        extent: Extent<'_>,
        progress: &dyn Progress,
    ) -> Result<Reference> {
        let session = sessions.session(scene)?;
        let half = |offset: u32| {
            let mut scene = scene.clone();
            scene.sampling.seed = scene.sampling.seed.wrapping_add(offset);
            session.prepare_sampling(&scene)
        };
        let both = [half(SEED_OFFSETS[0])?, half(SEED_OFFSETS[1])?];
        let clock = Instant::now();
        let halves = match extent {
            Extent::Samples(count) => run(&both, [0, count], progress)?,
            Extent::Enough { seconds, is_enough } => {
                grown(&both, scene.sampling.spp, seconds, is_enough, progress)?
            }
        };
        let seconds = clock.elapsed().as_secs_f64();
        let film = halves.mean();
        let kind = format!("{} Sobol-Owen samples a pixel without a prefilter", film.samples);
        let record = ReferenceRecord { kind, samples: film.samples, rmse: Some(halves.rmse()?), seconds };
        Ok(Reference { features: PerceptualFeatures::of(&film), film, record, halves: Some(halves) })
    }

    /// Returns the mean squared error of a picture; `None` if a pixel is no number.
    pub(super) fn mse_of(&self, film: &Film) -> Result<Option<Estimate>> {
        if let Some(halves) = &self.halves {
            return halves.mse_of(film);
        }
        let compared = compare(film, &self.film)?;
        let is_number = compared.nan_pixels == 0 && compared.mse.is_finite();
        Ok(is_number.then_some(Estimate { value: compared.mse, deviation: 0.0 }))
    }
}

/// Renders the samples from one number to another of both halves.
fn run(both: &[Prepared<'_, '_>; 2], [from, to]: [u32; 2], progress: &dyn Progress) -> Result<Halves> {
    let part = |from: f64, to: f64| SubProgress { whole: progress, from, to };
    let a = both[0].render_run(from..to, &part(0.0, 0.5))?;
    Ok(Halves { a, b: both[1].render_run(from..to, &part(0.5, 1.0))? })
}

/// Takes ever more samples until they are enough, or the time is over. They are those of one sequence, so that each run
/// refines the ones before.
fn grown(
    both: &[Prepared<'_, '_>; 2],
    most: u32,
    seconds: f64,
    is_enough: &dyn Fn(&Halves) -> Result<bool>,
    progress: &dyn Progress,
) -> Result<Halves> {
    let clock = Instant::now();
    let spent = || clock.elapsed().as_secs_f64();
    let mut count = FIRST_RUN.min(most);
    let mut halves = run(both, [0, count], &SubProgress { whole: progress, from: 0.0, to: 0.0 })?;
    let mut rate = spent() / f64::from(count);
    while count < most && !is_enough(&halves)? {
        let begun = spent();
        let fitting = ((seconds - begun).max(0.0) / rate.max(1e-9)).min(f64::from(count)) as u32;
        if f64::from(fitting) < MIN_SHARE * f64::from(count) {
            break;
        }
        let to = (count + fitting).min(most);
        let done = (begun / seconds).min(1.0);
        halves.add(&run(both, [count, to], &SubProgress { whole: progress, from: done, to: done })?);
        rate = (spent() - begun) / f64::from(to - count);
        count = to;
    }
    progress.advance(1.0);
    Ok(halves)
}
