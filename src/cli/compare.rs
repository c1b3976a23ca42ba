//! `moire compare A B`: prints how far two pictures are apart. Exit 0 when they agree well enough, 1
//! when the RMSE is above the bound or a NaN is present, 2 when they cannot be compared.

use std::path::PathBuf;
use std::process::ExitCode;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::metrics::{Comparison, compare, difference, flip, read_picture};
use crate::output::{self, WriteOptions};

/// Compare two pictures of the same size in linear RGB
///
/// Alpha is ignored, grey is replicated; 8- and 16-bit files are decoded from sRGB, float files are
/// taken as linear. Exit code 1 when a NaN is present or the RMSE is above --max-rmse.
#[derive(Debug, clap::Args)]
pub struct CompareArgs {
    /// First picture (PNG, JPEG, TIFF, TGA, HDR or EXR)
    pub a: PathBuf,
    /// Second picture, usually the reference
    pub b: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Largest RMSE that counts as agreement
    #[arg(long, value_name = "X", value_parser = bound, allow_negative_numbers = true)]
    pub max_rmse: Option<f64>,
    /// Write |A − B|, scaled so that the largest difference is white; pixels with NaN are magenta
    #[arg(long, value_name = "OUT.png")]
    pub diff: Option<PathBuf>,
}

#[derive(Serialize)]
struct Report<'a> {
    a: String,
    b: String,
    #[serde(flatten)]
    comparison: &'a Comparison,
    flip: f64,
    max_rmse: Option<f64>,
    pass: bool,
}

pub fn run(args: &CompareArgs) -> Result<ExitCode> {
    if let Some(path) = &args.diff {
        output::check_writable(path)?;
    }
    let (a, b) = (read_picture(&args.a)?, read_picture(&args.b)?);
    let comparison = compare(&a, &b)?;
    if let Some(path) = &args.diff {
        let picture = difference::scaled(&a, &b, &comparison)?;
        output::write(&picture, path, &WriteOptions::default())?;
    }
    let pass = comparison.passes(args.max_rmse);
    let flip = flip(&a, &b)?;
    let text = if args.json { json(args, &comparison, flip, pass)? } else { table(args, &comparison, flip) };
    super::print(&text)?;
    if !pass {
        super::tell(reason(&comparison, args.max_rmse));
    }
    Ok(ExitCode::from(if pass { 0 } else { 1 }))
}

fn bound(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("a finite number of at least 0 is needed".into()),
    }
}

fn json(args: &CompareArgs, comparison: &Comparison, flip: f64, pass: bool) -> Result<String> {
    let name = |path: &PathBuf| path.display().to_string();
    let report =
        Report { a: name(&args.a), b: name(&args.b), comparison, flip, max_rmse: args.max_rmse, pass };
    serde_json::to_string_pretty(&report).map_err(|e| Error::new(format!("the report as JSON: {e}")))
}

fn table(args: &CompareArgs, c: &Comparison, flip: f64) -> String {
    let at = c.max_at.map_or(String::new(), |[x, y]| format!("  at pixel ({x}, {y})"));
    let rows = [
        ("A", args.a.display().to_string()),
        ("B", args.b.display().to_string()),
        ("size", format!("{}×{}", c.width, c.height)),
        ("RMSE", format!("{:.6e}", c.rmse)),
        ("MSE", format!("{:.6e}", c.mse)),
        ("relative MSE", format!("{:.6e}", c.relative_mse)),
        ("max", format!("{:.6e}{at}", c.max)),
        ("PSNR", if c.mse == 0.0 { "infinite: equal".into() } else { format!("{:.2} dB", c.psnr) }),
        ("over 1/255", format!("{:.4} %  ({} pixels)", c.over_1_255 * 100.0, c.over_1_255_pixels)),
        ("FLIP", format!("{flip:.6}")),
        ("NaN pixels", c.nan_pixels.to_string()),
    ];
    rows.iter().map(|(name, value)| format!("{name:<14}{value}")).collect::<Vec<_>>().join("\n")
}

fn reason(c: &Comparison, bound: Option<f64>) -> String {
    match bound {
        _ if c.nan_pixels > 0 => format!("NaN in {} pixels", c.nan_pixels),
        Some(x) if c.rmse.is_finite() => format!("RMSE {:.6e} is above the bound {x:e}", c.rmse),
        _ => "the pictures differ by an infinite value".into(),
    }
}
