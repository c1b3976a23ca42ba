//! Very many samples in one pixel: the mean of N of them against the mean in float64, |x̄ − μ| / μ.
//! The error under test is that of the sum: N equal terms added one by one in f32 have an error of
//! 1e-3 at N = 2²⁰.

use super::case::{Bench, Case, Point};
use super::scenes::{SCREEN, hashed_unit, in_oracle, on_device, packed, texture};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::integrators::adaptive::{self, Goal};
use crate::oracle::backend::OracleBackend;
use crate::texture::data::{Dimension, TextureData};

const GROUP: &str = "sums";
const PARAMETER: &str = "samples in one pixel";
const UNIT: &str = "of the mean";
/// The exponent of the largest sample count of a scene, 2²⁴.
const MAX_EXPONENT: u32 = 24;
/// The limit for grids. Each block of 256 samples is a submission: 2²⁴ take as long as all the
/// others together.
const MAX_GRID: u32 = 22;
/// The limit for the oracle, which takes a microsecond per sample.
const MAX_IN_ORACLE: u32 = 18;
/// The limit for adaptive pictures, which take at most 2¹⁶ samples in each of two halves.
const MAX_BY_JOBS: u32 = 17;
/// The texels along each side.
const SIDE: u32 = 16;

pub fn cases() -> Vec<Case> {
    let case = |name, bound, reason, run| Case {
        group: GROUP,
        name,
        parameter: PARAMETER,
        unit: UNIT,
        bound,
        reason,
        run,
    };
    vec![
        case("colour", 1e-6, SUMMED, colour),
        case("texels", 1e-6, SUMMED, texels),
        case("noise", 1e-6, NOISE, noise),
        case("jobs-calm", 4.4e-6, BY_JOBS, jobs_calm),
        case("jobs-noise", 4.4e-6, BY_JOBS, jobs_noise),
    ]
}

const SUMMED: &str = "n equal terms summed in f32 are off by 1.5e-8 n at worst; blocks of 32 are summed so, 5e-7, and \
                      added with compensation, 1e-7 whatever their number";
const NOISE: &str = "the same; what rounding does to each sample averages out";
const BY_JOBS: &str = "blocks of 32 samples, and 256 sums of 256 samples one by one: (32 + 256) times 1.5e-8";

fn screen(pattern: &str, algorithm: &str, spp: u32, material: &str) -> String {
    format!(
        "{SCREEN}[image]\nwidth = 1\nheight = 1\n\
         [sampling]\nspp = {spp}\npattern = \"{pattern}\"\nalgorithm = \"{algorithm}\"\n\
         [[material]]\nname = \"m\"\nmodel = \"unlit\"\n{material}\n\
         [[plane]]\norigin = [-0.5, 0.5, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, -1.0, 0.0]\nmaterial = \"m\"\n"
    )
}

const COLOUR: [f32; 3] = [0.1, 0.7, 1e4 / 3.0];

fn coloured(pattern: &str, algorithm: &str, spp: u32) -> String {
    screen(pattern, algorithm, spp, &format!("color = {COLOUR:?}"))
}

fn textured(pattern: &str, algorithm: &str, spp: u32, filter: &str) -> String {
    let texture = "[[texture]]\nname = \"t\"\nfile = \"t.exr\"\n";
    let sampler = format!("[[sampler]]\nname = \"s\"\nfilter = \"{filter}\"\n");
    screen(pattern, algorithm, spp, "texture = \"t\"\nsampler = \"s\"") + texture + &sampler
}

/// Returns values over `decades` around 1, uniform in their logarithm.
fn noise_texture(decades: f64) -> TextureData {
    texture(Dimension::Two, [SIDE, SIDE, 1], |i| 10f64.powf(decades * (hashed_unit(i, 7) - 0.5)) as f32)
}

fn deviation(film: &Film, exact: [f64; 3]) -> f64 {
    let found = film.pixels.first().map_or([f32::NAN; 3], |p| *p);
    let errors = found.iter().zip(exact).map(|(x, mean)| (f64::from(*x) - mean).abs() / mean);
    errors.fold(0.0, |worst, e| if e.is_nan() { f64::INFINITY } else { worst.max(e) })
}

/// Returns powers of four from 2⁸ on.
fn counts(most: u32) -> impl Iterator<Item = u32> {
    (8..=most).step_by(2).map(|bits| 1 << bits)
}

fn point(samples: u32, film: &Film, exact: [f64; 3]) -> Point {
    Point::worst(f64::from(samples), [(deviation(film, exact), "pixel (0, 0)".into())])
}

fn colour(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |spp: u32| {
        let film = on_device(bench, &packed(&coloured("stratified", "samples", spp), vec![], None)?)?;
        Ok(point(spp, &film, COLOUR.map(f64::from)))
    };
    counts(MAX_EXPONENT).map(run).collect()
}

/// Sweeps grids of samples whose side is a multiple of the texture's, so that each texel is hit
/// equally often and the mean is that of the texels.
fn texels(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let texture = noise_texture(7.0);
    let texels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&texture.texels);
    let mean: [f64; 3] =
        std::array::from_fn(|c| texels.iter().map(|t| f64::from(t[c])).sum::<f64>() / texels.len() as f64);
    let run = |spp: u32| {
        let scene = packed(&textured("grid", "samples", spp, "nearest"), vec![texture.clone()], None)?;
        Ok(point(spp, &on_device(bench, &scene)?, mean))
    };
    counts(MAX_GRID).map(run).collect()
}

fn noise(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |spp: u32| {
        let scene = packed(&textured("random", "samples", spp, "linear"), vec![noise_texture(4.0)], None)?;
        let exact = in_oracle(bench, &scene)?;
        Ok(point(spp, &on_device(bench, &scene)?, exact.pixels[0].map(f64::from)))
    };
    counts(MAX_IN_ORACLE).map(run).collect()
}

/// Sweeps nearly equal terms, whose rounding errors are nearly equal too: the worst case of a sum.
fn jobs_calm(bench: &Bench<'_>) -> Result<Vec<Point>> {
    by_jobs(bench, 1e-4)
}

fn jobs_noise(bench: &Bench<'_>) -> Result<Vec<Point>> {
    by_jobs(bench, 4.0)
}

fn by_jobs(bench: &Bench<'_>, decades: f64) -> Result<Vec<Point>> {
    let run = |spp: u32| {
        let scene =
            packed(&textured("random", "adaptive", spp, "linear"), vec![noise_texture(decades)], None)?;
        let goal = Goal::Samples(spp);
        let exact = adaptive::run(
            &mut OracleBackend::new(&scene)?,
            Film::new(1, 1, 0),
            goal,
            false,
            None,
            bench.progress,
        )?
        .film;
        Ok(point(spp, &on_device(bench, &scene)?, exact.pixels[0].map(f64::from)))
    };
    job_counts().map(run).collect()
}

fn job_counts() -> impl Iterator<Item = u32> {
    (9..=MAX_BY_JOBS).step_by(2).map(|bits| 1 << bits)
}
