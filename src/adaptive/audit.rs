//! Pixels drawn at random and sampled anew → the picture's true mean squared error, with an interval.
//!
//! Halves of the same samples agree on what both have missed; an audit does not know what they have seen. For the
//! value x of a pixel and two independent means a and b of it, (x − a)(x − b) has the mean (x − µ)², whatever led to
//! x. Half of the draws go evenly over the picture, half by the variance that the film says, and each counts by
//! 1 over how often its pixel was to be drawn (Hansen & Hurwitz 1943). They lie at equal steps along the counts and the picture.

use rayon::prelude::*;

use super::estimate::Estimate;
use super::exact::{Exact, OWN_ERROR};
use super::{MOST, OCTAVES, Sums, Tracer, octave};
use crate::error::Result;
use crate::layout::{JOB_APART, JOB_BARE, JOB_STREAM_SHIFT, Job};
use crate::progress::Progress;

/// The interval holds the truth with this probability.
pub const CONFIDENCE: f64 = 0.99;
/// The normal deviate of that probability, two-sided.
const DEVIATE: f64 = 2.5758;
/// Draws of an audit.
const MIN_DRAWS: f64 = 256.0;
const MAX_DRAWS: f64 = 4096.0;
/// Fewer have no interval.
const FEW: usize = 16;
/// Samples of each of the two means where the film has fewer.
const MIN_SAMPLES: u32 = 512;
/// The share of draws that goes evenly over the picture.
const EVEN: f64 = 0.5;
/// Pixels that one thread takes at once.
const CHUNK: usize = 1 << 15;
/// Cells along each side of the picture.
const CELLS: usize = 32;
/// Samples have not seen what varies so many times more in an audit.
const UNSEEN: f32 = 4.0;
/// Pixels around an audited one that are taken to be like it.
const RADIUS: usize = 4;

/// What is audited.
pub struct Audited<'a> {
    pub sums: &'a Sums,
    pub counts: &'a [u32],
    pub estimate: &'a Estimate,
    pub exact: &'a Exact,
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
        tracer: &mut dyn Tracer,
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
        let bare = if tracer.prefilters() { JOB_BARE } else { 0 };
        let job = |&pixel: &usize, mean: u32| Job {
            place: Job::place_of(pixel as u32, self.sums.width),
            part: JOB_APART | bare | (2 + 2 * round + mean) << JOB_STREAM_SHIFT,
            first: 0,
            count: samples(pixel),
        };
        let jobs: Vec<Job> = places.iter().flat_map(|p| [job(p, 0), job(p, 1)]).collect();
        let sums = tracer.sample_apart(&jobs, progress)?;
        let pairs = sums.chunks_exact(2).zip(jobs.chunks_exact(2)).zip(&places);
        let findings: Vec<Option<Finding>> = pairs
            .map(|((sums, jobs), &pixel)| {
                self.finding(pixel, [sums[0], sums[1]], jobs[0].count, 1.0 / masses.draws_of(self, pixel))
            })
            .collect();
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

    /// The squared error of a pixel and what is found there; none where the film or the audit has no number.
    fn finding(&self, pixel: usize, sums: [[f32; 4]; 2], samples: u32, weight: f64) -> Option<Finding> {
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
        let (error, bound, unseen) = if self.exact.tells(pixel) {
            // Samples cannot resolve the error of what is told without them, but find what contradicts it.
            let noise = spread / (2.0 * k);
            let excess = (dot(off(middle), off(middle)) - 16.0 * noise).max(0.0);
            let error = excess + OWN_ERROR.powi(2);
            (error, error, false)
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

/// Samples of each of both means.
fn wanted(count: u32) -> u32 {
    (2 * count).clamp(MIN_SAMPLES, MOST)
}

/// How many draws each pixel may expect: an even share of half of them, and of the other half in proportion to its
/// variance, one at most. In sum, of each cell of the picture and each octave of counts.
struct Masses {
    cells: Vec<[f64; OCTAVES]>,
    even: f64,
    of_variance: f64,
}

impl Masses {
    fn new(of: &Audited, budget: f64) -> Masses {
        let pixels = of.counts.len() as f64;
        let sum = |f: &(dyn Fn(usize) -> f64 + Sync)| -> f64 {
            let chunks = (0..of.counts.len().div_ceil(CHUNK))
                .into_par_iter()
                .map(|chunk| (chunk * CHUNK..((chunk + 1) * CHUNK).min(of.counts.len())).map(f).sum::<f64>());
            chunks.collect::<Vec<f64>>().iter().sum()
        };
        let variance = |i: usize| f64::from(of.estimate.variances[i]);
        let cost = |i: usize| 2.0 * f64::from(wanted(of.counts[i]));
        let all = sum(&variance);
        let even_cost = sum(&cost) / pixels;
        let own_cost = if all > 0.0 { sum(&|i| cost(i) * variance(i)) / all } else { even_cost };
        let draws = budget / (EVEN * even_cost + (1.0 - EVEN) * own_cost);
        let draws = draws.clamp(MIN_DRAWS, MAX_DRAWS).min(pixels);
        let mut of_variance = 0.0;
        if all > 0.0 {
            let wanted = (1.0 - EVEN) * draws;
            of_variance = wanted / all;
            for _ in 0..4 {
                of_variance *= wanted / sum(&|i| (of_variance * variance(i)).min(1.0)).max(f64::MIN_POSITIVE);
            }
        }
        let even = if all > 0.0 { EVEN } else { 1.0 } * draws / pixels;
        let mut masses = Masses { cells: Vec::new(), even, of_variance };
        let cell = |cell: usize| {
            let mut mass = [0.0; OCTAVES];
            pixels_of(of, cell).for_each(|i| mass[octave(of.counts[i])] += masses.draws_of(of, i));
            mass
        };
        masses.cells = (0..CELLS * CELLS).into_par_iter().map(cell).collect();
        masses
    }

    fn draws_of(&self, of: &Audited, pixel: usize) -> f64 {
        (self.even + self.of_variance * f64::from(of.estimate.variances[pixel])).min(1.0)
    }

    /// Pixels at equal steps along the whole mass, in the order of octaves and cells: none of them twice.
    fn draw(&self, of: &Audited, rng: &mut fastrand::Rng) -> Vec<usize> {
        let mut drawn: Vec<usize> = Vec::new();
        let start = rng.f64();
        let mut wanted = start;
        let mut before = 0.0;
        for o in 0..OCTAVES {
            for cell in 0..CELLS * CELLS {
                let mut at = before;
                before += self.cells[cell][o];
                if wanted >= before {
                    continue;
                }
                for i in pixels_of(of, cell).filter(|&i| octave(of.counts[i]) == o) {
                    at += self.draws_of(of, i);
                    while wanted < at {
                        drawn.push(i);
                        wanted = start + drawn.len() as f64;
                    }
                }
            }
        }
        drawn
    }
}

/// Cells follow each other along a line that turns at the borders, so that neighbours in it are neighbours.
fn pixels_of<'a>(of: &Audited<'a>, cell: usize) -> impl Iterator<Item = usize> + use<'a> {
    let width = of.sums.width as usize;
    let height = of.counts.len() / width;
    let (row, along) = (cell / CELLS, cell % CELLS);
    let column = if row % 2 == 0 { along } else { CELLS - 1 - along };
    let part = |k: usize, size: usize| k * size / CELLS..(k + 1) * size / CELLS;
    let columns = part(column, width);
    part(row, height).flat_map(move |y| columns.clone().map(move |x| y * width + x))
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
