//! Filters over footprints from a millionth of a texel to a million texels: long, flat, degenerate
//! or not finite. The error of texture lookups is measured in f64 against means of texels in closed
//! form where there is one, else against the oracle.

use std::path::Path;

use super::areas::box_mean;
use super::case::{Bench, Case, Point};
use super::probing::{coordinates, decades, described, noise, oracle, over, scene, worst};
use crate::core::error::Result;
use crate::core::progress::NoProgress;
use crate::lab::probe::{LookupQuery, lookups};
use crate::lab::verify::queries::Rng;
use crate::oracle::backend::render as oracle_render;
use crate::pack::{self, PackedScene};
use crate::render::{Tuning, render};
use crate::scene::parse;
use crate::texture::sampler_spec::{Filter, MipMode, SamplerSpec};

const WIDTH: &str = "width of the footprint in texels";
const OF_RANGE: &str = "range of the texels";

pub fn cases() -> Vec<Case> {
    let sweep = |name, bound, reason, run| Case {
        group: "footprints",
        name,
        parameter: WIDTH,
        unit: OF_RANGE,
        bound,
        reason,
        run,
    };
    let levels = "weights are exact; sixteen products and sums round to 2^-24, 1e-6, and the share of a level by a \
                  logarithm's rounding to 2^-24 of up to 13, 8e-7";
    vec![
        sweep("trilinear", 2e-6, levels, |bench| widths(bench, Filter::Linear, Filter::Linear)),
        sweep(
            "cubic-and-trilinear",
            4e-6,
            "as trilinear; cubic weights round, and overshoot by 1.6",
            |bench| widths(bench, Filter::Cubic, Filter::Cubic),
        ),
        sweep(
            "anisotropic",
            1e-5,
            "as trilinear; places along the axis round to 2^-24 of 64 texels, 4e-6 on two axes",
            |bench| widths(bench, Filter::Linear, Filter::Anisotropic),
        ),
        sweep(
            "elliptical",
            1e-5,
            "the squared distance in an ellipse cancels by the square of its length in widths, here at most 9: eight \
             roundings of 2^-24, times 9, times 1.2, the slope of the weight, twice as weights are divided by their sum",
            |bench| widths(bench, Filter::Linear, Filter::Ewa),
        ),
        sweep(
            "sums-over-areas",
            2e-5,
            "the four sides of a box of at least a texel round to 2^-24 of 64 texels, 4e-6 each",
            areas,
        ),
        sweep(
            "stochastic",
            6.0,
            "mean of 4096 look-ups, in standard errors: 5.5 of them have a chance of 1e-6 in 25 means; and \
             half of one for the texels that rounding chooses otherwise",
            chances,
        ),
        Case {
            group: "footprints",
            name: "long",
            parameter: "length over width of a footprint",
            unit: OF_RANGE,
            bound: 1.5e-4,
            reason: "as elliptical, with 16² for 9: where the filters end, the ellipse grows no longer; weights count once, as \
                     they are off alike along it",
            run: lengths,
        },
        Case {
            group: "footprints",
            name: "normal-incidence",
            parameter: "angle between the view and the normal, in radians",
            unit: OF_RANGE,
            bound: 2e-4,
            reason: "as elliptical, and a place that is hit rounds a few times to 2^-24 of 64 texels; where the                      projected axis vanishes any other is as good",
            run: incidence,
        },
        Case {
            group: "footprints",
            name: "degenerate",
            parameter: "length of an axis in tiles",
            unit: "distance from the range of the texels, of the range",
            bound: 1e-5,
            reason: "a mean with positive weights lies among the texels, but for the roundings of its weights",
            run: degenerate,
        },
        Case {
            group: "footprints",
            name: "no-numbers",
            parameter: "number of the pair of axes",
            unit: "distance from the mean of the texels, of the range",
            bound: 1e-5,
            reason: "an axis that is no number, or endless, is as wide as the widest, of which the last level is the \
                     answer",
            run: no_numbers,
        },
    ]
}

pub const SIDE: u32 = 64;
/// The range of the texels, [-2, 6].
pub const RANGE: f64 = 8.0;
/// A factor that keeps powers of ten away from those of two, at which levels and counts step.
const OFF: f64 = 1.3;

fn spec(mag: Filter, min: Filter) -> SamplerSpec {
    SamplerSpec { mag, min, mip: MipMode::Linear, ..Default::default() }
}

