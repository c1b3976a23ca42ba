//! What `auto` chooses in a given time, on a device with a clock of its own: samples, one prefiltered sample a pixel, or
//! samples placed pixel by pixel. In: scenes whose prefilter errs less, or more, than samples of that time. Out: the
//! choice, and whether what is told of its error is true.

use moire::internal::core::error::Result;
use moire::internal::core::film::Film;
use moire::internal::core::progress::{NoProgress, Progress};
use moire::internal::core::range::{Range, Rect};
use moire::internal::integrators::adaptive::{Chosen, Outcome};
use moire::internal::integrators::{Auto, Integrator};
use moire::internal::render::{DeviceBackend, Session, Tuning};
use moire::internal::sampling::{Backend, Candidate, FilmSums, HalfSums, Made, PilotRun};
use moire::internal::scene::model::{Algorithm, Scene};
use moire::internal::scene::prefiltered::by_one_sample;
use moire::internal::schema::layout::PixelBatch;

use super::clocked::samples;
use super::{converged_file, rmse, with};
use crate::stage::{device, packed, small};

/// Seconds of a sample, and the samples in whose time a prefiltered one is taken.
const SAMPLE: f64 = 1e-6;
const PREFILTERED: f64 = 4.0;
const SIDE: u32 = 128;

struct Choosing<'p> {
    plain: DeviceBackend<'p>,
    /// Renders prefiltered samples, and takes them apart.
    prefiltered: Option<[DeviceBackend<'p>; 2]>,
    pixels: f64,
    seconds: f64,
}

impl Choosing<'_> {
    fn pass(&mut self, samples: f64) {
        self.seconds += SAMPLE * samples;
    }
}

impl Backend for Choosing<'_> {
    fn name(&self) -> String {
        self.plain.name()
    }

    fn prefilters(&self) -> bool {
        false
    }

    fn seconds(&self) -> f64 {
        self.seconds
    }

    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums> {
        self.plain.sum(range, progress)
    }

    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        self.plain.resolve(pixels, progress)
    }

    fn pilot(&mut self, _: &dyn Progress) -> Result<Option<PilotRun>> {
        Ok(None)
    }

    /// A part of the picture takes no time here.
    fn cost(&mut self, candidate: Candidate, samples: u32, _: &dyn Progress) -> Result<Option<f64>> {
        Ok(match candidate {
            Candidate::Samples => Some(SAMPLE * f64::from(samples) * self.pixels),
            Candidate::Prefiltered if self.prefiltered.is_some() => Some(SAMPLE * PREFILTERED * self.pixels),
            _ => None,
        })
    }

    fn prefiltered_apart(
        &mut self,
        batches: &[PixelBatch],
        progress: &dyn Progress,
    ) -> Result<Option<Vec<[f32; 4]>>> {
        self.pass(PREFILTERED * samples(batches));
        self.prefiltered.as_mut().map(|[_, apart]| apart.sample_apart(batches, progress)).transpose()
    }

    fn render_by(
        &mut self,
        candidate: Candidate,
        samples: u32,
        seconds: f64,
        film: &mut Film,
        progress: &dyn Progress,
    ) -> Result<Made> {
        let device = match (candidate, &mut self.prefiltered) {
            (Candidate::Prefiltered, Some([device, _])) => device,
            _ => &mut self.plain,
        };
        let fits = (seconds / (SAMPLE * self.pixels)) as u32;
        let (samples, cost) = match candidate {
            Candidate::Samples => (samples.max(fits), f64::from(samples.max(fits))),
            _ => (1, PREFILTERED),
        };
        let made = device.render_by(Candidate::Samples, samples, 0.0, film, progress)?;
        self.pass(cost * self.pixels);
        Ok(made)
    }

    fn sample(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<()> {
        self.pass(samples(batches));
        self.plain.sample(batches, progress)
    }

    fn sample_apart(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        self.pass(samples(batches));
        self.plain.sample_apart(batches, progress)
    }

    fn read(&mut self, sums: &mut HalfSums) -> Result<()> {
        self.plain.read(sums)
    }
}

/// Renders for the time of `samples` samples a pixel.
fn in_time_of(scene: &Scene, samples: f64) -> (Film, Outcome) {
    let gpu = device();
    let open = |scene| Session::open(&gpu, scene, false, &Tuning::default()).unwrap();
    let plain = open(with(scene.clone(), Algorithm::Auto, 4));
    let prefiltered = by_one_sample(scene).map(|scene| {
        let whole = packed(scene, None);
        // A sample of a batch stands for one of two halves.
        let mut apart = whole.clone();
        apart.header.pixel_side *= std::f64::consts::SQRT_2;
        [open(whole), open(apart)]
    });
    let plain = plain.prepare().unwrap();
    let prefiltered = prefiltered.as_ref().map(|both| both.each_ref().map(|one| one.prepare().unwrap()));
    let pixels = f64::from(scene.width) * f64::from(scene.height);
    let mut backend = Choosing {
        plain: DeviceBackend::new(&plain).unwrap(),
        prefiltered: prefiltered
            .as_ref()
            .map(|both| both.each_ref().map(|one| DeviceBackend::new(one).unwrap())),
        pixels,
        seconds: 0.0,
    };
    let auto = Auto { seconds: samples * SAMPLE * pixels, tells_pixels: false };
    let made = auto.render(&mut backend, Film::new(scene.width, scene.height, 0), &NoProgress).unwrap();
    (made.film, made.outcome.unwrap())
}

