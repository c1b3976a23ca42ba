//! What a prefilter leaves that no difference of halves shows: its bias. A few hundred pixels, spread over the
//! picture, are sampled anew without a footprint; by how much more than both variances say they differ
//! from the film is the square of the bias.

use super::{Sums, Tracer};
use crate::error::Result;
use crate::layout::{JOB_BARE, Job};
use crate::progress::Progress;

/// Pixels that are sampled, at most.
const PIXELS: usize = 512;
/// Samples of each half of them.
const SAMPLES: u32 = 512;

/// The root of the mean square of the bias, 0 where chance explains all. The film of the tracer is spoilt.
pub fn bias(
    tracer: &mut dyn Tracer,
    sums: &Sums,
    counts: &[u32],
    variances: &[f32],
    progress: &dyn Progress,
) -> Result<f64> {
    // Steps by the golden section visit a picture evenly.
    let golden = (counts.len() as f64 * 0.618_033_988_75) as usize | 1;
    let mut places: Vec<usize> = (0..PIXELS.min(counts.len())).map(|k| (k * golden) % counts.len()).collect();
    places.sort_unstable();
    places.dedup();
    let job = |&i: &usize, half: u32| {
        let place = Job::place_of(i as u32, sums.width);
        Job { place, part: half | JOB_BARE, first: 0, count: SAMPLES }
    };
    let jobs: Vec<Job> = places.iter().flat_map(|i| [job(i, 0), job(i, 1)]).collect();
    tracer.sample(&jobs, progress)?;
    let mut bare = Sums { halves: sums.halves.clone(), ..*sums };
    tracer.read(&mut bare)?;
    let excess = |&i: &usize| {
        let n = f64::from(counts[i]);
        let (mut apart, mut noise) = (0.0, f64::from(variances[i]));
        for c in 0..3 {
            let film = (f64::from(sums.halves[0][i][c]) + f64::from(sums.halves[1][i][c])) / (2.0 * n);
            let [a, b] = [0, 1].map(|half| f64::from(bare.halves[half][i][c]) / f64::from(SAMPLES));
            apart += (film - 0.5 * (a + b)).powi(2) / 3.0;
            noise += (a - b).powi(2) / 12.0;
        }
        apart - noise
    };
    // Pixels that are no numbers have no bias either.
    let told: Vec<f64> = places.iter().map(excess).filter(|e| e.is_finite()).collect();
    let mean = told.iter().sum::<f64>() / told.len().max(1) as f64;
    Ok(mean.max(0.0).sqrt())
}
