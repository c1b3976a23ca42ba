//! The opening pictures of the page: the scene with the lecture's three artefacts and their
//! remedies at one sample count, with errors, and a crop where they differ most. Nothing here is
//! timed.

use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::lab::metrics::compare;
use crate::scene::model::{Algorithm, Pattern, Scene};

use super::choice::chosen as best_of;
use super::format::samples_taken_by;
use super::limit::Limit;
use super::method::Method;
use super::pictures::{self, Window};
use super::plan::next_count;
use super::record::{MethodRecord, Record};
use super::session_cache::{SessionCache, sampled_part};
use crate::core::counted::{counted, verb};

/// The pixels along a side of the magnified crops.
const CROP: u32 = 64;
pub const SAMPLES: u32 = 16;

pub struct Panel {
    pub heading: &'static str,
    pub text: &'static str,
    /// The method as a person calls it.
    pub method: String,
    pub is_recommended: bool,
    /// The samples per pixel as text.
    pub taken: String,
    pub film: Film,
    pub rmse: f64,
}

pub struct Showcase {
    pub panels: Vec<Panel>,
    pub reference: Film,
    pub window: Window,
    /// The number of panels omitted for lack of time.
    left_out: usize,
}

impl Showcase {
    pub fn note(&self, limit: &Limit) -> Option<String> {
        let (count, seconds) = (self.left_out, limit.seconds);
        let pictures = counted(count, "picture");
        let was = verb(count, "was", "were");
        (count > 0)
            .then(|| format!("{pictures} of the page {was} left out: no room within --seconds {seconds}"))
    }
}

/// Returns the caption of an algorithm; `sampled` is the fraction of the pixels in which beams were sampled.
fn caption(algorithm: Algorithm, sampled: Option<f64>) -> &'static str {
    match (algorithm, sampled.unwrap_or(0.0)) {
        (Algorithm::Samples, _) => "The same number of samples in every pixel.",
        (Algorithm::Adaptive, _) => "More samples where the first ones differ, fewer where they agree.",
        (Algorithm::Beam, 0.0) => {
            "Each pixel is one region of rays, cut by the shapes that it meets: no samples, no grain."
        }
        (Algorithm::Beam, 1.0) => {
            "No pixel of this scene can be resolved by a beam: all are sampled as without."
        }
        (Algorithm::Beam, _) => {
            "Each pixel is one region of rays, cut by the shapes that it meets; where that cannot be done it is sampled."
        }
        (Algorithm::Cone, _) => {
            "Each pixel is one cone, over whose width shapes and textures are averaged: no grain, some blur."
        }
        (Algorithm::Auto, _) => "The program chooses the algorithm.",
    }
}

/// Heading, caption and pattern of the artefacts and the first remedy.
const PATTERNS: [(&str, &str, Pattern); 4] = [
    (
        "Jaggies",
        "Every ray through the pixel's centre: stairs along edges, false waves where detail is fine.",
        Pattern::Center,
    ),
    (
        "Regular patterns",
        "The same grid in every pixel: fewer stairs, but what is left repeats and stands out.",
        Pattern::Grid,
    ),
    (
        "Noise",
        "Independent random places: no pattern, and grain that falls only with the root of the count.",
        Pattern::Random,
    ),
    (
        "Stratified jitter",
        "One random place in each cell of a grid: no pattern, and less grain at the same cost.",
        Pattern::Stratified,
    ),
];
const FILTERED: (&str, &str) =
    ("Filtering", "Each sample reads its texture averaged over its share of the pixel: no grain, some blur.");
const ALGORITHM: &str = "Another algorithm";
const WINNER: (&str, &str) =
    ("The recommended method", "It has the least error within most of the times that were measured.");
const ANSWER: (&str, &str) =
    ("The recommended setting", "It answers what was asked, with as many samples as that needs.");

