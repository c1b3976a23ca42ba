//! The tables of the page: winners, slopes, times to errors, every point, and the conditions.

use super::analysis::{Analysis, MethodSlope};
use super::format::{
    asked_error, asked_seconds, error, own_error, own_error_of, percent, samples_taken, seconds, times,
};
use super::quote;
use super::record::{PointRecord, Question, Record};
use crate::lab::plot::html::{Html, code, html, scroll, section, table};

pub fn winners(record: &Record, analysis: &Analysis) -> Html {
    let row = |w: &super::results::Winner| {
        let about = if w.estimated { "about " } else { "" };
        let rmse = format!("{about}{}", own_error(w.rmse, w.interval));
        let names = std::iter::once(&w.method).chain(&w.ties).map(|name| method(record, name));
        let names = Html::join(names, " = ");
        vec![
            kept(&seconds(w.budget)),
            names,
            html!("{}", w.taken),
            kept(&rmse),
            kept(&format!("{} to {}", error(w.interval[0]), error(w.interval[1]))),
            kept(&seconds(w.seconds)),
        ]
    };
    let rows: Vec<Vec<Html>> = analysis.winners.iter().map(row).collect();
    let mut text = Html::default();
    if let Some(own) = record.reference.rmse {
        let told =
            "Errors are without that of the reference itself, whose square is subtracted. It is an RMSE of";
        let bound =
            "“under”: an error that cannot be told from none, as it is lost in the noise of the reference.";
        text = html!("<p>{} {}. {}</p>\n", told, error(own), bound);
    }
    if analysis.winners.iter().any(|w| w.estimated) {
        let about = "“about”: beyond what was measured of the method, along its fitted slope, up to four times its \
                     longest time and not below the reference's own error; only where it leads by more than noise and \
                     the slope leave open.";
        text = text + html!("<p>{}</p>\n", about);
    }
    if analysis.winners.iter().any(|w| !w.ties.is_empty()) {
        let ties = "“=”: the same picture, or errors whose difference has a 95 % interval that holds 0.";
        text = text + html!("<p>{}</p>\n", ties);
    }
    text + table(
        "The least error within each time",
        &["time", "winner", "a pixel takes", "RMSE", "95 % interval", "it takes"],
        &rows,
    )
}

