//! Sampling to a goal: which samples the batches take, that device and oracle take the same ones, that
//! the requested error is reached, and that adaptively placed samples reduce the error further than
//! uniform ones.

mod chosen;
mod clocked;
mod rare;
mod twins;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};

use moire::internal::core::error::{Error, Result};
use moire::internal::core::film::Film;
use moire::internal::core::progress::{NoProgress, Progress};
use moire::internal::core::range::{Range, Rect};
use moire::internal::integrators::adaptive::{self, Goal, Outcome};
use moire::internal::lab::metrics::compare;
use moire::internal::oracle::backend::OracleBackend;
use moire::internal::oracle::rng::sample_bits;
use moire::internal::pack::PackedScene;
use moire::internal::sampling::{Backend, FilmSums, HalfSums, PilotRun};
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, Scene};
use moire::internal::schema::layout::PixelBatch;

use crate::stage::{assert_same_bits, packed, render, small};
use clocked::Reached;

/// Returns the scene as `--algorithm` and `--pattern` would change it.
fn with(mut scene: Scene, algorithm: Algorithm, spp: u32) -> PackedScene {
    scene.sampling.algorithm = algorithm;
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.shared = false;
    scene.sampling.spp = spp;
    scene.sampling.footprint = Footprint::None;
    packed(scene, None)
}

/// Seconds for a sample on a device so fast that beams pay for none of these pictures, and on a slow one.
const FAST: f64 = 1e-9;
const SLOW: f64 = 5e-7;

fn to_goal(scene: &PackedScene, goal: Goal, keep_everything: bool) -> (Film, Outcome) {
    let Reached { film, outcome, .. } = clocked::render(scene, goal, keep_everything, FAST);
    (film, outcome)
}

fn converged(scene: &Scene) -> Film {
    render(&with(scene.clone(), Algorithm::Samples, 4096))
}

fn rmse(a: &Film, b: &Film) -> f64 {
    compare(a, b).unwrap().rmse
}

/// Returns a scene file's picture of at most 128 pixels a side with 4096 samples a pixel; tests share it.
fn converged_file(name: &'static str) -> Film {
    static FILMS: Mutex<BTreeMap<&str, Arc<OnceLock<Film>>>> = Mutex::new(BTreeMap::new());
    let film = FILMS.lock().unwrap().entry(name).or_default().clone();
    film.get_or_init(|| converged(&small(name, 128, 4))).clone()
}

/// Returns the mean of the pictures of two seeds: one sample of each half.
fn mean_of_halves(scene: &Scene) -> Film {
    let half = |seed: u32| {
        let mut scene = scene.clone();
        scene.sampling.seed = seed;
        render(&with(scene, Algorithm::Samples, 1))
    };
    let seed = scene.sampling.seed;
    let [mut a, b] = [half(seed), half(seed.wrapping_add(0x9E37_79B9))];
    for (p, q) in a.pixels.iter_mut().flatten().zip(b.pixels.iter().flatten()) {
        *p = ((f64::from(*p) + f64::from(*q)) / 2.0) as f32;
    }
    a.samples = 2;
    a
}

#[test]
fn halves_are_the_samples_of_two_seeds() {
    for name in ["s2", "glass", "lecture"] {
        let scene = small(name, 70, 4);
        let adaptive = with(scene.clone(), Algorithm::Adaptive, 2);
        let (film, outcome) = to_goal(&adaptive, Goal::Samples(2), false);
        assert_eq!((outcome.passes, outcome.least_samples, outcome.most_samples), (1, 2, 2));
        assert_same_bits(&film, &mean_of_halves(&scene), name);
        let (kept, _) = to_goal(&adaptive, Goal::Samples(2), true);
        assert_same_bits(&kept, &film, &format!("{name} with everything kept"));
    }
}

