//! Measures the points of a study: for each method and count the render stage's time in every
//! repeat, and the errors of its picture against the reference. Points of an earlier run are
//! reused. Repeats are interleaved: all points once, then all again, so that a drift of the
//! machine's speed affects all alike.

use std::time::Instant;

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::lab::metrics::compare;
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::render::Prepared;
use crate::scene::model::{Algorithm, Scene};

use super::bootstrap::blocks;
use super::identity::Hash;
use super::limit::Limit;
use super::method::Method;
use super::plan::{Forecast, Point};
use super::record::{Errors, PointRecord, Record, Stages};
use super::reference::Reference;
use super::results::OwnError;
use super::session_cache::{SessionCache, sampled_part};
use super::showcase::SAMPLES;
use super::{Options, files, quote, quoted};
use crate::core::counted::{counted, plural, verb};

/// The fraction of the time that may be reserved for the page's pictures.
const MAX_RESERVED: f64 = 0.25;
const PANELS: f64 = 6.0;
/// A first render shorter than that is made twice: what happens once, such as the driver's own compiling, would be a large
/// part of its time.
const COLD_SECONDS: f64 = 0.25;
/// The interval between two writes of the record, which limits the loss if the process is killed.
const SAVE_SECONDS: f64 = 1.0;

pub struct Measurement<'a> {
    pub sessions: &'a SessionCache<'a>,
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub methods: &'a [Method],
    pub points: &'a [Point],
    /// Renders per point.
    pub repeats: u32,
    /// Methods whose points are rendered once and no more.
    pub paused: &'a [usize],
    /// The part of the progress that these points take.
    pub span: [f64; 2],
    pub reference: &'a Reference,
    pub identity: &'a Hash,
    pub limit: &'a Limit,
    pub progress: &'a dyn Progress,
}

/// A point while it is measured.
struct Task<'a> {
    point: Point,
    record: PointRecord,
    prepared: Option<Prepared<'a, 'a>>,
    /// True if the record has the errors of its picture.
    compared: bool,
    left_out: bool,
}

impl<'a> Measurement<'a> {
    /// Fills in the record's points. On an error the points measured so far are in the folder.
    pub fn run(&self, record: &mut Record, kept: Vec<PointRecord>) -> Result<()> {
        let mut tasks: Vec<Task<'a>> = self.points.iter().map(|point| self.task(*point, &kept)).collect();
        let notes = record.notes.clone();
        let outcome = self.rounds(&mut tasks, record);
        let new = self.notes(&tasks).into_iter().filter(|note| !notes.contains(note)).collect();
        record.notes = [notes, new].concat();
        collect(record, &tasks, self.methods);
        files::save(&self.options.out, record)?;
        if record.points.is_empty() && outcome.is_ok() {
            return Err(Error::with_help(
                format!("--seconds {}: no time for a single point", self.options.limit),
                "allow more, or ask for fewer samples with --spp or a smaller picture with --size",
            ));
        }
        outcome
    }

