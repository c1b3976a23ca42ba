//! Positions of every pattern on the device against the oracle, bit for bit.

use moire::internal::lab::probe::{self, Positions};
use moire::internal::oracle::patterns::{HALTON_PAIRS, sample_pair};
use moire::internal::scene::model::Pattern;

use super::{points, scene};
use crate::stage::device;

const WIDTH: u32 = 5;

/// Returns the first position that differs: pixel, sample, and both.
fn difference(device: &[[u32; 2]], oracle: &[[u32; 2]], samples: u32) -> Option<String> {
    let i = (0..device.len()).find(|&i| device[i] != oracle[i])?;
    let (pixel, s) = (i as u32 / samples, i as u32 % samples);
    Some(format!("pixel {pixel}, sample {s}: {:?} on the device, {:?}", device[i], oracle[i]))
}

struct Case {
    pattern: Pattern,
    count: u32,
    shared: bool,
    seed: u32,
    keep: bool,
    which: Positions,
}

impl Case {
    fn new(pattern: Pattern, count: u32, pair: u32) -> Case {
        let which = Positions { pair, width: WIDTH, pixels: 7, first: 0, samples: count.min(300) };
        Case { pattern, count, shared: false, seed: 1, keep: false, which }
    }

    fn device(&self) -> Vec<[u32; 2]> {
        let scene = scene(self.pattern, self.count, self.shared, self.seed);
        probe::positions(&device(), &scene, self.keep, &self.which).unwrap()
    }

    fn oracle(&self) -> Vec<[u32; 2]> {
        let scene = scene(self.pattern, self.count, self.shared, self.seed);
        let Positions { pair, width, pixels, first, samples } = self.which;
        let of_pixel = |pixel: u32| {
            let points = points(&scene.header, [pixel % width, pixel / width], pair);
            (first..first + samples).map(move |s| sample_pair(&points, s))
        };
        (0..pixels).flat_map(of_pixel).collect()
    }

    fn check(&self) {
        let found = difference(&self.device(), &self.oracle(), self.which.samples);
        let Case { pattern, count, shared, seed, keep, which } = self;
        assert_eq!(
            found, None,
            "{pattern}, N = {count}, shared {shared}, seed {seed}, keep {keep}, {which:?}"
        );
    }
}

/// Counts that the pattern takes, up to a few hundred.
fn counts(pattern: Pattern) -> &'static [u32] {
    match pattern {
        Pattern::Center => &[1],
        Pattern::Grid | Pattern::Stratified => &[1, 4, 9, 49, 256],
        Pattern::BlueNoise => &[1, 2, 4, 8, 64, 128],
        Pattern::MultiJittered | Pattern::NRooks => &[1, 2, 3, 4, 5, 16, 17, 30, 31, 64, 100, 255],
        Pattern::Random | Pattern::Halton | Pattern::SobolOwen => &[1, 300],
    }
}

#[test]
fn all_counts_agree_bit_for_bit() {
    for &pattern in Pattern::ALL {
        for (i, &count) in counts(pattern).iter().enumerate() {
            let seed = [1, 0, u32::MAX, 0x8000_0001][i % 4];
            Case { keep: i % 2 == 1, seed, ..Case::new(pattern, count, i as u32 % 3) }.check();
        }
    }
}

#[test]
fn all_pairs_agree_bit_for_bit() {
    for &pattern in Pattern::ALL {
        let count = if pattern == Pattern::Center { 1 } else { 16 };
        for pair in [0, 1, 2, 3, 4, 5, HALTON_PAIRS - 1, HALTON_PAIRS, 40] {
            Case::new(pattern, count, pair).check();
        }
    }
}

#[test]
fn shared_sets_agree_and_are_one_for_all_pixels() {
    for &pattern in Pattern::ALL.iter().filter(|p| p.can_be_shared()) {
        for pair in [0, 1] {
            let case = Case { shared: true, ..Case::new(pattern, 16, pair) };
            case.check();
            let device = case.device();
            assert!(device.chunks(16).all(|pixel| pixel == &device[..16]), "{pattern}, pair {pair}");
        }
    }
}

/// Up to sample 2²⁴ - 1, with as many strata or blocks as there can be, and one fewer.
#[test]
fn the_last_of_very_many_samples_agree() {
    let most = 1 << 24;
    for &pattern in &Pattern::ALL[1..] {
        for count in [most, most - 1, 9_999_999] {
            if moire::internal::scene::check_spp(pattern, count).is_err() {
                continue;
            }
            for (pair, keep) in [(0, false), (1, true)] {
                for first in [0, count / 3, count - 500] {
                    let mut case = Case { keep, seed: 7, ..Case::new(pattern, count, pair) };
                    (case.which.first, case.which.samples) = (first, 500);
                    case.check();
                }
            }
        }
    }
}

/// Pixels far apart: tiles of blue noise are 4096 pixels wide at 256 samples.
#[test]
fn wide_pictures_agree() {
    for pattern in [Pattern::BlueNoise, Pattern::SobolOwen] {
        for (count, width) in [(1, 16_384), (256, 5000), (4096, 3000), (1 << 20, 100)] {
            let mut case = Case::new(pattern, count, 0);
            (case.which.width, case.which.pixels, case.which.samples) = (width, 3 * width + 7, 2);
            case.check();
        }
    }
}

#[test]
fn planted_errors_are_found() {
    for &pattern in &Pattern::ALL[1..] {
        let case = Case::new(pattern, 16, 0);
        let (device, oracle) = (case.device(), case.oracle());
        let swapped: Vec<_> = device.iter().map(|p| [p[1], p[0]]).collect();
        assert!(difference(&swapped, &oracle, 16).is_some(), "{pattern}: swapped axes");
        let mut off = device.clone();
        off[37][1] ^= 1;
        let found = difference(&off, &oracle, 16).unwrap();
        assert!(found.contains("pixel 2, sample 5"), "{pattern}: {found}");
        let other = Case { seed: 2, ..Case::new(pattern, 16, 0) }.oracle();
        assert_eq!(difference(&device, &other, 16).is_some(), pattern != Pattern::Grid, "{pattern}: seed");
    }
}
