//! Writes the folder of a study: `study.csv`, `study.json`, three plots and the page. Each file
//! appears complete or not at all.

use std::path::Path;

use crate::core::error::{Error, Result};
use crate::lab::plot::chart::{Chart, LEADERS, Role, Series};
use crate::output;

use super::choice::leaders;
use super::format::{error, samples_taken, seconds};
use super::page::Plots;
use super::record::{self, PointRecord, Record};
use super::showcase::Showcase;
use super::{page, stages};

/// Every file but the record and the reference.
pub const NAMES: [&str; 5] = ["study.csv", "error-time.svg", "error-rays.svg", "stages.svg", "index.html"];

/// Saves the record from which an interrupted study is resumed.
pub fn save(folder: &Path, record: &Record) -> Result<()> {
    let json =
        serde_json::to_string_pretty(record).map_err(|e| Error::new(format!("the study as JSON: {e}")))?;
    output::write_file(&folder.join(record::FILE), json.as_bytes())
}

pub fn write_all(folder: &Path, record: &Record, showcase: &Showcase) -> Result<()> {
    let plots = Plots::new(record);
    let page = page::html(record, showcase, &plots)?;
    save(folder, record)?;
    let [time, rays, stages] = [&plots.time[0], &plots.rays[0], &plots.stages[0]].map(String::clone);
    for (name, text) in NAMES.into_iter().zip([csv(record), time, rays, stages, page]) {
        output::write_file(&folder.join(name), text.as_bytes())?;
    }
    Ok(())
}

impl Plots {
    pub fn new(record: &Record) -> Plots {
        // Points below it are not significant.
        let own = record.reference.rmse.filter(|e| *e > 0.0).map(|e| (e, "the reference's own error"));
        let chart = |id, title: &str, x_label, x: &dyn Fn(&PointRecord) -> f64, guides| Chart {
            id,
            title: String::from(title),
            description: description(record, x_label),
            x_label,
            y_label: "RMSE (linear light)",
            series: series(record, x),
            level: own,
            guides,
        };
        let time =
            chart("error-time", "Error over time", "seconds of rendering", &|p| p.median_seconds(), vec![]);
        // Slopes of the RMSE are half of the variance's.
        let guides = vec![(-0.5, "variance −1"), (-0.75, "−1.5"), (-1.0, "−2")];
        let rays = |p: &PointRecord| f64::from(p.samples);
        let rays = chart("error-rays", "Error over rays", "camera rays a pixel", &rays, guides);
        let both = |chart: Chart<'_>| [chart.svg(), chart.narrow_svg()];
        Plots { time: both(time), rays: both(rays), stages: stages::svgs(record) }
    }
}

fn series(record: &Record, x: &dyn Fn(&PointRecord) -> f64) -> Vec<Series> {
    let leaders = leaders(record, LEADERS);
    let of = |m: &record::MethodRecord| {
        let points: Vec<&PointRecord> = record.points_of(&m.name).collect();
        let title = |p: &&PointRecord| {
            format!(
                "{}, {}: RMSE {} in {}",
                m.label,
                samples_taken(p),
                error(p.errors.rmse),
                seconds(p.median_seconds())
            )
        };
        let place = leaders.iter().position(|leader| *leader == m.name);
        Series {
            name: m.label.clone(),
            role: place.map_or(Role::Other, Role::Leader),
            points: points.iter().map(|p| [x(p), p.errors.rmse]).collect(),
            titles: points.iter().map(title).collect(),
            dashed: m.footprint != "none",
        }
    };
    record.methods.iter().map(of).filter(|s| !s.points.is_empty()).collect()
}

/// Returns a text description of a plot for screen readers.
fn description(record: &Record, over: &str) -> String {
    let best = |m: &record::MethodRecord| {
        let least = record.points_of(&m.name).min_by(|a, b| a.errors.rmse.total_cmp(&b.errors.rmse))?;
        Some(format!(
            "{} reaches {} with {} in {}",
            m.label,
            error(least.errors.rmse),
            samples_taken(least),
            seconds(least.median_seconds())
        ))
    };
    let all: Vec<String> = record.methods.iter().filter_map(best).collect();
    format!("Root mean square error over {over}, both logarithmic, by method. {}.", all.join("; "))
}

const COLUMNS: &str = "method,algorithm,pattern,footprint,filter,spp,rays_per_pixel,sampled,repeats,\
render_seconds,render_seconds_min,render_seconds_max,device_seconds,pack_seconds,upload_seconds,\
compile_seconds,readback_seconds,rmse,own_rmse,own_rmse_low,own_rmse_high,relative_mse,max,over_1_255,flip,command";

fn csv(record: &Record) -> String {
    let mut out = format!("{COLUMNS}\n");
    for method in &record.methods {
        for p in record.points_of(&method.name) {
            let least = p.seconds.iter().copied().fold(f64::INFINITY, f64::min);
            let most = p.seconds.iter().copied().fold(0.0, f64::max);
            let (s, e) = (&p.stages, &p.errors);
            let words = [
                &method.name,
                &method.algorithm,
                &method.pattern,
                &method.footprint,
                method.filter.as_deref().unwrap_or(""),
            ];
            let words = words.map(|w: &str| field(w)).join(",");
            let sampled = p.sampled.map_or(String::new(), |part| part.to_string());
            let counts = format!("{},{},{sampled},{}", p.spp, p.samples, p.seconds.len());
            let times = [
                p.median_seconds(),
                least,
                most,
                p.median_device_seconds(),
                s.pack,
                s.upload,
                s.compile,
                s.readback,
            ];
            let own = p.own();
            let errors = [e.rmse, own.rmse, own.low, own.high, e.relative_mse, e.max, e.over_1_255, e.flip];
            let numbers: Vec<String> = times.iter().chain(&errors).map(|v| format!("{v:.6e}")).collect();
            out += &format!("{words},{counts},{},{}\n", numbers.join(","), field(&p.command));
        }
    }
    out
}

/// Quotes a CSV field by RFC 4180.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
