//! Runs cases on a device and returns the report. A failing case is recorded as such; cancellation
//! or a lost device ends the run.

use std::time::Instant;

use super::case::{Bench, Case};
use super::report::{Row, StabilityReport};
use crate::core::error::{Error, Result};
use crate::core::progress::{Progress, SubProgress};
use crate::gpu::{BufferUse, Gpu};

/// Runs the cases whose label, such as `sums/colour`, contains `only`.
pub fn run(
    gpu: &Gpu,
    mut cases: Vec<Case>,
    only: Option<&str>,
    progress: &dyn Progress,
) -> Result<StabilityReport> {
    let start = Instant::now();
    if let Some(text) = only {
        let names: Vec<String> = cases.iter().map(Case::label).collect();
        cases.retain(|c| c.label().contains(text));
        if cases.is_empty() {
            return Err(Error::with_help(
                format!("no case has \"{text}\" in its name"),
                format!("the cases are {}", names.join(", ")),
            ));
        }
    }
    let share = 1.0 / cases.len().max(1) as f64;
    let mut rows = Vec::with_capacity(cases.len());
    for (done, case) in cases.iter().enumerate() {
        let from = done as f64 * share;
        let part = SubProgress { whole: progress, from, to: from + share };
        let bench = Bench::new(gpu, &part);
        bench.check_cancelled()?;
        let clock = Instant::now();
        let outcome = match (case.run)(&bench) {
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            Err(error) => {
                check_alive(gpu)?;
                Err(message(&error))
            }
            Ok(points) => Ok(points),
        };
        rows.push(Row::new(case, outcome, clock.elapsed().as_secs_f64()));
        progress.advance(from + share);
    }
    Ok(StabilityReport::new(gpu.info(), rows, start.elapsed().as_secs_f64()))
}

/// Returns an error if the device is lost: then every call fails.
fn check_alive(gpu: &Gpu) -> Result<()> {
    let mut word = [0; 4];
    let buffer = gpu.upload_buffer("a sign of life", BufferUse::Storage, &[0; 4])?;
    gpu.read_buffer(&buffer, 0, &mut word)
}

/// Returns the message with its advice.
fn message(error: &Error) -> String {
    error.help().map_or(error.to_string(), |help| format!("{error} ({help})"))
}