/// A page of film holds 64 MiB.
#[test]
fn films_of_several_pages_have_the_same_pixels() {
    let mut scene = small("s1a", 64, 4);
    (scene.width, scene.height) = (3000, 800);
    let (film, _) = to_goal(&with(scene.clone(), Algorithm::Adaptive, 2), Goal::Samples(2), false);
    assert_same_bits(&film, &mean_of_halves(&scene), "two pages");
}

#[test]
fn device_and_oracle_spend_the_same_samples() {
    let scene = with(small("s2", 48, 4), Algorithm::Adaptive, 64);
    let (film, outcome) = to_goal(&scene, Goal::Samples(64), false);
    let mut backend = OracleBackend::new(&scene).unwrap();
    let size = [scene.header.film_size.x, scene.header.film_size.y];
    let run = adaptive::run(
        &mut backend,
        Film::new(size[0], size[1], 0),
        Goal::Samples(64),
        false,
        None,
        &NoProgress,
    )
    .unwrap();
    let (exact, expected) = (run.film, run.outcome);
    // Counts follow estimates in f32: one pixel in a hundred may round differently.
    assert!((outcome.mean_samples / expected.mean_samples - 1.0).abs() < 0.01, "{outcome:?} {expected:?}");
    assert_eq!(outcome.passes, expected.passes);
    // Two pictures from different samples would differ by 1.4 of it.
    let (apart, expected) = (rmse(&film, &exact), expected.estimated_rmse);
    assert!(apart < 0.5 * expected, "{apart:e} of {expected:e}");
}

#[test]
fn an_error_asked_for_is_reached_and_not_left_far_behind() {
    for (name, goal) in [("s1a", 6e-3), ("s2", 1e-3), ("materials", 2e-3), ("glass", 1e-2)] {
        let scene = small(name, 128, 4);
        let reference = converged_file(name);
        let (film, outcome) = to_goal(&with(scene, Algorithm::Auto, 16), Goal::Error(goal), false);
        let error = rmse(&film, &reference);
        assert!(outcome.reached, "{name}: {outcome:?}");
        // The estimate has a sigma of about 3 % at this size; features that few samples miss add to that.
        assert!(error < 1.08 * goal, "{name}: {error:e} of {goal:e}, {outcome:?}");
        assert!(error > 0.5 * goal, "{name}: {error:e} of {goal:e} is wasteful, {outcome:?}");
    }
}

#[test]
fn adaptive_errs_less_than_the_same_number_for_all() {
    // Over seeds 1 to 4: 1.66 to 1.86, and 1.59 to 1.76.
    for (name, factor) in [("s1a", 1.5), ("s2", 1.5)] {
        let scene = small(name, 128, 4);
        let reference = converged_file(name);
        let equal = rmse(&render(&with(scene.clone(), Algorithm::Samples, 64)), &reference);
        let (film, outcome) = to_goal(&with(scene, Algorithm::Adaptive, 64), Goal::Samples(64), false);
        let error = rmse(&film, &reference);
        assert!(error * factor < equal, "{name}: {error:e}, for all {equal:e}");
        assert!((54.0..80.0).contains(&outcome.mean_samples), "{name}: {outcome:?}");
        assert!(outcome.most_samples > 2 * 64 && outcome.least_samples == 16, "{name}: {outcome:?}");
    }
}

/// The bias that a fixed number of samples does not have: the mean over many seeds.
#[test]
fn the_mean_over_seeds_shows_no_bias() {
    let scene = small("s2", 48, 4);
    let reference = converged(&scene);
    let mut sum = vec![[0f64; 3]; reference.pixels.len()];
    const SEEDS: u32 = 24;
    let mut one = 0.0;
    for seed in 0..SEEDS {
        let mut scene = scene.clone();
        scene.sampling.seed = 100 + seed;
        let (film, _) = to_goal(&with(scene, Algorithm::Adaptive, 32), Goal::Samples(32), false);
        one += rmse(&film, &reference).powi(2) / f64::from(SEEDS);
        sum.iter_mut().flatten().zip(film.pixels.iter().flatten()).for_each(|(s, v)| *s += f64::from(*v));
    }
    let mut mean = reference.clone();
    mean.pixels.iter_mut().flatten().zip(sum.iter().flatten()).for_each(|(m, s)| {
        *m = (s / f64::from(SEEDS)) as f32;
    });
    // Without bias the square falls with the number of seeds.
    let left = rmse(&mean, &reference).powi(2) * f64::from(SEEDS) / one;
    assert!(left < 2.0, "{left} of what chance leaves");
}