pub fn slopes(record: &Record, analysis: &Analysis) -> Html {
    let row = |s: &MethodSlope| {
        let fitted = match s.fitted {
            None => String::new(),
            Some(f) => {
                let interval = f.half_width.map_or(String::new(), |h| format!(" ± {h:.2}"));
                minus(format!("{:.2}{interval}", f.value))
            }
        };
        let points = s.fitted.map_or("–".into(), |f| f.points.to_string());
        let noise = s.interval.map_or("–".into(), |[low, high]| minus(format!("{low:.2} to {high:.2}")));
        let texts = [fitted, points, noise, s.theory_text.clone(), lies_within(s)];
        std::iter::once(method(record, &s.method)).chain(texts.iter().map(|text| kept(text))).collect()
    };
    let fitted = analysis.slopes.iter().filter(|slope| slope.fitted.is_some());
    let rows: Vec<Vec<Html>> = fitted.map(row).collect();
    let short = analysis.slopes.iter().filter(|slope| slope.fitted.is_none());
    let short = folded(short.map(|slope| record.label(&slope.method)), "with too few points for a slope");
    let text = "The slope of the variance (RMSE²) over the rays, without that of the reference, fitted to the points \
                that err by more than the reference itself, with a 95 % interval by how far they lie from the line; and what noise alone \
                leaves open, by drawing parts of the picture anew (95 % of 2000 draws). Theory: independent samples \
                −1; jittered strata −1 where all of a pixel varies, −1.5 along one edge, −2 where it is smooth. A \
                scene that has all three has a slope between.";
    let head = ["method", "slope", "points", "noise leaves", "theory", "within it"];
    html!("<p>{}</p>\n", text) + table("Slopes", &head, &rows) + short
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

pub fn reach(record: &Record, analysis: &Analysis) -> Html {
    let heads: Vec<String> = analysis.reach.errors.iter().map(|e| error(*e)).collect();
    let head: Vec<&str> = std::iter::once("RMSE").chain(heads.iter().map(String::as_str)).collect();
    let row = |(name, cells): &(String, Vec<Option<f64>>)| {
        let cells = cells.iter().map(|c| kept(&c.map_or("–".into(), seconds)));
        std::iter::once(method(record, name)).chain(cells).collect()
    };
    let rows: Vec<Vec<Html>> = analysis.reach.methods.iter().map(row).collect();
    html!(
        "<p>{}</p>\n",
        "Interpolated between measured points, without the error of the reference; – where none is as good."
    ) + table("Seconds of rendering until the error falls to a value", &head, &rows)
}

pub fn points(record: &Record) -> Html {
    let row = |p: &PointRecord| {
        let e = &p.errors;
        let taken = [p.samples.to_string(), samples_taken(p)];
        let texts = [
            seconds(p.median_device_seconds()),
            error(e.rmse),
            own_error_of(p),
            error(e.relative_mse),
            error(e.max),
            percent(e.over_1_255),
            error(e.flip),
        ];
        let mut cells = vec![method(record, &p.method)];
        let fit = |text: &String| html!("<span class=\"fit\">{}</span>", text);
        cells.extend(taken.iter().map(fit));
        cells.push(html!("<span class=\"fit times\">{}</span>", times(p)));
        cells.extend(texts.iter().map(fit));
        cells
    };
    let head = [
        "method",
        "rays",
        "a pixel takes",
        "render",
        "device",
        "RMSE",
        "without the reference's",
        "relative MSE",
        "max",
        "over 1/255",
        "FLIP",
    ];
    let rows: Vec<Vec<Html>> = record.points.iter().map(row).collect();
    let compare = format!("moire compare point.exr {}", quote(&record.reference.file));
    let text = html!(
        "<p>Times are medians of the render stage with the least and the most of all repeats. The commands below \
         render points to <code>point.exr</code>; this compares one:</p>\n{}",
        scroll("Comparison with the reference", code(&compare))
    );
    let commands: Vec<&str> = record.points.iter().map(|p| p.command.as_str()).collect();
    let summary = html!("<summary>The commands of all points, in the same order</summary>\n");
    let commands = html!(
        "<details>{}{}</details>\n",
        summary,
        scroll("Commands of all points", code(&commands.join("\n")))
    );
    text + table("Every measured point", &head, &rows) + commands
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
    let left_out = |note: &&String| note.contains(" left out");
    let (omitted, notes): (Vec<&String>, Vec<&String>) = record.notes.iter().partition(left_out);
    facts.extend(notes.into_iter().map(|note| fact("note", note)));
    let omitted = folded(omitted.into_iter().map(String::as_str), "left out");
    let limits = serde_json::to_value(&c.device.limits).unwrap_or_default();
    let empty = serde_json::Map::new();
    let limits: Vec<Vec<Html>> = limits
        .as_object()
        .unwrap_or(&empty)
        .iter()
        .map(|(name, value)| fact(&name.replace('_', " "), &value.to_string()))
        .collect();
    html!(
        "{}{}<details><summary>Limits of the device</summary>\n{}</details>\n",
        table("How it was measured", &["what", "value"], &facts),
        omitted,
        table("Limits of the device", &["limit", "value"], &limits)
    )
}

/// Returns what answers the question of the study: the best point of each method, in order; a section of its own, or
/// nothing without a question.
pub fn answer(record: &Record) -> Html {
    let Some(question) = record.conditions.question else { return Html::default() };
    let ranking = question.ranking(&record.points);
    let row = |p: &&PointRecord| {
        vec![
            method(record, &p.method),
            kept(&own_error_of(p)),
            kept(&seconds(p.median_seconds())),
            html!("{}", samples_taken(p)),
        ]
    };
    let met: Vec<&PointRecord> = ranking.iter().copied().filter(|p| question.is_met_by(p)).collect();
    let rows: Vec<Vec<Html>> = met.iter().map(row).collect();
    let others = ranking.iter().filter(|p| !question.is_met_by(p)).map(|p| record.label(&p.method));
    let (heading, caption, short) = match question {
        Question::Budget(limit) => (
            format!("Best in {}", asked_seconds(limit)),
            "The least error of each method in that time, the best first",
            "whose shortest picture takes longer",
        ),
        Question::Error(limit) => (
            format!("Fastest to an RMSE of {}", asked_error(limit)),
            "The least time of each method to that error, the best first",
            "that did not come to that error",
        ),
    };
    let head = ["method", "RMSE", "render", "a pixel takes"];
    section("answer", &heading, long_or_empty(caption, &head, &rows) + folded(others, short))
}

fn long_or_empty(caption: &str, head: &[&str], rows: &[Vec<Html>]) -> Html {
    if rows.is_empty() { html!("<p>No measured point does that.</p>\n") } else { table(caption, head, rows) }
}

/// Returns names or notes in one line that opens; nothing if there are none.
fn folded<'a>(all: impl Iterator<Item = &'a str>, what: &str) -> Html {
    let all: Vec<&str> = all.collect();
    if all.is_empty() {
        return Html::default();
    }
    let items: Html = all.iter().map(|text| html!("<li>{}</li>\n", text)).collect();
    html!("<details><summary>{} {}</summary>\n<ul>\n{}</ul></details>\n", all.len().to_string(), what, items)
}

/// Returns a cell that is not broken into lines.
fn kept(text: &str) -> Html {
    html!("<span class=\"keep\">{}</span>", text)
}

/// Returns the name of a method; its word on the command line is the tooltip.
fn method(record: &Record, name: &str) -> Html {
    html!("<span title=\"{}\">{}</span>", name, record.label(name))
}
