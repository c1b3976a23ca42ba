//! The loop of passes: sample, estimate, audit and choose the next counts, until the goal is met.

use super::analytic::{OWN_ERROR, Outlook, Resolution};
use super::audit::{Audit, CONFIDENCE, DEVIATE};
use super::auditor::Auditor;
use super::estimate::Exponent;
use super::host_pixels::HostPixels;
use super::pace::{PLANNED, Pace};
use super::{Goal, MAX_COUNT, Outcome, PixelEstimates};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::sampling::{Aim, Backend, Pixels, Plan};

/// Samples of each half in the first pass: enough to meet the edge of a shape that covers a tenth of the pixel with a
/// probability of 4 in 5.
const FIRST: u32 = 8;
/// If something small and bright is known to be in the scene: the first pass takes this number of samples divided by
/// its share of the texture, so that a pixel that sees all of it misses it with a probability of 1 in 50.
const FIRST_OF_BRIGHT: f64 = 4.0;
/// Most samples of the first pass, per pixel and in the whole picture.
const MAX_FIRST: f64 = 1024.0;
const MAX_FIRST_IN_ALL: f64 = (1u64 << 25) as f64;
/// Fraction of the remaining time for which a pass is planned: of the same number of samples in each pixel; of samples
/// that are placed for the first time, which take up to four times as long, where what errs is seen by few pixels and all
/// others show an empty background; and of more of them, whose rate is known.
const OF_TIME_OF_EQUAL: f64 = 0.6;
const OF_TIME_AT_FIRST: f64 = 0.25;
const OF_TIME: f64 = 0.85;
/// Fraction of the whole time that a first pass may take if the rate is known.
const OF_FIRST: f64 = 0.4;
/// Fraction of the whole time that is reserved for the last audit.
const AUDIT_TIME: f64 = 0.08;
/// A goal is met if the audit's estimate is below it and the interval ends below this multiple of it.
const SURE: f64 = 1.25;
/// Audits that may refuse the goal, each with more samples, before it counts as out of reach.
const MAX_REFUSALS: u32 = 12;

/// The result of a run.
pub struct Run {
    pub film: Film,
    pub outcome: Outcome,
    /// If they were asked for.
    pub estimates: Option<PixelEstimates>,
}

/// Samples until the goal is met, into a black film. Audits do not change it. `tells_pixels` asks for the estimates of single pixels;
/// `rate` is the number of samples per second, if that is known.
pub fn run(
    backend: &mut dyn Backend,
    film: Film,
    goal: Goal,
    tells_pixels: bool,
    rate: Option<f64>,
    progress: &dyn Progress,
) -> Result<Run> {
    if backend.keeps_pixels()
        && let Some(mut pixels) = backend.kept_pixels()?
    {
        return passes(&mut *pixels, film, goal, tells_pixels, rate, progress);
    }
    let size = [film.width, film.height];
    passes(&mut HostPixels::new(backend, size), film, goal, tells_pixels, rate, progress)
}

