//! Which points a study measures. In: methods and the sample counts asked for. Out: one point for each
//! method and count that its pattern takes, short ones first; and how long the rest will take, from what the
//! points before took.

use crate::core::error::{Error, Result};
use crate::scene::model::{Algorithm, Pattern, Scene};
use crate::scene::{MAX_SPP, check_spp};

use super::method::Method;

/// One method with one count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// Index into the study's methods.
    pub method: usize,
    /// `--spp`.
    pub spp: u32,
    /// Samples that are taken: `center` needs one.
    pub samples: u32,
}

/// The least count from `asked` on that the pattern takes.
pub fn next_count(pattern: Pattern, asked: u32) -> Option<u32> {
    (asked..=MAX_SPP).find(|&n| check_spp(pattern, n).is_ok())
}

/// In the order of the counts asked for, so that what takes longest comes last. Counts that a pattern rounds
/// to the same are measured once.
pub fn points(methods: &[Method], scene: &Scene, counts: &[u32]) -> Result<Vec<Point>> {
    let mut counts = counts.to_vec();
    counts.sort_unstable();
    let mut points: Vec<Point> = Vec::new();
    for &asked in &counts {
        for (method, how) in methods.iter().enumerate() {
            // Few pixels of beams take samples, if any: one point, with the most.
            if how.algorithm == Algorithm::Beam && Some(&asked) != counts.last() {
                continue;
            }
            let pattern = how.pattern_in(scene);
            let spp = next_count(pattern, asked).ok_or_else(|| {
                Error::new(format!("--spp: pattern \"{pattern}\" takes no count from {asked} on"))
            })?;
            let point = Point { method, spp, samples: how.apply(scene, spp)?.sampling.samples() };
            if !points.iter().any(|p| (p.method, p.samples) == (method, point.samples)) {
                points.push(point);
            }
        }
    }
    Ok(points)
}

/// How long points take, learnt from those that were measured.
#[derive(Clone, Debug, Default)]
pub struct Forecast {
    /// (method, samples, seconds) of one render.
    seen: Vec<(usize, u32, f64)>,
    /// Seconds beside rendering that points took when they were measured first: compiling, comparing.
    beside: Vec<f64>,
}

/// As many points tell how long the next will take beside rendering.
const RECENT: usize = 8;

impl Forecast {
    pub fn learn(&mut self, point: &Point, seconds: f64) {
        self.seen.push((point.method, point.samples, seconds));
    }

    pub fn learn_beside(&mut self, seconds: f64) {
        self.beside.push(seconds.max(0.0));
    }

    /// Seconds beside rendering of a point that is measured first: the mean of the last ones.
    pub fn beside(&self) -> f64 {
        let recent = &self.beside[self.beside.len().saturating_sub(RECENT)..];
        recent.iter().sum::<f64>() / recent.len().max(1) as f64
    }

    /// Seconds of one render. Time grows with the samples; of a method that was not seen yet, it is that of
    /// the slowest one.
    pub fn seconds(&self, point: &Point) -> f64 {
        let scaled = |&(_, samples, seconds): &(usize, u32, f64)| {
            let ratio = f64::from(point.samples) / f64::from(samples);
            // Fewer samples save less than their share: launching, reading back.
            seconds * if ratio < 1.0 { ratio.sqrt() } else { ratio }
        };
        // The last of equals: the machine may have become slower.
        let own = self.seen.iter().rev().filter(|s| s.0 == point.method);
        match own.min_by_key(|s| s.1.abs_diff(point.samples)) {
            Some(nearest) => scaled(nearest),
            None => self.seen.iter().map(scaled).fold(0.0, f64::max),
        }
    }
}
