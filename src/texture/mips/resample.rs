//! The next level by any separable kernel. In go a level and, for each axis, the weights of the
//! texels behind each new texel; out come the new level's numbers. Sums run in f64: thousands of
//! texels may lie behind one.

use rayon::prelude::*;

use super::Level;

/// Half the support of the Kaiser kernel, in texels of the new level.
const WIDTH: f64 = 3.0;
/// Shape of its window.
const BETA: f64 = 4.0;

/// For each new texel the first texel behind it, and the weights from there on; their sum is 1.
pub(super) struct Axis(Vec<(usize, Vec<f64>)>);

impl Axis {
    /// Shares of the interval that a new texel covers.
    pub fn boxes(from: usize, to: usize) -> Axis {
        // In units of 1/to of a texel, so that ends are whole numbers.
        let taps = |i: usize| {
            let (start, end) = (i * from, (i + 1) * from);
            let (first, last) = (start / to, (end - 1) / to);
            let share = |texel: usize| end.min((texel + 1) * to) - start.max(texel * to);
            (first, (first..=last).map(|texel| share(texel) as f64 / from as f64).collect())
        };
        Axis((0..to).map(taps).collect())
    }

    /// Windowed sinc; what lies beyond the ends counts for the texel at the end.
    pub fn kaiser(from: usize, to: usize) -> Axis {
        if from == to {
            return Axis::boxes(from, to);
        }
        let scale = from as f64 / to as f64;
        let taps = |i: usize| {
            let center = (i as f64 + 0.5) * scale;
            let first = (center - WIDTH * scale - 0.5).ceil() as i64;
            let last = (center + WIDTH * scale - 0.5).floor() as i64;
            let inside = |texel: i64| texel.clamp(0, from as i64 - 1) as usize;
            let mut weights = vec![0.0; inside(last) - inside(first) + 1];
            for texel in first..=last {
                let x = (texel as f64 + 0.5 - center) / scale;
                weights[inside(texel) - inside(first)] += kaiser(x);
            }
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|weight| *weight /= sum);
            (inside(first), weights)
        };
        Axis((0..to).map(taps).collect())
    }
}

fn kaiser(x: f64) -> f64 {
    let angle = std::f64::consts::PI * x;
    let sinc = if x == 0.0 { 1.0 } else { angle.sin() / angle };
    let inside = (1.0 - (x / WIDTH) * (x / WIDTH)).max(0.0);
    sinc * bessel_i0(BETA * inside.sqrt()) / bessel_i0(BETA)
}

/// Modified Bessel function of order 0 by its power series Σ ((x/2)ᵏ / k!)² (Abramowitz & Stegun
/// 9.6.12); 24 terms are enough below 10.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let terms = (1..24).scan(1.0, |term, k| {
        *term *= quarter / f64::from(k * k);
        Some(*term)
    });
    1.0 + terms.sum::<f64>()
}

pub(super) fn resample(level: &Level<'_>, axes: &[Axis; 3], channels: usize) -> Vec<f32> {
    match channels {
        1 => resample_channels::<1>(level, axes),
        2 => resample_channels::<2>(level, axes),
        _ => resample_channels::<4>(level, axes),
    }
}

fn resample_channels<const C: usize>(level: &Level<'_>, [xs, ys, zs]: &[Axis; 3]) -> Vec<f32> {
    let (width, height) = (xs.0.len(), ys.0.len());
    let mut out = vec![0.0; width * height * zs.0.len() * C];
    let buffers = || (Vec::new(), vec![0.0; level.size[0] * C]);
    out.par_chunks_mut(width * C).enumerate().for_each_init(buffers, |(scratch, sum), (index, out)| {
        let ((y, rows), (z, slices)) = (&ys.0[index % height], &zs.0[index / height]);
        sum.fill(0.0);
        for (k, slice) in slices.iter().enumerate() {
            for (j, row) in rows.iter().enumerate() {
                let weight = slice * row;
                let values = level.row((z + k) * level.size[1] + y + j, scratch);
                sum.iter_mut().zip(values).for_each(|(sum, &value)| *sum += weight * f64::from(value));
            }
        }
        let sum = sum.as_chunks::<C>().0;
        for ((x, weights), out) in xs.0.iter().zip(out.as_chunks_mut::<C>().0) {
            let mut total = [0.0; C];
            for (texel, weight) in sum[*x..].iter().zip(weights) {
                (0..C).for_each(|c| total[c] += weight * texel[c]);
            }
            *out = total.map(|value| value as f32);
        }
    });
    out
}
