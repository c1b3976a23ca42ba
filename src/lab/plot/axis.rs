//! A logarithmic axis: maps values to pixel positions and generates ticks. 0 and infinity, which
//! have no logarithm, get separate positions at the ends if they occur.

/// The distance in pixels between the end of the scale and values without a logarithm.
const END_GAP: f64 = 26.0;
/// The margins of a tight axis: a part of its logarithm, and the smallest factor.
const TIGHT_MARGIN: f64 = 0.04;
const LEAST_MARGIN: f64 = 1.3;
pub struct Axis {
    pub low: f64,
    pub high: f64,
    from: f64,
    to: f64,
    /// The positions of 0 and of infinity, if they occur.
    zero: Option<f64>,
    infinity: Option<f64>,
}

impl Axis {
    /// Creates an axis whose ends are multiples of 1, 2 or 5, because whole decades would waste
    /// space.
    pub fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Axis {
        let values: Vec<f64> = values.collect();
        let apart = END_GAP.copysign(to - from);
        let zero = values.contains(&0.0).then_some(from + 0.5 * apart);
        let infinity = values.contains(&f64::INFINITY).then_some(to - 0.5 * apart);
        let from = if zero.is_some() { from + apart } else { from };
        let to = if infinity.is_some() { to - apart } else { to };
        let usable: Vec<f64> = values.into_iter().filter(|v| *v > 0.0 && v.is_finite()).collect();
        let low = usable.iter().copied().fold(f64::INFINITY, f64::min);
        let high = usable.iter().copied().fold(0.0, f64::max);
        // The margins keep markers clear of the frame.
        let marks = if usable.is_empty() { vec![1.0, 10.0] } else { steps(low / 2.4, high * 1.3) };
        let (low, high) = match marks[..] {
            [first, .., last] => (first, last),
            _ => (low / 2.0, high * 2.0),
        };
        Axis { low, high, from, to, zero, infinity }
    }

    /// Creates an axis that ends a little beyond the values, so that no part of it is empty.
    pub fn tight(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Axis {
        let values: Vec<f64> = values.collect();
        let usable = || values.iter().copied().filter(|v| *v > 0.0 && v.is_finite());
        let [low, high] = [usable().fold(f64::INFINITY, f64::min), usable().fold(0.0, f64::max)];
        let axis = Axis::new(values.iter().copied(), from, to);
        if low > high {
            return axis;
        }
        // At least as much as keeps marks clear of the frame, and two ticks.
        let margin = (high / low).powf(TIGHT_MARGIN).max(LEAST_MARGIN);
        Axis { low: low / margin, high: high * margin, ..axis }
    }

    /// Returns the position of a value, or `None` if the axis cannot show it.
    pub fn position(&self, value: f64) -> Option<f64> {
        match value {
            0.0 => self.zero,
            f64::INFINITY => self.infinity,
            v if v > 0.0 => Some(self.at(v)),
            _ => None,
        }
    }

    /// Returns the position of a positive number.
    pub fn at(&self, value: f64) -> f64 {
        // Logarithms are taken separately, because the ratio may overflow.
        let [value, low, high] = [value, self.low, self.high].map(f64::ln);
        self.from + (self.to - self.from) * (value - low) / (high - low)
    }

    /// Returns tick positions with at most so many labels: all steps if they fit, else whole decades or, on long
    /// axes, some of them.
    pub fn ticks(&self, most: usize) -> Vec<(f64, Option<String>)> {
        let mut all = steps(self.low, self.high);
        all.retain(|step| *step <= self.high * (1.0 + 1e-9));
        let crowded = all.len() > most;
        let decade = |v: f64| (v.log10() - v.log10().round()).abs() < 1e-6;
        let decades = all.iter().filter(|v| decade(**v)).count();
        let every = decades.div_ceil(most).max(1) as i64;
        let numbered = |v: f64| !crowded || (decade(v) && v.log10().round() as i64 % every == 0);
        let shown = all.into_iter().filter(|v| decades <= most || decade(*v));
        let mut ticks: Vec<(f64, Option<String>)> =
            shown.map(|v| (self.at(v), numbered(v).then(|| number(v)))).collect();
        ticks.extend(self.zero.map(|at| (at, Some("0".into()))));
        ticks.extend(self.infinity.map(|at| (at, Some("∞".into()))));
        ticks
    }
}

/// Returns 1, 2, 5, 10, … from the first not below `from` up to the first not below `to`.
pub fn steps(from: f64, to: f64) -> Vec<f64> {
    if !(from > 0.0 && from.is_finite() && to.is_finite()) {
        return Vec::new();
    }
    let first = from.log10().floor() as i32;
    let all = (first..).flat_map(|e| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(e)));
    let mut steps = Vec::new();
    for step in all.skip_while(|s| *s < from * (1.0 - 1e-9)) {
        steps.push(step);
        if step >= to * (1.0 - 1e-9) {
            break;
        }
    }
    steps
}

/// Formats a tick label: 0.01, 1, 500, 2e−5.
fn number(value: f64) -> String {
    if (1e-3..1e5).contains(&value) {
        let rounded = (value * 1e6).round() / 1e6;
        return format!("{rounded}");
    }
    let exponent = (value.log10() + 1e-9).floor();
    let digits = value / 10f64.powf(exponent);
    format!("{digits:.0}e{exponent:.0}").replace('-', "−")
}
