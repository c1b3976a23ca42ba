//! A chart of error over time, rays or another quantity with logarithmic axes, as one SVG document:
//! series of points with a title each, a reference level, guide lines of known slope. Several series have their names at
//! the ends of their lines, and leading ones stand out from the rest. A narrow chart, for a phone, has the names of the
//! leading ones below.

use super::axis::Axis;
use super::labels::{Label, Obstacles, area, place};
use super::svg;

/// Where things are in the document.
struct Layout {
    width: f64,
    /// The upper left and the lower right end of the plot.
    plot: [[f64; 2]; 2],
    /// The largest numbers of labels along x and y.
    labels: [usize; 2],
    /// The left end of the y axis's name.
    y_name: f64,
}

const ALONE: Layout =
    Layout { width: 760.0, plot: [[78.0, 16.0], [744.0, 436.0]], labels: [10, 10], y_name: 18.0 };
/// With names beside the plot.
const NAMED: Layout = Layout { width: 870.0, plot: [[78.0, 16.0], [690.0, 436.0]], ..ALONE };
const NARROW: Layout =
    Layout { width: 350.0, plot: [[62.0, 10.0], [340.0, 330.0]], labels: [5, 10], y_name: 14.0 };
/// The height of a name below a narrow plot.
const KEY_ROW: f64 = 20.0;
/// A level this far below all points is left out: it would leave half of the plot empty.
const FAR_LEVEL: f64 = 4.0;
/// Where along a guide its name may stand: away from the right end, where lines have their names.
const GUIDE_NAMES: [f64; 13] = [0.55, 0.5, 0.6, 0.45, 0.65, 0.4, 0.7, 0.35, 0.3, 0.75, 0.25, 0.8, 0.15];
/// How far above or below its guide a name may stand, and what a pixel of that counts as.
const OFF_GUIDE: [f64; 5] = [0.0, -11.0, 11.0, -18.0, 18.0];
const OFF_GUIDE_COST: f64 = 0.1;
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
    /// Returns the document.
    pub fn svg(&self) -> String {
        let layout = if self.is_named() { NAMED } else { ALONE };
        let (body, obstacles, [x, y]) = self.body(&layout);
        let names = if self.is_named() { self.names(&layout, [&x, &y], obstacles) } else { String::new() };
        let size = [layout.width, layout.plot[1][1] + 58.0];
        svg::document(self.id, size, &self.title, &self.description, &(body + &names))
    }

    /// Returns the document as narrow as a phone.
    pub fn narrow_svg(&self) -> String {
        let (body, ..) = self.body(&NARROW);
        let (key, height) = self.key(NARROW.plot[1][1] + 66.0);
        let id = format!("{}-narrow", self.id);
        svg::document(&id, [NARROW.width, height], &self.title, &self.description, &(body + &key))
    }

    /// Returns all but the names, what names should keep off, and the axes.
    fn body(&self, layout: &Layout) -> (String, Obstacles, [Axis; 2]) {
        let [[left, top], [right, bottom]] = layout.plot;
        let points = || self.series.iter().flat_map(|s| &s.points);
        let level = self.level.filter(|level| self.is_near(level.0));
        let values = points().map(|p| p[1]).chain(level.map(|l| l.0));
        let [x, y] = if self.is_named() {
            [Axis::tight(points().map(|p| p[0]), left, right), Axis::tight(values, bottom, top)]
        } else {
            [Axis::new(points().map(|p| p[0]), left, right), Axis::new(values, bottom, top)]
        };
        let mut body = self.axes(layout, &x, &y);
        let mut obstacles = self.obstacles(&x, &y);
        let mut names = String::new();
        if let Some((value, name)) = level
            && let Some(at) = y.position(value)
        {
            body += &svg::line([left, at], [right, at], "level");
            let width = area([0.0; 2], name)[2];
            let own = |x: f64| area([x, at - 9.0], name);
            let cost = |x: &f64| obstacles.cost(&own(*x));
            let places = [0.02, 0.4, 0.7, 1.0].map(|part| left + part * (right - left - width - 4.0));
            let x = places.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(left);
            names += &svg::text(x, at - 5.0, "start", "small name", name);
            obstacles.marks.push(own(x));
            obstacles.add_line([left, at], [right, at]);
        }
        let (guides, of_guides) = self.guide_lines(&x, &y, &mut obstacles);
        body += &guides;
        names += &of_guides;
        // Leading ones lie above the others.
        let is_other = |series: &Series| series.role == Role::Other;
        for others in [true, false] {
            for series in self.series.iter().filter(|series| is_other(series) == others) {
                body += &drawn(series, &x, &y);
            }
        }
        (body + &names, obstacles, [x, y])
    }

    /// Returns the marks and lines of all series.
    fn obstacles(&self, x: &Axis, y: &Axis) -> Obstacles {
        let mut obstacles = Obstacles::default();
        for series in &self.series {
            let placed = |p: &[f64; 2]| Some([x.position(p[0])?, y.position(p[1])?]);
            let places: Vec<[f64; 2]> = series.points.iter().filter_map(placed).collect();
            places.windows(2).for_each(|pair| obstacles.add_line(pair[0], pair[1]));
            let mark = |[px, py]: &[f64; 2]| [px - MARK, py - MARK, px + MARK, py + MARK];
            obstacles.marks.extend(places.iter().map(mark));
        }
        obstacles
    }

    /// Returns true if series are named at their ends.
    fn is_named(&self) -> bool {
        self.series.iter().any(|series| series.role != Role::Alone)
    }

    fn is_near(&self, level: f64) -> bool {
        let values = self.series.iter().flat_map(|s| &s.points).map(|p| p[1]).filter(|v| *v > 0.0);
        !self.is_named() || level * FAR_LEVEL >= values.fold(f64::INFINITY, f64::min)
    }

    /// Returns the names at the ends of lines, those of leading series first; each switches its series.
    fn names(&self, layout: &Layout, [x, y]: [&Axis; 2], obstacles: Obstacles) -> String {
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
        let [[left, top], [_, bottom]] = layout.plot;
        let places = place(&labels, [left, top, layout.width - 4.0, bottom], &obstacles);
        let mut out = String::new();
        for ((series, end), placed) in named.iter().zip(places) {
            let [px, py] = placed.at;
            let lead = if placed.is_led { svg::line(*end, placed.joint, "leader") } else { String::new() };
            let class = format!("small name t{}{}", series.look()[0], series.weight());
            let text = svg::text(px, py + 4.0, "start", &class, &series.name);
            let name = svg::escape(&series.name);
            out += &format!("<g class=\"key series\" data-series=\"{name}\">{lead}{text}</g>\n");
        }
        out
    }

    /// Returns the leading names in rows from a height on, and the height of the document.
    fn key(&self, top: f64) -> (String, f64) {
        let mut out = String::new();
        let mut y = top;
        let mut leading: Vec<&Series> = self.series.iter().filter(|s| s.role != Role::Other).collect();
        leading.sort_by_key(|series| series.look()[0]);
        for series in &leading {
            let mark = svg::marker(series.look(), [18.0, y - 4.0], series.radius(), "");
            let class = format!("small t{}{}", series.look()[0], series.weight());
            let text = svg::text(30.0, y, "start", &class, &series.name);
            let name = svg::escape(&series.name);
            out += &format!("<g class=\"key series\" data-series=\"{name}\">{mark}{text}</g>\n");
            y += KEY_ROW;
        }
        if leading.len() < self.series.len() {
            let others =
                format!("grey: {} others, named in the wide plot", self.series.len() - leading.len());
            out += &svg::text(30.0, y, "start", "small", &others);
            y += KEY_ROW;
        }
        (out, y)
    }

    fn axes(&self, layout: &Layout, x: &Axis, y: &Axis) -> String {
        let [[left, top], [right, bottom]] = layout.plot;
        let [along_x, along_y] = layout.labels;
        let mut out = String::new();
        for (at, number) in x.ticks(along_x) {
            out += &svg::line([at, top], [at, bottom], "grid");
            if let Some(number) = number {
                // Beneath its tick, but for one at the end of the picture, where it would be cut.
                let half = 0.5 * area([0.0; 2], &number)[2];
                out +=
                    &svg::text(at.min(layout.width - half - 2.0), bottom + 18.0, "middle", "small", &number);
            }
        }
        for (at, number) in y.ticks(along_y) {
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
            "<text transform=\"translate({} {middle}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            layout.y_name,
            svg::escape(self.y_label)
        )
    }

    /// Draws the guides from the plot's upper left downwards, as far as the frame extends; their names, which keep off marks
    /// and lines where they can, are to be drawn above all else.
    fn guide_lines(&self, x: &Axis, y: &Axis, obstacles: &mut Obstacles) -> (String, String) {
        let (mut lines, mut names) = (String::new(), String::new());
        let start = (y.high / y.low).powf(0.93) * y.low;
        for (slope, name) in &self.guides {
            let reach = (y.low / start).powf(1.0 / slope);
            let end = x.high.min(x.low * reach);
            let at = |v: f64| [x.at(v), y.at(start * (v / x.low).powf(*slope))];
            lines += &svg::line(at(x.low), at(end), "guide");
            let half = area([0.0, 0.0], name)[2] / 2.0;
            let own = |[px, py]: [f64; 2]| area([px - half, py], name);
            let places = GUIDE_NAMES.map(|part| at(x.low * (end / x.low).powf(part)));
            let places = places.iter().flat_map(|[px, py]| OFF_GUIDE.map(|off| ([*px, py + off], off.abs())));
            let cost = |(place, off): &([f64; 2], f64)| obstacles.cost(&own(*place)) + OFF_GUIDE_COST * off;
            let Some((place, _)) = places.min_by(|a, b| cost(a).total_cmp(&cost(b))) else { continue };
            names += &svg::text(place[0], place[1] + 4.0, "middle", "small name", name);
            obstacles.marks.push(own(place));
        }
        (lines, names)
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
