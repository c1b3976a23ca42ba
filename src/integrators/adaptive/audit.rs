//! Estimates the picture's true mean squared error, with an interval, from pixels drawn at random and sampled anew.
//!
//! Halves of the same samples agree about anything that both have missed; an audit's samples are independent of them.
//! For the value x of a pixel and two independent means a and b of it, (x − a)(x − b) has the expectation (x − µ)²,
//! whatever led to x. Each finding is weighted by 1 over the expected number of draws of its pixel (Hansen & Hurwitz
//! 1943).

use std::cmp::Reverse;

use rayon::prelude::*;

use super::analytic::OWN_ERROR;
use super::draws::wanted;
use super::{MAX_COUNT, OCTAVES, octave};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::sampling::{AuditPlan, Audited, Backend, Drawn, Pixels, Raises};
use crate::schema::constants::{GOAL_AUDIT_RADIUS, GOAL_SHARE_AROUND};
use crate::schema::layout::{BATCH_APART, BATCH_BARE, BATCH_STREAM_SHIFT, PixelBatch};

/// The probability that the interval contains the true value.
pub const CONFIDENCE: f64 = 0.99;
/// The two-sided normal deviate of that probability.
pub const DEVIATE: f64 = 2.5758;
/// Fewer draws give no interval.
const MIN_DRAWS: usize = 16;
/// A pixel's variance counts as unseen if an audit's samples vary this many times more.
const UNSEEN: f32 = 4.0;
/// If samples are expected to meet something this many times, they miss it with a probability of e^-8.
const MISSED: f64 = 8.0;
/// The error of the area of a polygon that beams cut in f32, in pixels.
const AREA_ERROR: f64 = 1e-6;
/// Radius, in pixels, of the neighbourhood that is assumed to be like an audited pixel.
const RADIUS: usize = GOAL_AUDIT_RADIUS as usize;

/// The result of an audit.
#[derive(Clone, Debug, Default)]
pub struct Audit {
    /// The mean squared error of the whole picture, bias included. An unbiased estimate, which may be negative.
    pub mse: f64,
    /// Its bounds at `CONFIDENCE`; `None` if there are too few draws to estimate their variance.
    pub interval: Option<[f64; 2]>,
    pub pixels: usize,
    pub samples: f64,
    findings: Vec<Finding>,
}

#[derive(Clone, Copy, Debug)]
struct Finding {
    pixel: u32,
    /// Samples of a half.
    count: u32,
    /// The variance of one sample.
    spread: f32,
    /// The number of the picture's pixels that a draw of this one represents, and their squared errors and upper
    /// bounds.
    weight: f64,
    error: f64,
    bound: f64,
    /// True if the film's samples vary far less than those of the audit.
    unseen: bool,
}

/// Audits a picture of that size with at most about `budget` samples; `round` numbers its audits, whose samples are all
/// independent.
pub fn audit(
    pixels: &mut dyn Pixels,
    [width, height]: [u32; 2],
    budget: f64,
    round: u32,
    progress: &dyn Progress,
) -> Result<Audit> {
    let bare = if pixels.backend().prefilters() { BATCH_BARE } else { 0 };
    let plan = AuditPlan {
        budget,
        start: fastrand::Rng::with_seed(u64::from(round)).f64(),
        part: BATCH_APART | bare | (2 + 2 * round) << BATCH_STREAM_SHIFT,
    };
    let audited = pixels.audit(&plan, progress)?;
    let brightest = audited.iter().flat_map(|a| &a.sums).map(brightness).fold(0.0, f64::max);
    let findings: Vec<Option<Finding>> = audited.iter().map(|a| finding(a, brightest)).collect();
    // In the order of the draws, so that neighbouring ones are alike.
    let all = f64::from(width) * f64::from(height);
    let of_draws = |of: fn(&Finding) -> f64| {
        let value = |found: &Option<Finding>| found.as_ref().map_or(0.0, of) / all;
        Total::new(&findings.iter().map(value).collect::<Vec<f64>>())
    };
    let (errors, bounds) = (of_draws(|f| f.error), of_draws(|f| f.bound));
    Ok(Audit {
        mse: errors.sum,
        interval: (audited.len() >= MIN_DRAWS)
            .then(|| [(errors.sum - errors.reach()).max(0.0), bounds.sum + bounds.reach()]),
        pixels: audited.len(),
        samples: audited.iter().map(|a| 2.0 * f64::from(a.samples)).sum(),
        findings: findings.into_iter().flatten().collect(),
    })
}

