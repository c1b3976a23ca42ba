//! The measurements that the README states: `cargo bench`, `cargo bench -- filters` for the errors
//! of filters at equal time, `cargo bench -- patterns` for those of sample patterns, `cargo bench
//! -- pixel-filters` for those of pixel filters, `cargo bench -- cones` for cones against samples,
//! `cargo bench -- mips` for mip chains alone, `cargo bench -- meshes` for a million triangles, `cargo
//! bench -- scaling` for time against the amount of work, `cargo bench -- budgets` for `auto` against the
//! best fixed choice in the same time. Runs the program itself on the scenes of
//! `data/scenes/bench` and prints Markdown: medians over whole processes, the ratio of lean to full
//! pipelines from interleaved runs, errors against the float64 references. `MOIRE_DEVICE` chooses
//! the device (default cpu), `MOIRE_BENCH_RUNS` the number of runs (default 5).

mod budgets;
mod cones;
mod equal_time;
mod meshes;
mod mips;
mod patterns;
mod pixel_filters;
mod scaling;
mod scaling_scenes;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// One run of the program: its JSON, and the wall time of the whole process.
struct Run {
    json: Value,
    wall: f64,
}

impl Run {
    fn figure(&self, pointer: &str) -> f64 {
        self.json.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN)
    }
}

/// `MOIRE_BIN`, else the program that was built with this.
fn program() -> PathBuf {
    std::env::var_os("MOIRE_BIN").map_or(env!("CARGO_BIN_EXE_moire").into(), PathBuf::from)
}

struct Bench {
    device: String,
    runs: usize,
    picture: tempfile::TempDir,
}

impl Bench {
    fn scene(name: &str) -> String {
        format!("data/scenes/bench/{name}.toml")
    }

    fn out(&self) -> String {
        self.picture.path().join("out.exr").display().to_string()
    }

    fn run(&self, name: &str, options: &[&str], environment: &[(&str, &str)]) -> Outcome<Run> {
        self.run_file(&Self::scene(name), options, environment)
    }

    fn run_file(&self, scene: &str, options: &[&str], environment: &[(&str, &str)]) -> Outcome<Run> {
        self.run_to(&self.out(), scene, options, environment)
    }

    fn run_to(
        &self,
        picture: &str,
        scene: &str,
        options: &[&str],
        environment: &[(&str, &str)],
    ) -> Outcome<Run> {
        let clock = Instant::now();
        let output = Command::new(program())
            .args(["render", scene, "-o", picture, "--json", "-q", "--device", &self.device])
            .args(options)
            .envs(environment.iter().copied())
            .output()?;
        let wall = clock.elapsed().as_secs_f64();
        if !output.status.success() {
            // A program that was killed says nothing.
            let message = String::from_utf8_lossy(&output.stderr);
            return Err(if message.is_empty() { output.status.to_string().into() } else { message.into() });
        }
        Ok(Run { json: serde_json::from_slice(&output.stdout)?, wall })
    }

    /// The runs that count, after one that does not.
    fn repeat(&self, name: &str, options: &[&str], environment: &[(&str, &str)]) -> Outcome<Vec<Run>> {
        self.run(name, options, environment)?;
        (0..self.runs).map(|_| self.run(name, options, environment)).collect()
    }

    fn times(&self) -> Outcome<()> {
        println!(
            "| scene, samples | render s | device s | CPU s, whole process | wall s, whole process | peak MiB |"
        );
        println!("| --- | --- | --- | --- | --- | --- |");
        for (name, spp) in [("s1a", "16"), ("s1a", "64"), ("s1b", "64"), ("s2", "64")] {
            let runs = self.repeat(name, &["--spp", spp], &[])?;
            println!(
                "| {name}, {spp} | {:.3} | {:.4} | {:.2} | {:.3} | {:.0} |",
                median(&runs, |r| r.figure("/seconds/render")),
                median(&runs, |r| r.figure("/device_seconds/render")),
                median(&runs, |r| r.figure("/process/cpu_seconds")),
                median(&runs, |r| r.wall),
                median(&runs, |r| r.figure("/process/peak_host_bytes")) / f64::from(1 << 20),
            );
        }
        let cold = self.repeat("s1a", &["--spp", "16"], &[("MESA_SHADER_CACHE_DISABLE", "true")])?;
        println!("\ns1a, 16 samples, shader cache off: whole process {:.3} s", median(&cold, |r| r.wall));
        Ok(())
    }

