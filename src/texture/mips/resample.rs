//! The next level by an arbitrary separable kernel. Takes a level and, for each axis, the weights
//! of the source texels of each new texel; returns the values of the new level. Sums are in f64
//! because a texel may have thousands of source texels.

use rayon::prelude::*;

use super::Level;

/// Half the support of the Kaiser kernel, in texels of the new level.
const WIDTH: f64 = 3.0;
/// The shape parameter β of its window.
const BETA: f64 = 4.0;

/// For each new texel its first source texel and the weights from there on, whose sum is 1.
pub(super) struct AxisWeights(Vec<(usize, Vec<f64>)>);

impl AxisWeights {
    /// Returns box weights: the covered fractions of the interval of each new texel.
    pub fn covered(from: usize, to: usize) -> AxisWeights {
        // Interval ends are integers in units of 1/to of a texel.
        let taps = |i: usize| {
            let (start, end) = (i * from, (i + 1) * from);
            let (first, last) = (start / to, (end - 1) / to);
            let share = |texel: usize| end.min((texel + 1) * to) - start.max(texel * to);
            (first, (first..=last).map(|texel| share(texel) as f64 / from as f64).collect())
        };
        AxisWeights((0..to).map(taps).collect())
    }

    /// Returns the weights of a windowed sinc; positions beyond the ends use the border texel.
    pub fn windowed_sinc(from: usize, to: usize) -> AxisWeights {
        if from == to {
            return AxisWeights::covered(from, to);
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
        AxisWeights((0..to).map(taps).collect())
    }
}

fn kaiser(x: f64) -> f64 {
    let angle = std::f64::consts::PI * x;
    let sinc = if x == 0.0 { 1.0 } else { angle.sin() / angle };
    let inside = (1.0 - (x / WIDTH) * (x / WIDTH)).max(0.0);
    sinc * bessel_i0(BETA * inside.sqrt()) / bessel_i0(BETA)
}

/// Returns the modified Bessel function of order 0 by its power series Σ ((x/2)ᵏ / k!)² (Abramowitz
/// & Stegun 9.6.12); 24 terms suffice below 10.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let terms = (1..24).scan(1.0, |term, k| {
        *term *= quarter / f64::from(k * k);
        Some(*term)
    });
    1.0 + terms.sum::<f64>()
}

pub(super) fn resample(level: &Level<'_>, axes: &[AxisWeights; 3], channels: usize) -> Vec<f32> {
    match channels {
        1 => resample_channels::<1>(level, axes),
        2 => resample_channels::<2>(level, axes),
        _ => resample_channels::<4>(level, axes),
    }
}

fn resample_channels<const C: usize>(level: &Level<'_>, [xs, ys, zs]: &[AxisWeights; 3]) -> Vec<f32> {
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
