//! The content of a sheet, whatever it is written as: rows of cells with their heads, captions and notes. Input: the
//! plan, and what was rendered. Output: pictures and texts in the order in which they are read.

use super::plan::{Plan, ReferenceChoice};
use super::record::{CellRecord, Record, ReferenceRecord};
use super::render::{Beside, Sheet};
use super::shown::Shown;
use crate::core::film::Film;
use crate::core::range::Rect;
use crate::lab::study::format::{error, percent, samples, seconds};
use crate::lab::study::pictures::false_color;
use crate::output::{DisplayTransform, Gamut};
use crate::scene::model::Scene;

/// The share of an error from which on its uncertainty is told.
const TOLD: f64 = 0.05;
/// The columns of a sheet with one axis, unless their number is given.
const COLUMNS: usize = 4;

pub enum Body {
    Picture {
        film: Film,
        difference: Option<Film>,
    },
    /// The whole picture, and the part of it that the others show.
    Whole {
        film: Film,
        full: [u32; 2],
        part: Rect,
    },
    /// Why there is no picture.
    Missing(String),
}

pub struct Entry {
    /// The head of a cell that stands in no table.
    pub heading: Option<String>,
    pub body: Body,
    /// What a person hears who does not see the picture.
    pub description: String,
    pub caption: Vec<String>,
    /// The command that renders the picture alone.
    pub command: Option<String>,
}

pub struct Row {
    pub heading: Option<String>,
    pub entries: Vec<Entry>,
}

pub struct Block {
    pub heading: Option<String>,
    /// The heads of columns, if rows and columns are those of a table.
    pub columns: Vec<String>,
    pub rows: Vec<Row>,
}

pub struct Content {
    pub title: String,
    pub blocks: Vec<Block>,
    /// By how much the pixels of pictures are enlarged.
    pub factor: u32,
    /// The primaries with which pictures are written.
    pub gamut: Gamut,
    /// The value of the light end of the differences' colours.
    pub difference_scale: Option<f64>,
    /// Under what conditions it was measured, and how to read it.
    pub notes: Vec<String>,
}

impl Content {
    pub fn new(plan: &Plan, mut sheet: Sheet) -> Content {
        let notes = notes(plan, &sheet.record);
        let scale = sheet.record.difference_scale;
        let extras = extras(plan, &mut sheet);
        let Sheet { record, pictures, .. } = sheet;
        let entries = record.cells.iter().zip(pictures);
        let entries: Vec<Entry> = entries.map(|(cell, shown)| entry(plan, cell, shown, scale)).collect();
        Content {
            title: plan.title.clone(),
            blocks: blocks(plan, entries, extras),
            factor: plan.view.enlarged(),
            gamut: plan.gamut(),
            difference_scale: scale.map(f64::from),
            notes,
        }
    }
}

fn entry(plan: &Plan, cell: &CellRecord, shown: Option<Shown>, scale: Option<f32>) -> Entry {
    let why = || cell.error.clone().unwrap_or_else(|| "not rendered".into());
    let body = shown.map_or_else(|| Body::Missing(why()), |shown| picture(shown, scale));
    let mut caption = Vec::new();
    caption.extend(errors(cell));
    if let Some(time) = cell.median_device_seconds {
        let is_said =
            plan.axes.iter().any(|axis| axis.name == "spp") && cell.taken == samples(cell.samples as u32);
        let taken = if is_said { String::new() } else { format!(", {}", cell.taken) };
        caption.push(format!("{}{taken}", seconds(time)));
        let step = plan.view.reduced(cell.size);
        if step > 1 {
            caption.push(format!("shown at 1/{step}, averaged"));
        }
    }
    let description = format!("{}: {}", cell.label, caption.join(", "));
    Entry { heading: None, body, description, caption, command: Some(cell.command.clone()) }
}

