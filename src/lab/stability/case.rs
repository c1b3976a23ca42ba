//! What a case of the stability report is: a parameter swept over decades, the error against an exact or
//! float64 answer at each value, and a bound with the reason for it. Cases make their own scenes and answers;
//! the bench lends them the device.

use serde::Serialize;

use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::Gpu;

/// One sweep.
pub struct Case {
    /// What it is about, such as `coordinates`; cases of one group stand together.
    pub group: &'static str,
    /// Unique in its group.
    pub name: &'static str,
    /// What is swept, with its unit.
    pub parameter: &'static str,
    /// In what the error is measured.
    pub unit: &'static str,
    /// No error may be above it.
    pub bound: f64,
    /// Why that is the bound.
    pub reason: &'static str,
    pub run: fn(&Bench<'_>) -> Result<Vec<Point>>,
}

/// The worst error at one value of the parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// 0 or above: plots are logarithmic.
    pub parameter: f64,
    /// Infinite where the answer is no number; JSON has null for that.
    pub error: f64,
    /// Where it was reached: pixel, ray, coordinate.
    pub place: String,
}

/// What a case runs on.
pub struct Bench<'a> {
    pub gpu: &'a Gpu,
    pub progress: &'a dyn Progress,
    /// All geometry is of f32, whatever the scene needs: what cases are for has to show then.
    pub rounded: bool,
}

impl Case {
    /// Its group and its name: what it is called on the command line.
    pub fn label(&self) -> String {
        format!("{}/{}", self.group, self.name)
    }
}

impl<'a> Bench<'a> {
    pub fn new(gpu: &'a Gpu, progress: &'a dyn Progress) -> Bench<'a> {
        Bench { gpu, progress, rounded: false }
    }

    /// To be asked between values of the parameter: an interrupted report stops here.
    pub fn go_on(&self) -> Result<()> {
        if self.progress.cancelled() { Err(Error::Interrupted) } else { Ok(()) }
    }
}

impl Point {
    /// The worst of (error, place) pairs; no number counts as infinite.
    pub fn worst(parameter: f64, errors: impl IntoIterator<Item = (f64, String)>) -> Point {
        let mut worst = Point { parameter, error: 0.0, place: "everywhere".into() };
        for (error, place) in errors {
            let error = if error.is_nan() { f64::INFINITY } else { error };
            if error > worst.error {
                worst = Point { parameter, error, place };
            }
        }
        worst
    }
}
