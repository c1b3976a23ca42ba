//! `moire render --watch`: renders again whenever a file of the scene changes. Input: the options of a render. Output: its
//! files, soon a first look and then the whole picture, until Ctrl-C. Errors are told, and the next change is waited for.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::inputs::Inputs;
use super::progress::Bar;
use super::render::{Job, Show};
use crate::core::counted::counted;
use crate::core::error::{Error, ErrorKind, Result};
use crate::core::progress::Progress;
use crate::render::{FileStamp, Kept, stamp};
use crate::scene::model::{Algorithm, Scene};
use crate::scene::{BuiltIn, is_standard_input};

/// Time between two looks at the files: lengths and times of change, which every file system tells.
const POLL: Duration = Duration::from_millis(40);
/// Time without a change after which a file is taken to be written, and the longest that is waited for it.
const SETTLED: Duration = Duration::from_millis(20);
const LONGEST_WRITE: Duration = Duration::from_secs(2);
/// Time without a change after which a mistake is told: a file that is being written is wrong for a moment.
const PATIENCE: Duration = Duration::from_millis(400);
/// Time between two looks whether a scene that could not be read can be: a file that it names may have come.
const RETRY: Duration = Duration::from_secs(1);
/// Seconds of a whole picture below which no first look comes before it.
const SOON: f64 = 0.2;

/// Renders until Ctrl-C.
pub(super) fn run(job: &Job<'_>, bar: &Bar) -> Result<ExitCode> {
    let scene = job.path;
    check(job, scene)?;
    let mut kept = Kept::with_textures();
    let mut files = Files::default();
    files.add(scene.to_owned());
    let mut last_whole = f64::INFINITY;
    let mut is_told = job.args.quiet;
    let told = RefCell::new(Vec::new());
    while !bar.cancelled() {
        files.look();
        let start = Instant::now();
        let (mut mistake, mut is_unread) = (None, false);
        match picture(job, &mut files, &mut kept, &Told { bar, warnings: &told }, last_whole) {
            Ok(()) => last_whole = start.elapsed().as_secs_f64(),
            Err(Error::Interrupted) if bar.cancelled() => break,
            // A file has changed meanwhile.
            Err(Error::Interrupted) => {}
            Err(error) if error.kind() == ErrorKind::NoDevice => return Err(error),
            Err(error) => {
                if error.kind().is_transient() {
                    kept.close();
                }
                bar.finish();
                mistake = Some(error);
            }
        }
        if let Some(mistake) = mistake
            && !files.change_within(bar, PATIENCE)
        {
            super::tell(mistake);
            is_unread = job.stage().is_err();
        }
        if !is_told {
            let count = counted(files.0.len(), "file");
            super::notify(format_args!("watching {count} for changes; Ctrl-C ends"));
            is_told = true;
        }
        let is_read = || job.stage().is_ok();
        files.wait(bar, is_unread.then_some(&is_read));
    }
    bar.finish();
    Ok(ExitCode::from(130))
}

/// Refuses what no change of a file can mend.
fn check(job: &Job<'_>, scene: &Path) -> Result<()> {
    if is_standard_input(scene) {
        return Err(Error::with_help(
            "--watch: standard input is read once and does not change",
            "write the scene to a file, and name that",
        ));
    }
    if job.outputs.stream.is_some() {
        return Err(Error::with_help(
            "--watch: standard output takes one picture, and changes make several",
            "write a file: -o picture.png",
        ));
    }
    if BuiltIn::named(scene)?.is_none() && !scene.exists() {
        let what = format!("--watch: {}: there is no such file", scene.display());
        return Err(Error::new(what).of_kind(ErrorKind::File));
    }
    job.outputs.files.iter().try_for_each(|path| Inputs::default().check_picture(path))
}

/// How a picture tells of itself, and what was told of the one before.
struct Told<'a> {
    bar: &'a Bar,
    warnings: &'a RefCell<Vec<String>>,
}