fn fixed(scene: &Scene, samples: u32) -> Film {
    crate::stage::render(&with(scene.clone(), Algorithm::Samples, samples))
}

/// Fails if an interval is told that does not hold the error.
fn assert_holds(outcome: &Outcome, error: f64, name: &str) {
    if let Some([low, high]) = outcome.interval {
        assert!(low <= error && error <= high, "{name}: {error:e} in {low:e} to {high:e}");
    }
    let part = outcome.estimated_rmse / error;
    assert!((0.4..2.5).contains(&part), "{name}: {part} of {error:e}");
}

#[test]
fn a_prefilter_is_chosen_where_samples_of_that_time_err_more() {
    let scene = small("s1a", SIDE, 4);
    let reference = converged_file("s1a");
    let (film, outcome) = in_time_of(&scene, 16.0);
    assert_eq!(outcome.chosen, Chosen::Prefiltered, "{outcome:?}");
    let (error, by_samples) = (rmse(&film, &reference), rmse(&fixed(&scene, 16), &reference));
    assert!(error < by_samples, "{error:e}, by samples {by_samples:e}");
    assert_holds(&outcome, error, "s1a");
    assert_eq!((outcome.estimated_bias, outcome.estimated_noise), (outcome.estimated_rmse, 0.0));
}

#[test]
fn a_prefilter_is_refused_where_its_bias_is_more_than_the_noise_of_samples() {
    for name in ["s2", "lecture"] {
        let scene = small(name, SIDE, 4);
        let reference = converged_file(name);
        let (film, outcome) = in_time_of(&scene, 16.0);
        assert_eq!(outcome.chosen, Chosen::Samples, "{name}: {outcome:?}");
        assert_eq!(outcome.estimated_bias, 0.0);
        let error = rmse(&film, &reference);
        assert_holds(&outcome, error, name);
        // Some of the time went to trials: that of an eighth of the samples, or less.
        assert!(outcome.mean_samples >= 12.0, "{name}: {outcome:?}");
    }
}

#[test]
fn samples_are_placed_pixel_by_pixel_where_there_is_time() {
    let scene = small("s1a", SIDE, 4);
    let reference = converged_file("s1a");
    let (film, outcome) = in_time_of(&scene, 512.0);
    assert_eq!(outcome.chosen, Chosen::Adaptive, "{outcome:?}");
    let (error, by_samples) = (rmse(&film, &reference), rmse(&fixed(&scene, 512), &reference));
    assert!(error < by_samples, "{error:e}, by samples {by_samples:e}");
    assert!(outcome.most_samples > 2 * outcome.least_samples, "{outcome:?}");
}

/// A picture whose first samples show that there is time for more.
#[test]
fn samples_that_are_added_to_a_picture_leave_the_earlier_ones_in_it() {
    let gpu = device();
    for name in ["s1a", "meshes"] {
        let scene = small(name, 48, 4);
        let session = Session::open(&gpu, with(scene.clone(), Algorithm::Auto, 4), false, &Tuning::default());
        let session = session.unwrap();
        let prepared = session.prepare().unwrap();
        let mut backend = DeviceBackend::new(&prepared).unwrap();
        backend.cost(Candidate::Samples, 2, &NoProgress).unwrap();
        let mut film = Film::new(scene.width, scene.height, 0);
        let mut samples = 4;
        // Twice the seconds until it went on.
        for seconds in (0..12).map(|k| 1e-3 * f64::from(1 << k)) {
            samples =
                backend.render_by(Candidate::Samples, 4, seconds, &mut film, &NoProgress).unwrap().samples;
            if samples > 4 {
                break;
            }
        }
        assert!(samples > 4, "{name}: no time for more");
        let error = rmse(&film, &fixed(&scene, samples));
        assert!(error < 1e-5, "{name}: {error:e} with {samples} samples");
    }
}

#[test]
fn beams_are_not_tried_on_meshes() {
    let gpu = device();
    for (name, is_tried) in [("meshes", false), ("s1a", true)] {
        let scene = with(small(name, 32, 4), Algorithm::Auto, 4);
        let session = Session::open(&gpu, scene, false, &Tuning::default()).unwrap();
        let prepared = session.prepare().unwrap();
        let pilot = DeviceBackend::new(&prepared).unwrap().pilot(&NoProgress).unwrap();
        assert_eq!(pilot.is_some(), is_tried, "{name}");
    }
}
