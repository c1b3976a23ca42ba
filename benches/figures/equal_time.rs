//! Errors of filters at equal time: `cargo bench -- filters`. For each scene of `data/scenes/bench`
//! and each filter, measures the RMSE reached in the render time of 64 samples without a footprint.
//! Counts of stratified samples are squares, so that the time lies between two of them: the
//! logarithm of the error is interpolated over that of the time. One sample at the pixel's centre
//! is measured too. Times are ratios to the unfiltered scene, from interleaved runs.

use std::fs;
use std::path::Path;

use moire::internal::core::film::Film;

use crate::{Bench, Outcome};

const BASE: &str = "64";
const ROUNDS: usize = 3;
const SIDES: std::ops::RangeInclusive<u32> = 1..=24;
const FILTERS: [(&str, &str, &str); 8] = [
    ("trilinear", "linear", "cone"),
    ("trilinear", "linear", "differentials"),
    ("anisotropic", "anisotropic", "cone"),
    ("anisotropic", "anisotropic", "differentials"),
    ("EWA", "ewa", "cone"),
    ("EWA", "ewa", "differentials"),
    ("summed areas", "summed-area", "cone"),
    ("stochastic", "stochastic", "cone"),
];

/// A scene twice: as it is, and with a pyramid of levels.
struct Pair {
    plain: String,
    mipped: String,
    reference: Film,
}

/// What a number of samples costs, over the time of the unfiltered scene, and how far off it is.
#[derive(Clone, Copy)]
struct Point {
    samples: f64,
    time: f64,
    rmse: f64,
}

impl Pair {
    fn new(bench: &Bench, name: &str) -> Outcome<Pair> {
        let plain = Bench::scene(name);
        let textures = fs::canonicalize("data/textures")?.display().to_string();
        let text = fs::read_to_string(&plain)?
            .replace("../../textures", &textures)
            .replace("filter = \"linear\"", "filter = \"linear\"\nmip = \"linear\"");
        let mipped = bench.picture.path().join(format!("{name}.toml"));
        fs::write(&mipped, text)?;
        let reference =
            moire::internal::lab::metrics::read_picture(Path::new(&format!("data/reference/{name}.exr")))?;
        Ok(Pair { plain, mipped: mipped.display().to_string(), reference })
    }

    fn time(bench: &Bench, scene: &str, options: &[&str]) -> Outcome<f64> {
        Ok(bench.run_file(scene, options, &[])?.figure("/device_seconds/render"))
    }

    fn error(&self, bench: &Bench) -> Outcome<f64> {
        let picture = moire::internal::lab::metrics::read_picture(Path::new(&bench.out()))?;
        Ok(moire::internal::lab::metrics::compare(&picture, &self.reference)?.rmse)
    }

    fn point(&self, bench: &Bench, filter: &str, footprint: &str, side: u32) -> Outcome<Point> {
        let samples = side * side;
        let count = samples.to_string();
        let options = ["--filter", filter, "--footprint", footprint, "--spp", &count];
        let mut ratios = Vec::new();
        for _ in 0..ROUNDS {
            let base = Pair::time(bench, &self.plain, &["--spp", BASE])?;
            ratios.push(Pair::time(bench, &self.mipped, &options)? / base);
        }
        Ok(Point { samples: f64::from(samples), time: middle(ratios), rmse: self.error(bench)? })
    }

    /// One sample in the centre of each pixel: its error and its time.
    fn centred(&self, bench: &Bench, filter: &str, footprint: &str) -> Outcome<String> {
        let options = ["--filter", filter, "--footprint", footprint, "--pattern", "center"];
        let mut ratios = Vec::new();
        for _ in 0..ROUNDS {
            let base = Pair::time(bench, &self.plain, &["--spp", BASE])?;
            ratios.push(Pair::time(bench, &self.mipped, &options)? / base);
        }
        Ok(format!("{:.2e} ({:.2})", self.error(bench)?, middle(ratios)))
    }

    /// The error in the time of the unfiltered scene. A filter that takes longer even for one sample is
    /// shown with its time.
    fn cell(&self, bench: &Bench, filter: &str, footprint: &str) -> Outcome<String> {
        let at = |side: u32| self.point(bench, filter, footprint, side);
        let guess = at(3)?;
        let mut side = ((3.0 / guess.time.sqrt()) as u32).clamp(*SIDES.start(), *SIDES.end() - 1);
        let mut low = at(side)?;
        while low.time > 1.0 && side > *SIDES.start() {
            side -= 1;
            low = at(side)?;
        }
        if low.time > 1.0 {
            return Ok(format!("{:.2e} (1, in {:.1} times the time)", low.rmse, low.time));
        }
        let mut high = at(side + 1)?;
        while high.time < 1.0 && side + 1 < *SIDES.end() {
            side += 1;
            (low, high) = (high, at(side + 1)?);
        }
        let share = (1.0 / low.time).ln() / (high.time / low.time).ln();
        let between = |a: f64, b: f64| (a.ln() + share * (b / a).ln()).exp();
        Ok(format!("{:.2e} ({:.0})", between(low.rmse, high.rmse), between(low.samples, high.samples)))
    }
}

fn middle(mut ratios: Vec<f64>) -> f64 {
    ratios.sort_by(f64::total_cmp);
    ratios[ratios.len() / 2]
}

pub fn table(bench: &Bench) -> Outcome<()> {
    let names = ["s1a", "s1b", "s2"];
    let pairs = names.iter().map(|name| Pair::new(bench, name)).collect::<Outcome<Vec<Pair>>>()?;
    println!("| filter | footprint | {} |\n| --- | --- | --- | --- | --- |", names.join(" | "));
    let mut row = String::from("| linear | none |");
    for pair in &pairs {
        Pair::time(bench, &pair.plain, &["--spp", BASE])?;
        row += &format!(" {:.2e} ({BASE}) |", pair.error(bench)?);
    }
    println!("{row}");
    for (label, filter, footprint) in FILTERS {
        let mut row = format!("| {label} | {footprint} |");
        for pair in &pairs {
            row += &format!(" {} |", pair.cell(bench, filter, footprint)?);
        }
        println!("{row}");
    }
    println!("\n| one sample | footprint | {} |\n| --- | --- | --- | --- | --- |", names.join(" | "));
    for (label, filter, footprint) in [("linear", "linear", "none")].iter().chain(&FILTERS) {
        let mut row = format!("| {label} | {footprint} |");
        for pair in &pairs {
            row += &format!(" {} |", pair.centred(bench, filter, footprint)?);
        }
        println!("{row}");
    }
    Ok(())
}