pub fn render(
    sessions: &SessionCache<'_>,
    scene: &Scene,
    record: &Record,
    reference: &Film,
    limit: &Limit,
    progress: &dyn Progress,
) -> Result<Showcase> {
    let distance = |n: &u32| (f64::from(*n).ln() - f64::from(SAMPLES).ln()).abs();
    let counts = record.conditions.counts.iter();
    let count = counts.copied().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(SAMPLES);
    let mut chosen: Vec<(&str, &str, Method)> =
        PATTERNS.iter().map(|&(h, t, p)| (h, t, Method::of_pattern(p))).collect();
    let named = |m: &MethodRecord| Method::parse(&m.name).ok();
    if let Some(method) = best(record, count, |m| m.footprint != "none").and_then(named) {
        chosen.push((FILTERED.0, FILTERED.1, method));
    }
    for method in record.methods.iter().filter_map(named).filter(|m| m.algorithm != Algorithm::Samples) {
        chosen.push((ALGORITHM, "", method));
    }
    let winner = record.analysis.as_ref().and_then(|a| best_of(record, &a.winners));
    let winning = winner.and_then(|point| Method::parse(&point.method).ok());
    let asked = record.conditions.question.and(winner);
    if let Some(method) = winning.clone()
        && (asked.is_some() || !chosen.iter().any(|c| c.2 == method))
    {
        let (heading, text) = if asked.is_some() { ANSWER } else { WINNER };
        chosen.push((heading, text, method));
    }
    let still = SubProgress { whole: progress, from: 1.0, to: 1.0 };
    let mut panels: Vec<Panel> = Vec::new();
    let mut left_out = 0;
    for (heading, text, method) in chosen.into_iter().filter(|c| sessions.has(&c.2)) {
        let name = method.name();
        // A picture of a point that is in the tables, if there is one.
        let measured = record.points_of(&name).min_by_key(|p| p.spp.abs_diff(count)).map(|p| p.spp);
        let measured = asked.filter(|_| heading == ANSWER.0).map(|point| point.spp).or(measured);
        let count = measured.unwrap_or(count);
        let Some(spp) = next_count(method.pattern_in(scene), count) else { continue };
        let is_recommended = match asked {
            Some(_) => heading == ANSWER.0,
            None => winning.as_ref() == Some(&method),
        };
        // The first panel is always rendered.
        let seconds = if panels.is_empty() { f64::INFINITY } else { limit.seconds };
        if limit.spent() >= seconds {
            left_out += 1;
            continue;
        }
        let drawn =
            limit.until(seconds, &still, |still| sessions.prepare(scene, &method, spp)?.0.render(still))?;
        let Some((film, report)) = drawn else {
            left_out += 1;
            continue;
        };
        let sampled = sampled_part(method.algorithm, &report, film.pixels.len());
        let spp = if method.algorithm == Algorithm::Beam { spp } else { film.samples };
        let taken = samples_taken_by(method.algorithm, spp, sampled);
        let rmse = compare(&film, reference)?.rmse;
        let text = if text.is_empty() { caption(method.algorithm, sampled) } else { text };
        let method = method.label(scene.sampling.pattern);
        panels.push(Panel { heading, text, method, is_recommended, taken, film, rmse });
    }
    let films: Vec<(&Film, f64)> = panels.iter().map(|p| (&p.film, p.rmse)).collect();
    let window = pictures::worst_window(&films, reference, CROP);
    Ok(Showcase { panels, reference: reference.clone(), window, left_out })
}

/// Returns the method with the smallest error at about this count.
fn best(record: &Record, count: u32, such: impl Fn(&MethodRecord) -> bool) -> Option<&MethodRecord> {
    let error = |m: &&MethodRecord| {
        let points = record.points_of(&m.name);
        let nearest = points.min_by_key(|p| p.samples.abs_diff(count));
        nearest.map_or(f64::INFINITY, |p| p.errors.rmse)
    };
    record.methods.iter().filter(|m| such(m)).min_by(|a, b| error(a).total_cmp(&error(b)))
}
