//! A picture that refines: one setting, its pictures of more and more samples, and how far each is from the last one.
//! Shared by the device that renders it and the page that shows it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

use serde_json::{Value, json};

use super::inspector::Inspector;
use super::settings::{Resolved, Settings};
use super::shown::Shown;
use crate::core::film::Film;
use crate::scene::model::Scene;

/// Pixels by which errors are measured, at most: every n-th of a large picture.
const MAX_MEASURED: usize = 1 << 17;

/// What was measured of a picture.
struct Point {
    count: u32,
    /// Samples a pixel, on average.
    samples: f64,
    /// Seconds of rendering that picture alone.
    seconds: f64,
    /// The program's own estimate of its RMSE.
    estimate: Option<f64>,
    /// Every n-th pixel.
    pixels: Vec<[f32; 3]>,
    /// Root mean square of the difference to the newest picture; none for that itself.
    rmse: Option<f64>,
}

/// The state of a refinement.
#[derive(Default)]
struct State {
    points: Vec<Point>,
    shown: Option<Arc<Shown>>,
    failure: Option<String>,
    warnings: Vec<String>,
}

/// Settings that decide a film, and the pictures of it so far.
pub struct Refinement {
    /// Tells it from all others.
    pub number: u64,
    /// Without those of the display, which change no film.
    pub settings: Settings,
    /// With the last count.
    pub scene: Scene,
    pub counts: Vec<u32>,
    /// The version of the file of which it is.
    pub stamp: Option<(u64, SystemTime)>,
    /// The scene as the oracle reads it, once a pixel was asked for.
    pub inspector: Mutex<Option<Inspector>>,
    is_cancelled: AtomicBool,
    state: Mutex<State>,
}

impl Refinement {
    pub fn new(settings: Settings, resolved: Resolved) -> Refinement {
        static NUMBERS: AtomicU64 = AtomicU64::new(1);
        let Resolved { scene, counts, stamp, warnings } = resolved;
        Refinement {
            number: NUMBERS.fetch_add(1, Ordering::Relaxed),
            settings,
            scene,
            counts,
            stamp,
            inspector: Mutex::default(),
            is_cancelled: AtomicBool::new(false),
            state: Mutex::new(State { warnings, ..State::default() }),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    pub fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }

    /// Returns true if it can be shown and rendered further: it is neither cancelled nor has it failed.
    pub fn is_usable(&self) -> bool {
        !self.is_cancelled() && self.state().failure.is_none()
    }

    /// Returns the samples of its next picture; none if it is done, failed or cancelled.
    pub fn next(&self) -> Option<u32> {
        let state = self.state();
        let is_over = self.is_cancelled() || state.failure.is_some();
        self.counts.get(state.points.len()).copied().filter(|_| !is_over)
    }

    /// Returns the newest picture.
    pub fn shown(&self) -> Option<Arc<Shown>> {
        self.state().shown.clone()
    }

    /// Adds a picture, with the seconds of its rendering and the program's estimate of its error.
    pub fn add(&self, shown: Shown, samples: f64, seconds: f64, estimate: Option<f64>) {
        let pixels = thinned(&shown.film);
        let mut state = self.state();
        state.points.iter_mut().for_each(|point| point.rmse = rmse(&point.pixels, &pixels));
        state.points.push(Point { count: shown.count, samples, seconds, estimate, pixels, rmse: None });
        state.shown = Some(Arc::new(shown));
    }

    pub fn fail(&self, message: String) {
        self.state().failure = Some(message);
    }

    pub fn warn(&self, messages: Vec<String>) {
        let mut state = self.state();
        for message in messages {
            if !state.warnings.contains(&message) {
                state.warnings.push(message);
            }
        }
    }

    /// Returns the root mean square of the difference to another's newest picture; none if sizes differ.
    pub fn difference(&self, other: &Refinement) -> Option<f64> {
        let size = |own: &Refinement| [own.scene.width, own.scene.height];
        if self.number == other.number || size(self) != size(other) {
            return None;
        }
        let pixels = |own: &Refinement| own.state().points.last().map(|point| point.pixels.clone());
        rmse(&pixels(self)?, &pixels(other)?)
    }

    /// Returns what a page shows of it.
    pub fn described(&self) -> Value {
        let state = self.state();
        let point = |point: &Point| {
            json!({
                "spp": point.count,
                "samples": point.samples,
                "seconds": point.seconds,
                "rmse": point.rmse,
                "estimate": point.estimate,
            })
        };
        let next = self.counts.get(state.points.len());
        json!({
            "number": self.number,
            "width": self.scene.width,
            "height": self.scene.height,
            "spp": state.shown.as_ref().map(|shown| shown.count),
            "next": next.filter(|_| state.failure.is_none()),
            "last": self.counts.last(),
            "points": state.points.iter().map(point).collect::<Vec<_>>(),
            "failure": state.failure,
            "warnings": state.warnings,
        })
    }
}

/// Returns every n-th pixel, so that there are not too many.
fn thinned(film: &Film) -> Vec<[f32; 3]> {
    // Odd, so that it meets different columns of pictures whose width is even.
    let step = film.pixels.len().div_ceil(MAX_MEASURED) | 1;
    film.pixels.iter().step_by(if film.pixels.len() <= MAX_MEASURED { 1 } else { step }).copied().collect()
}

/// Returns the root mean square of the difference of all channels; pixels that are not finite do not count.
fn rmse(a: &[[f32; 3]], b: &[[f32; 3]]) -> Option<f64> {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let squares =
        pairs.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).filter(|square| square.is_finite());
    let (sum, count) = squares.fold((0.0, 0u64), |(sum, count), square| (sum + square, count + 1));
    (count > 0 && a.len() == b.len()).then(|| (sum / count as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_all_channels() {
        assert_eq!(rmse(&[[0.0, 0.0, 0.5]], &[[0.0; 3]]), Some((0.25f64 / 3.0).sqrt()));
        assert_eq!(rmse(&[[f32::NAN, 0.0, 2.0]], &[[0.0; 3]]), Some(2f64.sqrt()));
        assert_eq!(rmse(&[], &[]), None);
        assert_eq!(rmse(&[[0.0; 3]], &[[0.0; 3]; 2]), None);
    }

    #[test]
    fn large_pictures_are_measured_by_a_part_of_their_pixels() {
        assert_eq!(thinned(&Film::new(64, 48, 1)).len(), 64 * 48);
        let many = thinned(&Film::new(2048, 2048, 1)).len();
        assert!((MAX_MEASURED / 2..=MAX_MEASURED).contains(&many), "{many}");
    }
}
