//! Power spectrum of a point set: P(f) = |Σ exp(-2πi f·x)|² / N, the periodogram (Bartlett 1964),
//! for integer frequencies of the unit square, averaged over realisations. Random points have P = 1
//! at every frequency except 0, where P = N carries no information and is omitted.

use std::f64::consts::TAU;

use rayon::prelude::*;

pub struct Spectrum {
    /// Frequencies range from `-limit` to `limit` on each axis.
    pub limit: usize,
    /// Power row by row, with both frequencies ascending; 0 at frequency 0.
    pub power: Vec<f64>,
    pub realisations: u32,
}

/// Returns a limit that shows the range beyond the frequency √N of the mean sample distance, at
/// least 64.
pub fn limit_for(samples: u32) -> usize {
    (2.0 * f64::from(samples).sqrt()).ceil().max(64.0) as usize
}

/// Returns the number of realisations: hundreds, fewer for large sets.
pub fn realisations_for(samples: u32) -> u32 {
    ((1 << 18) / samples).clamp(64, 1600)
}

/// The four products of cosines and sines from which Σ exp(-2πi f·x) follows: sign changes of f
/// only change signs of products. Each is stored for 0 ≤ f ≤ limit on both axes.
struct Products {
    limit: usize,
    sums: [Vec<f32>; 4],
}

impl Products {
    fn new(limit: usize) -> Products {
        Products { limit, sums: std::array::from_fn(|_| vec![0.0; (limit + 1) * (limit + 1)]) }
    }

    fn add(&mut self, point: [f64; 2]) {
        let length = self.limit + 1;
        let [(cos_x, sin_x), (cos_y, sin_y)] = point.map(|x| multiples(x, length));
        let [cc, cs, sc, ss] = &mut self.sums;
        for y in 0..length {
            let (cosine, sine) = (cos_y[y], sin_y[y]);
            let row = y * length..(y + 1) * length;
            let (cc, cs) = (&mut cc[row.clone()], &mut cs[row.clone()]);
            let (sc, ss) = (&mut sc[row.clone()], &mut ss[row]);
            for x in 0..length {
                cc[x] += cos_x[x] * cosine;
                cs[x] += cos_x[x] * sine;
                sc[x] += sin_x[x] * cosine;
                ss[x] += sin_x[x] * sine;
            }
        }
    }

    /// Returns |Σ|² at (x, y), y ≥ 0.
    fn power(&self, x: i64, y: usize) -> f64 {
        let at = y * (self.limit + 1) + x.unsigned_abs() as usize;
        let [cc, cs, sc, ss] = [0, 1, 2, 3].map(|i| f64::from(self.sums[i][at]));
        let sign = if x < 0 { -1.0 } else { 1.0 };
        (cc - sign * ss).powi(2) + (cs + sign * sc).powi(2)
    }
}

/// Returns cosines and sines of 2π f x for f from 0 to `length` - 1.
fn multiples(x: f64, length: usize) -> (Vec<f32>, Vec<f32>) {
    let (sine, cosine) = (TAU * x).sin_cos();
    let mut at = (1.0, 0.0);
    let mut next = || {
        let (c, s) = at;
        at = (c * cosine - s * sine, s * cosine + c * sine);
        (c as f32, s as f32)
    };
    (0..length).map(|_| next()).unzip()
}

/// Returns the mean spectrum over `realisations` sets.
pub fn mean(set: impl Fn(u32) -> Vec<[f64; 2]> + Sync, realisations: u32, limit: usize) -> Spectrum {
    let side = 2 * limit + 1;
    let of_one = |number: u32| {
        let points = set(number);
        let mut products = Products::new(limit);
        points.iter().for_each(|&p| products.add(p));
        let scale = 1.0 / (points.len() as f64 * f64::from(realisations));
        let place = |i: usize| (i as i64 - limit as i64, limit - i / side);
        // This is the upper half, f_y from -limit to 0; the lower half is its point reflection.
        let half = |i: usize| scale * products.power(-place(i % side).0, place(i).1);
        (0..side * (limit + 1)).map(half).collect::<Vec<f64>>()
    };
    let add = |mut sum: Vec<f64>, other: Vec<f64>| {
        sum.iter_mut().zip(other).for_each(|(a, b)| *a += b);
        sum
    };
    // Sums have a fixed order, so that results are equal on any machine.
    let chunks: Vec<Vec<f64>> = (0..realisations.div_ceil(16))
        .into_par_iter()
        .map(|chunk| {
            let zero = vec![0.0; side * (limit + 1)];
            (chunk * 16..(chunk * 16 + 16).min(realisations)).map(of_one).fold(zero, add)
        })
        .collect();
    let mut power = chunks.into_iter().fold(vec![0.0; side * (limit + 1)], add);
    power[side * limit + limit] = 0.0;
    power.extend_from_within(..side * limit);
    power[side * (limit + 1)..].reverse();
    Spectrum { limit, power, realisations }
}

impl Spectrum {
    pub fn at(&self, x: i64, y: i64) -> f64 {
        let limit = self.limit as i64;
        self.power[((y + limit) * (2 * limit + 1) + x + limit) as usize]
    }

    /// Returns the mean power of the frequencies whose length rounds to 1, 2, …, `limit`.
    pub fn radial_mean(&self) -> Vec<f64> {
        let limit = self.limit as i64;
        let mut sums = vec![(0.0, 0u32); self.limit + 1];
        for y in -limit..=limit {
            for x in -limit..=limit {
                let length = ((x * x + y * y) as f64).sqrt().round() as usize;
                if let Some((sum, count)) = sums.get_mut(length) {
                    *sum += self.at(x, y);
                    *count += 1;
                }
            }
        }
        sums[1..].iter().map(|&(sum, count)| sum / f64::from(count)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_is_that_of_the_definition() {
        let points = [[0.1, 0.7], [0.35, 0.2], [0.81, 0.55]];
        let spectrum = mean(|_| points.to_vec(), 3, 5);
        for (x, y) in [(0, 1), (1, 0), (2, -3), (-2, 3), (2, 3), (-5, -5), (5, -1)] {
            let turns = points.map(|p| TAU * (x as f64 * p[0] + y as f64 * p[1]));
            let sums = [turns.map(f64::cos), turns.map(f64::sin)].map(|t| t.iter().sum::<f64>());
            let power = (sums[0].powi(2) + sums[1].powi(2)) / 3.0;
            // Sums of three products in f32.
            assert!(
                (spectrum.at(x, y) - power).abs() < 1e-5,
                "({x}, {y}): {} for {power}",
                spectrum.at(x, y)
            );
        }
        assert_eq!(spectrum.at(0, 0), 0.0);
    }

    #[test]
    fn frequencies_of_a_grid_stand_alone() {
        let grid = |_| (0..64).map(|i| [(i % 8) as f64 / 8.0, (i / 8) as f64 / 8.0]).collect();
        let spectrum = mean(grid, 1, 20);
        for (x, y) in [(8, 0), (-16, 8), (0, -8), (16, 16)] {
            assert!((spectrum.at(x, y) - 64.0).abs() < 1e-3);
        }
        assert!(spectrum.at(7, 0) < 1e-6 && spectrum.at(8, 1) < 1e-6);
        let radial = spectrum.radial_mean();
        assert!(radial[7] > 1.0 && radial[2] < 1e-6);
    }
}