fn passes(
    pixels: &mut dyn Pixels,
    mut film: Film,
    goal: Goal,
    tells_pixels: bool,
    rate: Option<f64>,
    progress: &dyn Progress,
) -> Result<Run> {
    let start = pixels.backend().seconds();
    let [width, height] = [film.width, film.height];
    let number = f64::from(width) * f64::from(height);
    let (bright_share, prefilters) = (pixels.backend().bright_share(), pixels.backend().prefilters());
    let bright = bright_share < 1.0;
    let first = first_count(goal, bright_share, number);
    pixels.plan_first(first_of_time(goal, rate, number).min(first))?;
    let mut is_planned = true;
    let mut outcome = Outcome { confidence: CONFIDENCE, ..Outcome::default() };
    let mut before = 0.0;
    let mut exponent = Exponent::default();
    let mut resolution = Resolution::default();
    let mut auditor = Auditor::default();
    let mut pace = Pace::default();
    let seen = loop {
        let begun = pixels.backend().seconds();
        if is_planned {
            pixels.sample(progress)?;
            outcome.passes += 1;
        }
        let seen = pixels.estimate(bright)?;
        let taken = seen.taken;
        if is_planned {
            pace.learn(taken - before, seen.sampling);
            before = taken;
        }
        exponent.learn(taken, seen.mse);
        outcome.beam_pixels = seen.resolved;
        let resolved = seen.resolved as f64 / number;
        let noise = seen.mse + OWN_ERROR.powi(2) * resolved;
        outcome.estimated_noise = noise.sqrt();
        let now = pixels.backend().seconds();
        pace.hosting = now - begun - if is_planned { seen.sampling } else { 0.0 };
        let all = match goal {
            Goal::Samples(spp) => f64::from(spp) * number,
            Goal::Error(_) => f64::INFINITY,
            Goal::Seconds(limit) => {
                let left = limit * (1.0 - AUDIT_TIME) - (now - start) - pace.hosting;
                taken + pace.rate * left.max(0.0) * of_time(seen.equal(), first)
            }
        };
        let enough = match goal {
            Goal::Error(rmse) => outcome.estimated_noise <= rmse,
            Goal::Samples(_) | Goal::Seconds(_) => taken * 1.02 >= all || seen.mse == 0.0 && resolved == 1.0,
        };

        let budget = auditor.budget(goal, taken, bright, pace.rate, now - start);
        let audit = if enough && auditor.is_due(goal, budget) {
            Some(auditor.audit(pixels, [width, height], budget, &mut outcome, progress)?)
        } else {
            None
        };
        outcome.note(noise, seen.deviation, audit.as_ref(), prefilters);
        if enough {
            let Goal::Error(rmse) = goal else { break seen };
            let sure = outcome.interval.is_none_or(|[_, high]| high <= SURE * rmse);
            outcome.reached = outcome.estimated_rmse <= rmse && sure;
            // More samples lower noise, but not the bias of a footprint.
            if outcome.reached || prefilters || auditor.refusals == MAX_REFUSALS {
                break seen;
            }
            auditor.refusals += 1;
        }
        if let Some(audit) = &audit {
            pixels.raise(&audit.raises())?;
        }

        let elapsed = pixels.backend().seconds() - start;
        let idle = pace.idle(goal, elapsed, outcome.estimated_noise, exponent.value());
        is_planned = match (seen.equal(), idle) {
            // A time limit begins with one sample in each half, to measure the rate.
            (Some(now), _) if now < first => {
                let most = (all / (2.0 * number)) as u32;
                pixels.plan_all(most.clamp(now, first))?;
                progress.advance((taken / all).min(1.0));
                most > now
            }
            (Some(now), Some(factor)) => {
                let next = (now * factor).min(MAX_COUNT);
                pixels.plan_all(next)?;
                next > now
            }
            _ => {
                let aim = match goal {
                    Goal::Samples(_) | Goal::Seconds(_) => Aim::Samples(all),
                    // In the allocation's measure, which includes the variance that may have been missed.
                    Goal::Error(rmse) => {
                        let weight = seen.weight() * auditor.strictness(noise);
                        Aim::Mse((rmse * PLANNED).powi(2) * weight)
                    }
                };
                let plan = Plan {
                    aim,
                    exponent: exponent.value(),
                    growth: growth(goal),
                    most: MAX_COUNT,
                    explores: enough,
                };
                let planned = pixels.plan(&plan)?;
                let needed = if let Aim::Mse(_) = aim { planned.cost } else { 0.0 };
                let outlook = Outlook {
                    goal,
                    passes: outcome.passes,
                    elapsed,
                    mse: seen.mse,
                    exponent: exponent.value(),
                    left: Outlook::left(goal, elapsed, (needed - taken) / pace.rate),
                };
                let whole = Rect::whole([width, height]);
                if resolution.resolve(pixels, whole, &outlook, progress)? {
                    is_planned = false;
                    continue;
                }
                progress.advance((taken / planned.cost).min(1.0));
                planned.gains
            }
        };
        if !is_planned {
            // No pixel that matters may have more samples; the result is recorded all the same.
            if audit.is_none() {
                let audit = auditor.audit(pixels, [width, height], budget, &mut outcome, progress)?;
                outcome.note(noise, seen.deviation, Some(&audit), prefilters);
            }
            break seen;
        }
    };
    outcome.mean_samples = seen.taken / number;
    outcome.least_samples = 2 * seen.least;
    outcome.most_samples = 2 * seen.most;
    outcome.reached = match goal {
        Goal::Samples(_) => true,
        Goal::Error(_) => outcome.reached,
        Goal::Seconds(limit) => Goal::is_kept(limit, pixels.backend().seconds() - start),
    };
    film.samples = outcome.mean_samples.round() as u32;
    pixels.write_to(&mut film)?;
    let estimates = if tells_pixels {
        let (samples, variances) = pixels.counts_and_variances()?;
        Some(PixelEstimates { samples, errors: variances.iter().map(|variance| variance.sqrt()).collect() })
    } else {
        None
    };
    Ok(Run { film, outcome, estimates })
}

