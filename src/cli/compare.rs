//! `moire compare A B`: prints error measures between two pictures. Exit code 0 if they agree
//! within the bounds, 1 if a measure is above its bound or a NaN is present, 2 if they cannot be
//! compared.

use std::path::PathBuf;
use std::process::ExitCode;

use serde::Serialize;

use super::inputs::Inputs;
use super::interrupt;
use crate::core::counted::counted;
use crate::core::error::{Error, Result};
use crate::core::film::Placement;
use crate::lab::metrics::{Comparison, common, compare, difference, flip, read_placed};
use crate::output::{self, WriteOptions};

/// Compare two pictures in linear RGB
///
/// They have the same size. Alpha is ignored, grey is replicated; 8- and 16-bit files are decoded from sRGB, float files are linear. If an EXR
/// file is a part of a picture, that part is compared. Exit code 1 if a NaN is present or a figure is above its bound.
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
    /// Largest mean FLIP, from 0 to 1
    #[arg(long, value_name = "X", value_parser = bound, allow_negative_numbers = true)]
    pub max_flip: Option<f64>,
    /// Largest difference of one channel of a pixel, in linear light
    #[arg(long, value_name = "X", value_parser = bound, allow_negative_numbers = true)]
    pub max_diff: Option<f64>,
    /// Picture of |A − B|, scaled to white
    ///
    /// The largest difference is white; pixels with NaN are magenta.
    #[arg(long, value_name = "OUT.png")]
    pub diff: Option<PathBuf>,
    /// Print only what is above a bound, and errors
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    a: String,
    b: String,
    #[serde(flatten)]
    comparison: &'a Comparison,
    flip: f64,
    /// The compared region of the picture that contains both: x, y, width, height.
    part: Option<[u32; 4]>,
    max_rmse: Option<f64>,
    max_flip: Option<f64>,
    max_diff: Option<f64>,
    pass: bool,
}

pub fn run(args: &CompareArgs) -> Result<ExitCode> {
    interrupt::ends_at_once()?;
    if let Some(path) = &args.diff {
        Inputs::of(&args.a, "the first picture").and(&args.b, "the second picture").check_picture(path)?;
    }
    let both = common(read_placed(&args.a)?, read_placed(&args.b)?)?;
    let mut comparison = compare(&both.a, &both.b)?;
    if let Some(path) = &args.diff {
        let picture = difference::scaled(&both.a, &both.b, &comparison)?;
        output::write(
            &picture,
            path,
            &WriteOptions { placement: Some(both.placement), ..Default::default() },
        )?;
    }
    comparison.max_at = comparison.max_at.map(|at| [0, 1].map(|i| at[i] + both.placement.corner[i]));
    let flip = flip(&both.a, &both.b)?;
    let faults = faults(args, &comparison, flip);
    if args.json {
        super::print(&json(args, &comparison, flip, both.placement, faults.is_empty())?)?;
    } else if !args.quiet {
        super::print(&table(args, &comparison, flip, both.placement))?;
    }
    faults.iter().for_each(super::notify);
    Ok(ExitCode::from(u8::from(!faults.is_empty())))
}

fn bound(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("a finite number of at least 0 is needed".into()),
    }
}

fn json(
    args: &CompareArgs,
    comparison: &Comparison,
    flip: f64,
    placement: Placement,
    pass: bool,
) -> Result<String> {
    let name = |path: &PathBuf| path.display().to_string();
    let report = Report {
        a: name(&args.a),
        b: name(&args.b),
        comparison,
        flip,
        part: part(comparison, placement),
        max_rmse: args.max_rmse,
        max_flip: args.max_flip,
        max_diff: args.max_diff,
        pass,
    };
    serde_json::to_string_pretty(&report).map_err(|e| Error::new(format!("the report as JSON: {e}")))
}

/// Returns the compared region, or `None` if it is the whole picture.
fn part(c: &Comparison, placement: Placement) -> Option<[u32; 4]> {
    let [x, y] = placement.corner;
    (placement != Placement::whole(c.width, c.height)).then_some([x, y, c.width, c.height])
}

fn table(args: &CompareArgs, c: &Comparison, flip: f64, placement: Placement) -> String {
    let of = part(c, placement).map_or(String::new(), |[x, y, ..]| {
        format!("  at ({x}, {y}) of {}×{}", placement.full[0], placement.full[1])
    });
    let at = c.max_at.map_or(String::new(), |[x, y]| format!("  at pixel ({x}, {y})"));
    let rows = [
        ("A", args.a.display().to_string()),
        ("B", args.b.display().to_string()),
        ("size", format!("{}×{}{of}", c.width, c.height)),
        ("RMSE", format!("{:.6e}", c.rmse)),
        ("MSE", format!("{:.6e}", c.mse)),
        ("relative MSE", format!("{:.6e}", c.relative_mse)),
        ("max", format!("{:.6e}{at}", c.max)),
        ("PSNR", if c.mse == 0.0 { "infinite: equal".into() } else { format!("{:.2} dB", c.psnr) }),
        ("over 1/255", format!("{:.4} %  ({})", c.over_1_255 * 100.0, counted(c.over_1_255_pixels, "pixel"))),
        ("FLIP", format!("{flip:.6}")),
        ("NaN pixels", c.nan_pixels.to_string()),
    ];
    rows.iter().map(|(name, value)| format!("{name:<14}{value}")).collect::<Vec<_>>().join("\n")
}

/// Returns the reasons why the pictures disagree, one line each.
fn faults(args: &CompareArgs, c: &Comparison, flip: f64) -> Vec<String> {
    if c.nan_pixels > 0 {
        return vec![format!("NaN in {}", counted(c.nan_pixels, "pixel"))];
    }
    if !c.rmse.is_finite() {
        return vec!["the pictures differ by an infinite value".into()];
    }
    let figures =
        [("RMSE", c.rmse, args.max_rmse), ("FLIP", flip, args.max_flip), ("max", c.max, args.max_diff)];
    let above = figures
        .into_iter()
        .filter_map(|(name, value, bound)| Some((name, value, bound.filter(|b| value > *b)?)));
    above.map(|(name, value, bound)| format!("{name} {value:.6e} is above the bound {bound:e}")).collect()
}
