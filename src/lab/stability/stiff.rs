//! Detail of very different scales in one picture: does the error still decrease with the samples?
//! Each picture is compared with exact areas and integrals (the oracle's beams); random samples
//! converge as N^-1/2, and a scene whose detail is missed converges more slowly.

use super::case::{Bench, Case, Point};
use super::scenes::{hashed_unit, in_oracle, on_device, packed, texture};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::pack::PackedScene;
use crate::texture::data::{Dimension, TextureData};

const SIDE: u32 = 32;
const SPP: [u32; 4] = [16, 64, 256, 1024];

pub fn cases() -> Vec<Case> {
    let case = |name, unit, reason, run| Case {
        group: "stiff",
        name,
        parameter: "samples a pixel",
        unit,
        bound: 1.5,
        reason,
        run,
    };
    let law = "of the error at N^-1/2";
    vec![
        case("texels-of-two-scales", law, FALLS, texels),
        case("needle-before-horizon", law, FALLS, needle),
        case("bright-point", law, FALLS, bright),
        case("bright-point-adaptive", "of the error of as many everywhere", FINDS, bright_adaptive),
    ]
}

const FALLS: &str = "independent samples err by sigma N^-1/2, from the first picture on; that its sigma is estimated from 1024 \
                     pixels, few of which see the detail, may cost a third";
const FINDS: &str = "adaptive samples go where the error is and may not do worse than the same number everywhere; both are \
                     estimates from few pixels. A pixel takes 2^17 samples at most, then its error stays";

const CAMERA: &str = "[camera]\neye = [0.0, 1.0, 0.0]\nlook_at = [0.0, 0.55, -2.0]\nvertical_fov = 50.0\n[image]\nwidth = 32\nheight = 32\n";
const SURFACES: &str = "[[texture]]\nname = \"t\"\nfile = \"t.exr\"\n[[sampler]]\nname = \"s\"\nfilter = \"nearest\"\n\
[[material]]\nname = \"fine\"\nmodel = \"unlit\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = { kind = \"surface\", scale = [62.5, 62.5] }\n\
[[material]]\nname = \"coarse\"\nmodel = \"unlit\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = { kind = \"surface\", scale = [6.25e-5, 6.25e-5], offset = [0.3, 0.4] }\n";

fn noise(bright: bool) -> TextureData {
    // Bright: one texel of 65504 among 4096 dark ones.
    let side = if bright { 64 } else { 16 };
    texture(Dimension::Two, [side, side, 1], |i| match bright {
        true if i / 4 == side * (side / 2) + side / 3 => 65504.0,
        true => 0.01,
        false => hashed_unit(i, 5) as f32,
    })
}

/// Returns the RMSE over all channels.
fn rmse(one: &Film, other: &Film) -> f64 {
    let squares = one
        .pixels
        .iter()
        .zip(&other.pixels)
        .flat_map(|(a, b)| [0, 1, 2].map(|c| (f64::from(a[c]) - f64::from(b[c])).powi(2)));
    (squares.sum::<f64>() / (3.0 * one.pixels.len() as f64)).sqrt()
}

/// Returns the pixel with the largest error.
fn worst_pixel(one: &Film, other: &Film) -> String {
    let error =
        |i: usize| one.pixels[i].iter().zip(other.pixels[i]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let worst = (0..one.pixels.len()).max_by(|&i, &j| error(i).total_cmp(&error(j))).unwrap_or(0);
    format!("pixel ({}, {}) off by {:.1e}", worst as u32 % SIDE, worst as u32 / SIDE, error(worst))
}

/// Returns a scene of these shapes with random samples, and its exact picture.
fn scene(shapes: &str, spp: u32, algorithm: &str, bright: bool) -> Result<PackedScene> {
    let sampling = format!("[sampling]\npattern = \"random\"\nspp = {spp}\nalgorithm = \"{algorithm}\"\n");
    packed(&(CAMERA.to_string() + &sampling + SURFACES + shapes), vec![noise(bright)], None)
}

fn falls(bench: &Bench<'_>, shapes: &str, bright: bool) -> Result<Vec<Point>> {
    let exact = in_oracle(bench, &scene(shapes, 1, "beam", bright)?)?;
    let mut points = Vec::new();
    let mut start = None;
    for spp in SPP {
        let picture = on_device(bench, &scene(shapes, spp, "samples", bright)?)?;
        let scaled = rmse(&picture, &exact) * f64::from(spp).sqrt();
        let first = *start.get_or_insert(scaled);
        points.push(Point::worst(f64::from(spp), [(scaled / first, worst_pixel(&picture, &exact))]));
    }
    Ok(points)
}

/// Sweeps texels of 1e-3 on the ground and of 1e3 on a wall behind it.
fn texels(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let shapes = "[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 0.0, 1.0]\nhalf_extent = 4.0\nmaterial = \"fine\"\n\
                  [[plane]]\norigin = [0.0, 0.0, -1e4]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 1.0, 0.0]\nmaterial = \"coarse\"\n";
    falls(bench, shapes, false)
}

/// Sweeps a needle a hundredth of a pixel wide.
fn needle(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let shapes = "[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 0.0, 1.0]\nmaterial = \"fine\"\n\
                  [[triangle]]\nvertices = [[-0.5, 0.4, -1.0], [0.6, 1.2, -1.1], [0.6, 1.2005, -1.1]]\nmaterial = \"coarse\"\n";
    falls(bench, shapes, false)
}

const WALL: &str = "[[plane]]\norigin = [-1.0, 1.55, -2.0]\ntangent = [2.0, 0.0, 0.0]\nbitangent = [0.0, -2.0, 0.0]\nmaterial = \"wall\"\n\
                    [[material]]\nname = \"wall\"\nmodel = \"unlit\"\ntexture = \"t\"\nsampler = \"s\"\n";

fn bright(bench: &Bench<'_>) -> Result<Vec<Point>> {
    falls(bench, WALL, true)
}

fn bright_adaptive(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let exact = in_oracle(bench, &scene(WALL, 1, "beam", true)?)?;
    let run = |spp: u32| {
        let even = on_device(bench, &scene(WALL, spp, "samples", true)?)?;
        let picture = on_device(bench, &scene(WALL, spp, "adaptive", true)?)?;
        let error = rmse(&picture, &exact) / rmse(&even, &exact);
        Ok(Point::worst(f64::from(spp), [(error, worst_pixel(&picture, &exact))]))
    };
    SPP.into_iter().map(run).collect()
}
