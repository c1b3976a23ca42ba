//! The loop of passes: sample, estimate, audit and choose the next counts, until the goal is met.

use std::collections::BTreeMap;

use super::allocate::{Aim, Allocation};
use super::analytic::{AnalyticPixels, OWN_ERROR, Outlook, needed};
use super::audit::{Audit, Audited, CONFIDENCE, DEVIATE};
use super::auditor::Auditor;
use super::estimate::{Estimate, Exponent};
use super::explore::Explorer;
use super::pace::{PLANNED, Pace};
use super::{Goal, MAX_COUNT, Outcome, PixelEstimates};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::{Range, Rect};
use crate::sampling::{Backend, Block, Count, FilmSums, HalfSums};
use crate::schema::layout::PixelBatch;

/// Samples of each half in the first pass: enough to meet the edge of a shape that covers a tenth of the pixel with a
/// probability of 4 in 5.
const FIRST: u32 = 8;
/// If something small and bright is known to be in the scene: the first pass takes this number of samples divided by
/// its share of the texture, so that a pixel that sees all of it misses it with a probability of 1 in 50.
const FIRST_OF_BRIGHT: f64 = 4.0;
/// Most samples of the first pass, per pixel and in the whole picture.
const MAX_FIRST: f64 = 1024.0;
const MAX_FIRST_IN_ALL: f64 = (1u64 << 25) as f64;
/// Fraction of the remaining time for which a pass is planned.
const OF_TIME: f64 = 0.85;
/// Fraction of the whole time that is reserved for the last audit.
const AUDIT_TIME: f64 = 0.08;
/// A time limit counts as met if it is exceeded by no more than this factor.
const KEPT: f64 = 1.05;
/// Rows of the film that are made at once.
const FILM_ROWS: u32 = 64;
/// A goal is met if the audit's estimate is below it and the interval ends below this multiple of it.
const SURE: f64 = 1.25;
/// Audits that may refuse the goal, each with more samples, before it counts as out of reach.
const MAX_REFUSALS: u32 = 12;

/// The result of a run.
pub struct Run {
    pub film: Film,
    pub outcome: Outcome,
    pub estimates: PixelEstimates,
}

