//! Procedural textures far from the origin and over footprints of any size. Measures the error of a
//! device's colours against means in closed form.

use super::case::{Bench, Case, Point};
use super::probing::decades;
use crate::core::error::Result;
use crate::lab::probe::{self, ProceduralQuery};
use crate::lab::verify::queries::{self, Rng};
use crate::pack::{self, PackedScene};
use crate::scene::model::Footprint;
use crate::texture::data::{ColorSpace, TexelFormat};
use crate::texture::procedural::{Procedural, ProceduralKind};
use crate::texture::sampler_spec::SamplerSpec;

pub fn cases() -> Vec<Case> {
    vec![
        Case {
            group: "procedurals",
            name: "checker-far-away",
            parameter: "distance from the origin in cells",
            unit: "difference of the two colours",
            bound: 1.5e-4,
            reason: "whole cells leave exactly, and a place within its cell rounds to 2^-24 on either side of a box of \
                     at least 1e-3",
            run: checker_far,
        },
        Case {
            group: "procedurals",
            name: "checker-over-boxes",
            parameter: "side of the box in cells",
            unit: "rounding (2^-24) of a cell, over the side of the box",
            bound: 8.0,
            reason: "the ends of two axes' boxes and their middles round to 2^-24 of a cell each",
            run: checker_boxes,
        },
        Case {
            group: "procedurals",
            name: "all-patterns-over-wide-footprints",
            parameter: "side of the box in cells",
            unit: "difference of the two colours",
            bound: 1e-4,
            reason: "what a box covers beside whole periods weighs at most one period over its side, 1e-4 from 1e4 on; \
                     noise has faded to its mean",
            run: wide,
        },
        Case {
            group: "procedurals",
            name: "all-patterns-anywhere",
            parameter: "distance from the origin in cells",
            unit: "distance from the range of the two colours",
            bound: 1e-6,
            reason: "every pattern is a share of one of two colours, but for the rounding of sums of octaves",
            run: anywhere,
        },
    ]
}

fn scene(kinds: &[ProceduralKind]) -> Result<PackedScene> {
    let texture = queries::texture(1, 1, TexelFormat::Grey8, ColorSpace::Linear, 1);
    let spec = SamplerSpec::default();
    let mut scene = queries::pairs_over(Footprint::Differentials, vec![texture], &[spec], &[(0, 0)])?;
    scene.records.procedurals = kinds.iter().map(|&kind| pack::procedural(&Procedural::new(kind))).collect();
    // A scene has no footprint unless a sampler asks for one.
    scene.header.footprint = Footprint::Differentials;
    Ok(scene)
}

pub fn query(procedural: usize, at: [f64; 3], side: [f64; 2]) -> ProceduralQuery {
    let [x, y, z] = at.map(|x| x as f32);
    let [wide, high] = side.map(|s| s as f32);
    ProceduralQuery {
        procedural: procedural as u32,
        padding: [0; 3],
        at: [x, y, z, 0.0],
        dx: [wide, 0.0, 0.0, 0.0],
        dy: [0.0, high, 0.0, 0.0],
    }
}

/// Returns the foreground's mean of a checker over a box that is flat in z: the means of products
/// of ±1 multiply.
pub fn checker_mean(query: &ProceduralQuery) -> f64 {
    let wave = |x: f64, wide: f64| {
        // The integral from 0 of a function that is 1 in even cells and -1 in odd ones.
        let integral = |x: f64| {
            let within = x.rem_euclid(2.0);
            within.min(2.0 - within)
        };
        let even = if x.floor().rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        if wide > 0.0 { (integral(x + 0.5 * wide) - integral(x - 0.5 * wide)) / wide } else { even }
    };
    let [x, y, z, _] = query.at.map(f64::from);
    let product = wave(x, query.dx[0].into()) * wave(y, query.dy[1].into()) * wave(z, 0.0);
    0.5 - 0.5 * product
}

fn checker(bench: &Bench<'_>, parameter: f64, unit: f64, list: &[ProceduralQuery]) -> Result<Point> {
    bench.check_cancelled()?;
    let scene = scene(&[ProceduralKind::Checker])?;
    let answers = probe::procedurals(bench.gpu, &scene, false, list)?;
    Ok(worst_checker(parameter, unit, list, &answers))
}

pub fn worst_checker(parameter: f64, unit: f64, list: &[ProceduralQuery], answers: &[[f32; 4]]) -> Point {
    let errors = list.iter().zip(answers).map(|(query, answer)| {
        let error = (f64::from(answer[0]) - checker_mean(query)).abs() / unit;
        (error, format!("at {:?}, box {} by {}", query.at, query.dx[0], query.dy[1]))
    });
    Point::worst(parameter, errors)
}

