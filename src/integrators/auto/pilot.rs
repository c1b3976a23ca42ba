//! Pixels that are scattered over the picture and sampled apart from it, by which the errors of pictures are measured.
//! For a value x and independent means a and b of a pixel, (x − a)(x − b) has the expectation (x − µ)², bias included,
//! whatever led to x.

use super::super::adaptive::DEVIATE;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::sampling::Backend;
use crate::schema::layout::{BATCH_APART, BATCH_STREAM_SHIFT, PixelBatch};

/// Most pixels of a pilot run, and least, even if these take longer than they should; and most of an audit.
const PIXELS: usize = 8192;
const MIN_PIXELS: usize = 1024;
const AUDIT_PIXELS: usize = 32_768;
/// Errors of fewer pixels, or of few that have most of the error, give no interval.
const MIN_EFFECTIVE: f64 = 32.0;
/// Steps of a sequence that fills the square evenly (Roberts 2018, "The unreasonable effectiveness of quasirandom
/// sequences").
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
/// Streams of independent samples; those of a picture are 0 and 1.
const STREAMS: [u32; 3] = [2, 3, 4];
const AUDIT_STREAMS: [u32; 2] = [5, 6];
/// Samples a pixel of the first two means, and of a third one, which shows how the error falls with the number.
pub const MANY: u32 = 8;
pub const FEW: u32 = 2;
/// The mean of |z|^(2/(1+p)) over normal deviates z, to the power 1 + p, for p = 1.5: by how much differences of single
/// pixels seem to vary more than the variances behind them.
const OF_SINGLE_DIFFERENCES: f64 = 0.6;
/// Most by which placing samples is assumed to gain, whatever few samples show.
const MAX_GAIN: f64 = 64.0;

type Color = [f64; 3];

/// The pixels, with two independent means of each.
pub struct Pilot {
    pixels: Vec<u32>,
    width: u32,
    means: [Vec<Color>; 2],
    few: Vec<Color>,
    /// Samples of each of the two means.
    pub samples: u32,
}

/// A mean squared error, with bounds of its root.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub mse: f64,
    /// Its standard deviation: less cannot be told from none.
    pub deviation: f64,
    /// `None` if too few pixels have most of the error.
    pub interval: Option<[f64; 2]>,
}

impl Pilot {
    /// Samples about `number` pixels of a picture of that size.
    pub fn new(
        backend: &mut dyn Backend,
        size: [u32; 2],
        number: f64,
        progress: &dyn Progress,
    ) -> Result<Pilot> {
        let pixels = scattered(size, (number as usize).clamp(MIN_PIXELS, PIXELS));
        let counts = [MANY, MANY, FEW];
        let batches: Vec<PixelBatch> = STREAMS
            .iter()
            .zip(counts)
            .flat_map(|(&stream, count)| batches(&pixels, size[0], stream, count))
            .collect();
        let sums = backend.sample_apart(&batches, progress)?;
        let mut parts = sums.chunks(pixels.len()).zip(counts).map(|(sums, count)| means(sums, count));
        let mut next = || parts.next().unwrap_or_default();
        Ok(Pilot { means: [next(), next()], few: next(), pixels, width: size[0], samples: MANY })
    }

    /// Samples other pixels in place of these, `number` of them, if those are more.
    pub fn widen(
        &mut self,
        backend: &mut dyn Backend,
        size: [u32; 2],
        [number, samples]: [u32; 2],
        progress: &dyn Progress,
    ) -> Result<()> {
        let pixels = scattered(size, (number as usize).min(AUDIT_PIXELS));
        if pixels.len() <= self.pixels.len() {
            return Ok(());
        }
        let of = |&stream: &u32| batches(&pixels, size[0], stream, samples);
        let batches: Vec<PixelBatch> = AUDIT_STREAMS.iter().flat_map(of).collect();
        let sums = backend.sample_apart(&batches, progress)?;
        for (own, sums) in self.means.iter_mut().zip(sums.chunks(pixels.len())) {
            *own = means(sums, samples);
        }
        (self.pixels, self.samples) = (pixels, samples);
        Ok(())
    }

    pub fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Returns the error of prefiltered samples; `None` if the backend has none.
    pub fn prefiltered(&self, backend: &mut dyn Backend, progress: &dyn Progress) -> Result<Option<Found>> {
        let batches: Vec<PixelBatch> = batches(&self.pixels, self.width, 0, 1).collect();
        let sums = backend.prefiltered_apart(&batches, progress)?;
        Ok(sums.map(|sums| self.error(means(&sums, 1).into_iter())))
    }

    /// Returns the error of a picture.
    pub fn error_in(&self, film: &Film) -> Found {
        self.error(self.pixels.iter().map(|&pixel| film.pixels[pixel as usize].map(f64::from)))
    }

    /// Returns the errors of as many samples as the two means have, and as the third one has.
    pub fn noise(&self) -> [f64; 2] {
        let variances = self.variances();
        let many = variances.iter().sum::<f64>() / variances.len().max(1) as f64;
        [many, self.error(self.few.iter().copied()).mse]
    }

    /// Returns by how much less the mean squared error is if samples go where they lower it most (Lagrange; see
    /// `adaptive::allocate`), when it falls with the exponent `p`.
    pub fn gain(&self, p: f64) -> f64 {
        let variances = self.variances();
        let count = variances.len().max(1) as f64;
        let mean = variances.iter().sum::<f64>() / count;
        let placed = (variances.iter().map(|v| v.powf(1.0 / (1.0 + p))).sum::<f64>() / count).powf(1.0 + p);
        if placed > 0.0 { (OF_SINGLE_DIFFERENCES * mean / placed).clamp(1.0, MAX_GAIN) } else { 1.0 }
    }