/// Samples until the goal is met. Audits do not change the film.
pub fn run(
    backend: &mut dyn Backend,
    [width, height]: [u32; 2],
    goal: Goal,
    progress: &dyn Progress,
) -> Result<Run> {
    let start = backend.seconds();
    let pixels = width as usize * height as usize;
    let mut sums = HalfSums::new([width, height]);
    let mut counts = vec![0u32; pixels];
    let first = first_count(goal, backend.bright_share(), pixels);
    let bright = backend.bright_share() < 1.0;
    let mut next = backend.first_samples(if let Goal::Seconds(_) = goal { 1 } else { first }, pixels)?;
    let mut outcome = Outcome { confidence: CONFIDENCE, ..Outcome::default() };
    let mut taken;
    let mut exponent = Exponent::default();
    let mut analytic = AnalyticPixels::default();
    let mut explorer = Explorer::default();
    let mut auditor = Auditor::default();
    let mut pace = Pace::default();
    let mut errors: Vec<f32>;
    loop {
        if next != counts {
            let begun = backend.seconds();
            match (equal(&counts), equal(&next)) {
                (Some(now), Some(next)) => backend.sample_all([width, height], now, next - now, progress)?,
                _ => backend.sample(&batches(&counts, &next, width), progress)?,
            }
            pace.learn(total(&next) - total(&counts), backend.seconds() - begun);
            counts.clone_from(&next);
            outcome.passes += 1;
        }
        let begun = backend.seconds();
        backend.read(&mut sums)?;
        analytic.replace(&mut sums, &counts);
        taken = total(&counts);

        let mut estimate = Estimate::new(&sums, &counts, bright);
        analytic.clear_variances(&mut estimate);
        errors = estimate.variances.iter().map(|variance| variance.sqrt()).collect();
        exponent.learn(taken, estimate.mse);
        outcome.beam_pixels = analytic.resolved() as u64;
        let resolved = outcome.beam_pixels as f64 / pixels as f64;
        let noise = estimate.mse + OWN_ERROR.powi(2) * resolved;
        outcome.estimated_noise = noise.sqrt();
        pace.hosting = backend.seconds() - begun;
        let all = match goal {
            Goal::Samples(spp) => f64::from(spp) * pixels as f64,
            Goal::Error(_) => f64::INFINITY,
            Goal::Seconds(limit) => {
                let left = limit * (1.0 - AUDIT_TIME) - (backend.seconds() - start) - pace.hosting;
                taken + pace.rate * left.max(0.0) * OF_TIME
            }
        };
        let enough = match goal {
            Goal::Error(rmse) => outcome.estimated_noise <= rmse,
            Goal::Samples(_) | Goal::Seconds(_) => {
                taken * 1.02 >= all || estimate.mse == 0.0 && resolved == 1.0
            }
        };

        let budget = auditor.budget(goal, taken, bright, pace.rate, backend.seconds() - start);
        let audited = Audited { sums: &sums, counts: &counts, estimate: &estimate, analytic: &analytic };
        let audit = if enough && auditor.is_due(goal, budget) {
            Some(auditor.audit(&audited, backend, budget, &mut outcome, progress)?)
        } else {
            None
        };
        outcome.note(noise, estimate.deviation, audit.as_ref(), backend.prefilters());
        let weight = estimate.weight();
        if enough {
            let Goal::Error(rmse) = goal else { break };
            let sure = outcome.interval.is_none_or(|[_, high]| high <= SURE * rmse);
            outcome.reached = outcome.estimated_rmse <= rmse && sure;
            // More samples lower noise, but not the bias of a footprint.
            if outcome.reached || backend.prefilters() || auditor.refusals == MAX_REFUSALS {
                break;
            }
            auditor.refusals += 1;
        }

        explorer.spread(&mut estimate, &counts, width as usize);
        if let Some(audit) = &audit {
            let raised = audit.raise(&mut estimate.variances, &counts, width as usize);
            explorer.look_at(&raised, &estimate);
        }
        let aim = match goal {
            Goal::Samples(_) | Goal::Seconds(_) => Aim::Samples(all),
            // In the allocation's measure, which includes the variance that may have been missed.
            Goal::Error(rmse) => Aim::Mse((rmse * PLANNED).powi(2) * weight * auditor.strictness(noise)),
        };
        let allocation = Allocation::new(&estimate, &counts, exponent.value());
        let needed = needed(&allocation, aim);
        let elapsed = backend.seconds() - start;
        let outlook = Outlook {
            goal,
            passes: outcome.passes,
            elapsed,
            mse: estimate.mse,
            exponent: exponent.value(),
            left: Outlook::left(goal, elapsed, (needed - taken) / pace.rate),
        };
        let whole = Rect::whole([width, height]);
        if analytic.resolve(backend, whole, &outlook, &estimate, &allocation, progress)? {
            continue;
        }
        let idle = pace.idle(goal, elapsed, outcome.estimated_noise, exponent.value());
        let short = equal(&counts).filter(|now| *now < first);
        next = match (short.or(equal(&counts)), idle) {
            // A time limit begins with one sample in each half, to measure the rate.
            (Some(now), _) if short.is_some() => {
                let most = all / (2 * pixels) as f64;
                vec![(most as u32).clamp(now, first); pixels]
            }
            (Some(now), Some(factor)) => vec![(now * factor).min(MAX_COUNT); pixels],
            _ => {
                let mut next = allocation.counts(aim, &counts, growth(goal), MAX_COUNT);
                // If no pixel that matters may have more samples, exploring does not help either.
                if next != counts || enough {
                    explorer.visit(&mut next, &counts, &estimate);
                }
                next
            }
        };
        if next == counts {
            // No pixel that matters may have more samples; the result is recorded all the same.
            if audit.is_none() {
                let audited =
                    Audited { sums: &sums, counts: &counts, estimate: &estimate, analytic: &analytic };
                let audit = auditor.audit(&audited, backend, budget, &mut outcome, progress)?;
                outcome.note(noise, estimate.deviation, Some(&audit), backend.prefilters());
            }
            break;
        }
        progress.advance((taken / total(&next)).min(1.0));
    }
    outcome.mean_samples = taken / pixels as f64;
    outcome.least_samples = 2 * counts.iter().copied().min().unwrap_or(0);
    outcome.most_samples = 2 * counts.iter().copied().max().unwrap_or(0);
    outcome.reached = match goal {
        Goal::Samples(_) => true,
        Goal::Error(_) => outcome.reached,
        Goal::Seconds(limit) => backend.seconds() - start <= KEPT * limit,
    };
    let film = film(&sums, &counts)?;
    let samples = counts.iter().map(|count| 2 * count).collect();
    Ok(Run { film, outcome, estimates: PixelEstimates { samples, errors } })
}

impl Outcome {
    /// Records the larger of the two estimates, which both err at random, and the larger of their bounds.
    fn note(&mut self, noise: f64, deviation: f64, audit: Option<&Audit>, prefilters: bool) {
        let mse = audit.map_or(noise, |audit| audit.mse.max(noise));
        self.estimated_rmse = mse.sqrt();
        self.estimated_bias = if prefilters { (mse - noise).max(0.0).sqrt() } else { 0.0 };
        self.interval = audit
            .and_then(|audit| audit.interval)
            .map(|[low, high]| [low.min(mse).sqrt(), high.max(noise + DEVIATE * deviation).sqrt()]);
    }
}

