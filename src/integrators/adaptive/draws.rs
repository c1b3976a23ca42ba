//! Chooses the pixels of an audit. Half of its samples are distributed evenly over the picture, where pixels with few
//! samples cost little to check and are drawn more often; half in proportion to the variance that the film shows. A
//! pixel is drawn at most once, at equal steps along the counts and the picture (systematic sampling).

use rayon::prelude::*;

use super::audit::Audited;
use super::{MAX_COUNT, OCTAVES, octave};

/// Draws for each half of the samples.
const MIN_DRAWS: f64 = 128.0;
const MAX_DRAWS: f64 = 2048.0;
/// Least number of samples of each of the two means: differences that few pixels show are found by many draws.
const MIN_SAMPLES: u32 = 64;
/// Pixels that one thread processes at once.
const PIXELS_PER_TASK: usize = 1 << 15;
/// Cells along each side of the picture.
const CELLS: usize = 32;

/// Returns the samples of each of the two means for a pixel with `count` samples in each half.
pub fn wanted(count: u32) -> u32 {
    (2 * count).clamp(MIN_SAMPLES, MAX_COUNT)
}

/// Returns the samples of a draw.
fn samples_of(count: u32) -> f64 {
    2.0 * f64::from(wanted(count))
}

/// The expected number of draws of each pixel: equal expected samples for all, plus draws in proportion to its
/// variance, at most one; summed over each cell of the picture and each octave of counts.
pub struct Masses {
    cells: Vec<[f64; OCTAVES]>,
    /// Expected samples of each pixel, independent of its variance.
    even: f64,
    /// Draws per unit of variance.
    of_variance: f64,
}

impl Masses {
    pub fn new(of: &Audited, budget: f64) -> Masses {
        let pixels = of.counts.len() as f64;
        let sum = |f: &(dyn Fn(usize) -> f64 + Sync)| -> f64 {
            let chunks = (0..of.counts.len().div_ceil(PIXELS_PER_TASK)).into_par_iter().map(|chunk| {
                (chunk * PIXELS_PER_TASK..((chunk + 1) * PIXELS_PER_TASK).min(of.counts.len()))
                    .map(f)
                    .sum::<f64>()
            });
            chunks.collect::<Vec<f64>>().iter().sum()
        };
        let draws = |wanted: f64| wanted.clamp(MIN_DRAWS, MAX_DRAWS).min(pixels);
        let variance = |i: usize| f64::from(of.estimate.variances[i]);
        let cost = |i: usize| samples_of(of.counts[i]);
        let even_draws = sum(&|i| 1.0 / cost(i)) * 0.5 * budget / pixels;
        let even = 0.5 * budget / pixels * draws(even_draws) / even_draws;
        let all = sum(&variance);
        let mut of_variance = 0.0;
        if all > 0.0 {
            let wanted = draws(0.5 * budget * all / sum(&|i| cost(i) * variance(i)));
            of_variance = wanted / all;
            for _ in 0..4 {
                of_variance *= wanted / sum(&|i| (of_variance * variance(i)).min(1.0)).max(f64::MIN_POSITIVE);
            }
        }
        let mut masses = Masses { cells: Vec::new(), even, of_variance };
        let cell = |cell: usize| {
            let mut mass = [0.0; OCTAVES];
            pixels_of(of, cell).for_each(|i| mass[octave(of.counts[i])] += masses.draws_of(of, i));
            mass
        };
        masses.cells = (0..CELLS * CELLS).into_par_iter().map(cell).collect();
        masses
    }

    /// Returns the expected number of draws of the pixel, at most one.
    pub fn draws_of(&self, of: &Audited, pixel: usize) -> f64 {
        let even = self.even / samples_of(of.counts[pixel]);
        (even + self.of_variance * f64::from(of.estimate.variances[pixel])).min(1.0)
    }

    /// Draws pixels at equal steps along the whole mass, in the order of octaves and cells; none of them twice.
    pub fn draw(&self, of: &Audited, rng: &mut fastrand::Rng) -> Vec<usize> {
        let mut drawn: Vec<usize> = Vec::new();
        let start = rng.f64();
        let mut wanted = start;
        let mut before = 0.0;
        for o in 0..OCTAVES {
            for cell in 0..CELLS * CELLS {
                let mut at = before;
                before += self.cells[cell][o];
                if wanted >= before {
                    continue;
                }
                for i in pixels_of(of, cell).filter(|&i| octave(of.counts[i]) == o) {
                    at += self.draws_of(of, i);
                    while wanted < at {
                        drawn.push(i);
                        wanted = start + drawn.len() as f64;
                    }
                }
            }
        }
        drawn
    }
}

/// Returns the pixels of a cell. Cells follow a boustrophedon path, so that successive cells are adjacent.
fn pixels_of<'a>(of: &Audited<'a>, cell: usize) -> impl Iterator<Item = usize> + use<'a> {
    let width = of.sums.width as usize;
    let height = of.counts.len() / width;
    let (row, along) = (cell / CELLS, cell % CELLS);
    let column = if row % 2 == 0 { along } else { CELLS - 1 - along };
    let part = |k: usize, size: usize| k * size / CELLS..(k + 1) * size / CELLS;
    let columns = part(column, width);
    part(row, height).flat_map(move |y| columns.clone().map(move |x| y * width + x))
}
