//! What is computed of a study's points, as data: slopes, winners, times to errors and one sentence. Part of the
//! record.

use serde::Serialize;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Analysis {
    pub recommendation: String,
    /// None where nothing was measured.
    pub recommended: Option<SampleDimension>,
    pub slopes: Vec<MethodSlope>,
    pub winners: Vec<Winner>,
    pub reach: Reach,
}

/// log MSE over log rays, fitted by least squares.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slope {
    pub value: f64,
    /// Half of the 95 % interval (Student's t); none from points that lie on a line by number.
    pub half_width: Option<f64>,
    pub points: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodSlope {
    pub method: String,
    pub fitted: Option<Slope>,
    /// 95 % of the slopes when blocks of pixels are drawn anew: what noise leaves open, whether or not the points
    /// lie on a line.
    pub interval: Option<[f64; 2]>,
    /// What theory says of the variance, steepest last; none where there is no law.
    pub theory: Vec<f64>,
    pub theory_text: String,
}

/// Seconds to each error, by method; none where no measured point is as good.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Reach {
    pub errors: Vec<f64>,
    pub methods: Vec<(String, Vec<Option<f64>>)>,
}

/// The least error within a time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Winner {
    pub budget: f64,
    pub method: String,
    /// Other methods that fit into the time and err the same, but for noise.
    pub ties: Vec<String>,
    pub spp: u32,
    /// What each pixel took, in words.
    pub taken: String,
    pub seconds: f64,
    pub rmse: f64,
    /// Beyond the method's longest point, along its slope. A method that is slow for its samples would
    /// otherwise win all the time in which nothing else was measured.
    pub estimated: bool,
}

/// The recommended point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleDimension {
    pub method: String,
    pub spp: u32,
    pub seconds: f64,
    pub rmse: f64,
}

impl Winner {
    pub fn is_or_ties(&self, method: &str) -> bool {
        self.method == method || self.ties.iter().any(|tie| tie == method)
    }
}
