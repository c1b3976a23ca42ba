//! Pictures with flipped bits, truncated ends and altered headers, by a seeded generator: each is
//! read or refused in bounded time, and nothing panics, not even inside the panic guard.

use std::fs;
use std::time::{Duration, Instant};

use moire::internal::lab::metrics::read_picture;
use moire::internal::texture::data::Dimension;
use tempfile::tempdir;

use super::load;
use crate::support::{data, moire, told};

/// PCG, as `glsl` has it.
struct Rng(u32);

impl Rng {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = (self.0 >> ((self.0 >> 28) + 4) ^ self.0).wrapping_mul(277_803_737);
        (word >> 22 ^ word) as usize % count
    }
}

/// Extreme values of header fields.
const ODD: [u32; 10] = [0, 1, 2, 7, 255, 65_535, 65_536, 0x7fff_ffff, 0x8000_0000, u32::MAX];

fn mutated(whole: &[u8], rng: &mut Rng) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    // Tags of TIFF files may lie at the end, all other headers at the start.
    let at = |rng: &mut Rng, length: usize| match rng.below(3) {
        0 => rng.below(length),
        1 => rng.below(length.min(400)),
        _ => length - 1 - rng.below(length.min(400)),
    };
    for _ in 0..1 + rng.below(3) {
        let place = at(rng, bytes.len());
        match rng.below(8) {
            0 => bytes.truncate(place.max(1)),
            1..=3 => bytes[place] ^= 1 << rng.below(8),
            4 => bytes[place] = rng.below(256) as u8,
            kind => {
                let value = ODD[rng.below(ODD.len())];
                let digits = if kind == 5 { value.to_be_bytes() } else { value.to_le_bytes() };
                let count = if kind == 7 { 2 } else { 4 };
                bytes.iter_mut().skip(place).zip(&digits[..count]).for_each(|(b, d)| *b = *d);
            }
        }
    }
    bytes
}

/// All pictures of `data/pictures`, DDS and KTX2 files of blocks, cubes and volumes, and OpenEXR files of one part, of several, and with subsampled chroma.
fn fixtures() -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(data().join("pictures")).unwrap().map(|e| e.unwrap());
    let mut fixtures: Vec<_> = entries
        .map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap()))
        .filter(|(name, _)| !name.ends_with(".py"))
        .collect();
    fixtures.push(("layers.exr".into(), include_bytes!("../exr/layers.exr").to_vec()));
    fixtures.push(("parts.exr".into(), include_bytes!("../exr/parts.exr").to_vec()));
    fixtures.push(("yc.exr".into(), include_bytes!("../exr/yc-piz.exr").to_vec()));
    fixtures.extend(crate::containers::samples());
    fixtures.sort();
    assert!(fixtures.len() > 30, "only {} pictures", fixtures.len());
    fixtures
}

fn run(rounds: usize, seed: u32) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.picture");
    let mut rng = Rng(seed);
    let (mut read, mut refused) = (0, 0);
    for (fixture, whole) in fixtures() {
        let dimension = match fixture.split_once('.') {
            Some((_, "nrrd" | "volume.dds")) => Dimension::Three,
            Some((_, "cube.ktx2")) => Dimension::Cube,
            _ => Dimension::Two,
        };
        for round in 0..rounds {
            let bytes = mutated(&whole, &mut rng);
            fs::write(&path, &bytes).unwrap();
            let clock = Instant::now();
            match load(&path, dimension) {
                Ok(_) => read += 1,
                Err(e) => {
                    let message = told::<()>(Err(e));
                    assert!(message.contains("a.picture"), "{fixture} {round}: {message}");
                    assert!(!message.contains("failed where it should not"), "{fixture} {round}: {message}");
                    refused += 1;
                }
            }
            // A file of a few KB takes milliseconds: only what is as good as a hang takes minutes on a busy machine.
            assert!(clock.elapsed() < Duration::from_secs(120), "{fixture} {round}: {:?}", clock.elapsed());
        }
    }
    assert!(read > rounds && refused > rounds, "{read} read, {refused} refused");
}

#[test]
fn thousands_of_mutated_pictures_are_read_or_refused() {
    run(100, 1);
}

/// The program itself: exit code 0 with the picture, or 2 with nothing beside the input.
#[test]
fn the_program_ends_in_order_and_leaves_a_whole_picture_or_none() {
    let folder = tempdir().unwrap();
    let mut rng = Rng(3);
    for (fixture, whole) in fixtures().into_iter().filter(|(name, _)| !name.ends_with(".nrrd")) {
        for round in 0..5 {
            fs::write(folder.path().join("a.picture"), mutated(&whole, &mut rng)).unwrap();
            let args = ["texture", "a.picture", "-o", "b.png"];
            let output = moire().current_dir(folder.path()).args(args).output().unwrap();
            let (code, message) =
                (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned());
            assert!([Some(0), Some(2)].contains(&code), "{fixture} {round}: {code:?} {message}");
            assert!(!message.contains("failed where it should not"), "{fixture} {round}: {message}");
            let files = fs::read_dir(folder.path()).unwrap().count();
            assert_eq!(files, if code == Some(0) { 2 } else { 1 }, "{fixture} {round}: {message}");
            if code == Some(0) {
                read_picture(&folder.path().join("b.png")).unwrap();
                fs::remove_file(folder.path().join("b.png")).unwrap();
            }
        }
    }
}

#[test]
#[ignore = "minutes; cargo test --release -- --ignored mutated"]
fn a_hundred_thousand_mutated_pictures_are_read_or_refused() {
    run(3000, 2);
}
