//! Samples where they lower the error most: jobs for a tracer out, sums of two independent halves in,
//! until a goal is met. Each pass estimates every pixel's error from the halves and from the spread of
//! its samples (Rousselle et al. 2011, "Adaptive Sampling and Reconstruction"), and asks for what a
//! Lagrange multiplier gives each pixel so that the whole picture's error falls fastest.

mod allocate;
mod bias;
mod estimate;
mod exact;

use std::collections::BTreeMap;
use std::time::Instant;

use serde::Serialize;

use crate::error::Result;
use crate::film::Film;
use crate::layout::Job;
use crate::progress::Progress;

use allocate::{Aim, Allocation};
use bias::bias;
use estimate::Estimate;
use exact::{Exact, OWN_ERROR, Outlook, needed};

pub use exact::Trial;

/// What ends the sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Samples a pixel, on average.
    Samples(u32),
    /// The picture's RMSE against its converged self.
    Error(f64),
    /// Wall seconds of sampling.
    Seconds(f64),
}

/// Who takes the samples.
pub trait Tracer {
    /// Adds the samples of each job to its pixel of its half. No two jobs of a call are of one pixel and
    /// one half.
    fn sample(&mut self, jobs: &[Job], progress: &dyn Progress) -> Result<()>;
    /// Adds as many samples to both halves of all pixels of a picture of that size.
    fn sample_all(
        &mut self,
        [width, height]: [u32; 2],
        first: u32,
        count: u32,
        progress: &dyn Progress,
    ) -> Result<()> {
        let job = |i: u32| Job { place: Job::place_of(i >> 1, width), part: i & 1, first, count };
        self.sample(&(0..2 * width * height).map(job).collect::<Vec<_>>(), progress)
    }
    /// Whether samples are averages over footprints.
    fn prefilters(&self) -> bool;
    /// The sums so far.
    fn read(&mut self, sums: &mut Sums) -> Result<()>;
    /// Samples of each half of each pixel in the first pass, at most so many: fewer where it is known that little
    /// is missed.
    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        Ok(vec![most; pixels])
    }
    /// Tells a part of the picture without samples, to see what that takes. None where it cannot.
    fn trial(&mut self, _: &dyn Progress) -> Result<Option<Trial>> {
        Ok(None)
    }
    /// Tells the whole picture: of each pixel red, green, blue and 0, or a last 1 where it needs samples.
    fn tell(&mut self, _: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        Ok(Vec::new())
    }
}

/// Of each half, row by row: sums of red, green, blue, and of their squares' mean.
pub struct Sums {
    pub width: u32,
    pub height: u32,
    pub halves: [Vec<[f32; 4]>; 2],
}

/// What was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// RMSE of the noise, by the difference of the halves.
    pub estimated_rmse: f64,
    /// RMSE of the prefilter's bias, which the halves have in common.
    pub estimated_bias: f64,
    pub passes: u32,
    pub mean_samples: f64,
    pub least_samples: u32,
    pub most_samples: u32,
    /// Pixels that one beam tells: they have no noise, and their samples do not count.
    pub beam_pixels: u64,
    /// Whether the goal was met before the limit of samples.
    pub reached: bool,
}

/// Samples of each half in the first pass: enough to meet the edge of a shape that covers a tenth of the
/// pixel with a chance of 4 in 5.
const FIRST: u32 = 8;
/// A pixel's count grows at most so much from one pass to the next: what is known of it is that rough. Towards a
/// fixed number of samples each one counts; else fewer passes do.
fn growth(goal: Goal) -> f64 {
    if let Goal::Samples(_) = goal { 8.0 } else { 16.0 }
}

/// Samples of a half: f32 sums of so many stay exact enough.
const MOST: u32 = 1 << 16;
/// The estimate leans towards pixels whose halves agree by chance. It is believed when it lies below the goal
/// by the first factor; passes are planned for the second, so that few are needed.
const BELIEVED: f64 = 0.94;
const PLANNED: f64 = 0.91;
/// Counts of a device that is idle grow at most so much at once.
const MOST_IDLE: f64 = 64.0;
/// Part of the remaining time that a pass is planned for.
const OF_TIME: f64 = 0.85;

