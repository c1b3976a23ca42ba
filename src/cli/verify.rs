//! `moire verify`: compares a device's samplers with the oracle and prints the results. Exit code 0
//! if every variant is within the device's declared precision or has a known fault of its driver, 1
//! if one is not (with --strict also for known faults), 2 if the device cannot be used.

use std::process::ExitCode;

use super::progress::Bar;
use crate::core::error::{Error, Result};
use crate::gpu::{DeviceSelect, Gpu};
use crate::lab::verify::{report::ConformanceReport, text::text, verify};

/// Compare a device's samplers with the float64 oracle
///
/// Every address mode, filter, mip mode, kind of texture and class of texel formats, over random, awkward and
/// finely stepped coordinates and levels. Exit code 1 if a variant is outside the device's declared
/// precision.
#[derive(clap::Args, Clone, Debug)]
pub struct VerifyArgs {
    /// Device: index, part of its name, cpu or gpu [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them.
    #[arg(long, value_name = "SEL")]
    device: Option<String>,
    /// Only variants whose name contains TEXT, such as "3d" or "mip=linear"; --json names all
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// Print one JSON object with a row for each variant
    #[arg(long)]
    json: bool,
    /// Treat known faults of drivers as failures too
    #[arg(long)]
    strict: bool,
    /// No progress bar
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &VerifyArgs) -> Result<ExitCode> {
    let bar = Bar::new(args.quiet)?;
    let select = match args.device.as_deref() {
        Some("oracle") => {
            return Err(Error::with_help(
                "verify holds a device against the oracle; the oracle itself is no device",
                "name one that `moire devices` lists, or leave --device out",
            ));
        }
        Some(text) => DeviceSelect::parse(text)?,
        None => DeviceSelect::Default,
    };
    let gpu = Gpu::open(&select)?;
    let report = verify(&gpu, args.only.as_deref(), &bar);
    bar.finish();
    let report = report?;
    for message in gpu.messages() {
        super::notify(format_args!("validation: {message}"));
    }
    super::print(if args.json { json(&report)? } else { text(&report) }.trim_end())?;
    Ok(ExitCode::from(if report.passes(args.strict) { 0 } else { 1 }))
}

fn json(report: &ConformanceReport) -> Result<String> {
    serde_json::to_string_pretty(report).map_err(|e| Error::new(format!("the report as JSON: {e}")))
}
