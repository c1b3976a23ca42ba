//! A device by whose clock every sample takes the same time, a beam as long as some samples, and all else none. In: the
//! backend of a device. Out: its pictures to a goal, after passes that are the same however busy the machine is.

use moire::internal::core::error::Result;
use moire::internal::core::film::Film;
use moire::internal::core::progress::{NoProgress, Progress};
use moire::internal::core::range::{Range, Rect};
use moire::internal::integrators::adaptive::{self, Goal, Outcome};
use moire::internal::pack::PackedScene;
use moire::internal::render::{DeviceBackend, Session, Tuning};
use moire::internal::sampling::{Backend, FilmSums, HalfSums, PilotRun};
use moire::internal::schema::layout::PixelBatch;

use crate::stage::device;

/// The time of a beam, in samples.
const BEAM: f64 = 16.0;

struct Clocked<'p> {
    device: DeviceBackend<'p>,
    pixels: usize,
    sample_seconds: f64,
    seconds: f64,
}

/// A picture, and the seconds that have passed by the device's own clock.
pub struct Reached {
    pub film: Film,
    pub outcome: Outcome,
    pub seconds: f64,
}

/// Renders to a goal on a device that takes `sample_seconds` for a sample.
pub fn render(scene: &PackedScene, goal: Goal, keep_everything: bool, sample_seconds: f64) -> Reached {
    let gpu = device();
    let session = Session::open(&gpu, scene.clone(), keep_everything, &Tuning::default()).unwrap();
    let prepared = session.prepare().unwrap();
    let size = scene.header.film_size.to_array();
    let pixels = Rect::whole(size).area();
    let device = DeviceBackend::new(&prepared).unwrap();
    let mut clocked = Clocked { device, pixels, sample_seconds, seconds: 0.0 };
    let run =
        adaptive::run(&mut clocked, Film::new(size[0], size[1], 0), goal, false, None, &NoProgress).unwrap();
    let (film, outcome) = (run.film, run.outcome);
    let seconds = clocked.seconds;
    clocked.device.finish().unwrap();
    Reached { film, outcome, seconds }
}

/// Returns the samples of all batches.
pub fn samples(batches: &[PixelBatch]) -> f64 {
    batches.iter().map(|batch| f64::from(batch.count)).sum()
}

impl Clocked<'_> {
    fn pass(&mut self, samples: f64) {
        self.seconds += self.sample_seconds * samples;
    }
}

impl Backend for Clocked<'_> {
    fn name(&self) -> String {
        self.device.name()
    }

    fn prefilters(&self) -> bool {
        self.device.prefilters()
    }

    fn seconds(&self) -> f64 {
        self.seconds
    }

    fn bright_share(&self) -> f64 {
        self.device.bright_share()
    }

    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums> {
        self.device.sum(range, progress)
    }

    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        self.pass(BEAM * pixels.area() as f64);
        self.device.resolve(pixels, progress)
    }

    fn pilot(&mut self, progress: &dyn Progress) -> Result<Option<PilotRun>> {
        let seconds = self.sample_seconds * BEAM * self.pixels as f64;
        let run = self.device.pilot(progress)?.map(|run| PilotRun { seconds, ..run });
        self.pass(BEAM * run.as_ref().map_or(0, |run| run.pixels.len()) as f64);
        Ok(run)
    }

    fn sample(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<()> {
        self.pass(samples(batches));
        self.device.sample(batches, progress)
    }

    fn sample_all(&mut self, size: [u32; 2], first: u32, count: u32, progress: &dyn Progress) -> Result<()> {
        self.pass(2.0 * f64::from(count) * self.pixels as f64);
        self.device.sample_all(size, first, count, progress)
    }

    fn sample_apart(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        self.pass(samples(batches));
        self.device.sample_apart(batches, progress)
    }

    fn read(&mut self, sums: &mut HalfSums) -> Result<()> {
        self.device.read(sums)
    }

    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        self.device.first_samples(most, pixels)
    }
}
