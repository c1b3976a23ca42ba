//! A chart of error over time, rays or another quantity with logarithmic axes, as one SVG document:
//! series of points with a title each, a reference level, guide lines of known slope, and a legend
//! below the plot if there are several series.

use super::axis::Axis;
use super::svg;

/// The width of the document; the legend adds to its height.
const WIDTH: f64 = 760.0;
const PLOT: [[f64; 2]; 2] = [[78.0, 16.0], [744.0, 436.0]];
const KEY_COLUMNS: usize = 2;
const KEY_ROW: f64 = 22.0;

pub struct Series {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// The title of each point, shown as its tooltip.
    pub titles: Vec<String>,
    pub dashed: bool,
}

pub struct Chart<'a> {
    /// The identifier, unique in a page.
    pub id: &'a str,
    pub title: String,
    pub description: String,
    pub x_label: &'a str,
    pub y_label: &'a str,
    pub series: Vec<Series>,
    /// A horizontal line with its label: a bound, or the error below which points are not
    /// significant.
    pub level: Option<(f64, &'static str)>,
    /// Guide slopes in the plot's logarithms, with labels.
    pub guides: Vec<(f64, &'static str)>,
}

impl Chart<'_> {
    pub fn svg(&self) -> String {
        let [[left, top], [right, bottom]] = PLOT;
        let points = || self.series.iter().flat_map(|s| &s.points);
        let x = Axis::new(points().map(|p| p[0]), left, right);
        let y = Axis::new(points().map(|p| p[1]).chain(self.level.map(|l| l.0)), bottom, top);
        let mut body = self.axes(&x, &y);
        body += &self.guide_lines(&x, &y);
        if let Some((value, name)) = self.level
            && let Some(at) = y.position(value)
        {
            body += &svg::line([left, at], [right, at], "level");
            body += &svg::text(left + 8.0, at - 5.0, "start", "small", name);
        }
        for (index, series) in self.series.iter().enumerate() {
            body += &drawn(series, index, &x, &y);
        }
        let (key, height) = self.key(bottom + 58.0);
        svg::document(self.id, [WIDTH, height], &self.title, &self.description, &(body + &key))
    }

    fn axes(&self, x: &Axis, y: &Axis) -> String {
        let [[left, top], [right, bottom]] = PLOT;
        let mut out = String::new();
        for (at, number) in x.ticks() {
            out += &svg::line([at, top], [at, bottom], "grid");
            if let Some(number) = number {
                out += &svg::text(at, bottom + 18.0, "middle", "small", &number);
            }
        }
        for (at, number) in y.ticks() {
            out += &svg::line([left, at], [right, at], "grid");
            if let Some(number) = number {
                out += &svg::text(left - 7.0, at + 4.0, "end", "small", &number);
            }
        }
        out += &format!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n",
            right - left,
            bottom - top
        );
        out += &svg::text(0.5 * (left + right), bottom + 40.0, "middle", "", self.x_label);
        let middle = 0.5 * (top + bottom);
        out + &format!(
            "<text transform=\"translate(18 {middle}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            svg::escape(self.y_label)
        )
    }

    /// Draws the guides from the plot's upper left downwards, as far as the frame extends.
    fn guide_lines(&self, x: &Axis, y: &Axis) -> String {
        let mut out = String::new();
        let start = (y.high / y.low).powf(0.93) * y.low;
        for (slope, name) in &self.guides {
            let reach = (y.low / start).powf(1.0 / slope);
            let end = x.high.min(x.low * reach);
            let at = |v: f64| [x.at(v), y.at(start * (v / x.low).powf(*slope))];
            out += &svg::line(at(x.low), at(end), "guide");
            let [px, py] = at(end);
            out += &svg::text(px - 7.0, py - 7.0, "end", "small", name);
        }
        out
    }

    /// Returns the legend and the document's height. One series needs no legend.
    fn key(&self, from: f64) -> (String, f64) {
        if self.series.len() == 1 {
            return (String::new(), from);
        }
        let rows = self.series.len().div_ceil(KEY_COLUMNS);
        let width = (PLOT[1][0] - PLOT[0][0]) / KEY_COLUMNS as f64;
        let mut out = String::new();
        for (index, series) in self.series.iter().enumerate() {
            let px = PLOT[0][0] + width * (index / rows) as f64;
            let py = from + KEY_ROW * (index % rows) as f64 + 8.0;
            let line = line(&format!("M{px:.1} {py:.1}h34"), series, index);
            let marker = svg::marker(index, [px + 17.0, py], "");
            let name = svg::text(px + 44.0, py + 4.5, "start", "", &series.name);
            out += &format!(
                "<g class=\"key series\" data-series=\"{}\">{line}{marker}{name}</g>\n",
                svg::escape(&series.name)
            );
        }
        (out, from + KEY_ROW * rows as f64 + 8.0)
    }
}

fn line(path: &str, series: &Series, index: usize) -> String {
    let dashes = if series.dashed { " stroke-dasharray=\"6 4\"" } else { "" };
    format!("<path d=\"{path}\" class=\"line s{}\"{dashes}/>\n", svg::color(index))
}

fn drawn(series: &Series, index: usize, x: &Axis, y: &Axis) -> String {
    let placed = |p: &[f64; 2]| Some([x.position(p[0])?, y.position(p[1])?]);
    let shown: Vec<([f64; 2], &String)> =
        series.points.iter().zip(&series.titles).filter_map(|(p, t)| Some((placed(p)?, t))).collect();
    let mut out = format!("<g class=\"series\" data-series=\"{}\">\n", svg::escape(&series.name));
    if shown.len() > 1 {
        let steps: Vec<String> = shown.iter().map(|([px, py], _)| format!("{px:.1} {py:.1}")).collect();
        out += &line(&format!("M{}", steps.join("L")), series, index);
    }
    for (at, title) in shown {
        out += &svg::marker(index, at, title);
    }
    out + "</g>\n"
}
