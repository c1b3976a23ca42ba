//! Errors and times of sample patterns at 64 samples: `cargo bench -- patterns`. For each scene of
//! `data/scenes/bench`, measures the RMSE against its reference, and on s1a the render time
//! relative to that of `stratified`, in interleaved runs.

use std::path::Path;

use moire::internal::scene::model::Pattern;

use crate::{Bench, Outcome};

const SCENES: [&str; 3] = ["s1a", "s1b", "s2"];

pub fn table(bench: &Bench) -> Outcome<()> {
    let patterns = || Pattern::ALL.iter().filter(|p| **p != Pattern::Center);
    let mut times = vec![Vec::new(); patterns().count()];
    for _ in 0..bench.runs {
        for (pattern, times) in patterns().zip(&mut times) {
            let run = bench.run("s1a", &["--spp", "64", "--pattern", pattern.name()], &[])?;
            times.push(run.figure("/device_seconds/render"));
        }
    }
    let fastest = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
    let stratified = patterns().position(|p| *p == Pattern::Stratified).ok_or("no pattern stratified")?;
    let base = fastest(&times[stratified]);
    println!("| pattern | {} | time |\n| --- | --- | --- | --- | --- |", SCENES.join(" | "));
    for (pattern, times) in patterns().zip(&times) {
        let mut row = format!("| `{pattern}` |");
        for name in SCENES {
            bench.run(name, &["--spp", "64", "--pattern", pattern.name()], &[])?;
            let reference = moire::internal::lab::metrics::read_picture(Path::new(&format!(
                "data/reference/{name}.exr"
            )))?;
            let picture = moire::internal::lab::metrics::read_picture(Path::new(&bench.out()))?;
            row += &format!(" {:.2e} |", moire::internal::lab::metrics::compare(&picture, &reference)?.rmse);
        }
        println!("{row} {:.2} |", fastest(times) / base);
    }
    Ok(())
}
