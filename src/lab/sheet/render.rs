//! Renders the cells of a plan, those of one reference after each other and among them those of one session, and then the
//! reference. Input: the plan. Output: the record, and of each picture what is shown.

use super::judge::{Drawn, is_enough, judge, notes};
use super::plan::{Cell, Job, Plan, ReferenceChoice};
use super::record::{AxisRecord, CellRecord, Record, ReferenceRecord};
use super::reference::{Extent, Reference};
use super::same;
use super::sessions::Sessions;
use super::shown::{Shown, shown, within};
use super::views::{names, views};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::gpu::Gpu;
use crate::lab::metrics::Halves;
use crate::lab::study::analysis::median;
use crate::lab::study::format::samples_taken_by;
use crate::lab::study::pictures;
use crate::render::Report;
use crate::scene::model::{Algorithm, Scene};

pub struct Sheet {
    pub record: Record,
    /// One for each cell; `None` where it could not be rendered.
    pub pictures: Vec<Option<Shown>>,
    /// What stands beside the cells of each view.
    pub beside: Vec<Beside>,
}

/// What stands beside the cells of a view for comparison.
#[derive(Default)]
pub struct Beside {
    /// What tells the view from the others; nothing if there are none.
    pub name: String,
    /// The part of the reference that is shown of the cells, and the index of its record.
    pub reference: Option<(Shown, usize)>,
    /// The whole reference, or the first picture without one, if a part is shown of the others; and its size.
    pub whole: Option<(Film, [u32; 2])>,
}

/// The width to which the whole picture is reduced.
const WHOLE_WIDTH: u32 = 384;
/// The time of a reference relative to that of the cells which it judges, and the least: of all together, and of each.
const TIME_SHARE: f64 = 1.0;
const MIN_SECONDS: f64 = 2.0;
const MIN_VIEW_SECONDS: f64 = 0.25;
/// The most bytes of pictures that wait for their reference.
const MAX_WAITING: usize = 1 << 30;

pub fn render(gpu: &Gpu, plan: &Plan, progress: &dyn Progress) -> Result<Sheet> {
    let views = views(plan);
    let sheet = Sheet {
        record: empty_record(gpu, plan),
        pictures: plan.cells.iter().map(|_| None).collect(),
        beside: Vec::new(),
    };
    let total: f64 = views.iter().map(|view| view_cost(plan, view)).sum();
    let mut run = Run {
        plan,
        sessions: Sessions::new(gpu),
        sheet,
        digests: vec![None; plan.cells.len()],
        views: views.len(),
        total,
        done: 0.0,
    };
    for (view, name) in views.iter().zip(names(plan, &views)) {
        run.sheet.beside.push(Beside { name, ..Beside::default() });
        run.view(view, progress)?;
    }
    run.sheet.record.warnings.extend(same::notes(plan, &run.digests));
    finish(run.sheet)
}

/// Returns what a cell costs, for the progress bar: samples.
fn cost(plan: &Plan, index: usize) -> f64 {
    let pixels = |scene: &Scene| f64::from(scene.width) * f64::from(scene.height);
    let samples = |scene: &Scene| f64::from(scene.sampling.samples()) * pixels(scene);
    let job = plan.cells[index].job.as_ref();
    // Building pipelines takes as long as some samples.
    job.map_or(0.0, |job| f64::from(plan.renders()) * samples(&job.scene) + 1e6)
}

/// Returns what a view costs: a reference about as much as its cells.
fn view_cost(plan: &Plan, view: &[usize]) -> f64 {
    let cells: f64 = view.iter().map(|i| cost(plan, *i)).sum();
    cells + if matches!(plan.reference, ReferenceChoice::Rendered { .. }) { cells } else { 0.0 }
}

/// A sheet while it is rendered.
struct Run<'a> {
    plan: &'a Plan,
    sessions: Sessions<'a>,
    sheet: Sheet,
    /// What tells the films of cells from each other.
    digests: Vec<Option<u64>>,
    /// The number of views, each with a reference of its own.
    views: usize,
    /// The costs of all, and of what is done.
    total: f64,
    done: f64,
}