/// Returns the largest factor by which a pixel's count grows from one pass to the next, as its variance is only roughly
/// known. With a fixed number of samples each one counts; otherwise fewer passes are better.
fn growth(goal: Goal) -> f64 {
    if let Goal::Samples(_) = goal { 8.0 } else { 16.0 }
}

/// Returns the samples of each half before anything is known about the pixels.
fn first_count(goal: Goal, bright_share: f64, pixels: usize) -> u32 {
    let most = (MAX_FIRST_IN_ALL / pixels as f64).min(MAX_FIRST) / 2.0;
    let bright = (FIRST_OF_BRIGHT / bright_share / 2.0).min(most) as u32;
    let first = if bright_share < 1.0 { bright.max(FIRST).next_power_of_two() } else { FIRST };
    match goal {
        Goal::Samples(spp) => {
            (spp / 8).clamp(1, FIRST).max(if bright_share < 1.0 { (spp / 4).min(first) } else { 1 })
        }
        Goal::Error(_) | Goal::Seconds(_) => first,
    }
}

/// Returns the count of all pixels if it is the same for all.
fn equal(counts: &[u32]) -> Option<u32> {
    counts.first().copied().filter(|first| counts.iter().all(|n| n == first))
}

/// Returns the samples of both halves.
fn total(counts: &[u32]) -> f64 {
    2.0 * counts.iter().map(|&n| f64::from(n)).sum::<f64>()
}

/// Returns the batches that take each half of each pixel from `counts` to `next` samples, longest first, so that
/// neighbouring threads have equal amounts of work.
fn batches(counts: &[u32], next: &[u32], width: u32) -> Vec<PixelBatch> {
    // There are few different lengths, so pixels are put into buckets instead of sorted.
    let mut lengths: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (i, (&now, &next)) in (0..).zip(counts.iter().zip(next)) {
        if next > now {
            lengths.entry(next - now).or_default().push(i);
        }
    }
    let batch = |i: u32, half, count| PixelBatch {
        place: PixelBatch::place_of(i, width),
        part: PixelBatch::part_of(half),
        first: counts[i as usize],
        count,
    };
    let both = |(count, pixels): (u32, Vec<u32>)| {
        let pair = |i: u32| [batch(i, 0, count), batch(i, 1, count)];
        pixels.into_iter().flat_map(pair).collect::<Vec<_>>()
    };
    lengths.into_iter().rev().flat_map(both).collect()
}

/// Returns the means over both halves; the samples of the second half follow those of the first.
fn film(sums: &HalfSums, counts: &[u32]) -> Result<Film> {
    let mean = total(counts) / counts.len() as f64;
    let most = counts.iter().copied().max().unwrap_or(0);
    let mut film = Film::new(sums.width, sums.height, mean.round() as u32);
    for pixels in Rect::whole([sums.width, sums.height]).strips(FILM_ROWS) {
        let first = pixels.y as usize * sums.width as usize;
        let places = first..first + pixels.area();
        let half = |half: u32| {
            let own = &sums.halves[half as usize][places.clone()];
            let mut block = Block::new(Range { pixels, samples: half * most..(half + 1) * most });
            block.sums = own.iter().map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect();
            block.squares = own.iter().map(|&[.., squares]| f64::from(squares)).collect();
            block.count = Count::Each(counts[places.clone()].to_vec());
            FilmSums::from(block)
        };
        let mut both = half(0);
        both.merge(half(1))?;
        both.write_to(&mut film);
    }
    Ok(film)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_count_differs_from_several() {
        assert_eq!([equal(&[3, 3, 3]), equal(&[3, 4, 3]), equal(&[])], [Some(3), None, None]);
    }

    #[test]
    fn what_is_small_and_bright_is_looked_for_from_the_first_pass_on() {
        let first = |goal, share| first_count(goal, share, 1 << 14);
        assert_eq!(first(Goal::Error(1e-3), 1.0), 8);
        assert_eq!(first(Goal::Error(1e-3), 0.01), 256, "400 samples a pixel");
        assert_eq!(first(Goal::Error(1e-3), 1e-6), 512, "no more than 1024");
        assert_eq!(first_count(Goal::Error(1e-3), 1e-6, 1 << 22), 8, "nor than 2^25 in the picture");
        assert_eq!(first(Goal::Samples(64), 1.0), 8);
        assert_eq!(first(Goal::Samples(64), 0.01), 16, "half of what there is");
    }
}
