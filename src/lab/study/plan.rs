//! The points of a study: one for each method and each requested count that its pattern supports,
//! short ones first; and a forecast of the remaining time from the points measured so far.

use crate::core::error::{Error, Result};
use crate::scene::model::{Algorithm, Pattern, Scene};
use crate::scene::{MAX_SPP, check_spp};

use super::method::Method;

/// One method with one count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// The index into the study's methods.
    pub method: usize,
    /// The value of `--spp`.
    pub spp: u32,
    /// The samples actually taken: `center` needs one.
    pub samples: u32,
}

/// Returns the smallest count from `asked` on that the pattern supports.
pub fn next_count(pattern: Pattern, asked: u32) -> Option<u32> {
    (asked..=MAX_SPP).find(|&n| check_spp(pattern, n).is_ok())
}

/// Returns points in the order of the requested counts, so that the longest come last. Counts that
/// a pattern rounds to the same value are measured once.
pub fn points(methods: &[Method], scene: &Scene, counts: &[u32]) -> Result<Vec<Point>> {
    let mut counts = counts.to_vec();
    counts.sort_unstable();
    let mut points: Vec<Point> = Vec::new();
    for &asked in &counts {
        for (method, how) in methods.iter().enumerate() {
            // Few pixels of beams take samples, if any: there is one point, with the largest count.
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

/// A forecast of render times, learnt from measured points.
#[derive(Clone, Debug, Default)]
pub struct Forecast {
    /// Method, samples and seconds of each render so far.
    measured: Vec<(usize, u32, f64)>,
    /// The overhead in seconds when a point was first measured: compiling, comparing.
    overhead: Vec<f64>,
}

/// The number of recent points from which the overhead of the next is predicted.
const RECENT: usize = 8;

impl Forecast {
    pub fn learn(&mut self, point: &Point, seconds: f64) {
        self.measured.push((point.method, point.samples, seconds));
    }

    pub fn learn_beside(&mut self, seconds: f64) {
        self.overhead.push(seconds.max(0.0));
    }

    /// Returns the predicted overhead of a new point: the mean of the last ones.
    pub fn overhead(&self) -> f64 {
        let recent = &self.overhead[self.overhead.len().saturating_sub(RECENT)..];
        recent.iter().sum::<f64>() / recent.len().max(1) as f64
    }

    /// Returns the predicted seconds of one render. Time grows with the samples; for a method
    /// without a measurement it is that of the slowest one.
    pub fn seconds(&self, point: &Point) -> f64 {
        let scaled = |&(_, samples, seconds): &(usize, u32, f64)| {
            let ratio = f64::from(point.samples) / f64::from(samples);
            // Fewer samples save less than proportionally: launching, reading back.
            seconds * if ratio < 1.0 { ratio.sqrt() } else { ratio }
        };
        // The last of equals, because the machine may have become slower.
        let own = self.measured.iter().rev().filter(|s| s.0 == point.method);
        match own.min_by_key(|s| s.1.abs_diff(point.samples)) {
            Some(nearest) => scaled(nearest),
            None => self.measured.iter().map(scaled).fold(0.0, f64::max),
        }
    }
}