impl Run<'_> {
    /// Renders the cells of a view, then their reference: that they are known tells how good it has to be.
    fn view(&mut self, view: &[usize], progress: &dyn Progress) -> Result<()> {
        let (mut waiting, mut reference): (Vec<Drawn>, _) = (Vec::new(), None);
        let mut seconds = 0.0;
        for (count, &index) in view.iter().enumerate() {
            let Ok(job) = &self.plan.cells[index].job else { continue };
            progress.describe(&format!(
                "{} ({} of {})",
                self.sheet.record.cells[index].label,
                count + 1,
                view.len()
            ));
            let part = self.part(cost(self.plan, index), progress);
            let drawn = draw(self.plan, &mut self.sessions, job, &part);
            let record = &mut self.sheet.record.cells[index];
            match drawn {
                Ok((film, reports)) => {
                    measure(record, job, &film, &reports);
                    seconds += record.seconds.iter().sum::<f64>();
                    self.digests[index] = Some(same::digest(&film));
                    waiting.push(Drawn { index, film });
                }
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                Err(why) => record.error = Some(why.to_string()),
            }
            let bytes: usize = waiting.iter().map(|drawn| size_of_val(&drawn.film.pixels[..])).sum();
            if bytes > MAX_WAITING {
                self.settle(&mut waiting, &mut reference, [seconds, view_cost(self.plan, view)], progress)?;
            }
        }
        self.settle(&mut waiting, &mut reference, [seconds, view_cost(self.plan, view)], progress)
    }

    fn part<'p>(&mut self, cost: f64, progress: &'p dyn Progress) -> SubProgress<'p> {
        let from = self.done / self.total.max(1e-9);
        self.done += cost;
        SubProgress { whole: progress, from, to: (self.done / self.total.max(1e-9)).min(1.0) }
    }

    /// Judges the pictures that wait, by a reference that is made first if there is none yet. The cells of the view took
    /// `seconds` so far.
    fn settle(
        &mut self,
        waiting: &mut Vec<Drawn>,
        reference: &mut Option<Reference>,
        [seconds, cost]: [f64; 2],
        progress: &dyn Progress,
    ) -> Result<()> {
        let Some(first) = waiting.first() else { return Ok(()) };
        if reference.is_none() {
            progress.describe("reference");
            let part = self.part(0.5 * cost, progress);
            *reference = match self.reference(first.index, waiting, seconds, &part) {
                Err(why) if !matches!(why, Error::Interrupted) && !why.kind().is_transient() => {
                    self.sheet.record.warnings.push(format!("no reference{}: {why}", self.whose()));
                    None
                }
                made => made?,
            };
            self.sheet.record.references.extend(reference.as_ref().map(|r| r.record.clone()));
        }
        let reference = reference.as_ref();
        if let Some(reference) = reference {
            for Drawn { index, film } in waiting.iter() {
                let record = &mut self.sheet.record.cells[*index];
                record.reference = Some(self.sheet.record.references.len() - 1);
                judge(record, film, reference)?;
            }
            let notes = notes(&self.sheet.record, waiting, reference, &self.whose())?;
            self.sheet.record.warnings.extend(notes);
        }
        for drawn in waiting.drain(..) {
            self.show(&drawn, reference);
        }
        Ok(())
    }

    /// Returns the view as a possessor, if there are others.
    fn whose(&self) -> String {
        let name = self.sheet.beside.last().map_or("", |beside| &beside.name);
        if name.is_empty() { String::new() } else { format!(" of \"{name}\"") }
    }

    fn reference(
        &mut self,
        first: usize,
        waiting: &[Drawn],
        seconds: f64,
        progress: &dyn Progress,
    ) -> Result<Option<Reference>> {
        let Ok(job) = &self.plan.cells[first].job else { return Ok(None) };
        let least = (MIN_SECONDS / self.views as f64).max(MIN_VIEW_SECONDS);
        let is_enough = |halves: &Halves| is_enough(halves, waiting);
        let enough = Extent::Enough { seconds: (TIME_SHARE * seconds).max(least), is_enough: &is_enough };
        match &self.plan.reference {
            ReferenceChoice::None => Ok(None),
            ReferenceChoice::File { name, film } => Ok(Some(Reference::of_file(name, film))),
            ReferenceChoice::Rendered { samples } => {
                let extent = samples.map_or(enough, Extent::Samples);
                Reference::render(&mut self.sessions, &job.reference, extent, progress).map(Some)
            }
        }
    }

    /// Keeps what is shown of a picture, in all cells that show it.
    fn show(&mut self, drawn: &Drawn, reference: Option<&Reference>) {
        let (plan, sheet) = (self.plan, &mut self.sheet);
        if let Some(beside) = sheet.beside.last_mut() {
            let picture = reference.map_or(&drawn.film, |reference| &reference.film);
            if beside.whole.is_none() && plan.view.zoom.is_some() {
                let whole = pictures::downscaled(&plan.display.developed(picture), WHOLE_WIDTH);
                let size = [picture.width, picture.height];
                beside.whole = Some((within(whole, plan, &plan.display), size));
            }
            if let (None, Some(reference)) = (&beside.reference, reference) {
                let index = sheet.record.references.len() - 1;
                beside.reference = Some((shown(plan, &plan.display, &reference.film, None), index));
            }
        }
        let record = sheet.record.cells[drawn.index].clone();
        for i in plan.showing(drawn.index) {
            sheet.pictures[i] = Some(shown(plan, &plan.cells[i].display, &drawn.film, reference));
            if i != drawn.index {
                let own = &mut sheet.record.cells[i];
                let (settings, label) = (std::mem::take(&mut own.settings), std::mem::take(&mut own.label));
                let command = std::mem::take(&mut own.command);
                *own = CellRecord { settings, label, command, film_of: Some(drawn.index), ..record.clone() };
            }
        }
    }
}