/// Sweeps positions around integers, where the colour changes, and elsewhere; boxes from 1e-3 to
/// 10.
fn checker_far(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let sweep = decades(0, 6, 2).map(|far| {
        let mut rng = Rng::new(21);
        let list: Vec<_> = (0..600)
            .map(|i| {
                let side = [1e-3, 1e-2, 0.1, 1.0, 10.0][i % 5] * [1.0, 1.3][i % 2];
                let reach = if i % 3 == 0 { 4.0 } else { side };
                let mut place = || far.floor() + rng.between(-reach, reach);
                let at = [place(), -place(), far.floor() + 0.5];
                query(0, at, [side, side])
            })
            .collect();
        checker(bench, far, 1.0, &list)
    });
    sweep.collect()
}

fn checker_boxes(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let sweep = decades(-6, 6, 2).map(|side| {
        let mut rng = Rng::new(22);
        let list: Vec<_> = (0..600)
            .map(|i| {
                let far = [0.0, 7.0, 1000.0][i % 3];
                let at = [far + rng.between(-side, side), rng.between(-2.0, 2.0), 0.5];
                query(0, at, [side, [1.0, 0.7][i % 2] * side])
            })
            .collect();
        checker(bench, side, super::probing::ROUNDING * (1.0 + 1.0 / side), &list)
    });
    sweep.collect()
}

/// Returns foreground fractions that follow from the definitions of the patterns with their
/// defaults.
fn shares() -> Vec<(ProceduralKind, f64)> {
    use ProceduralKind::{Brick, Checker, Fbm, Grid, Marble, Noise, Stripes, Wood};
    let lines = Procedural::new(Grid).width;
    let bricks = Procedural::new(Brick);
    let [lines, joint, aspect] = [lines, bricks.width, bricks.aspect].map(f64::from);
    vec![
        (Checker, 0.5),
        (Stripes, Procedural::new(Stripes).width.into()),
        (Grid, 1.0 - (1.0 - lines).powi(2)),
        (Brick, (1.0 - joint / aspect) * (1.0 - joint)),
        (Noise, 0.5),
        (Fbm, 0.5),
        (Marble, 0.5),
        (Wood, 0.5),
    ]
}

fn wide(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let shares = shares();
    let kinds: Vec<ProceduralKind> = shares.iter().map(|s| s.0).collect();
    let scene = scene(&kinds)?;
    let sweep = decades(4, 12, 1).map(|side| {
        bench.check_cancelled()?;
        let mut rng = Rng::new(23);
        let mut list = Vec::new();
        for _ in 0..40 {
            let at = [0; 3].map(|_| rng.between(-1e3, 1e3));
            list.extend((0..kinds.len()).map(|i| query(i, at, [side, side])));
        }
        let answers = probe::procedurals(bench.gpu, &scene, false, &list)?;
        let errors = list.iter().zip(&answers).map(|(query, answer)| {
            let (kind, share) = shares[query.procedural as usize];
            ((f64::from(answer[0]) - share).abs(), format!("{kind} at {:?}", query.at))
        });
        Ok(Point::worst(side, errors))
    });
    sweep.collect()
}

fn anywhere(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let scene = scene(ProceduralKind::ALL)?;
    let sweep = decades(0, 38, 2).map(|far| {
        bench.check_cancelled()?;
        let mut rng = Rng::new(24);
        let mut list = Vec::new();
        for side in [0.0, 1e-40, 1e-20, 1e-3, 1.0, 1e3, 1e20, f64::INFINITY, f64::NAN] {
            for _ in 0..6 {
                let at = [0; 3].map(|_| rng.between(-far, far));
                list.extend((0..ProceduralKind::ALL.len()).map(|i| query(i, at, [side, 0.6 * side])));
                let skewed = |q: &ProceduralQuery| ProceduralQuery { dy: q.dx, ..*q };
                list.extend(
                    list[list.len() - ProceduralKind::ALL.len()..].iter().map(skewed).collect::<Vec<_>>(),
                );
            }
        }
        let answers = probe::procedurals(bench.gpu, &scene, false, &list)?;
        let errors = list.iter().zip(&answers).map(|(query, answer)| {
            let value = f64::from(answer[0]);
            let error = if value.is_nan() { value } else { (value - 1.0).max(-value).max(0.0) };
            let kind = ProceduralKind::ALL[query.procedural as usize];
            (error, format!("{kind} at {:?}, axes {:?} and {:?}", query.at, query.dx, query.dy))
        });
        Ok(Point::worst(far, errors))
    });
    sweep.collect()
}
