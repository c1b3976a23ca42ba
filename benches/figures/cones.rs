//! One cone per pixel against samples: `cargo bench -- cones`. For each scene of
//! `data/scenes/bench`, measures the RMSE against its reference and the render time, in interleaved
//! runs.

use std::path::Path;

use crate::{Bench, Outcome};

const SCENES: [&str; 3] = ["s1a", "s1b", "s2"];
const METHODS: [(&str, &[&str]); 6] = [
    ("1 sample, centre", &["--pattern", "center"]),
    ("4 samples", &["--spp", "4"]),
    ("16 samples", &["--spp", "16"]),
    ("64 samples", &["--spp", "64"]),
    (
        "1 sample, centre, anisotropic",
        &["--pattern", "center", "--footprint", "cone", "--filter", "anisotropic", "--mip", "linear"],
    ),
    ("one cone", &["--algorithm", "cone"]),
];

pub fn table(bench: &Bench) -> Outcome<()> {
    println!("| method | {} |\n| --- | --- | --- | --- |", SCENES.join(" | "));
    let mut cells = vec![Vec::new(); METHODS.len()];
    for name in SCENES {
        let reference =
            moire::internal::lab::metrics::read_picture(Path::new(&format!("data/reference/{name}.exr")))?;
        let mut times = vec![Vec::new(); METHODS.len()];
        let mut errors = vec![0.0; METHODS.len()];
        for run in 0..=bench.runs {
            for (i, (_, options)) in METHODS.iter().enumerate() {
                let seconds = bench.run(name, options, &[])?.figure("/device_seconds/render");
                if run == 0 {
                    let picture = moire::internal::lab::metrics::read_picture(Path::new(&bench.out()))?;
                    errors[i] = moire::internal::lab::metrics::compare(&picture, &reference)?.rmse;
                } else {
                    times[i].push(seconds);
                }
            }
        }
        for (i, cell) in cells.iter_mut().enumerate() {
            times[i].sort_by(f64::total_cmp);
            cell.push(format!("{:.2e} ({:.0} ms)", errors[i], 1e3 * times[i][times[i].len() / 2]));
        }
    }
    for ((method, _), cell) in METHODS.iter().zip(&cells) {
        println!("| {method} | {} |", cell.join(" | "));
    }
    Ok(())
}