    fn error(&self, values: impl Iterator<Item = Color>) -> Found {
        let product = |(x, (a, b)): (Color, (&Color, &Color))| dot(x, *a, x, *b);
        let errors = values.zip(self.means[0].iter().zip(&self.means[1])).map(product);
        Found::new(&errors.filter(|error| error.is_finite()).collect::<Vec<f64>>())
    }

    /// Pixels that are NaN or infinite stay so however they are rendered.
    fn variances(&self) -> Vec<f64> {
        let both = self.means[0].iter().zip(&self.means[1]);
        both.map(|(a, b)| 0.5 * dot(*a, *b, *a, *b)).filter(|v| v.is_finite()).collect()
    }
}

impl Found {
    fn new(errors: &[f64]) -> Found {
        let count = errors.len().max(1) as f64;
        let mse = errors.iter().sum::<f64>() / count;
        let squares: f64 = errors.iter().map(|error| (error - mse).powi(2)).sum();
        let deviation = squares.sqrt() / count;
        let reach = DEVIATE * deviation;
        let all: f64 = errors.iter().map(|error| error.abs()).sum();
        let effective =
            all * all / errors.iter().map(|error| error * error).sum::<f64>().max(f64::MIN_POSITIVE);
        let interval = [mse - reach, mse + reach].map(|mse| mse.max(0.0).sqrt());
        Found { mse, deviation, interval: (effective >= MIN_EFFECTIVE).then_some(interval) }
    }
}

/// Returns pixels that fill a picture evenly.
fn scattered([width, height]: [u32; 2], number: usize) -> Vec<u32> {
    let at = |k: usize, step: f64, size: u32| {
        (((0.5 + k as f64 * step).fract() * f64::from(size)) as u32).min(size - 1)
    };
    let pixel = |k: usize| at(k, STEPS[1], height) * width + at(k, STEPS[0], width);
    (0..number.min(width as usize * height as usize)).map(pixel).collect()
}

fn batches(pixels: &[u32], width: u32, stream: u32, count: u32) -> impl Iterator<Item = PixelBatch> {
    pixels.iter().map(move |&pixel| PixelBatch {
        place: PixelBatch::place_of(pixel, width),
        part: BATCH_APART | stream << BATCH_STREAM_SHIFT,
        first: 0,
        count,
    })
}

fn means(sums: &[[f32; 4]], count: u32) -> Vec<Color> {
    sums.iter().map(|sum| std::array::from_fn(|c| f64::from(sum[c]) / f64::from(count))).collect()
}

/// Returns (u − v)(s − t), averaged over the channels.
fn dot(u: Color, v: Color, s: Color, t: Color) -> f64 {
    (0..3).map(|c| (u[c] - v[c]) * (s[c] - t[c])).sum::<f64>() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pixels of value 0.5 whose means err by `noise(i)` times normal deviates.
    fn pilot(noise: impl Fn(usize) -> f64) -> Pilot {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut mean = |i: usize| {
            let deviate = (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0;
            [0.5 + noise(i) * deviate; 3]
        };
        let mut means = || (0..PIXELS).map(&mut mean).collect::<Vec<Color>>();
        let means = [means(), means()];
        Pilot { pixels: (0..PIXELS as u32).collect(), width: 64, few: means[0].clone(), means, samples: MANY }
    }

    #[test]
    fn a_bias_below_the_noise_of_the_means_is_measured() {
        let pilot = pilot(|_| 0.05);
        let found = pilot.error(std::iter::repeat_n([0.52; 3], PIXELS));
        // A product deviates by less than 0.05² + 2·0.02·0.05: 4 sigma of 8192 are 2.1e-4.
        assert!((found.mse - 4e-4).abs() < 2.1e-4, "{found:?}");
        assert!((pilot.noise()[0] / 0.0025 - 1.0).abs() < 0.1, "{:?}", pilot.noise());
        let [low, high] = found.interval.unwrap();
        assert!(low < 0.02 && high > 0.02, "{found:?}");
    }

    #[test]
    fn placing_samples_gains_where_few_pixels_are_noisy_and_nothing_where_all_are() {
        let even = pilot(|_| 0.05).gain(1.5);
        assert!((1.0..1.2).contains(&even), "{even}");
        // All noise in a sixteenth of the pixels: 16^1.5 = 64 times less with as many samples.
        let rare = pilot(|i| if i % 16 == 0 { 0.05 } else { 0.0 }).gain(1.5);
        assert!((50.0..=64.0).contains(&rare), "{rare}");
    }

    #[test]
    fn few_pixels_that_have_all_of_the_error_give_no_interval() {
        let values = (0..PIXELS).map(|i| if i % 512 == 0 { [1.0; 3] } else { [0.5; 3] });
        let found = pilot(|_| 1e-4).error(values);
        assert!(found.interval.is_none() && found.mse > 0.0, "{found:?}");
    }

    #[test]
    fn pixels_that_are_no_numbers_do_not_count() {
        let mut pilot = pilot(|_| 0.05);
        pilot.means[0][7] = [f64::NAN; 3];
        assert!(pilot.noise()[0].is_finite());
        let film = Film { pixels: vec![[0.5; 3]; PIXELS], ..Film::new(64, PIXELS as u32 / 64, 1) };
        assert!(pilot.error_in(&film).mse.is_finite());
    }

    #[test]
    fn scattered_pixels_fill_the_picture() {
        let pixels = scattered([640, 64], PIXELS);
        let share = pixels.len() as f64 / 10.0;
        let of_part = |part: u32| pixels.iter().filter(|&&p| p % 640 / 64 == part).count() as f64;
        assert!((0..10).all(|part| (of_part(part) / share - 1.0).abs() < 0.02), "each tenth has its share");
        assert_eq!(scattered([3, 2], PIXELS).len(), 6);
    }
}
