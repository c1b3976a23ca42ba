//! The references of a sheet: pictures of many samples without a prefilter, in two independent halves whose difference
//! tells their own error. Input: a scene with the number of samples. Output: the mean of both halves.

use super::record::ReferenceRecord;
use super::sessions::Sessions;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::lab::metrics::compare;
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::scene::model::Scene;

/// Offsets of the scene's seed, so that no half shares its samples with a cell.
const SEED_OFFSETS: [u32; 2] = [1_000_003, 2_000_003];

pub(super) struct Reference {
    pub(super) film: Film,
    pub(super) features: PerceptualFeatures,
    pub(super) record: ReferenceRecord,
}

impl Reference {
    pub(super) fn of_file(name: &str, film: &Film) -> Reference {
        let record = ReferenceRecord { kind: name.to_owned(), samples: film.samples, rmse: None };
        Reference { features: PerceptualFeatures::of(film), film: film.clone(), record }
    }

    /// Renders a scene twice with its samples, other ones each time.
    pub(super) fn render(
        sessions: &mut Sessions<'_>,
        scene: &Scene,
        progress: &dyn Progress,
    ) -> Result<Reference> {
        let mut half = |i: usize| {
            let mut scene = scene.clone();
            scene.sampling.seed = scene.sampling.seed.wrapping_add(SEED_OFFSETS[i]);
            let part = SubProgress { whole: progress, from: 0.5 * i as f64, to: 0.5 * (i + 1) as f64 };
            sessions.render(&scene, 1, &part).map(|(film, _)| film)
        };
        let (mut film, other) = (half(0)?, half(1)?);
        let rmse = 0.5 * compare(&film, &other)?.rmse;
        for (pixel, other) in film.pixels.iter_mut().zip(&other.pixels) {
            let mean = |c: usize| (0.5 * (f64::from(pixel[c]) + f64::from(other[c]))) as f32;
            *pixel = [0, 1, 2].map(mean);
        }
        film.samples += other.samples;
        let kind = format!("{} stratified samples a pixel without a prefilter", film.samples);
        let record = ReferenceRecord { kind, samples: film.samples, rmse: Some(rmse) };
        Ok(Reference { features: PerceptualFeatures::of(&film), film, record })
    }
}
