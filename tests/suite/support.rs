//! Helpers of several test files: the program and the data, located when the tests run (not where
//! they were compiled), so that the binaries can be moved to another machine; small pictures.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use moire::internal::core::film::Film;
use moire::internal::texture::data::{ColorSpace, Dimension, MipKernel};
use moire::internal::texture::source::{ReadOptions, TextureContent, TextureSource};

/// The program under test: `MOIRE_BIN`, else `moire` beside this binary or one folder up.
pub fn moire() -> assert_cmd::Command {
    assert_cmd::Command::new(program())
}

pub fn program() -> PathBuf {
    if let Some(path) = std::env::var_os("MOIRE_BIN") {
        return path.into();
    }
    let own = std::env::current_exe().unwrap();
    let name = format!("moire{}", std::env::consts::EXE_SUFFIX);
    let mut candidates = own.ancestors().skip(1).take(2).map(|folder| folder.join(&name));
    candidates.find(|path| path.is_file()).expect("no program `moire` near the test binary: set MOIRE_BIN")
}

/// A texture `t` of linear texels.
pub fn texture_source(content: TextureContent, dimension: Dimension, reading: ReadOptions) -> TextureSource {
    TextureSource {
        name: "t".into(),
        content,
        dimension,
        color_space: ColorSpace::Linear,
        color_space_stated: true,
        reading,
        flip_v: false,
        mip_kernel: MipKernel::Box,
    }
}

/// The folder `data`: `MOIRE_DATA`, else in the current folder, else above this binary.
pub fn data() -> PathBuf {
    if let Some(path) = std::env::var_os("MOIRE_DATA") {
        return path.into();
    }
    let own = std::env::current_exe().unwrap();
    let mut candidates =
        std::iter::once(Path::new("")).chain(own.ancestors().skip(1)).map(|f| f.join("data"));
    candidates
        .find(|path| path.is_dir())
        .expect("no folder `data` here or above the test binary: set MOIRE_DATA")
}

/// Prints once on stderr what was skipped, outside the output that a passing test captures.
pub fn untested(what: &'static str) {
    static SAID: Mutex<BTreeSet<&str>> = Mutex::new(BTreeSet::new());
    if SAID.lock().unwrap().insert(what) {
        let _ = writeln!(std::io::stderr(), "not tested: {what}");
    }
}

/// Returns the seconds that this thread has run, not counting those in which others had its core.
#[cfg(target_os = "linux")]
pub fn thread_seconds() -> f64 {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeValLike;
    let usage = getrusage(UsageWho::RUSAGE_THREAD).unwrap();
    (usage.user_time() + usage.system_time()).num_microseconds() as f64 * 1e-6
}

/// Returns the seconds since the first call, where the system knows no time of threads.
#[cfg(not(target_os = "linux"))]
pub fn thread_seconds() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}

/// Every pixel and channel different, values in [0, 1].
pub fn gradient(width: u32, height: u32) -> Film {
    let mut film = Film::new(width, height, 1);
    let count = film.pixels.len() as f32 * 3.0;
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        *pixel = [0, 1, 2].map(|c| (i * 3 + c) as f32 / count);
    }
    film
}

/// The message and its help, as one string.
pub fn told<T>(result: moire::internal::core::error::Result<T>) -> String {
    match result.err().expect("an error was expected") {
        moire::internal::core::error::Error::Plain { message, help, .. } => {
            format!("{message}\n{}", help.unwrap_or_default())
        }
        other => other.to_string(),
    }
}