    /// Lean and full pipelines in turn, so that a drift of the machine's speed meets both.
    fn lean(&self) -> Outcome<()> {
        let mut ratios = Vec::new();
        for _ in 0..self.runs.min(3) {
            let lean = self.run("s1a", &["--spp", "64"], &[])?.figure("/device_seconds/render");
            let full = self.run("s1a", &["--spp", "64", "--keep-everything"], &[])?;
            ratios.push(full.figure("/device_seconds/render") / lean);
        }
        ratios.sort_by(f64::total_cmp);
        println!(
            "\ns1a, 64 samples, --keep-everything: {:.1} times the lean pipeline's time",
            ratios[ratios.len() / 2]
        );
        Ok(())
    }

    /// The pictures whose device time a GPU is measured by.
    fn large(&self) -> Outcome<()> {
        println!("\n| scene, 16 samples | size | method | device ms |\n| --- | --- | --- | --- |");
        for (name, size, method) in [
            ("s1a", "4096x4096", "shader"),
            ("s1a", "4096x4096", "hardware"),
            ("s1b", "4096x4096", "shader"),
            ("s1b", "4096x4096", "hardware"),
            ("s2", "2048x2048", "shader"),
        ] {
            let runs = self.repeat(name, &["--size", size, "--spp", "16", "--method", method], &[])?;
            let milliseconds = 1e3 * median(&runs, |r| r.figure("/device_seconds/render"));
            println!("| {name} | {size} | {method} | {milliseconds:.3} |");
        }
        Ok(())
    }

    fn errors(&self) -> Outcome<()> {
        println!("\n| scene | RMSE at 64 | 256 | 1024 samples |\n| --- | --- | --- | --- |");
        for name in ["s1a", "s1b", "s2"] {
            let reference = moire::internal::lab::metrics::read_picture(Path::new(&format!(
                "data/reference/{name}.exr"
            )))?;
            let mut row = format!("| {name} ");
            for spp in ["64", "256", "1024"] {
                self.run(name, &["--spp", spp], &[])?;
                let picture = moire::internal::lab::metrics::read_picture(Path::new(&self.out()))?;
                row +=
                    &format!("| {:.3e} ", moire::internal::lab::metrics::compare(&picture, &reference)?.rmse);
            }
            println!("{row}|");
        }
        Ok(())
    }
}

fn median(runs: &[Run], figure: impl Fn(&Run) -> f64) -> f64 {
    let mut values: Vec<f64> = runs.iter().map(figure).collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() -> Outcome<()> {
    let runs = std::env::var("MOIRE_BENCH_RUNS").ok().and_then(|n| n.parse().ok()).unwrap_or(5);
    let device = std::env::var("MOIRE_DEVICE").unwrap_or("cpu".into());
    let bench = Bench { device, runs, picture: tempfile::tempdir()? };
    let first = bench.run("s1a", &["--spp", "1"], &[])?;
    println!("{}, {runs} runs each\n", first.json["device"].as_str().unwrap_or("?"));
    let mut arguments = std::env::args().skip_while(|argument| argument != "scaling");
    if arguments.next().is_some() {
        let kinds: Vec<String> = arguments.filter(|argument| !argument.starts_with('-')).collect();
        return scaling::tables(&bench, &kinds);
    }
    let mut arguments = std::env::args().skip_while(|argument| argument != "budgets");
    if arguments.next().is_some() {
        let scenes: Vec<String> = arguments.filter(|argument| !argument.starts_with('-')).collect();
        return budgets::table(&bench, &scenes);
    }
    if std::env::args().any(|argument| argument == "filters") {
        return equal_time::table(&bench);
    }
    if std::env::args().any(|argument| argument == "mips") {
        return mips::table(&bench);
    }
    if std::env::args().any(|argument| argument == "meshes") {
        return meshes::table(&bench);
    }
    if std::env::args().any(|argument| argument == "cones") {
        return cones::table(&bench);
    }
    if std::env::args().any(|argument| argument == "patterns") {
        return patterns::table(&bench);
    }
    if std::env::args().any(|argument| argument == "pixel-filters") {
        return pixel_filters::table(&bench);
    }
    bench.times()?;
    bench.lean()?;
    mips::table(&bench)?;
    if first.json["driver"].as_str().is_some_and(|d| !d.contains("llvmpipe")) {
        bench.large()?;
    }
    bench.errors()
}
