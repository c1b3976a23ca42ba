//! Chooses the pixels of an audit. Half of its samples are distributed evenly over the picture, where pixels with few
//! samples cost little to check and are drawn more often; half in proportion to the variance that the film shows. A
//! pixel is drawn at most once, at equal steps along the counts and the picture (systematic sampling). Expected numbers
//! of draws are whole multiples of one part in `DRAW_UNIT`, so that host and device draw the same pixels.

use rayon::prelude::*;

use super::{MAX_COUNT, OCTAVES, octave};
use crate::core::error::Result;
use crate::schema::constants::{DRAW_CELLS, DRAW_MIN_SAMPLES, DRAW_UNIT};

/// Draws for each half of the samples.
const MIN_DRAWS: f64 = 128.0;
const MAX_DRAWS: f64 = 2048.0;
/// Pixels that one thread processes at once.
const PIXELS_PER_TASK: usize = 1 << 15;
/// Cells along each side of the picture.
const CELLS: usize = DRAW_CELLS as usize;

/// Returns the samples of each of the two means for a pixel with `count` samples in each half: at least
/// `DRAW_MIN_SAMPLES`, as differences that few pixels show are found by many draws.
pub fn wanted(count: u32) -> u32 {
    (2 * count).clamp(DRAW_MIN_SAMPLES, MAX_COUNT)
}

/// Returns the samples of a draw.
pub fn samples_of(count: u32) -> f32 {
    2.0 * wanted(count) as f32
}

/// Sums over the pixels of a picture, with the samples of a draw as a pixel's cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrawSums {
    pub pixels: f64,
    /// Of 1 / cost, of the variances, and of their products with the cost.
    pub inverse_cost: f64,
    pub variance: f64,
    pub cost_variance: f64,
}

/// The expected number of draws of each pixel: equal expected samples for all, plus draws in proportion to its
/// variance, at most one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DrawRates {
    /// Expected samples of each pixel, independent of its variance.
    pub even: f32,
    /// Draws per unit of variance.
    pub of_variance: f32,
}

impl DrawRates {
    /// Chooses the rates for about `budget` samples. `capped` returns the sum over all pixels of their variance times a
    /// factor, or 1 if that is less.
    pub fn new(
        sums: &DrawSums,
        budget: f64,
        mut capped: impl FnMut(f64) -> Result<f64>,
    ) -> Result<DrawRates> {
        let draws = |wanted: f64| wanted.clamp(MIN_DRAWS, MAX_DRAWS).min(sums.pixels);
        let even_draws = sums.inverse_cost * 0.5 * budget / sums.pixels;
        let even = 0.5 * budget / sums.pixels * draws(even_draws) / even_draws;
        let mut of_variance = 0.0;
        if sums.variance > 0.0 {
            let wanted = draws(0.5 * budget * sums.variance / sums.cost_variance);
            of_variance = wanted / sums.variance;
            for _ in 0..4 {
                of_variance *= wanted / capped(of_variance)?.max(f64::MIN_POSITIVE);
            }
        }
        Ok(DrawRates { even: even as f32, of_variance: of_variance as f32 })
    }

    /// Returns the expected draws of a pixel in parts of `DRAW_UNIT`: from one part to one draw.
    fn parts(&self, count: u32, variance: f32) -> u32 {
        let draws = (self.even / samples_of(count) + self.of_variance * variance).min(1.0);
        ((draws * DRAW_UNIT as f32 + 0.5) as u32).max(1)
    }
}

/// The expected draws of each pixel, summed over each cell of the picture and each octave of counts.
pub struct Masses<'a> {
    counts: &'a [u32],
    variances: &'a [f32],
    width: usize,
    rates: DrawRates,
    cells: Vec<[u32; OCTAVES]>,
}

