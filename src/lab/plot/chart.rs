//! A chart of error over time, rays or another quantity with logarithmic axes, as one SVG document:
//! series of points with a title each, a reference level, guide lines of known slope. Several series have their names at
//! the ends of their lines, and leading ones stand out from the rest.

use super::axis::Axis;
use super::labels::{Area, Label, area, place};
use super::svg;

/// The width of the document; the legend adds to its height.
const WIDTH: f64 = 760.0;
const PLOT: [[f64; 2]; 2] = [[78.0, 16.0], [744.0, 436.0]];
/// The width with names beside the plot, and the plot's right end then.
const NAMED_WIDTH: f64 = 870.0;
const NAMED_RIGHT: f64 = 690.0;
/// A level this far below all points is left out: it would leave half of the plot empty.
const FAR_LEVEL: f64 = 4.0;
/// Where along a guide its name stands.
const GUIDE_NAME: f64 = 0.55;
/// Half of a mark's side, with some air.
const MARK: f64 = 6.0;

pub struct Series {
    pub name: String,
    pub points: Vec<[f64; 2]>,
    /// The title of each point, shown as its tooltip.
    pub titles: Vec<String>,
    pub dashed: bool,
    pub role: Role,
}

/// How a series is told from the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// It is the only one.
    Alone,
    /// By a thick line in the colour of this number, of [`LEADERS`] at most, named at its end.
    Leader(usize),
    /// By its name alone, in grey.
    Other,
}

/// The number of colours of leading series.
pub const LEADERS: usize = 5;
/// The grey one.
const GREY: usize = 6;

impl Series {
    /// Returns the numbers of its colour and of its mark.
    fn look(&self) -> [usize; 2] {
        match self.role {
            Role::Alone => [0, 0],
            Role::Leader(color) => [color, color],
            Role::Other => [GREY, 0],
        }
    }

    /// Returns the radius of its marks.
    fn radius(&self) -> f64 {
        if self.role == Role::Other { 3.0 } else { 5.0 }
    }

