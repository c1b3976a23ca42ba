//! Time against the amount of work: `cargo bench -- scaling`, or `cargo bench -- scaling KIND` for one kind. Renders scenes of
//! `scaling_scenes.rs` that differ in one number alone, takes the smallest figures of a few runs, and fits the exponent with
//! which each figure grows. A size that the device refuses is a row with the first words of the message.

use std::fs;
use std::time::Instant;

use crate::scaling_scenes::KINDS;
use crate::{Bench, Outcome, Run};

/// No more runs of a point once they have taken this many seconds together.
const SECONDS_OF_A_POINT: f64 = 4.0;
const MAX_RUNS: usize = 3;
/// A figure that is not this many times its smallest value, and larger by this, is mostly its constant part or noise.
const GROWN: f64 = 1.25;
const GROWN_BY: f64 = 5e-4;
const MESSAGE_CHARACTERS: usize = 60;

/// One kind of work, and how a scene of a given amount of it is made.
pub struct Kind {
    pub name: &'static str,
    /// Completes "time against".
    pub work: &'static str,
    /// Numbers of the points, of which `amount` makes the work.
    pub points: &'static [u32],
    pub amount: fn(u32) -> f64,
    /// Returns the scene of a point, after writing the files that it reads.
    pub scene: fn(u32, &std::path::Path) -> Outcome<String>,
}

/// A column of the tables.
struct Figure {
    name: &'static str,
    value: fn(&Run) -> f64,
}

const FIGURES: [Figure; 7] = [
    Figure { name: "load s", value: |run| run.figure("/seconds/load") },
    Figure { name: "compile s", value: |run| run.figure("/seconds/compile") },
    Figure { name: "upload s", value: |run| run.figure("/seconds/upload") },
    Figure { name: "render s", value: |run| run.figure("/seconds/render") },
    Figure { name: "device s", value: device_seconds },
    Figure { name: "write s", value: |run| run.figure("/seconds/write") },
    Figure { name: "peak MiB", value: |run| run.figure("/process/peak_host_bytes") / f64::from(1 << 20) },
];

/// Returns the device's time for samples and, where there are any, lists of tiles.
fn device_seconds(run: &Run) -> f64 {
    let survey = run.figure("/device_seconds/survey");
    run.figure("/device_seconds/render") + if survey.is_nan() { 0.0 } else { survey }
}

/// Prints the table of each kind, or of those that are named.
pub fn tables(bench: &Bench, names: &[String]) -> Outcome<()> {
    if let Some(unknown) = names.iter().find(|name| KINDS.iter().all(|kind| kind.name != **name)) {
        let known: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        return Err(format!("scaling: no kind \"{unknown}\"; the kinds are {}", known.join(", ")).into());
    }
    for kind in KINDS.iter().filter(|kind| names.is_empty() || names.iter().any(|name| name == kind.name)) {
        table(bench, kind)?;
    }
    Ok(())
}

fn table(bench: &Bench, kind: &Kind) -> Outcome<()> {
    let clock = Instant::now();
    println!("\nTime against {} (`{}`):\n", kind.work, kind.name);
    println!("| {} | {} |", kind.work, FIGURES.map(|figure| figure.name).join(" | "));
    println!("|{}", " --- |".repeat(FIGURES.len() + 1));
    let mut points: Vec<(f64, [f64; FIGURES.len()])> = Vec::new();
    for &number in kind.points {
        let work = (kind.amount)(number);
        match point(bench, kind, number) {
            Ok(figures) => {
                println!("| {work} | {} |", figures.map(|figure| format!("{figure:.4}")).join(" | "));
                points.push((work, figures));
            }
            Err(error) => {
                println!(
                    "| {work} | {} {}|",
                    first_words(&error.to_string()),
                    "| ".repeat(FIGURES.len() - 1)
                );
            }
        }
    }
    let exponents = std::array::from_fn::<_, { FIGURES.len() }, _>(|column| {
        let line: Vec<(f64, f64)> = points.iter().map(|(work, figures)| (*work, figures[column])).collect();
        exponent(&line).map_or("–".into(), |exponent| format!("{exponent:.2}"))
    });
    println!("| exponent | {} |", exponents.join(" | "));
    eprintln!("{}: {:.0} s", kind.name, clock.elapsed().as_secs_f64());
    Ok(())
}

/// Returns the smallest figures of a few runs, in a folder of their own.
fn point(bench: &Bench, kind: &Kind, number: u32) -> Outcome<[f64; FIGURES.len()]> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("scene.toml");
    fs::write(&file, (kind.scene)(number, folder.path())?)?;
    let (file, picture) = (file.display().to_string(), folder.path().join("out.jpg").display().to_string());
    let mut smallest = [f64::INFINITY; FIGURES.len()];
    let clock = Instant::now();
    for _ in 0..bench.runs.clamp(1, MAX_RUNS) {
        let run = bench.run_to(&picture, &file, &[], &[])?;
        for (least, figure) in smallest.iter_mut().zip(&FIGURES) {
            *least = least.min((figure.value)(&run));
        }
        if clock.elapsed().as_secs_f64() > SECONDS_OF_A_POINT {
            break;
        }
    }
    Ok(smallest)
}

/// Returns the beginning of a message, without what would end a cell of the table.
fn first_words(message: &str) -> String {
    let words = message.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric));
    let line = words.collect::<Vec<_>>().join(" ").replace('|', "/");
    match line.char_indices().nth(MESSAGE_CHARACTERS) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}

/// Returns p of time = constant + factor · work^p at the upper end of the range: the constant is the smallest time, and the
/// logarithms of what is above it are fitted by least squares over the last three points. Where the time hardly grows p is 0;
/// without two points there is none.
fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let constant = points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
    let last = &points[points.len().saturating_sub(3)..];
    if last.len() < 2 {
        return None;
    }
    let grown: Vec<(f64, f64)> = last
        .iter()
        .filter(|point| point.1 > (GROWN * constant).max(constant + GROWN_BY))
        .map(|(work, time)| (work.ln(), (time - constant).ln()))
        .collect();
    match grown.len() {
        0 => Some(0.0),
        // All others are constant: the exponent between the last two, with the constant.
        1 => {
            let [.., (work, time), (more, longer)] = last else { return None };
            Some((longer / time).ln() / (more / work).ln())
        }
        count => {
            let mean = |part: fn(&(f64, f64)) -> f64| grown.iter().map(part).sum::<f64>() / count as f64;
            let (x, y) = (mean(|point| point.0), mean(|point| point.1));
            let covariance: f64 = grown.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
            Some(covariance / grown.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>())
        }
    }
}