impl<'a> Masses<'a> {
    pub fn new((counts, variances): (&'a [u32], &'a [f32]), width: usize, budget: f64) -> Result<Masses<'a>> {
        let sum = |f: &(dyn Fn(usize) -> f64 + Sync)| -> f64 {
            let chunks = (0..counts.len().div_ceil(PIXELS_PER_TASK)).into_par_iter().map(|chunk| {
                (chunk * PIXELS_PER_TASK..((chunk + 1) * PIXELS_PER_TASK).min(counts.len()))
                    .map(f)
                    .sum::<f64>()
            });
            chunks.collect::<Vec<f64>>().iter().sum()
        };
        let variance = |i: usize| f64::from(variances[i]);
        let cost = |i: usize| f64::from(samples_of(counts[i]));
        let sums = DrawSums {
            pixels: counts.len() as f64,
            inverse_cost: sum(&|i| 1.0 / cost(i)),
            variance: sum(&variance),
            cost_variance: sum(&|i| cost(i) * variance(i)),
        };
        let capped = |factor: f64| Ok(sum(&|i| (factor * variance(i)).min(1.0)));
        let rates = DrawRates::new(&sums, budget, capped)?;
        let mut masses = Masses { counts, variances, width, rates, cells: Vec::new() };
        let cell = |cell: usize| {
            let mut mass = [0; OCTAVES];
            masses.pixels_of(cell).for_each(|i| mass[octave(counts[i])] += masses.parts_of(i));
            mass
        };
        masses.cells = (0..CELLS * CELLS).into_par_iter().map(cell).collect();
        Ok(masses)
    }

    fn parts_of(&self, pixel: usize) -> u32 {
        self.rates.parts(self.counts[pixel], self.variances[pixel])
    }

    /// Returns the expected number of draws of the pixel, at most one.
    pub fn draws_of(&self, pixel: usize) -> f64 {
        f64::from(self.parts_of(pixel)) / f64::from(DRAW_UNIT)
    }

    /// Draws pixels at equal steps along the whole mass, in the order of octaves and cells; none of them twice. `start`,
    /// in 0 .. 1, is the place of the first one in its step.
    pub fn draw(&self, start: f64) -> Vec<usize> {
        let mut drawn: Vec<usize> = Vec::new();
        let mut wanted = first_draw(start);
        let mut before = 0u64;
        for o in 0..OCTAVES {
            for cell in 0..CELLS * CELLS {
                let mut at = before;
                before += u64::from(self.cells[cell][o]);
                if wanted >= before {
                    continue;
                }
                for i in self.pixels_of(cell).filter(|&i| octave(self.counts[i]) == o) {
                    at += u64::from(self.parts_of(i));
                    while wanted < at {
                        drawn.push(i);
                        wanted += u64::from(DRAW_UNIT);
                    }
                }
            }
        }
        drawn
    }

    /// Returns the pixels of a cell. Cells follow a boustrophedon path, so that successive cells are adjacent.
    fn pixels_of(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let width = self.width;
        let height = self.counts.len() / width;
        let (row, along) = (cell / CELLS, cell % CELLS);
        let column = if row % 2 == 0 { along } else { CELLS - 1 - along };
        let part = |k: usize, size: usize| k * size / CELLS..(k + 1) * size / CELLS;
        let columns = part(column, width);
        part(row, height).flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }
}

/// Returns the place of the first draw, in parts.
pub fn first_draw(start: f64) -> u64 {
    (start * f64::from(DRAW_UNIT)) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 100;

    /// Each pixel is drawn as often as its expected draws say, whatever its place; none twice at once.
    #[test]
    fn pixels_are_drawn_as_often_as_expected() {
        let counts: Vec<u32> = (0..WIDTH * 70).map(|i| 1 << (i % 5)).collect();
        let variances: Vec<f32> =
            (0..WIDTH * 70).map(|i| if i % 11 == 0 { (i % 7) as f32 } else { 0.0 }).collect();
        let masses = Masses::new((&counts, &variances), WIDTH, 1e5).unwrap();
        let mut times = vec![0u32; counts.len()];
        const ROUNDS: u32 = 512;
        for round in 0..ROUNDS {
            let drawn = masses.draw((f64::from(round) + 0.5) / f64::from(ROUNDS));
            let mut unique = drawn.clone();
            unique.dedup();
            assert_eq!(unique.len(), drawn.len(), "a pixel is drawn twice");
            drawn.into_iter().for_each(|i| times[i] += 1);
        }
        for (i, &times) in times.iter().enumerate() {
            // Equal steps miss the exact number by less than one.
            let expected = masses.draws_of(i) * f64::from(ROUNDS);
            assert!((f64::from(times) - expected).abs() < 1.001, "{i}: {times} of {expected}");
        }
    }
}
