//! A chart of the time by stage as SVG: one bar per method, for the count closest to the middle of
//! those requested.

use super::format::{samples, seconds};
use super::record::{MethodRecord, PointRecord, Record};
use crate::lab::plot::svg;

const WIDTH: f64 = 760.0;
const BAR: [f64; 2] = [230.0, 640.0];
const ROW: f64 = 26.0;
const STAGES: [&str; 5] = ["pack", "upload", "compile", "render", "read back"];

pub fn svg<'a>(record: &'a Record) -> String {
    let counts = &record.conditions.counts;
    let middle = counts.get(counts.len() / 2).copied().unwrap_or(1);
    let nearest = |m: &'a MethodRecord| record.points_of(&m.name).min_by_key(|p| p.samples.abs_diff(middle));
    let rows: Vec<&PointRecord> = record.methods.iter().filter_map(nearest).collect();
    let longest = rows.iter().map(|p| times(p).iter().sum()).fold(1e-9, f64::max);
    let scale = (BAR[1] - BAR[0]) / longest;
    let mut body = String::new();
    for (i, stage) in STAGES.iter().enumerate() {
        let x = 20.0 + 130.0 * i as f64;
        body +=
            &format!("<rect x=\"{x}\" y=\"12\" width=\"14\" height=\"14\" class=\"f{}\"/>\n", color_index(i));
        body += &svg::text(x + 20.0, 24.0, "start", "", stage);
    }
    for (row, point) in rows.iter().enumerate() {
        let y = 44.0 + ROW * row as f64;
        let label = format!("{}, {}", record.label(&point.method), point.samples);
        body += &svg::text(BAR[0] - 8.0, y + 14.0, "end", "small", &label);
        let mut x = BAR[0];
        for (i, time) in times(point).iter().enumerate() {
            let width = time * scale;
            body += &format!(
                "<rect x=\"{x:.1}\" y=\"{y}\" width=\"{width:.2}\" height=\"18\" class=\"f{}\"><title>{}</title></rect>\n",
                color_index(i),
                svg::escape(&format!("{}: {} {}", record.label(&point.method), STAGES[i], seconds(*time)))
            );
            x += width;
        }
        body += &svg::text(x + 6.0, y + 14.0, "start", "small", &seconds(times(point).iter().sum()));
    }
    let height = 56.0 + ROW * rows.len() as f64;
    let description = format!(
        "Bars of wall time by stage for each method with about {}. The longest takes {}.",
        samples(middle),
        seconds(longest)
    );
    svg::document("stages", [WIDTH, height], "Time by stage", &description, &body)
}

fn times(point: &PointRecord) -> [f64; 5] {
    let s = point.stages;
    [s.pack, s.upload, s.compile, point.median_seconds(), s.readback]
}

/// Returns the colour index of a stage, such that neighbours differ in lightness too.
fn color_index(stage: usize) -> usize {
    [4, 5, 3, 0, 2][stage]
}
