//! A case of the stability report: a parameter swept over decades, the error at each value against
//! an exact or float64 reference, and a bound with its reason. Cases create their own scenes and
//! references; the bench provides the device.

use serde::Serialize;

use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::Gpu;

/// One sweep.
pub struct Case {
    /// The subject, such as `coordinates`; cases of one group are listed together.
    pub group: &'static str,
    /// The name, unique in its group.
    pub name: &'static str,
    /// The swept parameter with its unit.
    pub parameter: &'static str,
    /// The unit of the error.
    pub unit: &'static str,
    /// The bound that no error may exceed.
    pub bound: f64,
    /// The derivation of the bound.
    pub reason: &'static str,
    pub run: fn(&Bench<'_>) -> Result<Vec<Point>>,
}

/// The largest error at one value of the parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// The parameter, at least 0: plots are logarithmic.
    pub parameter: f64,
    /// The error, infinite if the answer is NaN or infinity; JSON has null for that.
    pub error: f64,
    /// The pixel, ray or coordinate of the largest error.
    pub place: String,
}

/// The resources on which a case runs.
pub struct Bench<'a> {
    pub gpu: &'a Gpu,
    pub progress: &'a dyn Progress,
    /// True if all geometry is in f32, whatever the scene requires, so that the errors under test
    /// are visible.
    pub rounded: bool,
}

impl Case {
    /// Returns group and name, the case's name on the command line.
    pub fn label(&self) -> String {
        format!("{}/{}", self.group, self.name)
    }
}

impl<'a> Bench<'a> {
    pub fn new(gpu: &'a Gpu, progress: &'a dyn Progress) -> Bench<'a> {
        Bench { gpu, progress, rounded: false }
    }

    /// Returns an error if the report was interrupted. Called between values of the parameter.
    pub fn check_cancelled(&self) -> Result<()> {
        if self.progress.cancelled() { Err(Error::Interrupted) } else { Ok(()) }
    }
}

impl Point {
    /// Returns the largest of (error, place) pairs; NaN counts as infinite.
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
