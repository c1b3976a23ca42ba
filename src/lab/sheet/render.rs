//! Renders the cells of a plan, those of one reference after each other and among them those of one session. Input: the
//! plan. Output: the record, and of each picture what is shown.

use super::identity::Identity;
use super::plan::{Cell, Job, Plan, ReferenceChoice, View};
use super::record::{AxisRecord, CellRecord, Record, ReferenceRecord};
use super::reference::Reference;
use super::sessions::Sessions;
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::gpu::Gpu;
use crate::lab::metrics::compare;
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::lab::study::analysis::median;
use crate::lab::study::format::samples_taken_by;
use crate::lab::study::pictures::{self, Window};
use crate::render::Report;
use crate::scene::model::{Algorithm, Scene};

/// What is shown of a picture.
pub struct Shown {
    /// The part, in the pixels of the picture or averaged over squares.
    pub film: Film,
    /// |picture − reference|, the mean of three channels.
    pub difference: Option<Vec<f32>>,
}

pub struct Sheet {
    pub record: Record,
    /// One for each cell; `None` where it could not be rendered.
    pub pictures: Vec<Option<Shown>>,
    /// The part of the reference, if all cells have the same.
    pub reference: Option<Shown>,
    /// The whole reference, or the first picture without one, if a part is shown of the others.
    pub whole: Option<Film>,
}

/// The width to which the whole picture is reduced.
const WHOLE_WIDTH: u32 = 384;

pub fn render(gpu: &Gpu, plan: &Plan, progress: &dyn Progress) -> Result<Sheet> {
    let mut order: Vec<(Identity, Identity, usize)> = Vec::new();
    for (i, cell) in plan.cells.iter().enumerate() {
        if let Ok(job) = &cell.job {
            order.push((reference_of(plan, job), Identity::of(&job.scene), i));
        }
    }
    group(&mut order, |a, b| a.0 == b.0);
    group(&mut order, |a, b| a.0 == b.0 && a.1 == b.1);
    let alone = order.iter().all(|entry| entry.0 == order[0].0);

    let total: f64 = order.iter().map(|entry| cost(plan, entry.2)).sum::<f64>()
        + references(plan, &order).iter().map(|&i| reference_cost(plan, i)).sum::<f64>();
    let mut done = 0.0;
    let mut sheet = Sheet {
        record: empty_record(gpu, plan),
        pictures: plan.cells.iter().map(|_| None).collect(),
        reference: None,
        whole: None,
    };
    let mut sessions = Sessions::new(gpu);
    let mut current: Option<(Identity, Option<Reference>)> = None;
    for (count, (view, _, index)) in order.iter().enumerate() {
        let Some(job) = plan.cells[*index].job.as_ref().ok() else { continue };
        let mut part = |seconds: f64| {
            let from = done / total.max(1e-9);
            done += seconds;
            SubProgress { whole: progress, from, to: (done / total.max(1e-9)).min(1.0) }
        };
        if current.as_ref().is_none_or(|(own, _)| own != view) {
            // Freed before the next one is made.
            drop(current.take());
            progress.describe("reference");
            let reference = obtain(plan, &mut sessions, job, &part(reference_cost(plan, *index)))?;
            sheet.record.references.extend(reference.as_ref().map(|r| r.record.clone()));
            current = Some((view.clone(), reference));
        }
        let reference = current.as_ref().and_then(|(_, reference)| reference.as_ref());
        let label = &sheet.record.cells[*index].label;
        progress.describe(&format!("{label} ({} of {})", count + 1, order.len()));
        let drawn = draw(plan, &mut sessions, job, &part(cost(plan, *index)));
        let record = &mut sheet.record.cells[*index];
        let (film, reports) = match drawn {
            Ok(drawn) => drawn,
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            Err(why) => {
                record.error = Some(why.to_string());
                continue;
            }
        };
        measure(record, job, &film, &reports);
        if let Some(reference) = reference {
            record.reference = Some(sheet.record.references.len() - 1);
            judge(record, &film, reference)?;
        }
        if sheet.whole.is_none() && plan.view.zoom.is_some() && alone {
            let picture = reference.map_or(&film, |reference| &reference.film);
            sheet.whole = Some(pictures::downscaled(picture, WHOLE_WIDTH));
        }
        if sheet.reference.is_none() && alone {
            sheet.reference = reference.map(|reference| shown(&plan.view, &reference.film, None));
        }
        sheet.pictures[*index] = Some(shown(&plan.view, &film, reference));
    }
    finish(sheet)
}

