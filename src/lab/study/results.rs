//! What is computed of a study's points, as data: slopes, winners, times to errors and one sentence. Part of the
//! record.

use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Analysis {
    pub recommendation: String,
    /// The recommended point, absent if nothing was measured.
    pub recommended: Option<RecommendedPoint>,
    /// Absent if nothing was measured twice, or no other method comes to the recommended point's error.
    pub steadiness: Option<Steadiness>,
    pub slopes: Vec<MethodSlope>,
    pub winners: Vec<Winner>,
    pub reach: Reach,
}

/// The slope of log MSE over log rays, fitted by least squares.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slope {
    pub value: f64,
    /// Half of the 95 % interval (Student's t); absent if there are too few points for a residual.
    pub half_width: Option<f64>,
    pub points: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodSlope {
    pub method: String,
    pub fitted: Option<Slope>,
    /// The 95 % interval of the slopes over bootstrap samples of pixel blocks: the uncertainty due
    /// to noise, whether or not the points lie on a line.
    pub interval: Option<[f64; 2]>,
    /// The slopes that theory predicts for the variance, steepest last; empty if there is no law.
    pub theory: Vec<f64>,
    pub theory_text: String,
}

/// Seconds to each error, by method; absent if no measured point is as good.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Reach {
    pub errors: Vec<f64>,
    pub methods: Vec<(String, Vec<Option<f64>>)>,
}

/// An RMSE without the reference's own, and the interval of 95 % that noise leaves open. The lower end is 0 where the error
/// cannot be told from none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OwnError {
    pub rmse: f64,
    pub low: f64,
    pub high: f64,
}

/// The smallest error within a time budget.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Winner {
    pub budget: f64,
    pub method: String,
    /// Other methods within the budget whose errors are not significantly different.
    pub ties: Vec<String>,
    pub spp: u32,
    /// The samples per pixel as text.
    pub taken: String,
    pub seconds: f64,
    /// The error without the reference's own.
    pub rmse: f64,
    /// The interval of 95 % of the error: by noise, and by the slope if it is extrapolated.
    pub interval: [f64; 2],
    /// True if the error is extrapolated along the slope beyond the method's longest point. Without
    /// that, a slow method would win all the time in which nothing else was measured.
    pub estimated: bool,
}

/// The recommended point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecommendedPoint {
    pub method: String,
    pub spp: u32,
    pub seconds: f64,
    /// The error without the reference's own.
    pub rmse: f64,
}

/// Whether the times tell the recommended method from the one that comes to its error next to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Steadiness {
    /// The neighbour, and the seconds in which it comes to the error of the recommended point.
    pub next: String,
    pub next_seconds: f64,
    /// Between both times, as a part of the recommended point's.
    pub difference: f64,
    /// Of repeats: longest − shortest, as a part of the median; of both methods the larger one.
    pub spread: f64,
    pub tells_apart: bool,
}

impl Winner {
    pub fn is_or_ties(&self, method: &str) -> bool {
        self.method == method || self.ties.iter().any(|tie| tie == method)
    }
}
