//! A picture with many samples in two independent halves, as many as a part of the study's time allows. Input: how one half
//! is rendered. Output: the mean of the halves a and b, and its error, RMSE(a, b) / 2.
//!
//! Where time is short, each half is the mean of several passes, so that a machine that becomes slower loses one of them at
//! most, and one that was thought too slow gets more.

use std::time::Instant;

use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::lab::metrics::compare;
use crate::scene::model::Pattern;

use super::bootstrap::blocks;
use super::limit::Limit;
use super::plan::next_count;
use super::record::ReferenceRecord;

/// The least and the most of a study's time that the reference takes if it needs it: the most where the points leave it.
const TIME: [f64; 2] = [0.25, 0.5];
/// Renders take this many times as long as plain samples of their number, and so many seconds each for all else.
const SLOWER: f64 = 1.5;
const BESIDE_EACH: f64 = 0.1;
/// The deadlines of the first and the second attempt at a first pass as fractions of the time, the second with a sixteenth
/// of the samples.
const ATTEMPT_DEADLINES: [f64; 2] = [0.45, 0.6];
const FEWER: u32 = 16;
/// What takes no more than this part of the time is rendered in one pass.
const EASY: f64 = 0.4;
/// The parts of what fits in the first pass, and of what is left in each further one.
const FIRST_PASS: f64 = 0.25;
const NEXT_PASS: f64 = 0.7;
/// Passes of fewer samples than this part of what is there are not worth their time.
const WORTHWHILE: f64 = 0.05;
/// Offsets of the scene's seed, so that no half shares its samples with a measured point, and the distance of passes.
const SEED_OFFSETS: [u32; 2] = [1_000_003, 2_000_003];
const PASS_OFFSET: u32 = 7;

/// Renders a number of samples with an offset of the seed.
pub type Half<'a> = dyn Fn(u32, u32, &dyn Progress) -> Result<Film> + 'a;

pub struct Halves<'a> {
    /// The samples of one half.
    pub wanted: u32,
    /// The camera rays a pixel that the rest of the study takes.
    pub rest: f64,
    /// The renders of the rest.
    pub renders: f64,
    pub limit: &'a Limit,
}

/// The sums of the passes of one half, weighted by their samples.
struct Sum {
    pixels: Vec<[f64; 3]>,
    samples: u32,
}

impl Sum {
    fn add(&mut self, film: &Film, samples: u32) {
        self.pixels.resize(film.pixels.len(), [0.0; 3]);
        for (sum, pixel) in self.pixels.iter_mut().zip(&film.pixels) {
            (0..3).for_each(|c| sum[c] += f64::from(samples) * f64::from(pixel[c]));
        }
        self.samples += samples;
    }

    fn film(&self, [width, height]: [u32; 2]) -> Film {
        let mean = |sum: &[f64; 3]| sum.map(|s| (s / f64::from(self.samples)) as f32);
        Film { width, height, pixels: self.pixels.iter().map(mean).collect(), samples: self.samples }
    }
}