/// By the device's own clock, in which 1.5 s are 65 samples a pixel.
#[test]
fn a_time_to_keep_is_kept() {
    let scene = with(small("s1b", 48, 4), Algorithm::Auto, 16);
    let Reached { outcome, seconds, .. } = clocked::render(&scene, Goal::Seconds(1.5), false, 1e-5);
    assert!(outcome.passes > 1 && outcome.mean_samples >= 16.0, "{outcome:?}");
    assert!(outcome.reached && (1.2..1.5 * 1.05).contains(&seconds), "{seconds} s for 1.5 s: {outcome:?}");
    // Two samples a pixel take 0.046 s.
    let Reached { outcome, seconds, .. } = clocked::render(&scene, Goal::Seconds(0.04), false, 1e-5);
    assert!(!outcome.reached && outcome.mean_samples == 2.0, "{seconds} s for 0.04 s: {outcome:?}");
}

/// Trilinear look-ups of 16 samples' footprints blur a ground that is seen to the horizon.
#[test]
fn the_bias_of_a_prefilter_is_seen_and_without_a_footprint_there_is_none() {
    let mut scene = small("filters", 96, 4);
    scene.sampling.algorithm = Algorithm::Adaptive;
    scene.sampling.pattern = Pattern::SobolOwen;
    let reference = converged(&scene);
    let (film, blurred) = to_goal(&packed(scene.clone(), None), Goal::Samples(16), false);
    let error = rmse(&film, &reference);
    let estimated = blurred.estimated_rmse;
    assert!(blurred.estimated_bias > 2e-3, "{blurred:?}");
    // 512 pixels of very different bias.
    assert!((0.6..1.6).contains(&(estimated / error)), "{error:e}, {blurred:?}");
    let (_, sharp) = to_goal(&with(scene, Algorithm::Adaptive, 16), Goal::Samples(16), false);
    assert_eq!(sharp.estimated_bias, 0.0);
}

/// A backend with a constant and noise, slow by its own clock; half of the pixels can be resolved at once.
struct Slow {
    sums: HalfSums,
    seconds: f64,
    tells: bool,
    prefilters: bool,
}

const TOLD: [f32; 3] = [0.5, 0.25, 0.125];

impl Slow {
    fn add(batch: &PixelBatch, sum: &mut [f32; 4]) {
        for s in batch.first..batch.first + batch.count {
            let noise = sample_bits([batch.place, batch.stream()], s)[0] as f32 / u32::MAX as f32 - 0.5;
            let seen = TOLD.map(|v| v + noise);
            (0..3).for_each(|c| sum[c] += seen[c]);
            sum[3] += seen.iter().map(|v| v * v / 3.0).sum::<f32>();
        }
    }
}

impl Backend for Slow {
    fn name(&self) -> String {
        "slow".into()
    }

    fn seconds(&self) -> f64 {
        self.seconds
    }

    fn sum(&mut self, range: &Range, _: &dyn Progress) -> Result<FilmSums> {
        Err(Error::new(format!("batches alone, not {range:?}")))
    }

    fn sample(&mut self, batches: &[PixelBatch], _: &dyn Progress) -> Result<()> {
        self.seconds += SLOW * clocked::samples(batches);
        for batch in batches {
            let [x, y] = batch.column_and_row();
            let at = (y * self.sums.width + x) as usize;
            Slow::add(batch, &mut self.sums.halves[(batch.part & 1) as usize][at]);
        }
        Ok(())
    }

