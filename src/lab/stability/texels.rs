//! Texels at the limits of f32: very bright, very dark, of both signs, NaN and infinity. Measures
//! the error of lookups against weighted sums in f64.

use super::case::{Bench, Case, Point};
use super::probing::{ROUNDING, coordinates, decades, grey, noise, oracle, over, scene, worst};
use crate::core::error::Result;
use crate::lab::probe::lookups;
use crate::lab::verify::queries::Rng;
use crate::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

/// The smallest normal f32; devices may flush smaller numbers to 0.
const SMALLEST: f64 = f32::MIN_POSITIVE as f64;

pub fn cases() -> Vec<Case> {
    vec![
        Case {
            group: "texels",
            name: "brightness",
            parameter: "largest texel",
            unit: "roundings (2^-24) of the largest texel",
            bound: 64.0,
            reason: "at most 16 texels, whose weights are off by some ten roundings each and sum up, as sizes, to \
                     less than 1.6; of sums over areas, half a step of 24 bits",
            run: brightness,
        },
        Case {
            group: "texels",
            name: "opposite-extremes",
            parameter: "size of neighbouring texels of either sign",
            unit: "roundings (2^-24) of a texel",
            bound: 4.0,
            reason: "weights are exact; four products and their sums round once each, and none may be larger than the \
                     texels: a + w (b - a) would be, from 1.7e38 on",
            run: opposites,
        },
        Case {
            group: "texels",
            name: "darkness",
            parameter: "largest texel",
            unit: "smallest normal f32 (1.2e-38)",
            bound: 11.0,
            reason: "each of eight products, their two sums and the share of a level may be taken for 0 where it \
                     is below the smallest normal f32",
            run: darkness,
        },
        Case {
            group: "texels",
            name: "one-bright-texel-coarsest-level",
            parameter: "its value; all others are 1",
            unit: "roundings (2^-24) of the mean",
            bound: 16.0,
            reason: "each of six halvings adds two pairs, which rounds twice; the look-up adds four roundings",
            run: bright_level,
        },
        Case {
            group: "texels",
            name: "one-bright-texel-sums-over-areas",
            parameter: "its value; all others are 1",
            unit: "parts (2^-24) of the range",
            bound: 64.0,
            reason: "texels are whole steps of 2^-24 of the range, off by half of one; the corners of a box of at \
                     least a texel by 2^-24 of 16 texels, on four sides",
            run: bright_area,
        },
        Case {
            group: "texels",
            name: "one-texel-that-is-no-number",
            parameter: "texels along a side",
            unit: "look-ups that are no numbers without reading it, or numbers where they do",
            bound: 0.0,
            reason: "places lie on a grid on which f32 forms weights exactly, and a weight of 0 reads nothing",
            run: no_number,
        },
    ]
}

const SIDE: u32 = 16;
/// A footprint in texture coordinates of some two and a half texels.
const ROUND: [[f64; 2]; 2] = [[2.6 / SIDE as f64, 0.0], [0.0, 2.6 / SIDE as f64]];
const POINT: [[f64; 2]; 2] = [[0.0; 2]; 2];

fn spec(mag: Filter, min: Filter) -> SamplerSpec {
    SamplerSpec { mag, min, mip: MipMode::Linear, ..Default::default() }
}

fn brightness(bench: &Bench<'_>) -> Result<Vec<Point>> {
    use Filter::{Anisotropic, Cubic, Ewa, Linear, Nearest, SummedArea};
    let mags = [Nearest, Linear, Cubic].map(|mag| (spec(mag, Linear), POINT));
    let mins = [Linear, Anisotropic, Ewa, SummedArea].map(|min| (spec(Linear, min), ROUND));
    let (specs, footprints): (Vec<_>, Vec<_>) = mags.into_iter().chain(mins).unzip();
    let texels = noise(SIDE, SIDE);
    let sweep = decades(-30, 38, 1).map(|size| {
        bench.check_cancelled()?;
        let texels = grey(SIDE, SIDE, |x, y| (texels.value(x, y, 0) / 6.0 * size) as f32);
        let scene = scene(texels, &specs)?;
        let uvs = coordinates(&mut Rng::new(3), 200);
        let all = uvs.iter().flat_map(|&uv| (0..specs.len()).map(move |i| (i, uv)));
        let queries: Vec<_> = all.map(|(i, uv)| over(&scene, i, uv, footprints[i])).collect();
        let unit = size * ROUNDING;
        worst(bench.gpu, &scene, size, unit, &queries, |i, query| oracle(&scene, i, query))
    });
    sweep.collect()
}

/// Sweeps two columns of opposite sign, and two equal ones.
fn opposites(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let clamped = SamplerSpec { address: [Address::ClampToEdge; 2], ..Default::default() };
    let sizes = decades(0, 38, 1).chain([1.7e38, 2e38, 3.4e38]);
    let sweep = sizes.map(|size| {
        bench.check_cancelled()?;
        let size = f64::from(size as f32);
        let scene = scene(grey(4, 2, |x, _| if x == 0 { -size as f32 } else { size as f32 }), &[clamped])?;
        // The range from the first column's centre to the third's.
        let steps = 512u32;
        let place = |k: u32| [0.125 + 0.5 * k as f32 / steps as f32, 0.5];
        let queries: Vec<_> = (0..=steps).map(|k| over(&scene, 0, place(k), POINT)).collect();
        worst(bench.gpu, &scene, size, size * ROUNDING, &queries, |_, query| {
            let between = (4.0 * f64::from(query.uv[0]) - 0.5).min(1.0);
            size * between - size * (1.0 - between)
        })
    });
    sweep.collect()
}

