//! Pixels drawn at random and sampled anew → the picture's true mean squared error, with an interval.
//!
//! Halves of the same samples agree on what both have missed; an audit does not know what they have seen. For the
//! value x of a pixel and two independent means a and b of it, (x − a)(x − b) has the mean (x − µ)², whatever led to
//! x. Each finding counts by 1 over how often its pixel was to be drawn (Hansen & Hurwitz 1943).

use std::cmp::Reverse;

use rayon::prelude::*;

use super::analytic::{AnalyticPixels, OWN_ERROR};
use super::draws::{Masses, wanted};
use super::estimate::Estimate;
use super::{MOST, OCTAVES, octave};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::sampling::{Backend, HalfSums};
use crate::schema::layout::{JOB_APART, JOB_BARE, JOB_STREAM_SHIFT, Job};

/// The interval holds the truth with this probability.
pub const CONFIDENCE: f64 = 0.99;
/// The normal deviate of that probability, two-sided.
pub const DEVIATE: f64 = 2.5758;
/// Fewer have no interval.
const FEW: usize = 16;
/// Samples have not seen what varies so many times more in an audit.
const UNSEEN: f32 = 4.0;
/// Samples that are all due to meet something meet none of it with a chance of e^-8.
const MISSED: f64 = 8.0;
/// Of a polygon that beams cut in f32, in pixels.
const AREA_ERROR: f64 = 1e-6;
/// Pixels around an audited one that are taken to be like it.
const RADIUS: usize = 4;

/// What is audited.
pub struct Audited<'a> {
    pub sums: &'a HalfSums,
    pub counts: &'a [u32],
    pub estimate: &'a Estimate,
    pub analytic: &'a AnalyticPixels,
}

/// What an audit found.
#[derive(Clone, Debug, Default)]
pub struct Audit {
    /// The mean squared error of the whole picture, bias included. May be below 0 by chance.
    pub mse: f64,
    /// Bounds of it, with `CONFIDENCE`; none of so few draws that these say nothing of each other.
    pub interval: Option<[f64; 2]>,
    pub pixels: usize,
    pub samples: f64,
    findings: Vec<Finding>,
}

#[derive(Clone, Copy, Debug)]
struct Finding {
    pixel: usize,
    /// The variance of one sample.
    spread: f32,
    /// Pixels of the picture that a draw of this one stands for, their squared errors and upper bounds of these.
    weight: f64,
    error: f64,
    bound: f64,
    /// The film's samples vary far less than those of the audit.
    unseen: bool,
}

impl Audited<'_> {
    /// Takes at most about `budget` samples; `round` numbers the audits of a picture, none of which has samples of
    /// another.
    pub fn audit(
        &self,
        backend: &mut dyn Backend,
        budget: f64,
        round: u32,
        progress: &dyn Progress,
    ) -> Result<Audit> {
        let mut rng = fastrand::Rng::with_seed(u64::from(round));
        let masses = Masses::new(self, budget);
        let drawn = masses.draw(self, &mut rng);
        let mut places = drawn.clone();
        places.sort_unstable();
        places.dedup();
        let cost: f64 = places.iter().map(|&p| 2.0 * f64::from(wanted(self.counts[p]))).sum();
        let part = (budget / cost).min(1.0);
        let samples = |pixel: usize| ((f64::from(wanted(self.counts[pixel])) * part) as u32).clamp(16, MOST);
        let bare = if backend.prefilters() { JOB_BARE } else { 0 };
        let job = |&pixel: &usize, mean: u32| Job {
            place: Job::place_of(pixel as u32, self.sums.width),
            part: JOB_APART | bare | (2 + 2 * round + mean) << JOB_STREAM_SHIFT,
            first: 0,
            count: samples(pixel),
        };
        // Longest first: neighbouring threads then have equally much to do.
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by_key(|&at| Reverse(samples(places[at])));
        let jobs: Vec<Job> =
            order.iter().flat_map(|&at| [job(&places[at], 0), job(&places[at], 1)]).collect();
        let sums = backend.sample_apart(&jobs, progress)?;
        let brightest = sums.iter().map(brightness).fold(0.0, f64::max);
        let mut findings: Vec<Option<Finding>> = vec![None; places.len()];
        for ((sums, jobs), at) in sums.chunks_exact(2).zip(jobs.chunks_exact(2)).zip(order) {
            let weight = 1.0 / masses.draws_of(self, places[at]);
            findings[at] = self.finding(places[at], [sums[0], sums[1]], jobs[0].count, weight, brightest);
        }
        // In the order of the draws, so that neighbours are alike.
        let of_draws = |of: fn(&Finding) -> f64| {
            let value = |pixel: &usize| {
                let found = places.binary_search(pixel).ok().and_then(|at| findings[at].as_ref());
                found.map_or(0.0, of) / self.counts.len() as f64
            };
            Total::new(&drawn.iter().map(value).collect::<Vec<f64>>())
        };
        let (errors, bounds) = (of_draws(|f| f.error), of_draws(|f| f.bound));
        Ok(Audit {
            mse: errors.sum,
            interval: (drawn.len() >= FEW)
                .then(|| [(errors.sum - errors.reach()).max(0.0), bounds.sum + bounds.reach()]),
            pixels: places.len(),
            samples: jobs.iter().map(|j| f64::from(j.count)).sum(),
            findings: findings.into_iter().flatten().collect(),
        })
    }

    /// The squared error of a pixel and what is found there; none where the film or the audit has no number. Nothing
    /// in the picture is taken to be brighter than `brightest`.
    fn finding(
        &self,
        pixel: usize,
        sums: [[f32; 4]; 2],
        samples: u32,
        weight: f64,
        brightest: f64,
    ) -> Option<Finding> {
        let n = 2.0 * f64::from(self.counts[pixel]);
        let k = f64::from(samples);
        let both =
            |c: usize| f64::from(self.sums.halves[0][pixel][c]) + f64::from(self.sums.halves[1][pixel][c]);
        let film: [f64; 4] = std::array::from_fn(|c| both(c) / n);
        let means = sums.map(|sum| sum.map(|s| f64::from(s) / k));
        let middle: [f64; 4] = std::array::from_fn(|c| 0.5 * (means[0][c] + means[1][c]));
        let dot = |u: [f64; 3], v: [f64; 3]| (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / 3.0;
        let rgb = |v: [f64; 4]| [v[0], v[1], v[2]];
        let off = |m: [f64; 4]| std::array::from_fn(|c| film[c] - m[c]);
        let spread = (middle[3] - dot(rgb(middle), rgb(middle))).max(0.0);
        let (error, bound, unseen) = if self.analytic.has(pixel) {
            // Samples cannot resolve the error of what beams resolve, but find what contradicts it: beyond
            // four times their noise, and more than if they had missed the brightest where it was due so often.
            let squared = dot(off(middle), off(middle));
            let noise = (16.0 * spread).max(MISSED * brightest * squared.sqrt()) / (2.0 * k);
            let excess = (squared - noise).max(0.0);
            (excess, excess + OWN_ERROR.powi(2) + (AREA_ERROR * brightest).powi(2), false)
        } else {
            let error = dot(off(means[0]), off(means[1]));
            let seen = (film[3] - dot(rgb(film), rgb(film))).max(0.0);
            let unseen = spread > f64::from(UNSEEN) * seen;
            // Where the audit itself saw too little to know the mean, its samples still know their variance.
            (error, if unseen { error.max(spread / n) } else { error }, unseen)
        };
        let (error, bound) = (error * weight, bound * weight);
        let finding = Finding { pixel, spread: spread as f32, weight, error, bound, unseen };
        (error.is_finite() && bound.is_finite() && spread.is_finite()).then_some(finding)
    }
}

