//! Chooses how a picture is made in a given time. Input: a backend that tells what candidates cost. Output: a picture by
//! the one whose error is predicted to be the least: the same number of samples everywhere, samples where they are needed
//! most, one prefiltered sample a pixel, or one cone. Costs are learnt on a part of the picture; a prefilter's error is
//! measured against samples that do not share its bias.

mod decide;
mod pilot;

use super::adaptive::{CONFIDENCE, Chosen, Goal, Outcome, PixelEstimates};
use super::{Adaptive, Integrated, Integrator};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::sampling::{Backend, Candidate, Made};
use decide::{Costs, Decision, Even, OF_TIME, Prospect, Shot, decide};
use pilot::{FEW, Found, MANY, Pilot};

/// Fraction of the remaining time that measuring the picture's error may take.
const AUDIT_TIME: f64 = 0.04;
/// The first samples of a picture are one of this many.
const FIRST_PART: u32 = 4;
/// Samples of which a picture takes only a part first: fewer are soon done, and each pass sets up all pixels again.
const MANY_SAMPLES: u32 = 32;
/// Fraction of the whole time in which the cost of many samples is measured, and least and most of them over few.
const COST_TIME: f64 = 0.08;
const COSTS: [f64; 2] = [4.0, 32.0];
/// Largest fraction of the time that the first trials may take for others to follow.
const MAX_TRIAL: f64 = 0.2;
/// From this time on, samples placed pixel by pixel, or beams, were the best choice on all scenes that were measured.
const PLACED_FROM: f64 = 0.5;
/// Fraction of the whole time for which pixels are sampled apart at first, and the time of one of their samples over that
/// of one among neighbours.
const PILOT_TIME: f64 = 0.02;
const PILOT_COST: f64 = 4.0;
/// Most samples of each mean by which a picture's error is measured: more pixels tell more.
const MAX_AUDIT: u32 = 32;
/// A prefiltered sample, and a cone, take at least about as long as so many samples: known before any was tried.
const PREFILTERED_COST: f64 = 2.0;
const CONE_COST: f64 = 16.0;
/// The mean squared error of a cone over that of a prefiltered sample, which does not average over edges: assumed before
/// it is measured. Of three scenes with edges it is 0.09, 0.85 and 0.88.
const CONE_ERROR: f64 = 0.85;
/// RMSE of the best prefilter on any scene that was measured, rounded down: where samples come below it, none is tried.
const BEST_PREFILTER: f64 = 1e-3;
/// Seconds of the host for a pixel in each pass of sampling pixel by pixel, where the device does not keep the pixels.
const HOST_SECONDS: f64 = 8e-8;
/// Seconds for a pixel whose sums are written for the first time and read by the host, there: trials do not show them.
const FIRST_SECONDS: f64 = 8e-9;

/// Renders for a time by what promises the least error.
#[derive(Clone, Copy, Debug)]
pub struct Auto {
    pub seconds: f64,
    /// Tells samples and errors of single pixels, where samples are placed pixel by pixel.
    pub tells_pixels: bool,
}

impl Auto {
    /// Returns true if other ways than samples placed pixel by pixel, and beams, are tried in such a time.
    pub fn tries_others(seconds: f64) -> bool {
        seconds < PLACED_FROM
    }
}