/// Samples drawn pixels anew, in a picture of that width.
pub fn sample_drawn(
    backend: &mut dyn Backend,
    width: u32,
    drawn: &[Drawn],
    plan: &AuditPlan,
    progress: &dyn Progress,
) -> Result<Vec<Audited>> {
    let cost: f64 = drawn.iter().map(|d| 2.0 * f64::from(wanted(d.count))).sum();
    let share = (plan.budget / cost).min(1.0);
    let samples = |d: &Drawn| ((f64::from(wanted(d.count)) * share) as u32).clamp(16, MAX_COUNT);
    let batch = |d: &Drawn, mean: u32| PixelBatch {
        place: PixelBatch::place_of(d.pixel, width),
        part: plan.part + (mean << BATCH_STREAM_SHIFT),
        first: 0,
        count: samples(d),
    };
    // Longest first, so that neighbouring threads have equal amounts of work; then as the picture is.
    let mut order: Vec<usize> = (0..drawn.len()).collect();
    order.sort_by_key(|&at| (Reverse(samples(&drawn[at])), drawn[at].pixel));
    let batches: Vec<PixelBatch> =
        order.iter().flat_map(|&at| [batch(&drawn[at], 0), batch(&drawn[at], 1)]).collect();
    let taken = backend.sample_apart(&batches, progress)?;
    let audited = |drawn: &Drawn| Audited { drawn: *drawn, samples: samples(drawn), sums: [[0.0; 4]; 2] };
    let mut audited: Vec<Audited> = drawn.iter().map(audited).collect();
    for (sums, at) in taken.chunks_exact(2).zip(order) {
        audited[at].sums = [sums[0], sums[1]];
    }
    Ok(audited)
}

/// Returns the squared error of a pixel and its bounds; `None` if film or audit are NaN or infinite. Nothing in the
/// picture is assumed to be brighter than `brightest`.
fn finding(audited: &Audited, brightest: f64) -> Option<Finding> {
    let Audited { drawn, samples, sums } = *audited;
    let n = 2.0 * f64::from(drawn.count);
    let k = f64::from(samples);
    let both = |c: usize| f64::from(drawn.halves[0][c]) + f64::from(drawn.halves[1][c]);
    let film: [f64; 4] = std::array::from_fn(|c| both(c) / n);
    let means = sums.map(|sum| sum.map(|s| f64::from(s) / k));
    let middle: [f64; 4] = std::array::from_fn(|c| 0.5 * (means[0][c] + means[1][c]));
    let dot = |u: [f64; 3], v: [f64; 3]| (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) / 3.0;
    let rgb = |v: [f64; 4]| [v[0], v[1], v[2]];
    let off = |m: [f64; 4]| std::array::from_fn(|c| film[c] - m[c]);
    let spread = (middle[3] - dot(rgb(middle), rgb(middle))).max(0.0);
    let (error, bound, unseen) = if drawn.resolved {
        // Samples cannot measure the error of a resolved pixel, but they can contradict its value: by more than
        // four times their noise, and by more than if they had missed the brightest light where it was due `MISSED`
        // times.
        let squared = dot(off(middle), off(middle));
        let noise = (16.0 * spread).max(MISSED * brightest * squared.sqrt()) / (2.0 * k);
        let excess = (squared - noise).max(0.0);
        (excess, excess + OWN_ERROR.powi(2) + (AREA_ERROR * brightest).powi(2), false)
    } else {
        let error = dot(off(means[0]), off(means[1]));
        let seen = (film[3] - dot(rgb(film), rgb(film))).max(0.0);
        let unseen = spread > f64::from(UNSEEN) * seen;
        // If the audit itself saw too little to know the mean, its samples still know their variance.
        (error, if unseen { error.max(spread / n) } else { error }, unseen)
    };
    let weight = 1.0 / drawn.draws;
    let (error, bound) = (error * weight, bound * weight);
    let Drawn { pixel, count, .. } = drawn;
    let finding = Finding { pixel, count, spread: spread as f32, weight, error, bound, unseen };
    (error.is_finite() && bound.is_finite() && spread.is_finite()).then_some(finding)
}

