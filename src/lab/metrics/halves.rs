//! Two pictures of one view by independent samples, as many in each. Input: both. Output: their mean, which is a reference;
//! its own error; and the error of other pictures, with what the noise of the reference leaves unknown of it.

use super::compare;
use super::compare::check_sizes;
use crate::core::error::Result;
use crate::core::film::Film;

/// Deviations from which on a number is not taken for noise: by chance one in twenty would be.
const CLEAR: f64 = 2.0;

/// Both pictures.
#[derive(Clone, Debug)]
pub struct Halves {
    pub a: Film,
    pub b: Film,
}

/// A number that was measured against a noisy reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    pub value: f64,
    /// The standard deviation that the reference's noise gives it.
    pub deviation: f64,
}

impl Estimate {
    /// Returns true if the number is not within the noise about zero. Without noise every number is clear, also zero.
    pub fn is_clear(&self) -> bool {
        self.value.abs() >= CLEAR * self.deviation
    }

    /// Returns what a positive number is not above, but by chance.
    pub fn bound(&self) -> f64 {
        self.value.max(0.0) + CLEAR * self.deviation
    }
}

impl Halves {
    /// Adds further samples to each of both.
    pub fn add(&mut self, further: &Halves) {
        for (own, further) in [(&mut self.a, &further.a), (&mut self.b, &further.b)] {
            let all = own.samples.saturating_add(further.samples);
            let share = f64::from(further.samples) / f64::from(all.max(1));
            for (p, q) in own.pixels.iter_mut().flatten().zip(further.pixels.iter().flatten()) {
                *p = (f64::from(*p) * (1.0 - share) + f64::from(*q) * share) as f32;
            }
            own.samples = all;
        }
    }

    /// Returns the mean of both pictures.
    pub fn mean(&self) -> Film {
        let middle = |(p, q): (&[f32; 3], &[f32; 3])| {
            [0, 1, 2].map(|c: usize| (0.5 * (f64::from(p[c]) + f64::from(q[c]))) as f32)
        };
        let pixels = self.a.pixels.iter().zip(&self.b.pixels).map(middle).collect();
        Film { pixels, samples: self.a.samples.saturating_add(self.b.samples), ..self.a }
    }

    /// Returns the RMSE of the mean: half of that between both.
    pub fn rmse(&self) -> Result<f64> {
        Ok(0.5 * compare(&self.a, &self.b)?.rmse)
    }

    /// Returns the mean squared error of a picture against what both halves are estimates of: the mean of
    /// (c − a)(c − b), in which the noise of the halves cancels on average. `None` if a pixel is no number.
    pub fn mse_of(&self, film: &Film) -> Result<Option<Estimate>> {
        check_sizes(film, &self.a)?;
        check_sizes(film, &self.b)?;
        Ok(self.summed(film, |c, a, b| match c == a && c == b {
            // Infinite light may well be the truth.
            true => [0.0; 2],
            false => [(c - a) * (c - b), (c - 0.5 * (a + b)) * (a - b)],
        }))
    }

    /// Returns by how much the mean squared error of the picture `x` is larger than that of `y`, which is known far
    /// better than each of both where they are alike. `None` if a pixel is no number.
    pub fn mse_between(&self, x: &Film, y: &Film) -> Result<Option<Estimate>> {
        check_sizes(x, &self.a)?;
        check_sizes(y, &self.a)?;
        let mut others = y.pixels.iter().flatten();
        Ok(self.summed(x, |x, a, b| {
            let y = others.next().copied().map_or(x, f64::from);
            if x == y { [0.0; 2] } else { [(x - y) * (x + y - a - b), (x - y) * (a - b)] }
        }))
    }

    /// Sums two terms of each value of a picture and the halves: one whose mean is the estimate, and one that differs from
    /// the estimate's noise in sign only. Channels of a pixel share their noise, pixels do not.
    fn summed(&self, film: &Film, mut terms: impl FnMut(f64, f64, f64) -> [f64; 2]) -> Option<Estimate> {
        let (mut sum, mut squares) = (0.0, 0.0);
        for ((own, a), b) in film.pixels.iter().zip(&self.a.pixels).zip(&self.b.pixels) {
            let mut noise = 0.0;
            for c in 0..3 {
                let [value, part] = terms(f64::from(own[c]), f64::from(a[c]), f64::from(b[c]));
                sum += value;
                noise += part;
            }
            squares += noise * noise;
        }
        let count = (3 * film.pixels.len()).max(1) as f64;
        let found = Estimate { value: sum / count, deviation: squares.sqrt() / count };
        Some(found).filter(|found| found.value.is_finite() && found.deviation.is_finite())
    }
}
