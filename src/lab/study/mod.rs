//! Error against time for one scene on one device. In: a scene, the methods and sample counts to try, a
//! reference or how to make one. Out: a folder with the measured points as CSV and JSON, plots as SVG, and
//! one HTML page that says which setting to use.
//!
//! ```text
//! method ─ plan ─▶ course ─▶ measure (render, metrics) ─▶ record ─▶ analysis ─▶ plots · stages · page
//!                     ▲ reference
//! ```

mod advice;
pub mod analysis;
pub mod bootstrap;
pub mod choice;
mod course;
mod extrapolation;
pub mod files;
mod fit;
pub mod format;
pub mod halves;
mod identity;
pub mod label;
pub mod limit;
mod measure;
pub mod method;
pub mod own;
mod page;
pub mod pictures;
pub mod plan;
pub mod question;
pub mod record;
pub mod reference;
pub mod refine;
pub mod results;
mod session_cache;
mod showcase;
mod stages;
pub mod steadiness;
pub mod student;
mod tables;

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::gpu::Gpu;
use crate::scene::model::Scene;
use crate::texture;

use course::Course;
use limit::Limit;
use method::Method;
use record::{Conditions, Question, Record};
use session_cache::SessionCache;

/// The options of a study.
#[derive(Clone, Debug)]
pub struct Options {
    /// The methods; `None` for those of [`Method::all_for`].
    pub methods: Option<Vec<Method>>,
    /// True if a coarse pass over the methods chooses those that are measured further.
    pub best: bool,
    /// What the recommendation answers; `None` for what wins most times.
    pub question: Option<Question>,
    /// Samples per pixel, each rounded up to a count that the pattern supports.
    pub counts: Vec<u32>,
    /// Renders per point, of which the median counts.
    pub repeats: u32,
    pub reference: ReferenceChoice,
    /// The wall-clock limit in seconds for everything, from `started` on.
    pub limit: f64,
    pub started: Instant,
    /// An existing folder.
    pub out: PathBuf,
    /// Arguments of commands beside the method: `--size`, `--device`.
    pub arguments: Vec<String>,
}

/// The source of the reference picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReferenceChoice {
    /// Many samples on the device.
    Device,
    /// Many samples by the float64 oracle.
    Oracle,
    File(PathBuf),
}

/// Measures the points that the folder does not have yet and writes everything. If interrupted or
/// failed, it leaves a folder from which the same call resumes.
pub fn run(gpu: &Gpu, scene: &Scene, options: &Options, progress: &dyn Progress) -> Result<Record> {
    let limit = Limit::new(options.started, options.limit);
    let (methods, notes) = match &options.methods {
        Some(methods) => (methods.clone(), Vec::new()),
        None => Method::all_for(scene),
    };
    let points = plan::points(&methods, scene, &options.counts)?;
    let textures = scene.textures.iter().map(texture::load::load).collect::<Result<Vec<_>>>()?;
    let conditions = Conditions::new(gpu, scene, options);
    let identity = identity::of(&conditions, scene)?;
    let mut record = Record::new(conditions, methods.iter().map(|m| m.describe(scene)).collect());
    record.notes = notes;
    let kept = record::read(&options.out);

    let sessions = SessionCache::open(gpu, scene, textures, &methods)?;
    let reference =
        reference::obtain(&sessions, scene, options, &identity, kept.reference, &limit, progress)?;
    record.reference = reference.record.clone();
    record.notes.extend(reference.note.clone());
    Course {
        sessions: &sessions,
        scene,
        options,
        methods: &methods,
        reference: &reference,
        identity: &identity,
        limit: &limit,
        progress,
    }
    .run(&mut record, points, kept.points)?;
    record.analysis = Some(analysis::analyse(&record));
    let showcase = showcase::render(&sessions, scene, &record, &reference.film, &limit, progress)?;
    record.notes.extend(showcase.note(&limit));
    record.notes.extend(question::note(&record));
    record.notes.extend(steadiness::note(&record));
    record.notes.extend(limit.note());
    files::write_all(&options.out, &record, &showcase)?;
    Ok(record)
}

/// Quotes a path for a shell.
fn quoted(path: &Path) -> String {
    quote(&path.display().to_string())
}

/// Quotes an argument for a POSIX shell.
pub fn quote(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./+,=:@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', "'\\''"))
}