impl Audit {
    /// Returns the variances of pixels like those in which the audit saw light that the film has not seen: around them,
    /// and of the same counts.
    pub fn raises(&self) -> Raises {
        let all: f64 = self.findings.iter().map(|f| f.bound.max(0.0)).sum();
        let unseen = || self.findings.iter().filter(|f| f.unseen);
        let matters = |f: &&Finding| f.bound * self.findings.len() as f64 > all;
        let around = unseen().filter(matters).map(|f| (f.pixel, f.spread)).collect();
        let floors = (unseen().map(|f| f.bound).sum::<f64>() > 0.1 * all).then(|| {
            let mut floors = [[0.0f64; 2]; OCTAVES];
            for found in &self.findings {
                let [sum, weight] = &mut floors[octave(found.count)];
                *sum += found.weight * if found.unseen { f64::from(found.spread) } else { 0.0 };
                *weight += found.weight;
            }
            floors.map(|[sum, weight]| if weight > 0.0 { (sum / weight) as f32 } else { 0.0 }).to_vec()
        });
        Raises { around, floors }
    }
}

/// Raises variances to what an audit found. Returns the pixels around those that it looked at.
pub fn raise_all(raises: &Raises, variances: &mut [f32], counts: &[u32], width: usize) -> Vec<u32> {
    let mut raised = Vec::new();
    for &(pixel, spread) in &raises.around {
        raise(variances, counts, width, pixel as usize, spread, RADIUS, &mut raised);
    }
    if let Some(floors) = &raises.floors {
        variances.par_iter_mut().zip(counts).for_each(|(variance, &count)| {
            *variance = variance.max(floors[octave(count)] / (2.0 * count as f32));
        });
    }
    raised
}

/// Assumes that the pixels around one vary like it, by a share.
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
            let like = if i == pixel { spread } else { GOAL_SHARE_AROUND as f32 * spread }
                / (2.0 * counts[i] as f32);
            if variances[i] < like {
                variances[i] = like;
                raised.push(i as u32);
            }
        }
    }
}

/// Returns the brightness of a light that each sample either hits or misses: the mean of the squares over the mean.
fn brightness([r, g, b, squares]: &[f32; 4]) -> f64 {
    let mean = f64::from(r.abs().max(g.abs()).max(b.abs()));
    if mean > 0.0 { f64::from(*squares) / mean } else { 0.0 }
}

/// A sum over draws, one from each of many parts of the picture.
struct Total {
    sum: f64,
    variance: f64,
    /// Degrees of freedom of the variance: few if few draws contribute most of it.
    freedom: f64,
}

impl Total {
    /// Treats each two neighbouring parts as one with two draws (collapsed strata: Cochran 1977, 5A.12): their
    /// difference overestimates the variance rather than underestimating it.
    fn new(values: &[f64]) -> Total {
        let squares = values.chunks_exact(2).map(|pair| (pair[0] - pair[1]).powi(2));
        let (variance, fourth) = squares.fold((0.0, 0.0), |(s, f), d| (s + d, f + d * d));
        // For n squares of normal deviates: n² / 3n.
        let freedom = if fourth > 0.0 { 3.0 * variance * variance / fourth } else { 2.0 };
        Total { sum: values.iter().sum(), variance, freedom: freedom.max(2.0) }
    }

    /// Returns half of the interval's length by Student's t (Cornish & Fisher's expansion, Abramowitz & Stegun 26.7.5).
    fn reach(&self) -> f64 {
        let (z, nu) = (DEVIATE, self.freedom);
        let first = (z.powi(3) + z) / 4.0;
        let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
        let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
        (z + first / nu + second / nu.powi(2) + third / nu.powi(3)) * self.variance.sqrt()
    }
}