impl Audit {
    /// Raises the variances of pixels that are like those in which the audit saw what the film has not: around them,
    /// and of the same counts. Returns the pixels around.
    pub fn raise(&self, variances: &mut [f32], counts: &[u32], width: usize) -> Vec<u32> {
        let all: f64 = self.findings.iter().map(|f| f.bound.max(0.0)).sum();
        let unseen = || self.findings.iter().filter(|f| f.unseen);
        let mut raised = Vec::new();
        for found in unseen().filter(|f| f.bound * self.findings.len() as f64 > all) {
            raise(variances, counts, width, found.pixel, found.spread, RADIUS, &mut raised);
        }
        if unseen().map(|f| f.bound).sum::<f64>() > 0.1 * all {
            let mut floors = [[0.0f64; 2]; OCTAVES];
            for found in &self.findings {
                let [sum, weight] = &mut floors[octave(counts[found.pixel])];
                *sum += found.weight * if found.unseen { f64::from(found.spread) } else { 0.0 };
                *weight += found.weight;
            }
            variances.par_iter_mut().zip(counts).for_each(|(variance, &count)| {
                let [sum, weight] = floors[octave(count)];
                if weight > 0.0 {
                    *variance = variance.max((sum / weight) as f32 / (2.0 * count as f32));
                }
            });
        }
        raised
    }
}

/// Takes the pixels around one to vary like it, by a quarter.
pub fn raise(
    variances: &mut [f32],
    counts: &[u32],
    width: usize,
    pixel: usize,
    spread: f32,
    radius: usize,
    raised: &mut Vec<u32>,
) {
    let (x, y, height) = (pixel % width, pixel / width, counts.len() / width);
    for row in y.saturating_sub(radius)..(y + radius + 1).min(height) {
        for i in row * width + x.saturating_sub(radius)..row * width + (x + radius + 1).min(width) {
            let like = if i == pixel { spread } else { 0.25 * spread } / (2.0 * counts[i] as f32);
            if variances[i] < like {
                variances[i] = like;
                raised.push(i as u32);
            }
        }
    }
}

/// What samples of either something or nothing would show where it is: the mean of their squares over their mean.
fn brightness([r, g, b, squares]: &[f32; 4]) -> f64 {
    let mean = f64::from(r.abs().max(g.abs()).max(b.abs()));
    if mean > 0.0 { f64::from(*squares) / mean } else { 0.0 }
}

/// A sum over draws, one from each of many parts of the picture.
struct Total {
    sum: f64,
    variance: f64,
    /// Degrees of freedom of the variance: few where few draws make most of it.
    freedom: f64,
}

impl Total {
    /// Neighbouring parts count as one with two draws (collapsed strata: Cochran 1977, 5A.12): their difference says
    /// too much of the variance rather than too little.
    fn new(values: &[f64]) -> Total {
        let squares = values.chunks_exact(2).map(|pair| (pair[0] - pair[1]).powi(2));
        let (variance, fourth) = squares.fold((0.0, 0.0), |(s, f), d| (s + d, f + d * d));
        // Of n squares of normal deviates: n² / 3n.
        let freedom = if fourth > 0.0 { 3.0 * variance * variance / fourth } else { 2.0 };
        Total { sum: values.iter().sum(), variance, freedom: freedom.max(2.0) }
    }

    /// Half the interval's length, by Student's t (Cornish & Fisher's expansion, Abramowitz & Stegun 26.7.5).
    fn reach(&self) -> f64 {
        let (z, nu) = (DEVIATE, self.freedom);
        let first = (z.powi(3) + z) / 4.0;
        let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
        let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
        (z + first / nu + second / nu.powi(2) + third / nu.powi(3)) * self.variance.sqrt()
    }
}
