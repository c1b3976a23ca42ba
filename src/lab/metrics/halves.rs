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

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of mean 0 and variance 1, of which the channels of a pixel have the same.
    fn noise(rng: &mut fastrand::Rng) -> f32 {
        // The sum of twelve numbers from 0 to 1.
        (0..12).map(|_| rng.f32()).sum::<f32>() - 6.0
    }

    fn noisy(truth: &Film, deviation: f32, rng: &mut fastrand::Rng) -> Film {
        let mut film = truth.clone();
        film.pixels.iter_mut().for_each(|pixel| {
            let own = deviation * noise(rng);
            *pixel = pixel.map(|v| v + own);
        });
        film
    }

    fn with_planted(truth: &Film, error: f32) -> Film {
        let mut film = truth.clone();
        film.pixels.iter_mut().step_by(2).for_each(|pixel| *pixel = pixel.map(|v| v + error));
        film
    }

    fn truth() -> Film {
        let mut film = Film::new(40, 30, 4);
        film.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = [i as f32 / 600.0, 0.5, 0.25]);
        film
    }

    #[test]
    fn a_planted_error_is_found_whatever_the_noise_of_the_reference() {
        let (truth, mut rng) = (truth(), fastrand::Rng::with_seed(1));
        // Half of the pixels are off by 0.1: the squared error is 0.005. The noise of a half is as large as the error.
        let film = with_planted(&truth, 0.1);
        let mut scores = Vec::new();
        let mut naive = 0.0;
        for _ in 0..300 {
            let halves = Halves { a: noisy(&truth, 0.1, &mut rng), b: noisy(&truth, 0.1, &mut rng) };
            let found = halves.mse_of(&film).unwrap().unwrap();
            scores.push((found.value - 0.005) / found.deviation);
            naive += compare(&film, &halves.mean()).unwrap().mse / 300.0;
        }
        let mean = scores.iter().sum::<f64>() / 300.0;
        let spread = (scores.iter().map(|z| z * z).sum::<f64>() / 300.0).sqrt();
        // Of 300 numbers of variance 1, the mean has a deviation of 0.058 and the root of the mean square one of 0.041.
        assert!(mean.abs() < 0.24, "mean {mean} deviations off");
        assert!((0.83..1.17).contains(&spread), "{spread} times the deviation that was told");
        // Against the mean of both, the noise counts as an error of the picture.
        assert!(naive > 0.0095, "{naive}");
    }

    #[test]
    fn errors_that_differ_by_less_than_the_noise_are_not_ranked_and_larger_ones_are() {
        let (truth, mut rng) = (truth(), fastrand::Rng::with_seed(2));
        let halves = Halves { a: noisy(&truth, 0.1, &mut rng), b: noisy(&truth, 0.1, &mut rng) };
        let [x, y, z] = [0.1, 0.1001, 0.15].map(|error| with_planted(&truth, error));
        let clear = |x: &Film, y: &Film| halves.mse_between(x, y).unwrap().unwrap().is_clear();
        assert!(!clear(&noisy(&x, 0.02, &mut rng), &noisy(&x, 0.02, &mut rng)), "noise is ranked");
        assert!(clear(&z, &x) && clear(&x, &z), "a third more is not seen");
        assert!(halves.mse_between(&x, &x).unwrap().unwrap().is_clear(), "a picture equals itself for sure");
        assert!(!halves.mse_of(&truth).unwrap().unwrap().is_clear(), "the truth has an error");
        let quiet = Halves { a: truth.clone(), b: truth.clone() };
        assert!(quiet.mse_between(&y, &x).unwrap().unwrap().is_clear(), "without noise all is clear");
        assert_eq!(quiet.mse_of(&truth).unwrap(), Some(Estimate { value: 0.0, deviation: 0.0 }));
    }

    #[test]
    fn the_mean_has_half_of_the_difference_as_its_error() {
        let (truth, mut rng) = (truth(), fastrand::Rng::with_seed(3));
        let halves = Halves { a: noisy(&truth, 0.1, &mut rng), b: noisy(&truth, 0.1, &mut rng) };
        let found = compare(&halves.mean(), &truth).unwrap().rmse;
        // The mean of two has 0.1 / √2 = 0.0707; 1200 pixels tell it to 2 %.
        assert!((halves.rmse().unwrap() / found - 1.0).abs() < 0.1, "{found}");
        assert_eq!(halves.mean().samples, 8);
        let mut more = halves.clone();
        more.add(&Halves { a: halves.b.clone(), b: halves.a.clone() });
        assert_eq!((more.a.samples, more.rmse().unwrap() < 1e-7), (8, true), "both have all samples");
        let mut broken = truth.clone();
        broken.pixels[7][1] = f32::NAN;
        assert_eq!(halves.mse_of(&broken).unwrap(), None);
        assert!(halves.mse_of(&Film::new(3, 3, 1)).is_err());
    }
}
