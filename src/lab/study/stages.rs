//! A chart of the time by stage as SVG: one bar per method, for the count closest to the middle of
//! those requested. Bars far longer than most are cut.

use super::fit::median;
use super::format::{samples, seconds};
use super::record::{MethodRecord, PointRecord, Record};
use crate::lab::plot::svg;

/// Where bars are, and how rows follow each other.
struct Layout {
    width: f64,
    /// The left end of bars, and the right end of the longest.
    bar: [f64; 2],
    row: f64,
    /// From a row to its bar.
    drop: f64,
    /// The distance of the stages' names, and how many stand side by side.
    key: (f64, usize),
}

const WIDE: Layout = Layout { width: 800.0, bar: [290.0, 720.0], row: 26.0, drop: 0.0, key: (130.0, 5) };
/// Names are above bars.
const NARROW: Layout = Layout { width: 350.0, bar: [6.0, 280.0], row: 44.0, drop: 18.0, key: (110.0, 3) };
const KEY_ROW: f64 = 22.0;
const STAGES: [&str; 5] = ["pack", "upload", "compile", "render", "read back"];
/// Bars longer than this many times the median one are cut, so that the others can be read.
const LONGEST: f64 = 5.0;

/// Returns the document, and the one as narrow as a phone.
pub fn svgs(record: &Record) -> [String; 2] {
    [("stages", WIDE), ("stages-narrow", NARROW)].map(|(id, layout)| svg(record, id, &layout))
}

fn svg<'a>(record: &'a Record, id: &str, layout: &Layout) -> String {
    let counts = &record.conditions.counts;
    let middle = counts.get(counts.len() / 2).copied().unwrap_or(1);
    let nearest = |m: &'a MethodRecord| record.points_of(&m.name).min_by_key(|p| p.samples.abs_diff(middle));
    let rows: Vec<&PointRecord> = record.methods.iter().filter_map(nearest).collect();
    let all: Vec<f64> = rows.iter().map(|p| times(p).iter().sum()).collect();
    let longest = all.iter().copied().fold(1e-9, f64::max);
    let shown = longest.min(LONGEST * median(&all)).max(1e-9);
    let scale = (layout.bar[1] - layout.bar[0]) / shown;
    let mut body = String::new();
    let (apart, beside) = layout.key;
    for (i, stage) in STAGES.iter().enumerate() {
        let (x, y) = (6.0 + apart * (i % beside) as f64, 12.0 + KEY_ROW * (i / beside) as f64);
        body += &format!(
            "<rect x=\"{x}\" y=\"{y}\" width=\"14\" height=\"14\" class=\"f{}\"/>\n",
            color_index(i)
        );
        body += &svg::text(x + 20.0, y + 12.0, "start", "", stage);
    }
    let top = 22.0 + KEY_ROW * STAGES.len().div_ceil(beside) as f64;
    for (row, point) in rows.iter().enumerate() {
        let name = top + layout.row * row as f64;
        let y = name + layout.drop;
        let label = format!("{}, {}", record.label(&point.method), point.samples);
        let (at, anchor) = if layout.drop > 0.0 { (6.0, "start") } else { (layout.bar[0] - 8.0, "end") };
        body += &svg::text(at, name + 14.0, anchor, "small", &label);
        let mut x = layout.bar[0];
        for (i, time) in times(point).iter().enumerate() {
            let end = (x + time * scale).min(layout.bar[1]);
            body += &format!(
                "<rect x=\"{x:.1}\" y=\"{y}\" width=\"{:.2}\" height=\"18\" class=\"f{}\"><title>{}</title></rect>\n",
                end - x,
                color_index(i),
                svg::escape(&format!("{}: {} {}", record.label(&point.method), STAGES[i], seconds(*time)))
            );
            x = end;
        }
        if all[row] > shown * (1.0 + 1e-9) {
            // Two slanted gaps say that the bar goes on.
            for gap in [22.0, 14.0] {
                let from = layout.bar[1] - gap;
                body += &svg::line([from - 3.0, y + 19.0], [from + 3.0, y - 1.0], "cut");
            }
        }
        body += &svg::text(x + 6.0, y + 14.0, "start", "small", &seconds(all[row]));
    }
    let height = top + 10.0 + layout.row * rows.len() as f64;
    let description = format!(
        "Bars of wall time by stage for each method with about {}. The longest takes {}.",
        samples(middle),
        seconds(longest)
    );
    svg::document(id, [layout.width, height], "Time by stage", &description, &body)
}

fn times(point: &PointRecord) -> [f64; 5] {
    let s = point.stages;
    [s.pack, s.upload, s.compile, point.median_seconds(), s.readback]
}

/// Returns the colour index of a stage, such that neighbours differ in lightness too.
fn color_index(stage: usize) -> usize {
    [4, 5, 3, 0, 2][stage]
}