pub fn run(
    tracer: &mut dyn Tracer,
    [width, height]: [u32; 2],
    goal: Goal,
    progress: &dyn Progress,
) -> Result<(Film, Outcome)> {
    let start = Instant::now();
    let pixels = width as usize * height as usize;
    let half = || vec![[0.0; 4]; pixels];
    let mut sums = Sums { width, height, halves: [half(), half()] };
    let mut counts = vec![0u32; pixels];
    let mut next = tracer.first_samples(first_count(goal), pixels)?;
    let mut outcome = Outcome::default();
    let mut taken;
    let mut exponent = estimate::Exponent::default();
    let mut exact = Exact::default();
    let mut pace = Pace::default();
    let estimate = loop {
        if next != counts {
            let clock = Instant::now();
            match (equal(&counts), equal(&next)) {
                (Some(now), Some(next)) => tracer.sample_all([width, height], now, next - now, progress)?,
                _ => tracer.sample(&jobs(&counts, &next, width), progress)?,
            }
            pace.learn(total(&next) - total(&counts), clock.elapsed().as_secs_f64());
            counts.clone_from(&next);
            outcome.passes += 1;
        }
        let clock = Instant::now();
        tracer.read(&mut sums)?;
        exact.replace(&mut sums, &counts);
        taken = total(&counts);

        let mut estimate = Estimate::new(&sums, &counts);
        exact.settle(&mut estimate);
        exponent.learn(taken, estimate.mse);
        outcome.beam_pixels = exact.told() as u64;
        let told = outcome.beam_pixels as f64 / pixels as f64;
        outcome.estimated_rmse = estimate.mse.sqrt().hypot(OWN_ERROR * told.sqrt());
        pace.hosting = clock.elapsed().as_secs_f64();
        let elapsed = start.elapsed().as_secs_f64();
        let aim = match goal {
            Goal::Samples(spp) => Aim::Samples(f64::from(spp) * pixels as f64),
            // In the allocation's measure, which weighs what may have been missed too.
            Goal::Error(rmse) => Aim::Mse((rmse * PLANNED).powi(2) * estimate.weight()),
            Goal::Seconds(limit) => {
                Aim::Samples(taken + pace.rate * (limit - elapsed - pace.hosting).max(0.0) * OF_TIME)
            }
        };
        outcome.reached = match (aim, goal) {
            (Aim::Mse(_), Goal::Error(rmse)) => outcome.estimated_rmse <= rmse * BELIEVED,
            (Aim::Mse(_), _) => false,
            (Aim::Samples(all), _) => taken * 1.02 >= all || estimate.mse == 0.0 && told == 1.0,
        };
        if outcome.reached {
            break estimate;
        }
        let allocation = Allocation::new(&estimate, &counts, exponent.value());
        let needed = needed(&allocation, aim);
        let outlook = Outlook {
            goal,
            passes: outcome.passes,
            elapsed,
            mse: estimate.mse,
            exponent: exponent.value(),
            left: Outlook::left(goal, elapsed, (needed - taken) / pace.rate),
        };
        if exact.tell(tracer, &outlook, &estimate, &allocation, progress)? {
            continue;
        }
        let idle = pace.idle(goal, elapsed, outcome.estimated_rmse, exponent.value());
        next = match (equal(&counts), idle) {
            (Some(now), Some(factor)) => vec![(now * factor).min(MOST); pixels],
            _ => allocation.counts(aim, &counts, growth(goal), MOST),
        };
        if next == counts {
            break estimate;
        }
        progress.advance((taken / total(&next)).min(1.0));
    };
    outcome.mean_samples = taken / pixels as f64;
    outcome.least_samples = 2 * counts.iter().copied().min().unwrap_or(0);
    outcome.most_samples = 2 * counts.iter().copied().max().unwrap_or(0);
    if tracer.prefilters() {
        outcome.estimated_bias = bias(tracer, &sums, &counts, &estimate.variances, progress)?;
        if let Goal::Error(rmse) = goal {
            outcome.reached &= outcome.estimated_rmse.hypot(outcome.estimated_bias) <= rmse;
        }
    }
    Ok((film(&sums, &counts), outcome))
}

/// How fast samples are taken, and how long the host thinks about them.
#[derive(Default)]
struct Pace {
    /// Samples a second, and the seconds that they took, in the last pass.
    rate: f64,
    sampling: f64,
    hosting: f64,
}