impl Outcome {
    /// Records the larger of the two estimates, which both err at random, and the larger of their bounds.
    fn note(&mut self, noise: f64, deviation: f64, audit: Option<&Audit>, prefilters: bool) {
        let mse = audit.map_or(noise, |audit| audit.mse.max(noise));
        self.estimated_rmse = mse.sqrt();
        self.estimated_bias = if prefilters { (mse - noise).max(0.0).sqrt() } else { 0.0 };
        self.interval = audit
            .and_then(|audit| audit.interval)
            .map(|[low, high]| [low.min(mse).sqrt(), high.max(mse).max(noise + DEVIATE * deviation).sqrt()]);
    }
}

/// Returns the fraction of the remaining time for the next pass: `equal` is the number of samples in each half of every
/// pixel, if it is the same, and `first` the one that every pixel has before samples are placed.
fn of_time(equal: Option<u32>, first: u32) -> f64 {
    match equal {
        Some(now) if now < first => OF_TIME_OF_EQUAL,
        Some(_) => OF_TIME_AT_FIRST,
        None => OF_TIME,
    }
}

/// Returns the largest factor by which a pixel's count grows from one pass to the next, as its variance is only roughly
/// known. With a fixed number of samples each one counts; otherwise fewer passes are better.
fn growth(goal: Goal) -> f64 {
    if let Goal::Samples(_) = goal { 8.0 } else { 16.0 }
}

/// Returns the most samples of each half in a first pass that leaves most of the time to the next ones. A time limit
/// begins with one sample in each half, to measure the rate, unless that is known.
fn first_of_time(goal: Goal, rate: Option<f64>, pixels: f64) -> u32 {
    match (goal, rate) {
        (Goal::Seconds(limit), Some(rate)) => (OF_FIRST * rate * limit / (2.0 * pixels)).max(1.0) as u32,
        (Goal::Seconds(_), None) => 1,
        _ => u32::MAX,
    }
}

/// Returns the samples of each half before anything is known about the pixels.
fn first_count(goal: Goal, bright_share: f64, pixels: f64) -> u32 {
    let most = (MAX_FIRST_IN_ALL / pixels).min(MAX_FIRST) / 2.0;
    let bright = (FIRST_OF_BRIGHT / bright_share / 2.0).min(most) as u32;
    let first = if bright_share < 1.0 { bright.max(FIRST).next_power_of_two() } else { FIRST };
    match goal {
        Goal::Samples(spp) => {
            (spp / 8).clamp(1, FIRST).max(if bright_share < 1.0 { (spp / 4).min(first) } else { 1 })
        }
        Goal::Error(_) | Goal::Seconds(_) => first,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_small_and_bright_is_looked_for_from_the_first_pass_on() {
        let first = |goal, share| first_count(goal, share, 16_384.0);
        assert_eq!(first(Goal::Error(1e-3), 1.0), 8);
        assert_eq!(first(Goal::Error(1e-3), 0.01), 256, "400 samples a pixel");
        assert_eq!(first(Goal::Error(1e-3), 1e-6), 512, "no more than 1024");
        assert_eq!(first_count(Goal::Error(1e-3), 1e-6, 4_194_304.0), 8, "nor than 2^25 in the picture");
        assert_eq!(first(Goal::Samples(64), 1.0), 8);
        assert_eq!(first(Goal::Samples(64), 0.01), 16, "half of what there is");
    }
    #[test]
    fn the_bounds_of_an_error_hold_the_estimate() {
        for (found, noise) in [(4.0, 1.0), (1.0, 4.0)] {
            let mut audit = Audit::default();
            (audit.mse, audit.interval) = (found, Some([2.0, 3.0]));
            let mut outcome = Outcome::default();
            outcome.note(noise, 0.0, Some(&audit), false);
            let [low, high] = outcome.interval.unwrap_or_default();
            assert_eq!(outcome.estimated_rmse, 2.0);
            assert!(low <= 2.0 && high >= 2.0, "{low} to {high}");
        }
    }
}
