//! `moire stability`: verdicts of planted errors, the table, the JSON object and the page, and the command on
//! the device under test.

mod command;
mod page;
mod verdicts;

use moire::internal::core::error::Result;
use moire::internal::gpu::{DeviceInfo, DeviceKind};
use moire::internal::lab::stability::case::{Bench, Case, Point};
use moire::internal::lab::stability::report::{Row, StabilityReport};

type Run = fn(&Bench<'_>) -> Result<Vec<Point>>;

fn case(group: &'static str, name: &'static str, bound: f64, run: Run) -> Case {
    Case {
        group,
        name,
        parameter: "distance in metres",
        unit: "pixels",
        bound,
        reason: "half an ulp & no more",
        run,
    }
}

fn none(_: &Bench<'_>) -> Result<Vec<Point>> {
    Ok(Vec::new())
}

fn points(errors: &[f64]) -> Vec<Point> {
    let point = |(i, error): (usize, &f64)| Point {
        parameter: 10f64.powi(i as i32),
        error: *error,
        place: format!("pixel ({i}, 0)"),
    };
    errors.iter().enumerate().map(point).collect()
}

/// Returns the verdict of a case with a bound of 1e-3 pixels and these errors.
fn row(name: &'static str, errors: &[f64]) -> Row {
    Row::new(&case("planted", name, 1e-3, none), Ok(points(errors)), 0.5)
}

fn report(rows: Vec<Row>) -> StabilityReport {
    let device = DeviceInfo {
        index: 0,
        name: "made up".into(),
        kind: DeviceKind::Cpu,
        driver: "of paper <1>".into(),
        api_version: "1.3.0".into(),
        uuid: None,
        limits: Default::default(),
        suitable: Ok(()),
    };
    StabilityReport::new(&device, rows, 12.34)
}
