//! `moire pattern NAME`: shows the points of a sample pattern in a pixel, as a picture with their
//! power spectrum, and as numbers.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use serde_json::json;

use super::inputs::Inputs;
use super::{interrupt, named_parser};
use crate::core::counted::counted;
use crate::core::error::{Error, Result};
use crate::lab::pattern::measures::{mean_nearest_distance, occupied, star_discrepancy};
use crate::lab::pattern::picture::picture;
use crate::lab::pattern::points::Set;
use crate::lab::pattern::spectrum::{self, Spectrum};
use crate::oracle::patterns::HALTON_PAIRS;
use crate::output::{self, WriteOptions};
use crate::scene::check_spp;
use crate::scene::model::Pattern;

/// The largest number of points: more would merge into grey, and their spectra take minutes.
const MAX_POINTS: u32 = 4096;

/// Show a sample pattern and its power spectrum
///
/// The picture. Above: the points with the pattern's strata and their projections on both axes; the mean
/// power spectrum (black 0, middle grey 1 as of random points, white 2 and more); its radial mean from 0 to
/// 2, with lines at 1 and at the frequency of the square root of the number of points. Below: the points of
/// the next three pairs of dimensions, then x with the next pair's x, y with y, x with y.
#[derive(Debug, clap::Args)]
pub struct PatternArgs {
    /// Pattern
    #[arg(value_name = "NAME", value_parser = named_parser(Pattern::NAMES, Pattern::from_name))]
    name: Pattern,
    /// Picture to write
    #[arg(short, long, value_name = "OUT.png")]
    out: Option<PathBuf>,
    /// Points in the pixel; `center` has one
    #[arg(long, value_name = "N", default_value = "64", allow_negative_numbers = true)]
    spp: u32,
    /// Another set of random positions
    #[arg(long, value_name = "N", default_value = "1", allow_negative_numbers = true)]
    seed: u32,
    /// Pair of dimensions: 0 is the position in the pixel
    #[arg(long, value_name = "K", default_value = "0", value_parser = clap::value_parser!(u32).range(..i64::from(HALTON_PAIRS)))]
    pair: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Measures of the first realisation, except for the radial mean, which is over all.
struct Measures {
    star_discrepancy: f64,
    nearest_distance: Option<f64>,
    /// Columns and rows of about √N each.
    cells: [u32; 2],
    occupied: u32,
    /// The number of occupied columns of N, and of occupied rows of N.
    occupied_lines: [u32; 2],
    radial_mean: Vec<f64>,
}

pub fn run(args: &PatternArgs) -> Result<ExitCode> {
    interrupt::ends_at_once()?;
    let samples = samples(args)?;
    if let Some(path) = &args.out {
        Inputs::default().check_picture(path)?;
    }
    let set = Set { pattern: args.name, samples, seed: args.seed, pair: args.pair };
    let count = spectrum::realisations_for(samples);
    let spectrum = spectrum::mean(|number| set.realisation(number), count, spectrum::limit_for(samples));
    if let Some(path) = &args.out {
        output::write(&picture(&set, &spectrum), path, &WriteOptions::default())?;
    }
    let measures = measure(&set, &spectrum);
    let text = if args.json {
        format!("{:#}", report(args, &set, &spectrum, &measures))
    } else {
        table(args, &set, &spectrum, &measures)
    };
    super::print(text.trim_end()).map(|()| ExitCode::SUCCESS)
}

fn samples(args: &PatternArgs) -> Result<u32> {
    if args.spp > MAX_POINTS {
        return Err(Error::new(format!(
            "--spp: {} points cannot be told apart in a picture; use 1 to {MAX_POINTS}",
            args.spp
        )));
    }
    check_spp(args.name, args.spp).map_err(|what| Error::new(format!("--spp: {what}")))?;
    Ok(if args.name == Pattern::Center { 1 } else { args.spp })
}

fn measure(set: &Set, spectrum: &Spectrum) -> Measures {
    let points = set.realisation(0);
    let columns = set.samples.isqrt();
    let cells = [columns, set.samples.div_ceil(columns)];
    Measures {
        star_discrepancy: star_discrepancy(&points),
        nearest_distance: mean_nearest_distance(&points),
        cells,
        occupied: occupied(&points, cells[0], cells[1]),
        occupied_lines: [occupied(&points, set.samples, 1), occupied(&points, 1, set.samples)],
        radial_mean: spectrum.radial_mean(),
    }
}

fn report(args: &PatternArgs, set: &Set, spectrum: &Spectrum, measures: &Measures) -> serde_json::Value {
    json!({
        "pattern": set.pattern.name(),
        "points": set.samples,
        "seed": set.seed,
        "pair": set.pair,
        "star_discrepancy": measures.star_discrepancy,
        "mean_nearest_distance": measures.nearest_distance,
        "strata": {
            "columns": measures.cells[0],
            "rows": measures.cells[1],
            "occupied": measures.occupied,
            "occupied_of_n_columns": measures.occupied_lines[0],
            "occupied_of_n_rows": measures.occupied_lines[1],
        },
        "realisations": spectrum.realisations,
        "radial_mean": measures.radial_mean,
        "out": args.out.as_ref().map(|path| path.display().to_string()),
    })
}

fn table(args: &PatternArgs, set: &Set, spectrum: &Spectrum, measures: &Measures) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<20}{value}");
    };
    line("pattern", format!("{}, pair {}, seed {}", set.pattern, set.pair, set.seed));
    line("points", set.samples.to_string());
    line("star discrepancy", format!("{:.6}", measures.star_discrepancy));
    line("nearest distance", measures.nearest_distance.map_or("-".into(), |d| format!("{d:.6}, mean")));
    let [columns, rows] = measures.cells;
    let [x, y] = measures.occupied_lines;
    line("strata with points", format!("{} of {columns}×{rows}", measures.occupied));
    line("in N strips", format!("{}, {}", counted(x, "column"), counted(y, "row")));
    // The mean over frequencies 1 … √N/2, where blue-noise patterns have little power.
    let low = (set.samples.isqrt() as usize / 2).max(1);
    let mean = measures.radial_mean[..low].iter().sum::<f64>() / low as f64;
    line("low frequencies", format!("{mean:.4} of random's power, up to {low}"));
    line("realisations", spectrum.realisations.to_string());
    if let Some(path) = &args.out {
        line("written", path.display().to_string());
    }
    text
}
