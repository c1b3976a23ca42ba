//! `moire stability`: runs the extreme cases on a device and prints the largest error of each. Exit
//! code 0 if every case is within its bound, 1 if one is not, 2 if the device cannot be used.

use std::path::PathBuf;
use std::process::ExitCode;

use super::inputs::Inputs;
use super::progress::Bar;
use crate::core::error::{Error, Result};
use crate::gpu::{DeviceSelect, Gpu};
use crate::lab::stability::{all, page, run::run as run_cases, text::text};

/// Sweep extreme cases on a device, with errors against float64
///
/// Each case sweeps one parameter over many decades, compares the device's results with exact or float64
/// ones, and the largest error with a derived bound. Exit code 1 if a bound is exceeded.
#[derive(clap::Args, Clone, Debug)]
pub struct StabilityArgs {
    /// Device: index, part of its name, cpu or gpu [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them.
    #[arg(long, value_name = "SEL")]
    device: Option<String>,
    /// Only cases whose name contains TEXT, such as "sums" or "dielectric/"
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// Folder for stability.html, a page with plots, and stability.json
    ///
    /// Its last component is created if it is missing.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print one JSON object with every point
    #[arg(long)]
    json: bool,
    /// No progress bar
    #[arg(short, long)]
    quiet: bool,
}

pub fn run(args: &StabilityArgs) -> Result<ExitCode> {
    let bar = Bar::new(args.quiet)?;
    let select = match args.device.as_deref() {
        Some("oracle") => {
            return Err(Error::with_help(
                "stability holds a device against the oracle; the oracle itself is no device",
                "name one that `moire devices` lists, or leave --device out",
            ));
        }
        Some(text) => DeviceSelect::parse(text)?,
        None => DeviceSelect::Default,
    };
    let _folder = args
        .out
        .as_ref()
        .map(|folder| Inputs::default().prepare_folder(folder, page::PAGE, [page::JSON]))
        .transpose()?;
    let gpu = Gpu::open(&select)?;
    let report = run_cases(&gpu, all(), args.only.as_deref(), &bar);
    bar.finish();
    let report = report?;
    for message in gpu.messages() {
        super::notify(format_args!("validation: {message}"));
    }
    if let Some(folder) = &args.out {
        page::write(folder, &report)?;
    }
    super::print(if args.json { page::json(&report)? } else { text(&report) }.trim_end())?;
    Ok(ExitCode::from(if report.passes() { 0 } else { 1 }))
}
