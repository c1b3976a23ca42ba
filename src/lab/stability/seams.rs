//! Seams within one texture: edges, corners and ties of cube faces, poles and the date line of
//! equirectangular maps. Measures the step between answers at pairs of directions a small gap
//! apart.

use glam::DVec3;

use super::case::{Bench, Case, Point};
use super::probing::{self, decades};
use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::lab::probe::{LookupQuery, lookups};
use crate::lab::verify::queries::{self, Rng};
use crate::pack::PackedScene;
use crate::texture::data::{ColorSpace, Dimension, TexelFormat};
use crate::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

pub fn cases() -> Vec<Case> {
    let step = "step beyond what the gap allows, of the range of the texels";
    vec![
        Case {
            group: "seams",
            name: "cube-edges-and-corners",
            parameter: "gap between two directions",
            unit: step,
            bound: 2e-6,
            reason: "linear look-ups change by the range over a texel on two axes; weights of eight texels round to \
                     2^-24 of eight texels, four times",
            run: cube_edges,
        },
        Case {
            group: "seams",
            name: "ties-of-cube-faces",
            parameter: "length of the direction",
            unit: "directions on another face than z before y before x",
            bound: 0.0,
            reason: "components that are equal are compared, not computed",
            run: cube_ties,
        },
        Case {
            group: "seams",
            name: "levels-of-a-cube",
            parameter: "length of the direction",
            unit: "range of the texels",
            bound: 1e-5,
            reason: "places and footprints on a face are quotients, whatever the length: the bound of trilinear look-ups",
            run: cube_levels,
        },
        Case {
            group: "seams",
            name: "poles-and-date-line",
            parameter: "gap between two places, of the map",
            unit: step,
            bound: 4e-6,
            reason: "half a turn away across the pole lies what lies beyond it: linear look-ups change by the range over a \
                     texel; places of 16 texels round to 2^-24 of them",
            run: poles,
        },
    ]
}

const SIDE: u32 = 8;
const RANGE: f64 = 8.0;

fn scene(dimension: Dimension, size: [u32; 3], filter: Filter) -> Result<PackedScene> {
    let spec = SamplerSpec { mag: filter, min: filter, ..Default::default() };
    let texture = queries::noise(dimension, size, TexelFormat::GreyFloat, ColorSpace::Linear, 31);
    queries::pairs(vec![texture], &[spec], &[(0, 0)])
}

fn towards(one: &LookupQuery, direction: DVec3) -> LookupQuery {
    LookupQuery { uv: direction.as_vec3().extend(0.0).to_array(), ..*one }
}

/// Returns the steps between answers of pairs a gap apart, less the `allowed` step.
fn steps(gpu: &Gpu, scene: &PackedScene, gap: f64, allowed: f64, pairs: &[LookupQuery]) -> Result<Point> {
    let answers = lookups(gpu, scene, false, false, pairs)?;
    Ok(worst_step(gap, allowed, pairs, &answers))
}

pub fn worst_step(gap: f64, allowed: f64, pairs: &[LookupQuery], answers: &[[f32; 4]]) -> Point {
    let errors = pairs.chunks(2).zip(answers.chunks(2)).map(|(places, values)| {
        let apart = (f64::from(values[0][0]) - f64::from(values[1][0])).abs();
        let error = if apart.is_nan() { apart } else { (apart - allowed).max(0.0) / RANGE };
        (error, format!("between {:?} and {:?}", places[0].uv, places[1].uv))
    });
    Point::worst(gap, errors)
}

fn cube_edges(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let scene = scene(Dimension::Cube, [SIDE, SIDE, 6], Filter::Linear)?;
    let one = queries::query(&scene, 0, [0.0; 2]);
    let sweep = decades(-7, -1, 2).map(|gap| {
        bench.check_cancelled()?;
        let mut rng = Rng::new(32);
        let mut pairs = Vec::new();
        let mut farthest = 0.0f64;
        for i in 0..1200 {
            let mut sign = || if rng.unit() < 0.5 { -1.0 } else { 1.0 };
            // Two equal components: an edge; three: a corner.
            let mut on = [sign(), sign(), sign()];
            if i % 4 != 0 {
                on[2] = rng.between(-1.0, 1.0);
            }
            on.rotate_left(i % 3);
            let on = DVec3::from_array(on);
            let direction = DVec3::from_array([0; 3].map(|_| rng.between(-0.5, 0.5))) * gap;
            let pair = [on + direction, on - direction].map(|d| towards(&one, d));
            // The gap as f32 represents it.
            let at = pair.map(|q| queries::place_of(&q).at);
            farthest = farthest.max((at[0] - at[1]).length());
            pairs.extend(pair);
        }
        // A texel is 2 / SIDE wide, and a step along each of two axes has the range; a direction
        // off the face's plane moves by √2 on it.
        let allowed = 2.0 * RANGE * std::f64::consts::SQRT_2 * farthest * f64::from(SIDE) / 2.0;
        steps(bench.gpu, &scene, gap, allowed, &pairs)
    });
    sweep.collect()
}