/// Makes the picture of the files as they are: a first look, unless the whole is there as soon.
fn picture(
    job: &Job<'_>,
    files: &mut Files,
    kept: &mut Kept,
    told: &Told<'_>,
    last_whole: f64,
) -> Result<()> {
    let (bar, warnings) = (told.bar, Some(told.warnings));
    let start = Instant::now();
    let stage = job.stage()?;
    files.add_all(&stage.scene);
    let until_change = UntilChange::new(bar, files);
    if last_whole > SOON && is_long(&stage.scene, job) {
        let mut quick = job.stage()?;
        let sampling = &mut quick.scene.sampling;
        (sampling.spp, sampling.algorithm) = (1, Algorithm::Samples);
        job.render(quick, kept, &Show { progress: &until_change, bar, is_preview: true, told: None }, start)?;
    }
    bar.restart();
    job.render(stage, kept, &Show { progress: &until_change, bar, is_preview: false, told: warnings }, start)
}

/// Returns true if one sample a pixel takes much less time than the whole picture.
fn is_long(scene: &Scene, job: &Job<'_>) -> bool {
    let sampling = &scene.sampling;
    job.has_picture() && (sampling.algorithm != Algorithm::Samples || job.has_goal() || sampling.spp > 2)
}

/// Files with their stamps.
#[derive(Default)]
struct Files(Vec<(PathBuf, FileStamp)>);

impl Files {
    /// Adds the files that a scene names; those of scenes before it stay, as a mistake may have lost them.
    fn add_all(&mut self, scene: &Scene) {
        let textures = scene.textures.iter().flat_map(|texture| texture.content.files());
        let named: Vec<PathBuf> = textures.map(Path::to_owned).chain(scene.sources.iter().cloned()).collect();
        named.into_iter().for_each(|path| self.add(path));
    }

    fn add(&mut self, path: PathBuf) {
        if !self.0.iter().any(|(known, _)| *known == path) {
            let now = stamp(&path);
            self.0.push((path, now));
        }
    }

    fn look(&mut self) {
        self.0.iter_mut().for_each(|(path, seen)| *seen = stamp(path));
    }

    fn has_changed(&self) -> bool {
        self.0.iter().any(|(path, seen)| stamp(path) != *seen)
    }

    /// Returns true as soon as a file changes in this time.
    fn change_within(&self, bar: &Bar, time: Duration) -> bool {
        let start = Instant::now();
        while !bar.cancelled() && start.elapsed() < time {
            if self.has_changed() {
                return true;
            }
            sleep(POLL);
        }
        // This process may have been stopped for a while.
        self.has_changed()
    }

    /// Waits until a file has changed and is written, until `is_over` says so, or until Ctrl-C. An editor may put a new file in
    /// the place of the old one, which is missing for a moment.
    fn wait(&mut self, bar: &Bar, is_over: Option<&dyn Fn() -> bool>) {
        while !bar.cancelled() && !self.change_within(bar, RETRY) {
            if is_over.is_some_and(|is_over| is_over()) {
                return;
            }
        }
        let was_there: Vec<bool> = self.0.iter().map(|(_, seen)| seen.is_some()).collect();
        let start = Instant::now();
        while !bar.cancelled() && start.elapsed() < LONGEST_WRITE {
            self.look();
            sleep(SETTLED);
            let is_whole = self.0.iter().zip(&was_there).all(|((_, seen), was)| seen.is_some() || !was);
            if is_whole && !self.has_changed() {
                return;
            }
        }
    }
}

/// A render that a change of its files cancels, too.
struct UntilChange<'a> {
    bar: &'a Bar,
    files: &'a Files,
    has_changed: AtomicBool,
    last_look: Mutex<Instant>,
}

impl<'a> UntilChange<'a> {
    fn new(bar: &'a Bar, files: &'a Files) -> Self {
        UntilChange { bar, files, has_changed: AtomicBool::new(false), last_look: Mutex::new(Instant::now()) }
    }
}

impl Progress for UntilChange<'_> {
    fn advance(&self, done: f64) {
        self.bar.advance(done);
    }

    fn cancelled(&self) -> bool {
        let mut last = self.last_look.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() >= POLL {
            *last = Instant::now();
            self.has_changed.fetch_or(self.files.has_changed(), Ordering::Relaxed);
        }
        self.bar.cancelled() || self.has_changed.load(Ordering::Relaxed)
    }
}
