//! Damaged files of models. Readers refuse them or read them, and what is read keeps the rules of meshes; whole scenes of
//! them are loaded and packed, or refused with the name of the file.

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use fastrand::Rng;
use moire::internal::mesh::{FORMATS, mtl};
use moire::internal::pack;
use moire::internal::scene::load;
use moire::internal::texture::load::load as load_texture;
use tempfile::tempdir;

use crate::support::{data, told};

/// Returns a file with a few bytes changed, doubled, cut out or replaced by what misleads readers.
fn mutated(bytes: &[u8], rng: &mut Rng) -> Vec<u8> {
    const WORDS: [&[u8]; 8] =
        [b"-1", b"4294967295", b"1e999", b"nan", b"\\\n", b" ", b"\xff\xff\xff\xff", b"f 1 1 1\n"];
    const NUMBERS: [&str; 10] = ["0", "1", "2", "3", "12", "5121", "5126", "-1", "4294967296", "1e300"];
    let mut bytes = bytes.to_vec();
    for _ in 0..rng.usize(1..5) {
        let at = rng.usize(..=bytes.len());
        let end = (at + rng.usize(..12)).min(bytes.len());
        match rng.u8(..6) {
            0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = rng.u8(..)),
            1 => drop(bytes.drain(at..end)),
            2 => bytes.truncate(at),
            // A digit, which in JSON changes more than it breaks.
            3 | 4 => {
                let digits = bytes.iter().enumerate().take(1 << 14).filter(|(_, byte)| byte.is_ascii_digit());
                let digits: Vec<usize> = digits.map(|(at, _)| at).collect();
                if let Some(at) = rng.choice(digits) {
                    bytes.splice(at..=at, NUMBERS[rng.usize(..NUMBERS.len())].bytes());
                }
            }
            _ => drop(bytes.splice(at..end, WORDS[rng.usize(..WORDS.len())].iter().copied())),
        }
    }
    bytes
}

/// Mutated files are read or refused, and what is read keeps the rules of meshes.
#[test]
fn mutated_files_are_refused_or_read_and_never_more() {
    let mut rng = Rng::with_seed(14);
    let mut read = [0; 2];
    for name in ["crate.obj", "gem.stl", "ball.ply"] {
        let bytes = fs::read(data().join("models").join(name)).unwrap();
        let format = FORMATS.iter().find(|format| name.ends_with(format.ending)).unwrap();
        for _ in 0..2000 {
            let result = (format.read)(&mutated(&bytes, &mut rng), 1000);
            read[usize::from(result.is_ok())] += 1;
            let Ok(mesh) = result else { continue };
            assert!(mesh.triangles.len() <= 1000);
            let mut corners = mesh.triangles.positions().as_flattened().iter();
            assert!(corners.all(|i| mesh.positions[*i as usize].is_finite()));
        }
    }
    let library = fs::read(data().join("models/crate.mtl")).unwrap();
    for _ in 0..2000 {
        read[usize::from(mtl::read(&mutated(&library, &mut rng)).is_ok())] += 1;
    }
    assert!(read.iter().all(|&count| count > 1000), "one-sided: {read:?}");
}

/// How often each model is damaged, unless `MOIRE_MODEL_FUZZ` asks for another number.
const ROUNDS: usize = 12;

/// Models, with what lies beside them.
fn models() -> Vec<PathBuf> {
    let files =
        ["gallery", "models"].into_iter().flat_map(|folder| fs::read_dir(data().join(folder)).unwrap());
    let mut files: Vec<PathBuf> =
        files.map(|file| file.unwrap().path()).filter(|path| path.is_file()).collect();
    files.sort();
    assert!(files.len() > 25, "{}", files.len());
    files
}

#[test]
fn damaged_models_are_scenes_or_refused_by_name() {
    let folder = tempdir().unwrap();
    let files = models();
    for file in &files {
        fs::copy(file, folder.path().join(file.file_name().unwrap())).unwrap();
    }
    let wanted = std::env::var("MOIRE_MODEL_FUZZ").ok().and_then(|rounds| rounds.parse().ok());
    let rounds = wanted.unwrap_or(ROUNDS);
    let mut rng = Rng::with_seed(rounds as u64);
    let (mut shown, mut refused) = (0, 0);
    for file in &files {
        let ending = file.extension().unwrap().to_str().unwrap();
        if ending == "toml" || ending == "mtl" {
            continue;
        }
        let whole = fs::read(file).unwrap();
        let path = folder.path().join(format!("damaged.{ending}"));
        for round in 0..rounds {
            fs::write(&path, mutated(&whole, &mut rng)).unwrap();
            let clock = Instant::now();
            let result = load(&path).and_then(|scene| {
                let textures = scene.textures.iter().map(load_texture).collect::<Result<_, _>>()?;
                pack::pack(&scene, textures, None)
            });
            match result {
                Ok(_) => shown += 1,
                Err(error) => {
                    let said = told::<()>(Err(error));
                    // Of a picture beside the file, its own name.
                    let names_it = said.contains("damaged") || said.contains("texture \"");
                    let is_clear = names_it && !said.contains("failed where it should not");
                    assert!(is_clear, "{} {round}: {said}", file.display());
                    refused += 1;
                }
            }
            // Only what is as good as a hang takes minutes on a busy machine.
            assert!(clock.elapsed() < Duration::from_secs(120), "{} {round}", file.display());
        }
    }
    assert!(shown > rounds && refused > rounds, "{shown} shown, {refused} refused");
}