impl Integrator for Auto {
    fn render(&self, backend: &mut dyn Backend, film: Film, progress: &dyn Progress) -> Result<Integrated> {
        // What is small and bright is looked for by samples pixel by pixel: few trials would miss it.
        if backend.bright_share() < 1.0 || !Auto::tries_others(self.seconds) {
            return self.adaptive(self.seconds, None, backend, film, progress);
        }
        let mut clock = Deadline::new(backend, self.seconds);
        let Some(costs) = costs(backend, self.seconds, progress)? else {
            return self.adaptive(self.seconds, None, backend, film, progress);
        };
        // A device that keeps the pixels places samples in less time than further trials take. Without any time left, one
        // sample a pixel is the least.
        let left = clock.left(backend);
        if backend.keeps_pixels() && left > 0.0 && self.seconds - left > MAX_TRIAL * self.seconds {
            return self.adaptive(left, None, backend, film, progress);
        }
        let pixels = film.pixels.len() as f64;
        let number = PILOT_TIME * self.seconds * pixels
            / (PILOT_COST * f64::from(2 * MANY + FEW) * costs.each().max(1e-12));
        // Building pipelines, on first use, does not count.
        let begun = backend.seconds();
        let mut pilot = Pilot::new(backend, [film.width, film.height], number, progress)?;
        clock.sample = (backend.seconds() - begun) / (f64::from(2 * MANY + FEW) * pilot.len() as f64);
        let [first, hosting] = match backend.keeps_pixels() {
            true => [0.0; 2],
            false => [FIRST_SECONDS, HOST_SECONDS].map(|seconds| seconds * pixels),
        };
        let even = Even::new(costs, first, [MANY, FEW], pilot.noise());
        let mut prospect = Prospect {
            left: clock.left(backend),
            even,
            gain: pilot.gain(even.exponent),
            hosting,
            shots: Vec::new(),
        };
        add_shots(&mut prospect, first, &pilot, &clock, backend, progress)?;
        let (candidate, samples) = match decide(&prospect).0 {
            Decision::Adaptive => {
                let rate = Some(pixels / prospect.placed_cost());
                return self.adaptive(clock.left(backend), rate, backend, film, progress);
            }
            // A part at first, as the cost of all is known better then.
            Decision::Samples(samples) if samples > MANY_SAMPLES => {
                (Candidate::Samples, samples.div_ceil(FIRST_PART))
            }
            Decision::Samples(samples) => (Candidate::Samples, samples),
            Decision::Shot(candidate) => (candidate, 1),
        };
        let seconds = OF_TIME * clock.left(backend);
        let mut film = film;
        let made = backend.render_by(candidate, samples, seconds, &mut film, progress)?;
        let mut rendered = Rendered { film, by: candidate, made };
        // What was assumed of a shot is known now; another one may be better, and fit into the rest of the time.
        if candidate != Candidate::Samples {
            let (mse, left) = (pilot.error_in(&rendered.film).mse, clock.left(backend));
            let others = prospect.shots.iter().filter(|shot| shot.candidate != candidate);
            let better = others.filter(|shot| shot.mse < mse && shot.seconds < left);
            if let Some(shot) = better.min_by(|a, b| a.mse.total_cmp(&b.mse)) {
                rendered.by = shot.candidate;
                rendered.made = backend.render_by(shot.candidate, 1, 0.0, &mut rendered.film, progress)?;
            }
        }
        self.audited(rendered, &mut pilot, &clock, backend, progress)
    }
}

/// A picture, the way in which it was made, and what that took.
struct Rendered {
    film: Film,
    by: Candidate,
    made: Made,
}

/// The time that is left, and how long a sample takes that is taken apart.
struct Deadline {
    end: f64,
    seconds: f64,
    sample: f64,
}

impl Deadline {
    fn new(backend: &dyn Backend, seconds: f64) -> Deadline {
        Deadline { end: backend.seconds() + seconds, seconds, sample: 0.0 }
    }

    fn left(&self, backend: &dyn Backend) -> f64 {
        self.end - backend.seconds()
    }
}

/// Measures the costs of few samples and of more, as many as the time allows; `None` if the backend cannot.
fn costs(backend: &mut dyn Backend, seconds: f64, progress: &dyn Progress) -> Result<Option<Costs>> {
    // Building pipelines does not count, but happens here.
    let begun = backend.seconds();
    let Some(few) = backend.cost(Candidate::Samples, FEW, progress)? else { return Ok(None) };
    let spent = (backend.seconds() - begun).max(1e-9);
    // No time for even those: a second cost would tell nothing.
    if few > seconds {
        return Ok(Some(Costs { samples: [2 * FEW, FEW], seconds: [2.0 * few, few] }));
    }
    let many = (COST_TIME * seconds / spent).clamp(COSTS[0], COSTS[1]) as u32 * FEW;
    let costs = backend.cost(Candidate::Samples, many, progress)?;
    Ok(costs.map(|seconds| Costs { samples: [many, FEW], seconds: [seconds, few] }))
}