fn darkness(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let specs = [spec(Filter::Nearest, Filter::Nearest), spec(Filter::Linear, Filter::Linear)];
    let texels = noise(SIDE, SIDE);
    let sweep = decades(-45, -34, 2).map(|size| {
        bench.check_cancelled()?;
        let texels = grey(SIDE, SIDE, |x, y| (texels.value(x, y, 0) / 6.0 * size) as f32);
        let scene = scene(texels, &specs)?;
        let mut queries = Vec::new();
        for uv in coordinates(&mut Rng::new(4), 200) {
            queries.extend([0, 1].map(|i| over(&scene, i, uv, POINT)));
            queries.push(over(&scene, 1, uv, ROUND));
        }
        worst(bench.gpu, &scene, size, SMALLEST, &queries, |i, query| oracle(&scene, i, query))
    });
    sweep.collect()
}

/// Reads the last level, which is one texel with a known value.
fn bright_level(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let side = 64;
    let sweep = decades(0, 38, 1).map(|size| {
        bench.check_cancelled()?;
        let size = f64::from(size as f32);
        let texels = grey(side, side, |x, y| if [x, y] == [37, 11] { size as f32 } else { 1.0 });
        let scene = scene(texels, &[spec(Filter::Linear, Filter::Linear)])?;
        let uvs = coordinates(&mut Rng::new(5), 50);
        let queries: Vec<_> = uvs.iter().map(|&uv| over(&scene, 0, uv, [[3.0, 0.0], [0.0, 3.0]])).collect();
        let texels = f64::from(side * side);
        let mean = (size + (texels - 1.0)) / texels;
        worst(bench.gpu, &scene, size, mean * ROUNDING, &queries, |_, _| mean)
    });
    sweep.collect()
}

/// Measures the mean over boxes in a repeated texture with texels as squares of constant colour.
fn bright_area(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let sweep = decades(0, 38, 1).map(|size| {
        bench.check_cancelled()?;
        let size = f64::from(size as f32);
        let texel = [9.0, 6.0];
        let texels = grey(SIDE, SIDE, |x, y| if [x, y] == [9, 6] { size as f32 } else { 1.0 });
        let scene = scene(texels, &[spec(Filter::Linear, Filter::SummedArea)])?;
        let uvs = coordinates(&mut Rng::new(6), 200);
        let queries: Vec<_> = uvs.iter().map(|&uv| over(&scene, 0, uv, ROUND)).collect();
        worst(bench.gpu, &scene, size, size * ROUNDING, &queries, |_, query| {
            let side = f64::from(SIDE);
            let covered = |axis: usize| {
                let reach = 0.5 * side * f64::from([query.dx[0], query.dy[1]][axis]);
                let from_texel = side * f64::from(query.uv[axis]) - texel[axis];
                // The nearest of its repetitions.
                let middle = from_texel - side * ((from_texel - 0.5) / side).round();
                ((middle + reach).min(1.0) - (middle - reach).max(0.0)).max(0.0) / (2.0 * reach)
            };
            let share = covered(0) * covered(1);
            size * share + (1.0 - share)
        })
    });
    sweep.collect()
}

fn no_number(bench: &Bench<'_>) -> Result<Vec<Point>> {
    use Filter::{Cubic, Linear, Nearest};
    let specs = [Nearest, Linear, Cubic].map(|mag| spec(mag, Linear));
    let sweep = (1..=10).map(|log2| {
        bench.check_cancelled()?;
        let side = 1u32 << log2;
        let at = [side / 2, side - 1];
        let only = |value: f32| grey(side, side, move |x, y| if [x, y] == at { value } else { 0.0 });
        let odd = scene(only(f32::NAN), &specs)?;
        let weights = scene(only(1.0), &specs)?;
        // On quarters of texels around it, and elsewhere.
        let near = |k: u32| [k % 24, k / 24].map(|n| (n as f32 / 4.0 - 3.0) / side as f32);
        let center = at.map(|n| n as f32 / side as f32);
        let around = (0..576).map(near).map(|[x, y]| [center[0] + x, center[1] + y]);
        let uvs: Vec<_> = around.chain(coordinates(&mut Rng::new(7), 200)).collect();
        let all = uvs.iter().flat_map(|&uv| (0..specs.len()).map(move |i| (i, uv)));
        let queries: Vec<_> = all.map(|(i, uv)| over(&odd, i, uv, POINT)).collect();
        let answers = lookups(bench.gpu, &odd, false, false, &queries)?;
        let wrong = queries.iter().zip(&answers).enumerate().filter(|(i, (query, answer))| {
            let reads = oracle(&weights, *i, query) != 0.0;
            reads == answer[0].is_finite()
        });
        Ok(Point::worst(f64::from(side), [(wrong.count() as f64, "around the texel".to_string())]))
    });
    sweep.collect()
}