/// Moves entries to the first one that is like them.
fn group<T>(entries: &mut Vec<T>, alike: impl Fn(&T, &T) -> bool) {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for entry in entries.drain(..) {
        match groups.iter_mut().find(|group| alike(&group[0], &entry)) {
            Some(group) => group.push(entry),
            None => groups.push(vec![entry]),
        }
    }
    entries.extend(groups.into_iter().flatten());
}

fn reference_of(plan: &Plan, job: &Job) -> Identity {
    // A file is the reference of all.
    let first = plan.jobs().next().unwrap_or(job);
    let scene = if matches!(plan.reference, ReferenceChoice::Rendered) { job } else { first };
    Identity::of(&scene.reference)
}

/// Returns the first cell of each reference.
fn references(plan: &Plan, order: &[(Identity, Identity, usize)]) -> Vec<usize> {
    if !matches!(plan.reference, ReferenceChoice::Rendered) {
        return Vec::new();
    }
    let first = |i: &usize| *i == 0 || order[*i].0 != order[*i - 1].0;
    (0..order.len()).filter(first).map(|i| order[i].2).collect()
}

/// Returns the samples of a picture, for the progress bar.
fn samples(scene: &Scene) -> f64 {
    f64::from(scene.sampling.samples()) * f64::from(scene.width) * f64::from(scene.height)
}

fn cost(plan: &Plan, index: usize) -> f64 {
    let job = plan.cells[index].job.as_ref();
    // Building pipelines takes as long as some samples.
    job.map_or(0.0, |job| f64::from(plan.repeats) * samples(&job.scene) + 1e6)
}

fn reference_cost(plan: &Plan, index: usize) -> f64 {
    let job = plan.cells[index].job.as_ref();
    let is_rendered = matches!(plan.reference, ReferenceChoice::Rendered);
    job.ok().filter(|_| is_rendered).map_or(0.0, |job| 2.0 * samples(&job.reference) + 1e6)
}

fn obtain(
    plan: &Plan,
    sessions: &mut Sessions<'_>,
    job: &Job,
    progress: &dyn Progress,
) -> Result<Option<Reference>> {
    match &plan.reference {
        ReferenceChoice::None => Ok(None),
        ReferenceChoice::File { name, film } => Ok(Some(Reference::of_file(name, film))),
        ReferenceChoice::Rendered => Reference::render(sessions, &job.reference, progress).map(Some),
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

fn judge(record: &mut CellRecord, film: &Film, reference: &Reference) -> Result<()> {
    let comparison = compare(film, &reference.film)?;
    record.rmse = Some(comparison.rmse).filter(|rmse| rmse.is_finite() && comparison.nan_pixels == 0);
    record.flip = record.rmse.map(|_| PerceptualFeatures::of(film).mean(&reference.features));
    Ok(())
}

fn shown(view: &View, film: &Film, reference: Option<&Reference>) -> Shown {
    let part = view.part([film.width, film.height]);
    let window = Window { x: part.x, y: part.y, width: part.width, height: part.height };
    let step = view.reduced([film.width, film.height]);
    let fitted = |film: &Film| {
        let own = pictures::crop(film, window);
        if step > 1 { pictures::averaged(&own, step) } else { own }
    };
    let difference = |reference: &Reference| {
        let values =
            pictures::differences(&pictures::crop(film, window), &pictures::crop(&reference.film, window));
        let pixels = values.into_iter().map(|v| [v; 3]).collect();
        let whole = Film { width: window.width, height: window.height, pixels, samples: 0 };
        let reduced = if step > 1 { pictures::averaged(&whole, step) } else { whole };
        reduced.pixels.into_iter().map(|pixel| pixel[0]).collect()
    };
    Shown { film: fitted(film), difference: reference.filter(|_| view.difference).map(difference) }
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
        repeats: plan.repeats,
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