impl Pace {
    fn learn(&mut self, samples: f64, seconds: f64) {
        (self.rate, self.sampling) = (samples / seconds.max(1e-9), seconds);
    }

    /// Of a device that mostly waits for the host: by how much all counts may grow until both work alike, or the
    /// goal is met. That costs less than to think of where samples are wanted most.
    fn idle(&self, goal: Goal, elapsed: f64, rmse: f64, exponent: f64) -> Option<u32> {
        let (time, most) = match goal {
            Goal::Samples(_) => return None,
            Goal::Error(wanted) => (f64::INFINITY, (rmse / (PLANNED * wanted)).powf(2.0 / exponent)),
            Goal::Seconds(limit) => (0.5 * (limit - elapsed), MOST_IDLE),
        };
        let factor = self.hosting.min(time) / self.sampling.max(1e-9);
        let factor = factor.min(most.max(2.0)).min(MOST_IDLE);
        (factor >= 2.0).then(|| 1 << (factor as u32).ilog2())
    }
}

/// The count of all pixels, if it is one.
fn equal(counts: &[u32]) -> Option<u32> {
    counts.first().copied().filter(|first| counts.iter().all(|n| n == first))
}

fn first_count(goal: Goal) -> u32 {
    match goal {
        Goal::Samples(spp) => (spp / 8).clamp(1, FIRST),
        Goal::Error(_) | Goal::Seconds(_) => FIRST,
    }
}

/// Of both halves.
fn total(counts: &[u32]) -> f64 {
    2.0 * counts.iter().map(|&n| f64::from(n)).sum::<f64>()
}

/// From `counts` to `next` samples in each half of each pixel, longest first: neighbouring threads then
/// have equally much to do.
fn jobs(counts: &[u32], next: &[u32], width: u32) -> Vec<Job> {
    // Few lengths occur, so pixels are dealt out by length instead of sorted.
    let mut lengths: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (i, (&now, &next)) in (0..).zip(counts.iter().zip(next)) {
        if next > now {
            lengths.entry(next - now).or_default().push(i);
        }
    }
    let job = |i: u32, half, count| Job {
        place: Job::place_of(i, width),
        part: half,
        first: counts[i as usize],
        count,
    };
    let both = |(count, pixels): (u32, Vec<u32>)| {
        let pair = |i: u32| [job(i, 0, count), job(i, 1, count)];
        pixels.into_iter().flat_map(pair).collect::<Vec<_>>()
    };
    lengths.into_iter().rev().flat_map(both).collect()
}

fn film(sums: &Sums, counts: &[u32]) -> Film {
    let mean = total(counts) / counts.len() as f64;
    let mut film = Film::new(sums.width, sums.height, mean.round() as u32);
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let sum = |c: usize| f64::from(sums.halves[0][i][c]) + f64::from(sums.halves[1][i][c]);
        *pixel = std::array::from_fn(|c| (sum(c) / (2.0 * f64::from(counts[i]))) as f32);
    }
    film
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_grow_where_a_device_waits_for_the_host_and_no_further_than_to_the_goal() {
        let waits = Pace { rate: 1e9, sampling: 1e-3, hosting: 0.2 };
        assert_eq!(waits.idle(Goal::Seconds(10.0), 1.0, 1e-2, 1.6), Some(64));
        assert_eq!(waits.idle(Goal::Seconds(1.02), 1.0, 1e-2, 1.6), Some(8), "half of what is left");
        // Samples that lower the error by half are 2^(2 / 1.6) = 2.4 times as many; with what is planned beyond 2.7.
        assert_eq!(waits.idle(Goal::Error(5e-3), 1.0, 1e-2, 1.6), Some(2));
        assert_eq!(waits.idle(Goal::Error(1e-5), 1.0, 1e-2, 1.6), Some(64));
        assert_eq!(waits.idle(Goal::Samples(64), 1.0, 1e-2, 1.6), None);
        let works = Pace { sampling: 0.15, ..waits };
        assert_eq!(works.idle(Goal::Seconds(10.0), 1.0, 1e-2, 1.6), None);
    }

    #[test]
    fn one_count_is_told_from_several() {
        assert_eq!([equal(&[3, 3, 3]), equal(&[3, 4, 3]), equal(&[])], [Some(3), None, None]);
    }
}