fn draw(
    plan: &Plan,
    sessions: &mut Sessions<'_>,
    job: &Job,
    progress: &dyn Progress,
) -> Result<(Film, Vec<Report>)> {
    match job.goal {
        Some(goal) => sessions.render_to(&job.scene, goal, progress),
        None => sessions.render(&job.scene, plan.repeats, progress),
    }
}

fn measure(record: &mut CellRecord, job: &Job, film: &Film, reports: &[Report]) {
    let algorithm = job.scene.sampling.algorithm;
    let last = reports.last();
    let outcome = last.and_then(|report| report.outcome.as_ref());
    record.samples = outcome.map_or(f64::from(film.samples), |outcome| outcome.mean_samples);
    let sampled = last.and_then(|report| report.sampled_pixels);
    let sampled = sampled.map(|count| count as f64 / film.pixels.len().max(1) as f64);
    let count = match algorithm {
        Algorithm::Beam => job.scene.sampling.spp,
        _ => record.samples.round().max(1.0) as u32,
    };
    // What `auto` has chosen.
    let algorithm = if outcome.is_some() { Algorithm::Adaptive } else { algorithm };
    record.taken =
        samples_taken_by(algorithm, count, sampled.or((algorithm == Algorithm::Beam).then_some(1.0)));
    record.seconds = reports.iter().map(|report| report.seconds.render).collect();
    record.device_seconds = reports.iter().map(|report| report.device_render_seconds).collect();
    record.median_device_seconds = Some(median(&record.device_seconds));
}

fn empty_record(gpu: &Gpu, plan: &Plan) -> Record {
    let info = gpu.info();
    let label = |cell: &Cell| {
        let of = |(axis, at): (&super::plan::Axis, &usize)| axis.labels[*at].clone();
        plan.axes.iter().zip(&cell.at).map(of).collect::<Vec<_>>().join(", ")
    };
    let cell = |cell: &Cell| {
        let size = cell.job.as_ref().map_or([0; 2], |job| [job.scene.width, job.scene.height]);
        CellRecord {
            settings: cell.settings.clone(),
            label: label(cell),
            size,
            command: cell.command.clone(),
            error: cell.job.as_ref().err().cloned(),
            ..CellRecord::default()
        }
    };
    Record {
        program: format!("moire {}", env!("CARGO_PKG_VERSION")),
        scene: plan.scene.clone(),
        device: info.name.clone(),
        driver: info.driver.clone(),
        axes: plan
            .axes
            .iter()
            .map(|axis| AxisRecord { name: axis.name.clone(), labels: axis.labels.clone() })
            .collect(),
        repeats: plan.renders(),
        zoom: plan.view.zoom.map(|z| [z.x, z.y, z.width, z.height]),
        references: Vec::<ReferenceRecord>::new(),
        difference_scale: None,
        cells: plan.cells.iter().map(cell).collect(),
        warnings: Vec::new(),
        outputs: Vec::new(),
    }
}

/// Refuses a sheet without any picture, and finds the scale of all differences.
fn finish(mut sheet: Sheet) -> Result<Sheet> {
    if sheet.pictures.iter().all(Option::is_none) {
        let why = sheet.record.cells.iter().find_map(|cell| cell.error.clone());
        return Err(Error::new(format!("no cell of this sheet was rendered: {}", why.unwrap_or_default())));
    }
    let values: Vec<&[f32]> =
        sheet.pictures.iter().flatten().filter_map(|shown| shown.difference.as_deref()).collect();
    if !values.is_empty() {
        sheet.record.difference_scale = Some(pictures::scale(&values));
    }
    Ok(sheet)
}
