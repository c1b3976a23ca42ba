//! The tables of the page: winners, slopes, times to errors, every point, and the conditions.

use super::analysis::{Analysis, MethodSlope};
use super::format::{error, percent, samples_taken, seconds, times};
use super::quote;
use super::record::{PointRecord, Record};
use crate::lab::plot::html::{code, scroll, table};
use crate::lab::plot::svg::escape;

pub fn winners(analysis: &Analysis) -> String {
    let row = |w: &super::analysis::Winner| {
        let about = if w.estimated { "about " } else { "" };
        let rmse = format!("{about}{}", error(w.rmse));
        let names = std::iter::once(&w.method).chain(&w.ties).map(|name| method(name));
        let names = names.collect::<Vec<_>>().join(" = ");
        vec![seconds(w.budget), names, escape(&w.taken), rmse, seconds(w.seconds)]
    };
    let rows: Vec<Vec<String>> = analysis.winners.iter().map(row).collect();
    let mut text = String::new();
    if analysis.winners.iter().any(|w| w.estimated) {
        text += "<p>“about”: beyond what was measured of the method, along its fitted slope.</p>\n";
    }
    if analysis.winners.iter().any(|w| !w.ties.is_empty()) {
        text +=
            "<p>“=”: the same picture, or errors whose difference has a 95 % interval that holds 0.</p>\n";
    }
    text + &table(
        "The least error within each time",
        &["time", "winner", "a pixel takes", "RMSE", "it takes"],
        &rows,
    )
}

pub fn slopes(analysis: &Analysis) -> String {
    let row = |s: &MethodSlope| {
        let fitted = match s.fitted {
            None => "too few points".into(),
            Some(f) => {
                let interval = f.half_width.map_or(String::new(), |h| format!(" ± {h:.2}"));
                minus(format!("{:.2}{interval}", f.value))
            }
        };
        let points = s.fitted.map_or("–".into(), |f| f.points.to_string());
        let noise = s.interval.map_or("–".into(), |[low, high]| minus(format!("{low:.2} to {high:.2}")));
        vec![method(&s.method), fitted, points, noise, escape(&s.theory_text), lies_within(s)]
    };
    let rows: Vec<Vec<String>> = analysis.slopes.iter().map(row).collect();
    let text = "<p>The slope of the variance (RMSE²) over the rays, fitted to the points that lie well above the \
                reference's own error, with a 95 % interval by how far they lie from the line; and what noise alone \
                leaves open, by drawing parts of the picture anew (95 % of 2000 draws). Theory: independent samples \
                −1; jittered strata −1 where all of a pixel varies, −1.5 along one edge, −2 where it is smooth. A \
                scene that has all three has a slope between.</p>\n";
    let head = ["method", "slope", "points", "noise leaves", "theory", "within it"];
    text.to_owned() + &table("Slopes", &head, &rows)
}

fn minus(text: String) -> String {
    text.replace('-', "−")
}

/// Returns the theoretical slopes that lie within the wider of both intervals.
fn lies_within(slope: &MethodSlope) -> String {
    let Some(fitted) = slope.fitted else { return "–".into() };
    let own = fitted.half_width.unwrap_or(0.0);
    let [low, high] = slope.interval.unwrap_or([fitted.value; 2]);
    let [low, high] = [low.min(fitted.value - own), high.max(fitted.value + own)];
    let held: Vec<String> =
        slope.theory.iter().filter(|t| (low..=high).contains(*t)).map(|t| minus(t.to_string())).collect();
    if held.is_empty() { "none".into() } else { held.join(", ") }
}

pub fn reach(analysis: &Analysis) -> String {
    let heads: Vec<String> = analysis.reach.errors.iter().map(|e| error(*e)).collect();
    let head: Vec<&str> = std::iter::once("RMSE").chain(heads.iter().map(String::as_str)).collect();
    let row = |(name, cells): &(String, Vec<Option<f64>>)| {
        let cells = cells.iter().map(|c| c.map_or("–".into(), seconds));
        std::iter::once(method(name)).chain(cells).collect()
    };
    let rows: Vec<Vec<String>> = analysis.reach.methods.iter().map(row).collect();
    let text = "<p>Interpolated between measured points; – where none is as good.</p>\n";
    text.to_owned() + &table("Seconds of rendering until the error falls to a value", &head, &rows)
}

pub fn points(record: &Record) -> String {
    let row = |p: &PointRecord| {
        let e = &p.errors;
        vec![
            method(&p.method),
            p.samples.to_string(),
            escape(&samples_taken(p)),
            times(p),
            seconds(p.median_device_seconds()),
            error(e.rmse),
            error(e.relative_mse),
            error(e.max),
            percent(e.over_1_255),
            error(e.flip),
            format!("<code>{}</code>", escape(&p.command)),
        ]
    };
    let head = [
        "method",
        "rays",
        "a pixel takes",
        "render",
        "device",
        "RMSE",
        "relative MSE",
        "max",
        "over 1/255",
        "FLIP",
        "command",
    ];
    let rows: Vec<Vec<String>> = record.points.iter().map(row).collect();
    let compare = format!("moire compare point.exr {}", quote(&record.reference.file));
    let text = format!(
        "<p>Times are medians of the render stage with the least and the most of all repeats. Each command renders \
         its point to <code>point.exr</code>; this compares it:</p>\n{}",
        scroll("Comparison with the reference", &code(&compare))
    );
    text + &table("Every measured point", &head, &rows)
}

pub fn conditions(record: &Record) -> String {
    let c = &record.conditions;
    let reference = &record.reference;
    let own = match reference.rmse {
        Some(rmse) => format!("; it is itself off by an RMSE of {}", error(rmse)),
        None => "; how far off it is itself is not known".into(),
    };
    let mut facts = vec![
        vec!["device".into(), escape(&c.device.name)],
        vec!["driver".into(), escape(&c.device.driver)],
        vec!["Vulkan".into(), escape(&c.device.api_version)],
        vec!["program".into(), escape(&c.program)],
        vec!["scene".into(), escape(&c.scene)],
        vec!["size".into(), format!("{}×{}", c.size[0], c.size[1])],
        vec!["seed".into(), c.seed.to_string()],
        vec!["repeats".into(), format!("{}, interleaved", c.repeats)],
        vec!["reference".into(), escape(&format!("{}{own}", reference.kind))],
    ];
    facts.extend(record.notes.iter().map(|note| vec!["note".into(), escape(note)]));
    let limits = serde_json::to_value(&c.device.limits).unwrap_or_default();
    let empty = serde_json::Map::new();
    let limits: Vec<Vec<String>> = limits
        .as_object()
        .unwrap_or(&empty)
        .iter()
        .map(|(name, value)| vec![escape(&name.replace('_', " ")), escape(&value.to_string())])
        .collect();
    format!(
        "{}<details><summary>Limits of the device</summary>\n{}</details>\n",
        table("How it was measured", &["what", "value"], &facts),
        table("Limits of the device", &["limit", "value"], &limits)
    )
}

fn method(name: &str) -> String {
    format!("<code>{}</code>", escape(name))
}
