//! What `--budget` reaches against the best fixed choice: `cargo bench -- budgets [SCENE…]`. For each scene and each
//! time, measures the RMSE of `auto` in that time, and of each fixed choice in the time that it takes; between two counts
//! of one method, errors are interpolated over time, both as logarithms. References are two renders of many samples
//! with different seeds, kept under `target/budgets`: half of their difference is the error of their mean, which is
//! subtracted from what is measured. `MOIRE_BUDGETS` lists other times, `MOIRE_REFERENCE_SPP` another number of samples.

use std::fs;
use std::path::{Path, PathBuf};

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::{Halves, compare, read_picture};

use crate::{Bench, Outcome, Run};

const SCENES: [&str; 10] = [
    "data/scenes/lecture.toml",
    "data/scenes/horizon.toml",
    "data/scenes/bench/s1a.toml",
    "data/scenes/bench/s1b.toml",
    "data/scenes/bench/s2.toml",
    "data/scenes/filters.toml",
    "data/scenes/procedural.toml",
    "data/scenes/physical.toml",
    "data/scenes/meshes.toml",
    "data/scenes/penumbra.toml",
];
const BUDGETS: &str = "0.02,0.05,0.2,1";
const REFERENCE_SPP: &str = "4096";
const PREFILTERED: [&str; 2] = ["--mip", "linear"];
/// Each method with its options and the samples to try; 0 for a method that takes none.
const METHODS: [(&str, &[&str], &[u32]); 13] = [
    ("center", &["--pattern", "center"], &[0]),
    ("sobol-owen", &["--pattern", "sobol-owen"], &[1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 4096, 16384]),
    ("multi-jittered", &["--pattern", "multi-jittered"], &[4, 16, 64, 256, 1024]),
    ("blue-noise", &["--pattern", "blue-noise"], &[4, 16, 64, 256]),
    ("grid", &["--pattern", "grid"], &[4, 16, 64, 256]),
    ("n-rooks", &["--pattern", "n-rooks"], &[4, 16]),
    ("adaptive", &["--algorithm", "adaptive", "--pattern", "sobol-owen"], &[4, 16, 64, 256, 1024, 4096]),
    ("center, trilinear", &["--pattern", "center", "--footprint", "cone", "--filter", "linear"], &[0]),
    ("center, anisotropic", &["--pattern", "center", "--footprint", "cone", "--filter", "anisotropic"], &[0]),
    ("center, EWA", &["--pattern", "center", "--footprint", "cone", "--filter", "ewa"], &[0]),
    (
        "sobol-owen, anisotropic",
        &["--pattern", "sobol-owen", "--footprint", "cone", "--filter", "anisotropic"],
        &[1, 2, 4, 8, 16, 64, 256],
    ),
    ("cone", &["--algorithm", "cone"], &[0]),
    ("beam", &["--algorithm", "beam", "--pattern", "sobol-owen"], &[16, 64]),
];

/// A measured render: its time and its error.
#[derive(Clone, Copy)]
struct Point {
    spp: u32,
    seconds: f64,
    rmse: f64,
}

struct Reference {
    mean: Film,
    /// The mean squared error of the mean.
    mse: f64,
}

impl Reference {
    fn new(bench: &Bench, scene: &str) -> Outcome<Reference> {
        let spp = std::env::var("MOIRE_REFERENCE_SPP").unwrap_or(REFERENCE_SPP.into());
        let [a, b] = [Self::part(bench, scene, "101", &spp)?, Self::part(bench, scene, "202", &spp)?];
        let halves = Halves { a, b };
        Ok(Reference { mean: halves.mean(), mse: halves.rmse()?.powi(2) })
    }

    /// Renders one of the two, unless it is there already.
    fn part(bench: &Bench, scene: &str, seed: &str, spp: &str) -> Outcome<Film> {
        let folder = PathBuf::from("target/budgets");
        fs::create_dir_all(&folder)?;
        let stem = Path::new(scene).file_stem().unwrap_or_default().display().to_string();
        let path = folder.join(format!("{stem}-{spp}-{seed}.exr"));
        if !path.exists() {
            let sampling = ["--algorithm", "samples", "--pattern", "sobol-owen", "--footprint", "none"];
            let options = [&sampling[..], &["--spp", spp, "--seed", seed]].concat();
            bench.run_to(&path.display().to_string(), scene, &options, &[])?;
        }
        Ok(read_picture(&path)?)
    }

    fn rmse(&self, picture: &Film) -> Outcome<f64> {
        let measured = compare(picture, &self.mean)?.rmse.powi(2);
        Ok((measured - self.mse).max(0.1 * self.mse).sqrt())
    }
}

fn seconds(run: &Run) -> f64 {
    run.figure("/seconds/render") + run.figure("/seconds/readback")
}