/// Sweeps cubes whose faces have one colour, their number.
fn cube_ties(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let spec = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    let blank = queries::noise(Dimension::Cube, [2, 2, 6], TexelFormat::GreyFloat, ColorSpace::Linear, 1);
    let faces = blank.with_floats(1, |_, y, _| (y / 2) as f32);
    let scene = queries::pairs(vec![faces], &[spec], &[(0, 0)])?;
    let one = queries::query(&scene, 0, [0.0; 2]);
    let sweep = decades(-30, 30, 1).map(|long| {
        bench.check_cancelled()?;
        let numbers = [-1.0, 0.0, 1.0];
        let all = || (0..27).map(|k| [numbers[k % 3], numbers[k / 3 % 3], numbers[k / 9]]);
        let directions: Vec<[f64; 3]> = all().filter(|d| *d != [0.0; 3]).collect();
        let queries: Vec<LookupQuery> =
            directions.iter().map(|&d| towards(&one, DVec3::from_array(d) * long)).collect();
        let answers = lookups(bench.gpu, &scene, false, false, &queries)?;
        let wrong = directions.iter().zip(&answers).filter(|([x, y, z], answer)| {
            let (axis, sign) = match () {
                () if *z != 0.0 => (2.0, *z),
                () if *y != 0.0 => (1.0, *y),
                () => (0.0, *x),
            };
            f64::from(answer[0]) != 2.0 * axis + if sign < 0.0 { 1.0 } else { 0.0 }
        });
        let first = wrong.clone().next().map_or(String::from("all"), |(d, _)| format!("towards {d:?}"));
        Ok(Point::worst(long, [(wrong.count() as f64, first)]))
    });
    sweep.collect()
}

/// Sweeps the length of the direction. The footprint grows with it: all lengths have the level of
/// length 1.
fn cube_levels(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let spec = SamplerSpec { mip: MipMode::Linear, ..Default::default() };
    let texture = queries::noise(
        Dimension::Cube,
        [4 * SIDE, 4 * SIDE, 6],
        TexelFormat::GreyFloat,
        ColorSpace::Linear,
        34,
    );
    let scene = probing::scene(texture, &[spec])?;
    let one = queries::query(&scene, 0, [0.0; 2]);
    let sweep = decades(-30, 30, 1).map(|long| {
        bench.check_cancelled()?;
        let mut rng = Rng::new(35);
        let queries: Vec<LookupQuery> = (0..300)
            .map(|_| {
                let mut vector = |reach: f64| DVec3::from_array([0; 3].map(|_| rng.between(-reach, reach)));
                let narrow = |v: DVec3| (v * long).as_vec3().extend(0.0).to_array();
                let (dx, dy) = (narrow(vector(0.3)), narrow(vector(0.3)));
                LookupQuery { dx, dy, ..towards(&one, vector(1.0) * long) }
            })
            .collect();
        probing::worst(bench.gpu, &scene, long, RANGE, &queries, |i, query| probing::oracle(&scene, i, query))
    });
    sweep.collect()
}

fn poles(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let mut scene = scene(Dimension::Two, [2 * SIDE, SIDE, 1], Filter::Linear)?;
    // Environments are read this way: rows continue across the poles.
    scene.records.samplers[0].crosses_poles = true;
    scene.records.samplers[0].address_v = Address::ClampToEdge;
    let one = queries::query(&scene, 0, [0.0; 2]);
    let sweep = decades(-8, -2, 2).map(|gap| {
        bench.check_cancelled()?;
        let mut rng = Rng::new(33);
        let mut pairs = Vec::new();
        for i in 0..900 {
            // Half a turn more is exact in f32.
            let u = (rng.bits() % 4096) as f64 / 8192.0;
            let places = match i % 3 {
                0 => [[u, 0.5 * gap], [u + 0.5, 0.5 * gap]],
                1 => [[u, 1.0 - 0.5 * gap], [u + 0.5, 1.0 - 0.5 * gap]],
                _ => [[0.5 * gap, 2.0 * u], [1.0 - 0.5 * gap, 2.0 * u]],
            };
            pairs.extend(places.map(|[u, v]| LookupQuery { uv: [u as f32, v as f32, 0.0, 0.0], ..one }));
        }
        // The spacing of coordinates next to 1 is 2^-24.
        let allowed = RANGE * (gap + 2.0 * probing::ROUNDING) * f64::from(2 * SIDE);
        steps(bench.gpu, &scene, gap, allowed, &pairs)
    });
    sweep.collect()
}
