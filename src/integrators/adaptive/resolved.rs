//! Pixels that beams resolved: they have no variance and gain no samples. Input: their values. Output: sums and variances of
//! a film in which they take the place of samples; and the part that a pilot run's pixels have in cost and error.

use super::allocate::weight;
use crate::sampling::{HalfSums, PilotRun};

/// The resolved pixels.
#[derive(Default)]
pub struct ResolvedPixels {
    /// Red, green, blue, and 1 if samples are needed. Empty before anything is resolved.
    pixels: Vec<[f32; 4]>,
}

impl ResolvedPixels {
    pub fn new(pixels: Vec<[f32; 4]>) -> ResolvedPixels {
        ResolvedPixels { pixels }
    }

    /// Returns the number of resolved pixels.
    pub fn count(&self) -> usize {
        self.pixels.iter().filter(|p| p[3] == 0.0).count()
    }

    /// Returns true if the pixel is resolved.
    pub fn has(&self, pixel: usize) -> bool {
        self.pixels.get(pixel).is_some_and(|p| p[3] == 0.0)
    }

    /// Replaces the sums of resolved pixels by their resolved values.
    pub fn replace(&self, sums: &mut HalfSums, counts: &[u32]) {
        for (i, &[r, g, b, sampled]) in self.pixels.iter().enumerate() {
            if sampled == 0.0 {
                let n = counts[i] as f32;
                let square = (r * r + g * g + b * b) / 3.0;
                sums.halves.iter_mut().for_each(|half| half[i] = [n * r, n * g, n * b, n * square]);
            }
        }
    }

    /// Sets the variances of resolved pixels to zero: their values are not random.
    pub fn clear_variances(&self, variances: &mut [f32]) {
        for (variance, pixel) in variances.iter_mut().zip(&self.pixels) {
            *variance *= pixel[3];
        }
    }
}

/// Returns the resolved pixels' shares of what a pilot run's pixels would cost further, and of their error.
pub fn shares(pilot: &PilotRun, counts: &[u32], variances: &[f32], exponent: f64) -> [f64; 2] {
    let cost = share(pilot, |i| weight(variances[i], counts[i], exponent as f32));
    [cost, share(pilot, |i| variances[i])]
}

/// Returns the resolved pixels' share of the sum over a pilot run's pixels.
fn share(pilot: &PilotRun, of: impl Fn(usize) -> f32) -> f64 {
    let sum = |resolved: bool| {
        let pixels = pilot.pixels.iter().filter(|p| p.1 || !resolved);
        pixels.map(|p| f64::from(of(p.0 as usize))).sum::<f64>()
    };
    let all = sum(false);
    if all > 0.0 { sum(true) / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resolved_pixels_have_their_value_and_no_variance() {
        let resolved = ResolvedPixels::new(vec![[0.25, 0.5, 1.0, 0.0], [9.0, 9.0, 9.0, 1.0]]);
        let half = || vec![[1.0, 2.0, 3.0, 4.0]; 2];
        let mut sums = HalfSums { width: 2, height: 1, halves: [half(), half()] };
        resolved.replace(&mut sums, &[4, 8]);
        for half in &sums.halves {
            assert_eq!(half[0][..3], [1.0, 2.0, 4.0]);
            assert_eq!(half[1], [1.0, 2.0, 3.0, 4.0], "a sampled pixel has changed");
        }
        let mut variances = vec![0.5, 0.5];
        resolved.clear_variances(&mut variances);
        assert_eq!((variances, resolved.count()), (vec![0.0, 0.5], 1));
    }

    #[test]
    fn shares_are_weighed() {
        let pilot = PilotRun { seconds: 1.0, pixels: vec![(0, true), (2, false)] };
        assert_eq!(share(&pilot, |i| [3.0, 100.0, 1.0][i]), 0.75);
        assert_eq!(share(&pilot, |_| 0.0), 0.0);
        // Of equal counts the costs are as the variances to 1 / (1 + p).
        let [cost, error] = shares(&pilot, &[4; 3], &[4.0, 0.0, 1.0], 1.0);
        assert!((cost - 2.0 / 3.0).abs() < 1e-6, "{cost}");
        assert!((error - 0.8).abs() < 1e-6, "{error}");
    }
}
