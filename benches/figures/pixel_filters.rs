//! Noise and times of pixel filters at 64 samples: `cargo bench -- pixel-filters`. For each scene
//! of `data/scenes/bench`, measures the RMSE of each filter against its own picture of 4096 samples
//! of another seed, and on s1a the render time relative to that of a box of one pixel, in
//! interleaved runs.

use std::path::Path;

use moire::internal::scene::model::PixelFilterKind;

use crate::{Bench, Outcome};

const SCENES: [&str; 3] = ["s1a", "s1b", "s2"];

pub fn table(bench: &Bench) -> Outcome<()> {
    let filters = PixelFilterKind::ALL;
    let mut times = vec![Vec::new(); filters.len()];
    for _ in 0..bench.runs {
        for (filter, times) in filters.iter().zip(&mut times) {
            let run = bench.run("s1a", &["--spp", "64", "--pixel-filter", filter.name()], &[])?;
            times.push(run.figure("/device_seconds/render"));
        }
    }
    let fastest = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
    println!("| filter | {} | time |\n| --- | --- | --- | --- | --- |", SCENES.join(" | "));
    for (filter, own) in filters.iter().zip(&times) {
        let mut row = format!("| `{filter}` |");
        for name in SCENES {
            let picture = |options: &[&str]| {
                let all = [options, &["--pixel-filter", filter.name()]].concat();
                bench.run(name, &all, &[])?;
                Outcome::Ok(moire::internal::lab::metrics::read_picture(Path::new(&bench.out()))?)
            };
            let reference = picture(&["--spp", "4096", "--seed", "77"])?;
            row += &format!(
                " {:.2e} |",
                moire::internal::lab::metrics::compare(&picture(&["--spp", "64"])?, &reference)?.rmse
            );
        }
        println!("{row} {:.2} |", fastest(own) / fastest(&times[0]));
    }
    Ok(())
}