    fn task(&self, point: Point, kept: &[PointRecord]) -> Task<'a> {
        let method = self.methods[point.method].name();
        let reference = &self.reference.record;
        let hash = self.identity.text(&reference.hash).text(&reference.samples.to_string());
        let hash = hash.text(&method).text(&point.spp.to_string()).hex();
        let same = |p: &&PointRecord| p.hash == hash && !p.seconds.is_empty();
        let found = kept.iter().find(same).cloned();
        let compared = found.is_some();
        let fresh =
            PointRecord { hash, method, spp: point.spp, samples: point.samples, ..PointRecord::default() };
        let record = PointRecord { command: self.command(&point), ..found.unwrap_or(fresh) };
        Task { point, record, prepared: None, compared, left_out: false }
    }

    fn rounds(&self, tasks: &mut [Task<'a>], record: &mut Record) -> Result<()> {
        let mut forecast = Forecast::default();
        for task in tasks.iter().filter(|t| t.compared) {
            forecast.learn(&task.point, task.record.median_seconds());
        }
        let begun = Instant::now();
        let mut saved = Instant::now();
        let mut done = 0;
        for round in 0..self.repeats as usize {
            for i in 0..tasks.len() {
                done += 1;
                if self.is_done(&tasks[i], round) || tasks[i].left_out {
                    continue;
                }
                self.describe(&tasks[i], round, done, tasks.len());
                let next = forecast.seconds(&tasks[i].point);
                let needed = if round == 0 { self.upkeep(tasks, i, &forecast) } else { next };
                let end = self.limit.seconds - self.reserve(&forecast);
                if self.limit.spent() + needed > end {
                    tasks[i].left_out |= round == 0;
                    continue;
                }
                let spent = begun.elapsed().as_secs_f64();
                let left = self.remaining(tasks, &forecast);
                let share = |seconds: f64| {
                    let [from, to] = self.span;
                    from + (to - from) * (seconds / (spent + left).max(1e-9)).min(1.0)
                };
                let part = SubProgress { whole: self.progress, from: share(spent), to: share(spent + next) };
                let clock = Instant::now();
                let Some(rendering) =
                    self.limit.until(end, &part, |part| self.measure(&mut tasks[i], part))?
                else {
                    tasks[i].left_out |= round == 0;
                    continue;
                };
                forecast.learn(&tasks[i].point, rendering);
                if round == 0 {
                    forecast.learn_beside(clock.elapsed().as_secs_f64() - rendering);
                }
                if saved.elapsed().as_secs_f64() > SAVE_SECONDS {
                    collect(record, tasks, self.methods);
                    files::save(&self.options.out, record)?;
                    saved = Instant::now();
                }
            }
        }
        Ok(())
    }

    fn is_done(&self, task: &Task<'_>, round: usize) -> bool {
        task.record.seconds.len() > round || task.compared && self.paused.contains(&task.point.method)
    }

    fn describe(&self, task: &Task<'_>, round: usize, done: usize, all: usize) {
        let name = self.methods[task.point.method].label(self.scene.sampling.pattern);
        let again = if self.repeats > 1 {
            format!(", round {} of {}", round + 1, self.repeats)
        } else {
            String::new()
        };
        let samples = counted(task.point.samples, "sample");
        self.progress.describe(&format!("{name}, {samples} ({} of {all}{again})", done - round * all));
    }

    /// Returns the seconds that the pictures of the page will take.
    fn reserve(&self, forecast: &Forecast) -> f64 {
        let panel = |method: usize| {
            forecast.seconds(&Point { method, spp: SAMPLES, samples: SAMPLES }) + forecast.overhead()
        };
        let of = |plain: bool| {
            let all = self.methods.iter().enumerate();
            all.filter(move |(_, m)| (m.algorithm == Algorithm::Samples) == plain).map(|(i, _)| panel(i))
        };
        let seconds = of(false).sum::<f64>() + PANELS * of(true).fold(0.0, f64::max);
        seconds.min(MAX_RESERVED * self.limit.seconds)
    }

    /// Returns the seconds that point `i` needs if it is started now: all its repeats, and the
    /// outstanding ones of the points before it.
    fn upkeep(&self, tasks: &[Task<'_>], i: usize, forecast: &Forecast) -> f64 {
        let own = forecast.seconds(&tasks[i].point) * f64::from(self.repeats);
        let before = tasks[..i].iter().filter(|t| !t.left_out && t.compared);
        own + forecast.overhead() + before.map(|t| self.lacking(t) * forecast.seconds(&t.point)).sum::<f64>()
    }

    fn lacking(&self, task: &Task<'_>) -> f64 {
        if self.is_done(task, 0) && self.paused.contains(&task.point.method) {
            return 0.0;
        }
        f64::from(self.repeats.saturating_sub(task.record.seconds.len() as u32))
    }

    fn remaining(&self, tasks: &[Task<'_>], forecast: &Forecast) -> f64 {
        let left = tasks.iter().filter(|t| !t.left_out);
        let sum: f64 = left.map(|t| self.lacking(t) * forecast.seconds(&t.point)).sum();
        sum.min(self.limit.left())
    }

    /// Returns the seconds of the render stage.
    fn measure(&self, task: &mut Task<'a>, progress: &dyn Progress) -> Result<f64> {
        if progress.cancelled() {
            return Err(Error::Interrupted);
        }
        let is_cold = task.prepared.is_none();
        let (prepared, pack) = match task.prepared.take() {
            Some(prepared) => (prepared, task.record.stages.pack),
            None => self.sessions.prepare(self.scene, &self.methods[task.point.method], task.point.spp)?,
        };
        let (film, report) = prepared.render(progress)?;
        let seconds = report.seconds;
        let Stages { upload, compile, .. } = task.record.stages;
        let first = !task.compared;
        task.record.stages = Stages {
            pack,
            upload: if first { seconds.upload } else { upload },
            compile: if first { seconds.compile } else { compile },
            readback: seconds.readback,
        };
        let (mut render, mut on_device) = (seconds.render, report.device_render_seconds);
        if is_cold && render < COLD_SECONDS {
            let (_, again) = prepared.render(progress)?;
            (render, on_device) = (again.seconds.render, again.device_render_seconds);
        }
        task.record.seconds.push(render);
        task.record.device_seconds.push(on_device);
        task.prepared = Some(prepared);
        if first {
            task.record.errors = judge(&film, self.reference)?;
            task.record.blocks = blocks(&film, &self.reference.film);
            let own = || OwnError::of(task.record.errors.rmse, &task.record.blocks, &self.reference.record);
            task.record.own = self.reference.record.rmse.map(|_| own());
            task.record.picture = Hash::new().picture(&film).hex();
            task.record.sampled =
                sampled_part(self.methods[task.point.method].algorithm, &report, film.pixels.len());
            if self.methods[task.point.method].algorithm == Algorithm::Adaptive {
                task.record.samples = film.samples;
            }
            if let Some(part) = task.record.sampled {
                // One ray per beam, or per the cone in its place.
                task.record.samples = (part * f64::from(task.point.samples)).ceil().max(1.0) as u32;
            }
            task.compared = true;
        }
        Ok(render)
    }

    fn command(&self, point: &Point) -> String {
        let mut words = vec!["moire".to_owned(), "render".to_owned(), quoted(&self.scene.path)];
        words.extend(self.methods[point.method].arguments(self.scene, point.spp));
        words.extend(self.options.arguments.iter().map(|a| quote(a)));
        words.extend(["-o".to_owned(), "point.exr".to_owned()]);
        words.join(" ")
    }

    fn notes(&self, tasks: &[Task<'_>]) -> Vec<String> {
        let limit = self.options.limit;
        let mut notes = Vec::new();
        for (index, method) in self.methods.iter().enumerate() {
            let left = tasks.iter().filter(|t| t.point.method == index && t.left_out);
            let counts: Vec<String> = left.map(|t| t.point.spp.to_string()).collect();
            if !counts.is_empty() {
                notes.push(format!(
                    "{} with {} {} was left out: no room within --seconds {limit}",
                    method.name(),
                    counts.join(", "),
                    plural(if counts == ["1"] { 1 } else { 2 }, "sample")
                ));
            }
        }
        let wanted = self.repeats as usize;
        let short = tasks.iter().filter(|t| t.compared && !self.is_done(t, wanted - 1)).count();
        if short > 0 {
            notes.push(format!(
                "{} {} fewer than {wanted} repeats: no room within --seconds {limit}",
                counted(short, "point"),
                verb(short, "has", "have")
            ));
        }
        notes
    }
}

fn judge(film: &Film, reference: &Reference) -> Result<Errors> {
    let comparison = compare(film, &reference.film)?;
    let flip =
        if comparison.nan_pixels > 0 { f64::NAN } else { PerceptualFeatures::of(film).mean(&reference.seen) };
    Ok(Errors::new(&comparison, flip))
}

/// Collects the measured points, method by method.
fn collect(record: &mut Record, tasks: &[Task<'_>], methods: &[Method]) {
    let of = |method: usize| tasks.iter().filter(move |t| t.point.method == method && t.compared);
    let sorted = |method: usize| {
        let mut points: Vec<PointRecord> = of(method).map(|t| t.record.clone()).collect();
        points.sort_by_key(|p| p.spp);
        points
    };
    record.points = (0..methods.len()).flat_map(sorted).collect();
}
