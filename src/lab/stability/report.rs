//! The report: rows with a verdict for each case, as plain data that `--json` prints. A case is
//! within its bound if the largest error of its points is at most the bound; NaN and infinity
//! exceed every bound.

use serde::{Serialize, Serializer};

use super::case::{Case, Point};
use crate::core::named::named_enum;
use crate::gpu::DeviceInfo;

named_enum! {
    pub enum Verdict {
        Within = "within",
        Broken = "broken",
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// One case with its result.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub group: &'static str,
    pub name: &'static str,
    pub parameter: &'static str,
    pub unit: &'static str,
    pub bound: f64,
    pub reason: &'static str,
    /// The point with the largest error, or a placeholder if there are no points.
    pub worst: Point,
    pub points: Vec<Point>,
    pub seconds: f64,
    pub verdict: Verdict,
}

impl Row {
    /// Creates a row. `outcome` holds the case's points, or the reason why there are none.
    pub fn new(case: &Case, outcome: Result<Vec<Point>, String>, seconds: f64) -> Row {
        let (mut points, why) = match outcome {
            Ok(points) => (points, "no value was measured".to_string()),
            Err(message) => (Vec::new(), message),
        };
        for point in points.iter_mut().filter(|p| p.error.is_nan()) {
            point.error = f64::INFINITY;
        }
        let nothing = || Point { parameter: f64::NAN, error: f64::INFINITY, place: why };
        let worst = points.iter().max_by(|a, b| a.error.total_cmp(&b.error)).cloned().unwrap_or_else(nothing);
        let verdict = if worst.error <= case.bound { Verdict::Within } else { Verdict::Broken };
        Row {
            group: case.group,
            name: case.name,
            parameter: case.parameter,
            unit: case.unit,
            bound: case.bound,
            reason: case.reason,
            worst,
            points,
            seconds,
            verdict,
        }
    }

    pub fn label(&self) -> String {
        format!("{}/{}", self.group, self.name)
    }

    /// Returns the smallest and largest value of the parameter.
    pub fn range(&self) -> Option<[f64; 2]> {
        let values = || self.points.iter().map(|p| p.parameter);
        Some([values().reduce(f64::min)?, values().reduce(f64::max)?])
    }
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Summary {
    pub cases: usize,
    pub points: usize,
    pub within: usize,
    pub broken: usize,
}

#[derive(Clone, Debug, Serialize)]
pub struct StabilityReport {
    pub device: String,
    pub driver: String,
    pub api_version: String,
    pub seconds: f64,
    pub summary: Summary,
    #[serde(rename = "cases")]
    pub rows: Vec<Row>,
}

impl StabilityReport {
    pub fn new(device: &DeviceInfo, rows: Vec<Row>, seconds: f64) -> StabilityReport {
        let count = |verdict| rows.iter().filter(|r| r.verdict == verdict).count();
        StabilityReport {
            device: device.name.clone(),
            driver: device.driver.clone(),
            api_version: device.api_version.clone(),
            seconds,
            summary: Summary {
                cases: rows.len(),
                points: rows.iter().map(|r| r.points.len()).sum(),
                within: count(Verdict::Within),
                broken: count(Verdict::Broken),
            },
            rows,
        }
    }

    pub fn passes(&self) -> bool {
        self.summary.broken == 0
    }

    pub fn broken(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|r| r.verdict == Verdict::Broken)
    }
}