/// Returns the line of a caption that tells the errors, if there is a reference.
fn errors(cell: &CellRecord) -> Option<String> {
    cell.reference?;
    let Some(flip) = cell.flip else { return Some("RMSE –: pixels that are no numbers".into()) };
    let rmse = match (cell.rmse, cell.rmse_deviation, cell.rmse_below) {
        (Some(rmse), Some(deviation), _) if deviation > TOLD * rmse => {
            format!("{} ± {}", error(rmse), percent(deviation / rmse))
        }
        (Some(rmse), _, _) => error(rmse),
        (None, _, bound) => format!("below {}", error(bound.unwrap_or(f64::NAN))),
    };
    Some(format!("RMSE {rmse}, FLIP {flip:.3}"))
}

fn picture(shown: Shown, scale: Option<f32>) -> Body {
    let width = shown.film.width;
    let difference = shown.difference.map(|values| false_color(&values, width, scale.unwrap_or(1.0)));
    Body::Picture { film: shown.film, difference }
}

/// Returns what stands beside the cells for comparison: whole pictures, and references.
fn extras(plan: &Plan, sheet: &mut Sheet) -> [Vec<Entry>; 2] {
    let mut found = [Vec::new(), Vec::new()];
    for Beside { name, reference, whole } in std::mem::take(&mut sheet.beside) {
        let heading = |what: &str| if name.is_empty() { what.to_owned() } else { format!("{what}, {name}") };
        if let (Some((film, full)), Some(part)) = (whole, plan.view.zoom) {
            found[0].push(self::whole(heading("whole picture"), film, full, part));
        }
        if let Some((shown, index)) = reference {
            let record = &sheet.record.references[index];
            found[1].push(self::reference(plan, heading("reference"), shown, record));
        }
    }
    found
}

fn whole(heading: String, film: Film, full: [u32; 2], part: Rect) -> Entry {
    let step = full[0].div_ceil(film.width.max(1));
    let size = if step > 1 { format!(", shown at 1/{step}") } else { String::new() };
    let frame = format!("{}×{} pixels from ({}, {})", part.width, part.height, part.x, part.y);
    Entry {
        description: format!("The {heading}; a frame marks {frame}, which the others show enlarged"),
        heading: Some(heading),
        caption: vec![format!("{}×{}{size}", full[0], full[1]), format!("frame: {frame}")],
        body: Body::Whole { film, full, part },
        command: None,
    }
}

fn reference(plan: &Plan, heading: String, shown: Shown, record: &ReferenceRecord) -> Entry {
    let own = record.rmse.map(|rmse| format!("itself off by RMSE {}", error(rmse)));
    let kind = match &plan.reference {
        ReferenceChoice::Rendered { .. } => samples(record.samples),
        _ => record.kind.clone(),
    };
    let caption: Vec<String> = std::iter::once(kind).chain(own).chain(developed(plan)).collect();
    Entry {
        description: format!("The {heading}: {}", caption.join(", ")),
        heading: Some(heading),
        caption,
        body: Body::Picture { film: shown.film, difference: None },
        command: None,
    }
}

/// Returns how the reference is shown, if that varies among the cells.
fn developed(plan: &Plan) -> Option<String> {
    let first = plan.cells.first()?.display;
    let DisplayTransform { exposure, white_balance, tone_map, .. } = plan.display;
    let varies =
        |differs: &dyn Fn(&DisplayTransform) -> bool| plan.cells.iter().any(|cell| differs(&cell.display));
    let words = [
        varies(&|d| d.exposure != first.exposure).then(|| format!("exposure {exposure}")),
        varies(&|d| d.tone_map != first.tone_map).then(|| format!("tone map: {tone_map}")),
        varies(&|d| d.white_balance != first.white_balance).then(|| {
            white_balance.map_or("no white balance".into(), |kelvin| format!("white balance: {kelvin} K"))
        }),
    ];
    let words: Vec<String> = words.into_iter().flatten().collect();
    (!words.is_empty()).then(|| words.join(", "))
}

