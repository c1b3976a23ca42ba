//! The tables of the page: winners, slopes, times to errors, every point, and the conditions.

use super::analysis::{Analysis, MethodSlope};
use super::format::{error, percent, samples_taken, seconds, times};
use super::quote;
use super::record::{PointRecord, Record};
use crate::lab::plot::html::{Html, code, html, scroll, table};

pub fn winners(analysis: &Analysis) -> Html {
    let row = |w: &super::results::Winner| {
        let about = if w.estimated { "about " } else { "" };
        let rmse = format!("{about}{}", error(w.rmse));
        let names = std::iter::once(&w.method).chain(&w.ties).map(|name| method(name));
        let names = Html::join(names, " = ");
        vec![
            html!("{}", seconds(w.budget)),
            names,
            html!("{}", w.taken),
            html!("{}", rmse),
            html!("{}", seconds(w.seconds)),
        ]
    };
    let rows: Vec<Vec<Html>> = analysis.winners.iter().map(row).collect();
    let mut text = Html::default();
    if analysis.winners.iter().any(|w| w.estimated) {
        text =
            text + html!("<p>“about”: beyond what was measured of the method, along its fitted slope.</p>\n");
    }
    if analysis.winners.iter().any(|w| !w.ties.is_empty()) {
        let ties = "“=”: the same picture, or errors whose difference has a 95 % interval that holds 0.";
        text = text + html!("<p>{}</p>\n", ties);
    }
    text + table(
        "The least error within each time",
        &["time", "winner", "a pixel takes", "RMSE", "it takes"],
        &rows,
    )
}

pub fn slopes(analysis: &Analysis) -> Html {
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
        let texts = [fitted, points, noise, s.theory_text.clone(), lies_within(s)];
        std::iter::once(method(&s.method)).chain(texts.iter().map(|text| html!("{}", text))).collect()
    };
    let rows: Vec<Vec<Html>> = analysis.slopes.iter().map(row).collect();
    let text = "The slope of the variance (RMSE²) over the rays, fitted to the points that lie well above the \
                reference's own error, with a 95 % interval by how far they lie from the line; and what noise alone \
                leaves open, by drawing parts of the picture anew (95 % of 2000 draws). Theory: independent samples \
                −1; jittered strata −1 where all of a pixel varies, −1.5 along one edge, −2 where it is smooth. A \
                scene that has all three has a slope between.";
    let head = ["method", "slope", "points", "noise leaves", "theory", "within it"];
    html!("<p>{}</p>\n", text) + table("Slopes", &head, &rows)
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

pub fn reach(analysis: &Analysis) -> Html {
    let heads: Vec<String> = analysis.reach.errors.iter().map(|e| error(*e)).collect();
    let head: Vec<&str> = std::iter::once("RMSE").chain(heads.iter().map(String::as_str)).collect();
    let row = |(name, cells): &(String, Vec<Option<f64>>)| {
        let cells = cells.iter().map(|c| html!("{}", c.map_or("–".into(), seconds)));
        std::iter::once(method(name)).chain(cells).collect()
    };
    let rows: Vec<Vec<Html>> = analysis.reach.methods.iter().map(row).collect();
    html!("<p>Interpolated between measured points; – where none is as good.</p>\n")
        + table("Seconds of rendering until the error falls to a value", &head, &rows)
}

pub fn points(record: &Record) -> Html {
    let row = |p: &PointRecord| {
        let e = &p.errors;
        let texts = [
            p.samples.to_string(),
            samples_taken(p),
            times(p),
            seconds(p.median_device_seconds()),
            error(e.rmse),
            error(e.relative_mse),
            error(e.max),
            percent(e.over_1_255),
            error(e.flip),
        ];
        let mut cells = vec![method(&p.method)];
        cells.extend(texts.iter().map(|text| html!("{}", text)));
        cells.push(html!("<code>{}</code>", p.command));
        cells
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
    let rows: Vec<Vec<Html>> = record.points.iter().map(row).collect();
    let compare = format!("moire compare point.exr {}", quote(&record.reference.file));
    let text = html!(
        "<p>Times are medians of the render stage with the least and the most of all repeats. Each command renders \
         its point to <code>point.exr</code>; this compares it:</p>\n{}",
        scroll("Comparison with the reference", code(&compare))
    );
    text + table("Every measured point", &head, &rows)
}

pub fn conditions(record: &Record) -> Html {
    let c = &record.conditions;
    let reference = &record.reference;
    let own = match reference.rmse {
        Some(rmse) => format!("; it is itself off by an RMSE of {}", error(rmse)),
        None => "; how far off it is itself is not known".into(),
    };
    let fact = |what: &str, value: &str| vec![html!("{}", what), html!("{}", value)];
    let mut facts = vec![
        fact("device", &c.device.name),
        fact("driver", &c.device.driver),
        fact("Vulkan", &c.device.api_version),
        fact("program", &c.program),
        fact("scene", &c.scene),
        fact("size", &format!("{}×{}", c.size[0], c.size[1])),
        fact("seed", &c.seed.to_string()),
        fact("repeats", &format!("{}, interleaved", c.repeats)),
        fact("reference", &format!("{}{own}", reference.kind)),
    ];
    facts.extend(record.notes.iter().map(|note| fact("note", note)));
    let limits = serde_json::to_value(&c.device.limits).unwrap_or_default();
    let empty = serde_json::Map::new();
    let limits: Vec<Vec<Html>> = limits
        .as_object()
        .unwrap_or(&empty)
        .iter()
        .map(|(name, value)| fact(&name.replace('_', " "), &value.to_string()))
        .collect();
    html!(
        "{}<details><summary>Limits of the device</summary>\n{}</details>\n",
        table("How it was measured", &["what", "value"], &facts),
        table("Limits of the device", &["limit", "value"], &limits)
    )
}

fn method(name: &str) -> Html {
    html!("<code>{}</code>", name)
}