    fn weight(&self) -> &'static str {
        match self.role {
            Role::Alone => "",
            Role::Leader(_) => " lead",
            Role::Other => " rest",
        }
    }
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
        let [[left, top], [right, bottom]] = self.plot();
        let points = || self.series.iter().flat_map(|s| &s.points);
        let level = self.level.filter(|level| self.is_near(level.0));
        let values = points().map(|p| p[1]).chain(level.map(|l| l.0));
        let [x, y] = if self.is_named() {
            [Axis::tight(points().map(|p| p[0]), left, right), Axis::tight(values, bottom, top)]
        } else {
            [Axis::new(points().map(|p| p[0]), left, right), Axis::new(values, bottom, top)]
        };
        let mut body = self.axes(&x, &y);
        let (guides, mut taken) = self.guide_lines(&x, &y);
        body += &guides;
        if let Some((value, name)) = level
            && let Some(at) = y.position(value)
        {
            body += &svg::line([left, at], [right, at], "level");
            body += &svg::text(left + 8.0, at - 5.0, "start", "small", name);
            taken.push(area([left + 8.0, at - 9.0], name));
        }
        // Leading ones lie above the others.
        let is_other = |series: &Series| series.role == Role::Other;
        for others in [true, false] {
            for series in self.series.iter().filter(|series| is_other(series) == others) {
                body += &drawn(series, &x, &y);
            }
        }
        if self.is_named() {
            let body = body + &self.names(&x, &y, taken);
            return svg::document(
                self.id,
                [NAMED_WIDTH, bottom + 58.0],
                &self.title,
                &self.description,
                &body,
            );
        }
        svg::document(self.id, [WIDTH, bottom + 58.0], &self.title, &self.description, &body)
    }

    /// Returns true if series are named at their ends.
    fn is_named(&self) -> bool {
        self.series.iter().any(|series| series.role != Role::Alone)
    }

    fn plot(&self) -> [[f64; 2]; 2] {
        let [from, [right, bottom]] = PLOT;
        [from, [if self.is_named() { NAMED_RIGHT } else { right }, bottom]]
    }

    fn is_near(&self, level: f64) -> bool {
        let values = self.series.iter().flat_map(|s| &s.points).map(|p| p[1]).filter(|v| *v > 0.0);
        !self.is_named() || level * FAR_LEVEL >= values.fold(f64::INFINITY, f64::min)
    }

    /// Returns the names at the ends of lines, those of leading series first; each switches its series.
    fn names(&self, x: &Axis, y: &Axis, mut taken: Vec<Area>) -> String {
        let mut order: Vec<&Series> = self.series.iter().collect();
        order.sort_by_key(|series| series.role == Role::Other);
        let placed = |p: &[f64; 2]| Some([x.position(p[0])?, y.position(p[1])?]);
        let end = |series: &Series| {
            let ends = series.points.iter().filter_map(placed);
            ends.max_by(|a, b| a[0].total_cmp(&b[0]))
        };
        let named: Vec<(&Series, [f64; 2])> =
            order.into_iter().filter_map(|series| Some((series, end(series)?))).collect();
        let labels: Vec<Label<'_>> =
            named.iter().map(|(s, end)| Label { text: &s.name, end: *end }).collect();
        let marks = self.series.iter().flat_map(|series| &series.points).filter_map(placed);
        taken.extend(marks.map(|[px, py]| [px - MARK, py - MARK, px + MARK, py + MARK]));
        let [[left, top], [_, bottom]] = self.plot();
        let places = place(&labels, [left, top, NAMED_WIDTH - 4.0, bottom], &taken);
        let mut out = String::new();
        for ((series, end), placed) in named.iter().zip(places) {
            let [px, py] = placed.at;
            let lead = if placed.is_led { svg::line(*end, [px - 2.0, py], "leader") } else { String::new() };
            let class = format!("small name t{}{}", series.look()[0], series.weight());
            let text = svg::text(px, py + 4.0, "start", &class, &series.name);
            let name = svg::escape(&series.name);
            out += &format!("<g class=\"key series\" data-series=\"{name}\">{lead}{text}</g>\n");
        }
        out
    }

    fn axes(&self, x: &Axis, y: &Axis) -> String {
        let [[left, top], [right, bottom]] = self.plot();
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
        if self.is_named() {
            // Names cross the right end.
            out += &svg::line([left, top], [left, bottom], "axis");
            out += &svg::line([left, bottom], [right, bottom], "axis");
        } else {
            out += &format!(
                "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n",
                right - left,
                bottom - top
            );
        }
        out += &svg::text(0.5 * (left + right), bottom + 40.0, "middle", "", self.x_label);
        let middle = 0.5 * (top + bottom);
        out + &format!(
            "<text transform=\"translate(18 {middle}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            svg::escape(self.y_label)
        )
    }

    /// Draws the guides from the plot's upper left downwards, as far as the frame extends.
    fn guide_lines(&self, x: &Axis, y: &Axis) -> (String, Vec<Area>) {
        let (mut out, mut taken) = (String::new(), Vec::new());
        let start = (y.high / y.low).powf(0.93) * y.low;
        for (slope, name) in &self.guides {
            let reach = (y.low / start).powf(1.0 / slope);
            let end = x.high.min(x.low * reach);
            let at = |v: f64| [x.at(v), y.at(start * (v / x.low).powf(*slope))];
            out += &svg::line(at(x.low), at(end), "guide");
            // Away from the right end, where lines have their names.
            let [px, py] = at(x.low * (end / x.low).powf(GUIDE_NAME));
            out += &svg::text(px, py + 4.0, "middle", "small name", name);
            let half = area([0.0, 0.0], name)[2] / 2.0;
            taken.push(area([px - half, py], name));
        }
        (out, taken)
    }
}

fn line(path: &str, series: &Series) -> String {
    let dashes = if series.dashed { " stroke-dasharray=\"6 4\"" } else { "" };
    let class = format!("line s{}{}", series.look()[0], series.weight());
    format!("<path d=\"{path}\" class=\"{class}\"{dashes}/>\n")
}

fn drawn(series: &Series, x: &Axis, y: &Axis) -> String {
    let placed = |p: &[f64; 2]| Some([x.position(p[0])?, y.position(p[1])?]);
    let shown: Vec<([f64; 2], &String)> =
        series.points.iter().zip(&series.titles).filter_map(|(p, t)| Some((placed(p)?, t))).collect();
    let mut out = format!("<g class=\"series\" data-series=\"{}\">\n", svg::escape(&series.name));
    if shown.len() > 1 {
        let steps: Vec<String> = shown.iter().map(|([px, py], _)| format!("{px:.1} {py:.1}")).collect();
        out += &line(&format!("M{}", steps.join("L")), series);
    }
    for (at, title) in shown {
        out += &svg::marker(series.look(), at, series.radius(), title);
    }
    out + "</g>\n"
}