/// Tries the prefilters that may come below the error of samples, and fit into the time by what is known before.
fn add_shots(
    prospect: &mut Prospect,
    first: f64,
    pilot: &Pilot,
    clock: &Deadline,
    backend: &mut dyn Backend,
    progress: &dyn Progress,
) -> Result<()> {
    let even = prospect.even;
    let may_win = |prospect: &Prospect, least: f64, samples: f64| {
        decide(prospect).1 > least && even.once + samples * even.each < prospect.left
    };
    if !may_win(prospect, BEST_PREFILTER.powi(2), PREFILTERED_COST) {
        return Ok(());
    }
    let Some(found) = pilot.prefiltered(backend, progress)? else { return Ok(()) };
    // Few pixels may have missed where it errs most.
    let mse = found.mse.max(0.0) + found.deviation;
    if let Some(seconds) = backend.cost(Candidate::Prefiltered, 1, progress)? {
        prospect.shots.push(Shot { candidate: Candidate::Prefiltered, mse, seconds: seconds + first });
    }
    prospect.left = clock.left(backend);
    if may_win(prospect, CONE_ERROR * mse, CONE_COST)
        && let Some(seconds) = backend.cost(Candidate::Cone, 1, progress)?
    {
        prospect.shots.push(Shot {
            candidate: Candidate::Cone,
            mse: CONE_ERROR * mse,
            seconds: seconds + first,
        });
    }
    prospect.left = clock.left(backend);
    Ok(())
}

impl Auto {
    fn adaptive(
        &self,
        left: f64,
        rate: Option<f64>,
        backend: &mut dyn Backend,
        film: Film,
        progress: &dyn Progress,
    ) -> Result<Integrated> {
        let adaptive = Adaptive { goal: Goal::Seconds(left), tells_pixels: self.tells_pixels, rate };
        adaptive.render(backend, film, progress)
    }

    /// Measures the error of the picture with more samples, if there is time for them.
    fn audited(
        &self,
        rendered: Rendered,
        pilot: &mut Pilot,
        clock: &Deadline,
        backend: &mut dyn Backend,
        progress: &dyn Progress,
    ) -> Result<Integrated> {
        let Rendered { mut film, by, made } = rendered;
        film.samples = made.samples;
        let samples = (made.samples / 2).clamp(MANY, MAX_AUDIT);
        let time = clock.left(backend).min(AUDIT_TIME * clock.seconds);
        let number = time / (2.0 * f64::from(samples) * clock.sample);
        pilot.widen(backend, [film.width, film.height], [number as u32, samples], progress)?;
        let Found { mse, deviation, interval } = pilot.error_in(&film);
        // Less than a deviation cannot be told from none; and few pixels that have most of the error may have missed some.
        let missed = if interval.is_some() { 0.0 } else { deviation };
        let rmse = (mse.max(deviation) + missed).sqrt();
        let is_noise = by == Candidate::Samples;
        let pixels = film.pixels.len() as f64;
        let outcome = Outcome {
            chosen: by.into(),
            estimated_rmse: rmse,
            interval,
            confidence: CONFIDENCE,
            estimated_noise: if is_noise { rmse } else { 0.0 },
            estimated_bias: if is_noise { 0.0 } else { rmse },
            audited_pixels: pilot.len() as u64,
            audit_samples: 2 * u64::from(pilot.samples) * pilot.len() as u64,
            passes: 1,
            mean_samples: made.samples.into(),
            least_samples: made.samples,
            most_samples: made.samples,
            beam_pixels: 0,
            reached: Goal::is_kept(clock.seconds, clock.seconds - clock.left(backend)),
        };
        let estimates = self.tells_pixels.then(|| PixelEstimates {
            samples: vec![made.samples; film.pixels.len()],
            errors: vec![rmse as f32; film.pixels.len()],
        });
        let dropped = (by == Candidate::Cone).then_some(made.dropped / pixels);
        Ok(Integrated { outcome: Some(outcome), estimates, dropped, ..Integrated::from(film) })
    }
}

impl From<Candidate> for Chosen {
    fn from(candidate: Candidate) -> Chosen {
        match candidate {
            Candidate::Samples => Chosen::Samples,
            Candidate::Prefiltered => Chosen::Prefiltered,
            Candidate::Cone => Chosen::Cone,
        }
    }
}
