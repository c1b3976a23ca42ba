//! The scale of a layer's colours: which value has which colour, and the values that a legend names. Input: a layer's
//! kind, and its values. Output: places in [0, 1].

/// How values become places on a colour bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Evenly.
    Linear,
    /// By the logarithm of base 2.
    Octaves,
    /// Evenly, with 0 in the middle.
    Signed,
}

/// A value that a legend names, and its text.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    pub at: f64,
    pub text: String,
}

/// The values at both ends of a colour bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    kind: Kind,
    /// As powers of two for octaves.
    from: f64,
    to: f64,
}

/// The share of the values at each end that may lie beyond a bar: they have the colour of its end.
const ENDS: f64 = 0.01;
/// The lowest and the highest octave.
const OCTAVES: [f64; 2] = [-12.0, 16.0];
/// Names on a bar.
const TICKS: usize = 5;
/// The largest range of a signed scale.
const MAX_SIGNED: f64 = 4.0;

impl Scale {
    /// Returns the scale of these values, but for the few at both ends; of no values, a scale from 0 to 1.
    pub fn new(kind: Kind, values: impl Iterator<Item = f32>) -> Scale {
        let finite = values.map(f64::from).filter(|v| v.is_finite());
        let mut placed: Vec<f64> =
            finite.map(|v| if kind == Kind::Octaves { octave(v) } else { v }).collect();
        placed.sort_by(f64::total_cmp);
        let at = |share: f64| placed.get((share * placed.len().saturating_sub(1) as f64).round() as usize);
        let [low, high] = [at(ENDS).copied().unwrap_or(0.0), at(1.0 - ENDS).copied().unwrap_or(1.0)];
        let [from, to] = match kind {
            Kind::Linear => [low, high],
            Kind::Octaves => [low.floor(), high.ceil()],
            Kind::Signed => {
                let most = low.abs().max(high.abs()).ceil().clamp(1.0, MAX_SIGNED);
                [-most, most]
            }
        };
        Scale { kind, from, to: if to > from { to } else { from + 1.0 } }
    }

    /// Returns the scale between two values, evenly.
    pub fn between(from: f64, to: f64) -> Scale {
        Scale { kind: Kind::Linear, from, to: if to > from { to } else { from + 1.0 } }
    }

    /// Returns the place of a value on the bar.
    pub fn place(&self, value: f64) -> f64 {
        let value = if self.kind == Kind::Octaves { octave(value) } else { value };
        ((value - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// Returns the values that are named.
    pub fn ticks(&self) -> Vec<Tick> {
        let span = self.to - self.from;
        let whole =
            self.kind != Kind::Linear || (span >= 2.0 && self.from.fract() == 0.0 && self.to.fract() == 0.0);
        let step = if whole { (span / (TICKS - 1) as f64).ceil() } else { span / (TICKS - 1) as f64 };
        let count = (span / step + 1e-9).floor() as usize;
        let tick = |i: usize| {
            let value = self.from + i as f64 * step;
            let text = match self.kind {
                Kind::Octaves => power_of_two(value),
                Kind::Signed if value > 0.0 => format!("+{}", short(value)),
                Kind::Linear | Kind::Signed => short(value),
            };
            Tick { at: (value - self.from) / span, text }
        };
        (0..=count).map(tick).collect()
    }
}

fn octave(value: f64) -> f64 {
    value.max(f64::MIN_POSITIVE).log2().clamp(OCTAVES[0], OCTAVES[1])
}

/// Returns `1/8`, `1` or `16`.
fn power_of_two(exponent: f64) -> String {
    let power = exponent.abs().exp2();
    if exponent < 0.0 { format!("1/{power}") } else { format!("{power}") }
}

/// Returns a number with three digits.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.1e}")
    } else {
        let decimals = (2.0 - size.log10().floor()).max(0.0) as usize;
        let text = format!("{value:.decimals$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(scale: Scale) -> Vec<String> {
        scale.ticks().into_iter().map(|tick| tick.text).collect()
    }

    #[test]
    fn octaves_are_named_by_powers_of_two() {
        let scale = Scale::new(Kind::Octaves, [0.3, 4.0].into_iter());
        assert_eq!(texts(scale), ["1/4", "1/2", "1", "2", "4"]);
        assert_eq!([scale.place(0.25), scale.place(1.0), scale.place(4.0)], [0.0, 0.5, 1.0]);
    }

    #[test]
    fn a_signed_scale_has_0_in_the_middle() {
        let scale = Scale::new(Kind::Signed, [-1.5, 0.25].into_iter());
        assert_eq!(scale.place(0.0), 0.5);
        assert_eq!(texts(scale), ["-2", "-1", "0", "+1", "+2"]);
    }

    #[test]
    fn one_value_and_none_have_a_scale() {
        assert_eq!(Scale::new(Kind::Linear, [3.0].into_iter()).place(3.0), 0.0);
        assert_eq!(texts(Scale::new(Kind::Linear, std::iter::empty())), ["0", "0.25", "0.5", "0.75", "1"]);
        assert_eq!(texts(Scale::between(0.0, 4.0)), ["0", "1", "2", "3", "4"]);
    }

    #[test]
    fn numbers_have_three_digits() {
        let numbers = [0.0, 0.5, 1234.0, 0.01234, 1e-7, -2.25];
        assert_eq!(numbers.map(short), ["0", "0.5", "1234", "0.0123", "1.0e-7", "-2.25"]);
    }
}