impl Halves<'_> {
    /// Returns the mean of both halves, and the part of the study's progress that they took.
    pub fn render(&self, half: &Half<'_>, progress: &dyn Progress) -> Result<(Film, ReferenceRecord, f64)> {
        let clock = Instant::now();
        let none = SubProgress { whole: progress, from: 0.0, to: 0.0 };
        let mut rate = 2.0 * seconds_per_sample(half, self.wanted, &none)?;
        let until = self.end(0.5 * rate);
        let fitting = |rate: f64| (until - self.limit.spent()).max(0.0) / rate;
        let mut samples = self.first_pass(fitting(rate));
        let expected = fitting(rate).min(f64::from(self.wanted)).max(1.0);
        let share = 2.0 * expected / (2.0 * expected + self.rest);
        let mut sums = [0, 1].map(|_| Sum { pixels: Vec::new(), samples: 0 });
        let mut size = [0, 0];
        let mut attempts = ATTEMPT_DEADLINES.iter();
        for pass in 0.. {
            let done = f64::from(sums[0].samples);
            let at = |done: f64| share * (done / expected).min(1.0);
            let part = SubProgress { whole: progress, from: at(done), to: at(done + f64::from(samples)) };
            let is_first = sums[0].samples == 0;
            let deadline = match attempts.next().filter(|_| is_first && samples > 1) {
                Some(share) => share * self.limit.seconds,
                None if is_first => f64::INFINITY,
                None => until,
            };
            let started = Instant::now();
            let both = self.limit.until(deadline, &part, |part| both(half, samples, pass, part))?;
            if let Some(both) = both {
                size = [both[0].width, both[0].height];
                sums.iter_mut().zip(&both).for_each(|(sum, film)| sum.add(film, samples));
                rate = started.elapsed().as_secs_f64() / f64::from(samples);
            } else if is_first {
                samples = if pass == 0 { square(f64::from(samples / FEWER)) } else { 1 };
                continue;
            } else {
                break;
            }
            let lacking = self.wanted.saturating_sub(sums[0].samples);
            let room = NEXT_PASS * fitting(rate);
            if lacking == 0 || room < (WORTHWHILE * f64::from(sums[0].samples)).max(1.0) {
                break;
            }
            samples = match next_count(Pattern::Stratified, lacking) {
                Some(next) if f64::from(next) <= room => next,
                _ => square(room.min(f64::from(lacking))),
            };
        }
        let [a, b] = sums.each_ref().map(|sum| sum.film(size));
        let record = ReferenceRecord {
            samples: sums[0].samples.saturating_add(sums[1].samples),
            seconds: clock.elapsed().as_secs_f64(),
            rmse: Some(0.5 * compare(&a, &b)?.rmse),
            // Half of the difference, squared.
            blocks: blocks(&a, &b).into_iter().map(|sum| 0.25 * sum).collect(),
            ..ReferenceRecord::default()
        };
        Ok((mean(&a, &b), record, share))
    }

    /// Returns when the reference ends, in seconds from the start of the study: what the points leave, within bounds.
    fn end(&self, seconds_per_ray: f64) -> f64 {
        let points = SLOWER * seconds_per_ray * self.rest + BESIDE_EACH * self.renders;
        let [least, most] = TIME.map(|part| part * self.limit.seconds);
        (self.limit.seconds - points).clamp(least, most)
    }

    fn first_pass(&self, fitting: f64) -> u32 {
        match next_count(Pattern::Stratified, self.wanted) {
            Some(all) if f64::from(all) <= EASY * fitting => all,
            _ => square(FIRST_PASS * fitting.min(f64::from(self.wanted))),
        }
    }
}

/// Returns the largest square number not above a count, at least 1.
fn square(count: f64) -> u32 {
    (count as u32).isqrt().max(1).pow(2)
}

fn both(half: &Half<'_>, samples: u32, pass: u32, progress: &dyn Progress) -> Result<[Film; 2]> {
    let part = |from, to| SubProgress { whole: progress, from, to };
    let [a, b] = SEED_OFFSETS.map(|offset| offset.wrapping_add(PASS_OFFSET.wrapping_mul(pass)));
    Ok([half(samples, a, &part(0.0, 0.5))?, half(samples, b, &part(0.5, 1.0))?])
}

/// Estimates the time from renders of 1, 4, 16, … samples, until they take so long that neither the
/// constant overhead nor a short disturbance of the machine matters.
fn seconds_per_sample(half: &Half<'_>, wanted: u32, progress: &dyn Progress) -> Result<f64> {
    const CLEAR: f64 = 0.1;
    let timed = |samples: u32| {
        let clock = Instant::now();
        half(samples, 0, progress).map(|_| clock.elapsed().as_secs_f64())
    };
    let one = timed(1)?;
    let mut samples = 4;
    loop {
        let more = timed(samples)? - one;
        if more >= CLEAR || samples >= wanted.isqrt().pow(2) {
            return Ok(more.max(1e-9) / f64::from(samples - 1));
        }
        samples *= 4;
    }
}

fn mean(a: &Film, b: &Film) -> Film {
    let middle = |(p, q): (&[f32; 3], &[f32; 3])| {
        [0, 1, 2].map(|c: usize| (0.5 * (f64::from(p[c]) + f64::from(q[c]))) as f32)
    };
    let pixels = a.pixels.iter().zip(&b.pixels).map(middle).collect();
    Film { pixels, samples: a.samples + b.samples, ..*a }
}