/// Returns a footprint of a width in tiles: round, elongated, rotated or sheared.
fn shape(kind: usize, wide: f64) -> [[f64; 2]; 2] {
    let (sine, cosine) = (0.6 * wide, 0.8 * wide);
    match kind % 4 {
        0 => [[wide, 0.0], [0.0, wide]],
        1 => [[2.3 * wide, 0.0], [0.0, wide]],
        2 => [[2.3 * cosine, 2.3 * sine], [-sine, cosine]],
        _ => [[0.2 * wide, 1.1 * wide], [wide, 0.3 * wide]],
    }
}

pub fn footprints(scene: &PackedScene, wide: f64) -> Vec<LookupQuery> {
    let uvs = coordinates(&mut Rng::new(11), 240);
    let wide = wide / f64::from(SIDE);
    uvs.iter().enumerate().map(|(i, &uv)| over(scene, 0, uv, shape(i, wide))).collect()
}

fn texel_mean() -> f64 {
    let texels = noise(SIDE, SIDE);
    let all = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    all.map(|(x, y)| texels.value(x, y, 0)).sum::<f64>() / f64::from(SIDE * SIDE)
}

/// Sweeps the width: below a texel the magnification filter applies, far beyond the texture the
/// mean of its texels.
fn widths(bench: &Bench<'_>, mag: Filter, min: Filter) -> Result<Vec<Point>> {
    let scene = scene(noise(SIDE, SIDE), &[spec(mag, min)])?;
    let mean = texel_mean();
    let sweep = decades(-6, 6, 2).map(|wide| {
        bench.check_cancelled()?;
        let endless = wide > 64.0 * f64::from(SIDE);
        worst(bench.gpu, &scene, wide, RANGE, &footprints(&scene, wide * OFF), |i, query| {
            if endless { mean } else { oracle(&scene, i, query) }
        })
    });
    sweep.collect()
}

fn areas(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let scene = scene(noise(SIDE, SIDE), &[spec(Filter::Linear, Filter::SummedArea)])?;
    let texels = noise(SIDE, SIDE);
    let sweep = decades(-6, 6, 2).map(|wide| {
        bench.check_cancelled()?;
        let queries = footprints(&scene, wide * OFF);
        worst(bench.gpu, &scene, wide, RANGE, &queries, |i, query| {
            // Magnification is linear.
            if wide < 1.0 { oracle(&scene, i, query) } else { box_mean(&texels, query) }
        })
    });
    sweep.collect()
}

fn chances(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let specs = [spec(Filter::Stochastic, Filter::Stochastic), spec(Filter::Linear, Filter::Linear)];
    let scene = scene(noise(SIDE, SIDE), &specs)?;
    let count = 4096u32;
    let sweep = decades(-6, 6, 2).map(|wide| {
        bench.check_cancelled()?;
        let one = footprints(&scene, wide * OFF)[2];
        let queries: Vec<LookupQuery> = (0..count).map(|seed| LookupQuery { seed, ..one }).collect();
        let answers = lookups(bench.gpu, &scene, false, false, &queries)?;
        let values = || answers.iter().map(|a| f64::from(a[0]));
        let mean = values().sum::<f64>() / f64::from(count);
        let variance = values().map(|v| (v - mean).powi(2)).sum::<f64>() / f64::from(count);
        let exact = oracle(&scene, 0, &LookupQuery { sampler: 1, ..one });
        let error = (mean - exact).abs() / (variance / f64::from(count)).sqrt().max(1e-6);
        let outside = values().any(|v| !(-2.0..=6.0).contains(&v));
        let error = if outside { f64::INFINITY } else { error };
        Ok(Point::worst(wide, [(error, described(&scene, &one))]))
    });
    sweep.collect()
}

fn lengths(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let specs = [spec(Filter::Linear, Filter::Anisotropic), spec(Filter::Linear, Filter::Ewa)];
    let scene = scene(noise(SIDE, SIDE), &specs)?;
    let sweep = decades(0, 6, 2).map(|ratio| {
        bench.check_cancelled()?;
        let wide = OFF / f64::from(SIDE);
        let uvs = coordinates(&mut Rng::new(12), 240);
        let queries: Vec<LookupQuery> = uvs
            .iter()
            .enumerate()
            .map(|(i, &uv)| {
                let (sine, cosine) = (0.37 * i as f64).sin_cos();
                let long = wide * ratio * 1.07;
                let axes = [[long * cosine, long * sine], [-wide * sine, wide * cosine]];
                over(&scene, i % 2, uv, axes)
            })
            .collect();
        worst(bench.gpu, &scene, ratio, RANGE, &queries, |i, query| oracle(&scene, i, query))
    });
    sweep.collect()
}

