//! Pictures with bits turned over, ends cut off and headers changed, by a seeded generator: each is read or
//! refused, in bounded time, and nothing panics, not even within the guard.

use std::fs;
use std::time::{Duration, Instant};

use moire::texture::data::Dimension;
use tempfile::tempdir;

use super::load;
use crate::support::{data, told};

/// PCG, as `glsl` has it.
struct Dice(u32);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = (self.0 >> ((self.0 >> 28) + 4) ^ self.0).wrapping_mul(277_803_737);
        (word >> 22 ^ word) as usize % count
    }
}

/// Numbers that headers should not hold.
const ODD: [u32; 10] = [0, 1, 2, 7, 255, 65_535, 65_536, 0x7fff_ffff, 0x8000_0000, u32::MAX];

fn mutated(whole: &[u8], dice: &mut Dice) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    // Tags of TIFF files may lie at the end, all other headers at the start.
    let at = |dice: &mut Dice, length: usize| match dice.below(3) {
        0 => dice.below(length),
        1 => dice.below(length.min(400)),
        _ => length - 1 - dice.below(length.min(400)),
    };
    for _ in 0..1 + dice.below(3) {
        let place = at(dice, bytes.len());
        match dice.below(8) {
            0 => bytes.truncate(place.max(1)),
            1..=3 => bytes[place] ^= 1 << dice.below(8),
            4 => bytes[place] = dice.below(256) as u8,
            kind => {
                let value = ODD[dice.below(ODD.len())];
                let digits = if kind == 5 { value.to_be_bytes() } else { value.to_le_bytes() };
                let count = if kind == 7 { 2 } else { 4 };
                bytes.iter_mut().skip(place).zip(&digits[..count]).for_each(|(b, d)| *b = *d);
            }
        }
    }
    bytes
}

fn run(rounds: usize, seed: u32) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.picture");
    let mut dice = Dice(seed);
    let mut fixtures: Vec<_> =
        fs::read_dir(data().join("pictures")).unwrap().map(|e| e.unwrap().path()).collect();
    fixtures.retain(|path| path.extension().is_some_and(|e| e != "py"));
    fixtures.sort();
    assert!(fixtures.len() > 30, "only {} pictures", fixtures.len());
    let (mut read, mut refused) = (0, 0);
    for fixture in &fixtures {
        let whole = fs::read(fixture).unwrap();
        let volume = fixture.extension().is_some_and(|e| e == "nrrd");
        let dimension = if volume { Dimension::Three } else { Dimension::Two };
        for round in 0..rounds {
            let bytes = mutated(&whole, &mut dice);
            fs::write(&path, &bytes).unwrap();
            let clock = Instant::now();
            match load(&path, dimension) {
                Ok(_) => read += 1,
                Err(e) => {
                    let message = told::<()>(Err(e));
                    assert!(message.contains("a.picture"), "{fixture:?} {round}: {message}");
                    assert!(
                        !message.contains("failed where it should not"),
                        "{fixture:?} {round}: {message}"
                    );
                    refused += 1;
                }
            }
            // A file of a few KB that other work holds up; a hang is longer.
            assert!(clock.elapsed() < Duration::from_secs(20), "{fixture:?} {round}: {:?}", clock.elapsed());
        }
    }
    assert!(read > rounds && refused > rounds, "{read} read, {refused} refused");
}

#[test]
fn thousands_of_mutated_pictures_are_read_or_refused() {
    run(100, 1);
}

#[test]
#[ignore = "minutes; cargo test --release -- --ignored mutated"]
fn a_hundred_thousand_mutated_pictures_are_read_or_refused() {
    run(3000, 2);
}