/// Renders several times; returns the median time and the error of the picture in that run.
fn measure(bench: &Bench, scene: &str, reference: &Reference, options: &[&str]) -> Outcome<(Point, Run)> {
    let mut runs = Vec::new();
    for _ in 0..bench.runs {
        let run = bench.run_file(scene, options, &[])?;
        let rmse = reference.rmse(&read_picture(Path::new(&bench.out()))?)?;
        runs.push((Point { spp: 0, seconds: seconds(&run), rmse }, run));
    }
    runs.sort_by(|a, b| a.0.seconds.total_cmp(&b.0.seconds));
    let middle = runs.len() / 2;
    Ok(runs.swap_remove(middle))
}

/// Returns the points of a method, up to the first that takes longer than the longest time.
fn points(
    bench: &Bench,
    scene: &str,
    reference: &Reference,
    method: usize,
    longest: f64,
) -> Outcome<Vec<Point>> {
    let (_, options, counts) = METHODS[method];
    let mut points = Vec::new();
    for &spp in counts {
        let count = spp.to_string();
        let mut options = options.to_vec();
        if !options.contains(&"--footprint") {
            options.extend(["--footprint", "none"]);
        } else {
            options.extend(PREFILTERED);
        }
        if options.contains(&"cone") && options.contains(&"--algorithm") {
            options.truncate(2);
        }
        if spp > 0 {
            options.extend(["--spp", &count]);
        }
        // Some scenes do not allow some methods.
        let Ok((point, _)) = measure(bench, scene, reference, &options) else { break };
        points.push(Point { spp, ..point });
        if point.seconds > longest {
            break;
        }
    }
    Ok(points)
}

/// Returns the error of a method in a time, and the samples that it took there.
fn within(points: &[Point], budget: f64) -> Option<(f64, f64)> {
    let at = points.iter().rposition(|point| point.seconds <= budget)?;
    let low = points[at];
    let Some(high) = points.get(at + 1) else { return Some((low.rmse, low.spp.into())) };
    let share = (budget / low.seconds).ln() / (high.seconds / low.seconds).ln();
    let between = |a: f64, b: f64| (a.ln() + share * (b / a).ln()).exp();
    let rmse = between(low.rmse, high.rmse).min(low.rmse);
    Some((rmse, between(low.spp.into(), high.spp.into())))
}

fn rows(bench: &Bench, scene: &str, budgets: &[f64]) -> Outcome<()> {
    let reference = Reference::new(bench, scene)?;
    let longest = budgets.iter().fold(0.0f64, |a, &b| a.max(b));
    let mut measured = Vec::new();
    for (method, (name, ..)) in METHODS.iter().enumerate() {
        let points = points(bench, scene, &reference, method, longest)?;
        if std::env::var_os("MOIRE_BENCH_POINTS").is_some() {
            for Point { spp, seconds, rmse } in &points {
                println!("  {name} {spp}: {:.1} ms, {rmse:.2e}", 1e3 * seconds);
            }
        }
        measured.push((*name, points));
    }
    let stem = Path::new(scene).file_stem().unwrap_or_default().display();
    for &budget in budgets {
        let options = ["--budget", &budget.to_string()];
        let (auto, run) = measure(bench, scene, &reference, &options)?;
        let reached = run.json.pointer("/reached").cloned().unwrap_or_default();
        let chosen = reached.pointer("/chosen").and_then(|c| c.as_str()).unwrap_or("adaptive").to_owned();
        let estimated = reached.pointer("/estimated_rmse").and_then(|e| e.as_f64()).unwrap_or(f64::NAN);
        let best = measured.iter().filter_map(|(name, points)| Some((name, within(points, budget)?)));
        let best = best.min_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let best = best.map_or("none | | ".into(), |(name, (rmse, spp))| {
            let spp = if spp > 0.0 { format!(" {spp:.0}") } else { String::new() };
            format!("{name}{spp} | {rmse:.2e} | {:.2}", auto.rmse / rmse)
        });
        println!(
            "| {stem} | {:.0} ms | {chosen} | {:.0} ms | {:.2e} | {estimated:.2e} | {best} |",
            1e3 * budget,
            1e3 * auto.seconds,
            auto.rmse
        );
    }
    Ok(())
}

pub fn table(bench: &Bench, scenes: &[String]) -> Outcome<()> {
    let times = std::env::var("MOIRE_BUDGETS").unwrap_or(BUDGETS.into());
    let budgets = times.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
    println!("| scene | budget | auto | takes | RMSE | estimated | best fixed choice | RMSE | ratio |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let all = SCENES.map(str::to_owned);
    for scene in if scenes.is_empty() { &all[..] } else { scenes } {
        rows(bench, scene, &budgets)?;
    }
    Ok(())
}