/// Sweeps cones around rays that approach the normal of a plane.
fn incidence(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let sweep = decades(-12, 0, 1).map(|tilt| {
        bench.check_cancelled()?;
        let text = format!(
            "camera = {{ eye = [{}, {}, 0.1], look_at = [0.2, 0, 0.1], up = [0, 0, 1], vertical_fov = 15 }}
            image = {{ width = 3, height = 3 }}
            sampling = {{ pattern = 'center', spp = 1, footprint = 'cone' }}
            [[texture]]\nname = 't'\nfile = 't'
            [[sampler]]\nname = 's'\nfilter = 'ewa'
            [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'
            mapping = {{ kind = 'surface', scale = [0.3, 0.3] }}
            [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'm'",
            0.2 + 3.0 * tilt.sin(),
            3.0 * tilt.cos()
        );
        let scene = parse(Path::new("incidence.toml"), &text)?;
        let packed = pack::pack(&scene, vec![noise(SIDE, SIDE)], None)?;
        let exact = oracle_render(&packed, &NoProgress)?;
        let (film, _) = render(bench.gpu, packed, false, &Tuning::default(), &NoProgress)?;
        let errors = film.pixels.iter().zip(&exact.pixels).enumerate().map(|(i, (a, b))| {
            (f64::from((a[0] - b[0]).abs()) / RANGE, format!("pixel ({}, {})", i % 3, i / 3))
        });
        Ok(Point::worst(tilt, errors))
    });
    sweep.collect()
}

const MINIFIERS: [Filter; 5] =
    [Filter::Linear, Filter::Anisotropic, Filter::Ewa, Filter::SummedArea, Filter::Stochastic];

fn outside(scene: &PackedScene, query: &LookupQuery, answer: f64) -> (f64, String) {
    let error = if answer.is_nan() { answer } else { (answer - 6.0).max(-2.0 - answer).max(0.0) };
    let place = format!("{}, axes {:?} and {:?}", described(scene, query), query.dx, query.dy);
    (error / RANGE, place)
}

/// Sweeps footprints with one axis, two equal ones, two opposite ones, almost parallel ones, and
/// one axis beside another of a texel.
fn degenerate(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let specs = MINIFIERS.map(|min| spec(Filter::Linear, min));
    let scene = scene(noise(SIDE, SIDE), &specs)?;
    let sweep = decades(-45, 38, 1).map(|long| {
        bench.check_cancelled()?;
        let wide = 3.0 / f64::from(SIDE);
        let shapes = [
            [[long, 0.0], [0.0; 2]],
            [[0.0; 2], [0.0, long]],
            [[long, long]; 2],
            [[long, -long], [-long, long]],
            [[long, long], [long, long * (1.0 + 1e-7)]],
            [[long, 0.0], [0.0, wide]],
            [[wide, wide], [long, -long]],
        ];
        let mut queries = Vec::new();
        for uv in coordinates(&mut Rng::new(13), 12) {
            for axes in shapes {
                queries.extend((0..specs.len()).map(|sampler| over(&scene, sampler, uv, axes)));
            }
        }
        let answers = lookups(bench.gpu, &scene, false, false, &queries)?;
        let errors = queries.iter().zip(&answers).map(|(q, a)| outside(&scene, q, a[0].into()));
        Ok(Point::worst(long, errors))
    });
    sweep.collect()
}

fn no_numbers(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let specs = [Filter::Linear, Filter::Ewa, Filter::SummedArea].map(|min| spec(Filter::Linear, min));
    let scene = scene(noise(SIDE, SIDE), &specs)?;
    let mean = texel_mean();
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e30, -1e38];
    let pairs = odd.iter().flat_map(|&a| odd.iter().map(move |&b| [a, b]));
    let sweep = pairs.enumerate().map(|(number, [a, b])| {
        bench.check_cancelled()?;
        let mut queries = Vec::new();
        for uv in coordinates(&mut Rng::new(14), 12) {
            for axes in [[[a, 0.0], [0.0, b]], [[a, b], [b, -a]], [[0.1, a], [b, 0.1]]] {
                queries.extend((0..specs.len()).map(|sampler| over(&scene, sampler, uv, axes)));
            }
        }
        worst(bench.gpu, &scene, (number + 1) as f64, RANGE, &queries, |_, _| mean)
    });
    sweep.collect()
}
