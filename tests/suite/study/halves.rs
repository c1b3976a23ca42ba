//! The reference of a study takes the time that is there, whatever happens to the machine meanwhile.

use std::cell::Cell;
use std::thread::sleep;
use std::time::{Duration, Instant};

use moire::internal::core::error::{Error, Result};
use moire::internal::core::film::Film;
use moire::internal::core::progress::{NoProgress, Progress};
use moire::internal::lab::study::halves::Halves;
use moire::internal::lab::study::limit::Limit;

/// Returns the samples of a reference in this many seconds, where a sample takes 0.1 ms and some renders stall.
fn samples(wanted: u32, limit: f64, rest: f64, stalls: &dyn Fn(u32) -> f64) -> u32 {
    let limit = Limit::new(Instant::now(), limit);
    let renders = Cell::new(0);
    let half = |samples: u32, seed: u32, progress: &dyn Progress| -> Result<Film> {
        let mut left = 1e-4 * f64::from(samples) + stalls(renders.replace(renders.get() + 1));
        while left > 0.0 {
            if progress.cancelled() {
                return Err(Error::Interrupted);
            }
            sleep(Duration::from_secs_f64(left.min(0.01)));
            left -= 0.01;
        }
        let mut film = Film::new(8, 8, samples);
        film.pixels.fill([seed as f32; 3]);
        Ok(film)
    };
    let halves = Halves { wanted, rest, renders: 0.0, limit: &limit };
    let (film, record, _) = halves.render(&half, &NoProgress).unwrap();
    assert_eq!((film.samples, record.blocks.len()), (record.samples, 64));
    record.samples
}

/// Returns the first of three that are enough, or the last one: the machine of the test may stall by itself.
fn enough(of: impl Fn() -> u32, least: u32) -> u32 {
    let all = || (0..3).map(|_| of());
    all().find(|samples| *samples > least).unwrap_or(0)
}

#[test]
fn a_stall_of_the_machine_leaves_no_reference_of_a_few_samples() {
    // Half of 1.6 s is 4000 samples of each half; the estimate by a stalled render is fifteen hundred times too long.
    let stalled = || samples(8192, 1.6, 0.0, &|render| if render == 1 { 0.4 } else { 0.0 });
    assert!(enough(stalled, 400) > 400, "too few samples after a stalled estimate");
    // The first pass stalls beyond its deadline.
    let first = || samples(8192, 1.0, 0.0, &|render| if render == 6 { 9.0 } else { 0.0 });
    assert!(enough(first, 50) > 50, "too few samples after a stalled pass");
}

#[test]
fn a_reference_takes_more_where_the_points_leave_time() {
    let beside = samples(8192, 1.0, 1e9, &|_| 0.0);
    let least = beside + beside / 4;
    assert!(
        enough(|| samples(8192, 1.0, 0.0, &|_| 0.0), least) > least,
        "no more than {beside} without points"
    );
    // All that is wanted, in one pass.
    assert_eq!(samples(1024, 1e6, 0.0, &|_| 0.0), 2 * 1024);
}
