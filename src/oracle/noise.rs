//! Smooth noise from random values on the integer lattice: gradient noise (Perlin 2002), sums of its octaves,
//! and the distance to the nearest jittered point (Worley 1996, F1), each faded to its mean as the footprint
//! grows. Twin of `glsl/shared/noise.glsl`.

use glam::DVec3;

use super::rng::pcg3d;
use crate::schema::layout::Procedural;

/// Statistics of gradient noise over space, from 3·10⁶ random points.
pub const NOISE_VARIANCE: f64 = 0.0729;
/// Statistics of |noise|.
pub const FOLDED_MEAN: f64 = 0.2203;
pub const FOLDED_VARIANCE: f64 = 0.0244;
/// See `slice_mean`.
pub const FOLDED_SLICES: [f64; 2] = [-0.11, -0.094];

/// Returns the weight of the value at the footprint's centre relative to the mean, for a footprint of this
/// many cells.
pub fn kept(cells: f64) -> f64 {
    let x = (0.5 * cells).min(1.0);
    1.0 - x * x * (3.0 - 2.0 * x)
}

/// Returns the mean of a function that is constant along the axes that the footprint does not extend along.
pub fn slice_mean(mean: f64, slopes: [f64; 2], fraction: DVec3, widths: DVec3) -> f64 {
    let square = (fraction - 0.5) * (fraction - 0.5);
    let off = (square - 1.0 / 12.0) * (slopes[0] + (slopes[1] - slopes[0]) * (4.0 * square));
    mean + off.dot(DVec3::new(kept(widths.x), kept(widths.y), kept(widths.z)))
}

/// Returns the index of a cell, modulo 2³².
pub fn lattice_cell(whole: DVec3) -> [u32; 3] {
    whole.to_array().map(|x| if x.abs() <= 2_147_483_520.0 { x as i64 as u32 } else { 0 })
}

fn moved(cell: [u32; 3], by: [u32; 3]) -> [u32; 3] {
    [0, 1, 2].map(|i| cell[i].wrapping_add(by[i]))
}

/// Returns the dot product with one of the 12 vectors from a cube's centre to its edges.
pub fn lattice_gradient(cell: [u32; 3], d: DVec3) -> f64 {
    let code = pcg3d(cell)[0] >> 28;
    let u = if code < 8 { d.x } else { d.y };
    let v = match code {
        0..4 => d.y,
        12 | 14 => d.x,
        _ => d.z,
    };
    (if code & 1 != 0 { -u } else { u }) + (if code & 2 != 0 { -v } else { v })
}

/// Returns gradient noise in [-1, 1], 0 at lattice points, with continuous second derivatives.
pub fn gradient_noise(p: DVec3, key: [u32; 3]) -> f64 {
    let whole = p.floor();
    let f = p - whole;
    let s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let first = moved(lattice_cell(whole), key);
    let corner = |x: u32, y: u32, z: u32| {
        let away = f - DVec3::new(x.into(), y.into(), z.into());
        lattice_gradient(moved(first, [x, y, z]), away)
    };
    let blend = |a: f64, b: f64, weight: f64| a + weight * (b - a);
    let edge = |y, z| blend(corner(0, y, z), corner(1, y, z), s.x);
    let side = |z| blend(edge(0, z), edge(1, z), s.y);
    blend(side(0), side(1), s.z).clamp(-1.0, 1.0)
}

/// Returns the weighted mean of the octaves of noise, or of |noise| if `folded`, and the variance that has
/// faded out of it.
pub fn octave_sum(what: &Procedural, at: DVec3, size: f64, widths: DVec3, folded: bool) -> (f64, f64) {
    let [lacunarity, gain, norm] = [what.lacunarity, what.gain, what.normalization].map(f64::from);
    let Procedural { seed, octaves: count, .. } = *what;
    let (mut sum, mut faded) = (0.0, 0.0);
    let (mut weight, mut frequency) = (norm, 1.0);
    for k in 0..count {
        let key = pcg3d([seed, k, 0]);
        let shift = if k == 0 { DVec3::ZERO } else { fractions(key) };
        let p = at * frequency + shift;
        let noise = gradient_noise(p, key);
        let keep = kept(size * frequency);
        let (value, mean, variance) = if folded {
            let mean = slice_mean(FOLDED_MEAN, FOLDED_SLICES, p - p.floor(), widths * frequency);
            (noise.abs(), mean, FOLDED_VARIANCE)
        } else {
            (noise, 0.0, NOISE_VARIANCE)
        };
        sum += weight * (keep * value + (1.0 - keep) * mean);
        faded += weight * weight * variance * (1.0 - keep * keep);
        weight *= gain;
        frequency *= lacunarity;
    }
    (sum, faded)
}

/// Returns multiples of 2⁻²⁴ in [0, 1).
fn fractions(bits: [u32; 3]) -> DVec3 {
    DVec3::from_array(bits.map(|b| f64::from(b >> 8) / 16_777_216.0))
}

/// Returns the distance to the nearest point, at most 1: nearer points are in the 27 cells that are searched.
pub fn cell_distance(p: DVec3, seed: u32, jitter: f64) -> f64 {
    let whole = p.floor();
    let f = p - whole;
    let cell = moved(lattice_cell(whole), pcg3d([seed, 0, 0]));
    let mut nearest = 1.0_f64;
    for i in 0..27 {
        let step = [i % 3, i / 3 % 3, i / 9];
        let random = fractions(pcg3d(moved(cell, step.map(|s: u32| s.wrapping_sub(1)))));
        let away = DVec3::from_array(step.map(f64::from)) - 0.5 + jitter * (random - 0.5) - f;
        nearest = nearest.min(away.length_squared());
    }
    nearest.sqrt()
}

/// Returns the mean of `cell_distance`, with its variation between planes: polynomials in the jitter.
pub fn cell_mean(p: DVec3, widths: DVec3, jitter: f64) -> f64 {
    let j = jitter * jitter;
    let mean = 0.4803 + j * (0.0504 - 0.0099 * j);
    let slopes = [1.175 + j * (0.36 * j - 1.42), 0.96 - 0.93 * jitter];
    slice_mean(mean, slopes, p - p.floor(), widths)
}