fn blocks(plan: &Plan, entries: Vec<Entry>, extras: [Vec<Entry>; 2]) -> Vec<Block> {
    let labels = |axis: usize| plan.axes.get(axis).map_or(&[][..], |axis| &axis.labels);
    let mut entries = entries.into_iter();
    let plain = |rows| Block { heading: None, columns: Vec::new(), rows };
    let is_one_view = extras.iter().all(|row| row.len() <= 1);
    if plan.axes.len() == 1 {
        let headed =
            entries.zip(labels(0)).map(|(entry, label)| Entry { heading: Some(label.clone()), ..entry });
        let most = plan.view.columns.map_or(COLUMNS, |columns| columns as usize);
        if is_one_view {
            return vec![plain(wrapped(headed.chain(extras.into_iter().flatten()).collect(), most))];
        }
        let all = std::iter::once(headed.collect()).chain(extras).filter(|row| !row.is_empty());
        return all.map(|row| plain(wrapped(row, most))).collect();
    }
    let [columns, rows] = [labels(0), labels(1)];
    let headings =
        if plan.axes.len() > 2 { labels(2).iter().cloned().map(Some).collect() } else { vec![None] };
    let mut blocks = Vec::new();
    for heading in headings {
        let row = |label: &String| Row {
            heading: Some(label.clone()),
            entries: entries.by_ref().take(columns.len()).collect(),
        };
        blocks.push(Block { heading, columns: columns.to_vec(), rows: rows.iter().map(row).collect() });
    }
    if is_one_view {
        let entries: Vec<Entry> = extras.into_iter().flatten().collect();
        if !entries.is_empty() {
            blocks.push(plain(vec![Row { heading: None, entries }]));
        }
        return blocks;
    }
    let extras = extras.into_iter().filter(|row| !row.is_empty());
    blocks.extend(extras.map(|row| plain(wrapped(row, columns.len()))));
    blocks
}

/// Returns rows of as equal lengths as possible.
fn wrapped(entries: Vec<Entry>, most: usize) -> Vec<Row> {
    let rows = entries.len().div_ceil(most.max(1)).max(1);
    let length = entries.len().div_ceil(rows).max(1);
    let mut found: Vec<Row> = Vec::new();
    for entry in entries {
        match found.last_mut() {
            Some(row) if row.entries.len() < length => row.entries.push(entry),
            _ => found.push(Row { heading: None, entries: vec![entry] }),
        }
    }
    found
}

fn notes(plan: &Plan, record: &Record) -> Vec<String> {
    let sizes = |scene: &Scene| format!("{}×{}", scene.width, scene.height);
    let mut all: Vec<String> = plan.jobs().map(|job| sizes(&job.scene)).collect();
    all.dedup();
    let size = if all.len() == 1 { format!("{} pixels, ", all[0]) } else { String::new() };
    let times = match plan.renders() {
        1 => "times: one render each".to_owned(),
        many => format!("times: median of {many} renders"),
    };
    let mut notes =
        vec![format!("{size}{}; {times}, on the device, without loading and compiling", record.device)];
    let (linear, likewise) = match plan.is_developed() {
        true => (" before exposure, white balance and tone map,", ", shown likewise"),
        false => ("", ""),
    };
    if let Some(reference) = record.references.first() {
        let kind = match record.references.len() {
            1 => reference.kind.clone(),
            many => format!("one for each of {many} views, {}", reference_of_views(record)),
        };
        let noise = if reference.rmse.is_some() { "; its own noise is taken out of the RMSE" } else { "" };
        notes
            .push(format!("RMSE and FLIP of the whole picture{linear} against the reference: {kind}{noise}"));
    }
    if let Some(scale) = record.difference_scale {
        notes.push(format!(
            "lower pictures: difference from the reference{likewise}, mean of three channels, from 0 (dark) to {} or more \
             (light)",
            error(f64::from(scale))
        ));
    }
    if plan.view.zoom.is_some() && plan.view.enlarged() > 1 {
        notes.push(format!("each pixel of the part is shown as {0}×{0}", plan.view.enlarged()));
    }
    notes.extend(record.warnings.iter().cloned());
    notes
}

/// Returns the words for references of several views, whose numbers of samples may differ.
fn reference_of_views(record: &Record) -> String {
    let counts = || record.references.iter().map(|reference| reference.samples);
    match (counts().min(), counts().max()) {
        (Some(fewest), Some(most)) if fewest != most => {
            format!("{fewest} to {most} Sobol-Owen samples a pixel without a prefilter")
        }
        _ => record.references.first().map(|reference| reference.kind.clone()).unwrap_or_default(),
    }
}