    fn sample_apart(&mut self, batches: &[PixelBatch], _: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        self.seconds += SLOW * clocked::samples(batches);
        let mut sums = vec![[0.0; 4]; batches.len()];
        batches.iter().zip(&mut sums).for_each(|(batch, sum)| Slow::add(batch, sum));
        Ok(sums)
    }

    fn prefilters(&self) -> bool {
        self.prefilters
    }

    fn read(&mut self, sums: &mut HalfSums) -> Result<()> {
        sums.halves.clone_from(&self.sums.halves);
        Ok(())
    }

    fn pilot(&mut self, _: &dyn Progress) -> Result<Option<PilotRun>> {
        let pixels = (0..64).map(|i| (i, i % 2 == 0)).collect();
        Ok(self.tells.then_some(PilotRun { seconds: 0.1, pixels }))
    }

    fn resolve(&mut self, _: Rect, _: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let [r, g, b] = TOLD;
        Ok((0..self.sums.halves[0].len()).map(|i| [r, g, b, (i % 2) as f32]).collect())
    }
}

fn slowly(tells: bool, prefilters: bool, goal: Goal) -> (Film, Outcome) {
    const SIZE: [u32; 2] = [32, 16];
    let sums = HalfSums::new(SIZE);
    let mut slow = Slow { sums, seconds: 0.0, tells, prefilters };
    let run =
        adaptive::run(&mut slow, Film::new(SIZE[0], SIZE[1], 0), goal, false, None, &NoProgress).unwrap();
    (run.film, run.outcome)
}

/// 4e-3 takes some 5000 random samples a pixel: 2.6 s, by the time of the first passes.
#[test]
fn what_is_far_from_its_goal_is_told_by_beams_and_the_rest_sampled() {
    let (film, outcome) = slowly(true, false, Goal::Error(4e-3));
    assert_eq!(outcome.beam_pixels, 256);
    assert!(outcome.reached, "{outcome:?}");
    for (i, pixel) in film.pixels.iter().enumerate() {
        if i % 2 == 0 {
            assert_eq!(*pixel, TOLD, "pixel {i}");
        } else {
            assert_ne!(*pixel, TOLD, "pixel {i}");
        }
    }
    assert!(outcome.most_samples >= 4 * outcome.least_samples, "told pixels took samples: {outcome:?}");
}

#[test]
fn what_is_near_its_goal_or_prefiltered_or_cannot_be_told_is_sampled() {
    for (tells, prefilters, goal) in
        [(true, false, Goal::Error(4e-2)), (true, true, Goal::Error(4e-3)), (false, false, Goal::Error(4e-3))]
    {
        let (_, outcome) = slowly(tells, prefilters, goal);
        assert_eq!(outcome.beam_pixels, 0, "{tells} {prefilters} {goal:?}");
        assert!(outcome.passes > 1, "{outcome:?}");
    }
}

/// A checker up to the horizon is resolved as algorithm beam resolves it; the remaining time is not spent.
#[test]
fn time_enough_for_beams_is_spent_on_beams() {
    let scene = small("s1a", 256, 4);
    let auto = with(scene.clone(), Algorithm::Auto, 16);
    let Reached { film, outcome, seconds } = clocked::render(&auto, Goal::Seconds(15.0), false, SLOW);
    // Ends once beams have resolved all pixels.
    assert!(seconds < 0.5 * 15.0, "{seconds} s: {outcome:?}");
    assert_eq!(outcome.beam_pixels, 256 * 256, "{outcome:?}");
    assert!(outcome.reached && outcome.estimated_noise == 5e-5, "{outcome:?}");
    let beams = render(&with(scene, Algorithm::Beam, 4));
    assert!(rmse(&film, &beams) < 1e-7, "{:e}", rmse(&film, &beams)); // a product and a quotient in f32
}
