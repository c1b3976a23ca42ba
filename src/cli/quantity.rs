//! Numbers on the command line. Input: a word such as `50ms` or `1e-3`. Output: the number, times in seconds; or what is
//! allowed there.

use crate::scene::MAX_SPP;

/// The units of time, and their seconds.
const UNITS: [(&str, f64); 6] =
    [("us", 1e-6), ("µs", 1e-6), ("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("h", 3600.0)];
const EXPECTED: &str = "expected a time above 0: a number of seconds, or one with a unit (us, ms, s, min, h), such as 0.05, 50ms or 2min";

pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) && value > 0.0 => Ok(value),
        _ => Err("expected a number above 0".into()),
    }
}

/// Parses a seed.
pub(super) fn seed(text: &str) -> Result<u32, String> {
    text.trim().parse().map_err(|_| format!("expected a whole number from 0 to {}", u32::MAX))
}

/// Parses a number of samples; which ones a pattern takes is for the scene to say.
pub(super) fn samples(text: &str) -> Result<u32, String> {
    text.trim().parse().map_err(|_| format!("expected a whole number from 1 to {MAX_SPP}"))
}

/// Parses a time; without a unit it is in seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    let text = text.trim();
    if let Ok(value) = positive(text) {
        return Ok(value);
    }
    let number = text.trim_end_matches(char::is_alphabetic);
    let unit = &text[number.len()..];
    let Ok(value) = positive(number.trim_end()) else { return Err(EXPECTED.into()) };
    let named = UNITS.iter().find(|(name, _)| *name == unit);
    let near = || UNITS.iter().find(|(name, _)| unit.starts_with(name) || unit.eq_ignore_ascii_case(name));
    match (named, near()) {
        (Some((_, factor)), _) => {
            let seconds = value * factor;
            if seconds.is_finite() && seconds > 0.0 { Ok(seconds) } else { Err(EXPECTED.into()) }
        }
        (None, Some((meant, _))) => Err(format!("\"{unit}\" is no unit; did you mean {meant}? {EXPECTED}")),
        (None, None) => Err(format!("\"{unit}\" is no unit; {EXPECTED}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_take_units_and_are_seconds_without() {
        let good = [
            ("0.05", 0.05),
            ("5e-2", 0.05),
            ("50ms", 0.05),
            ("50 ms", 0.05),
            ("0.05s", 0.05),
            ("5e-2s", 0.05),
            ("200us", 2e-4),
            ("200µs", 2e-4),
            ("2min", 120.0),
            ("1h", 3600.0),
        ];
        for (text, expected) in good {
            let found = seconds(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert!((found / expected - 1.0).abs() < 1e-12, "{text}: {found}");
        }
    }

    #[test]
    fn what_is_no_time_is_told_what_is() {
        for text in ["", "ms", "-1", "0", "0ms", "inf", "nan", "1e400", "1e308h", "1e-320us", "1ms2", "5,0"] {
            assert!(seconds(text).is_err_and(|e| e.contains("such as 0.05, 50ms or 2min")), "{text}");
        }
        assert!(seconds("3sec").is_err_and(|e| e.starts_with("\"sec\" is no unit; did you mean s?")));
        assert!(seconds("3MS").is_err_and(|e| e.contains("did you mean ms?")));
        assert!(seconds("3days").is_err_and(|e| e.starts_with("\"days\" is no unit; expected")));
        assert!(positive("1e-3").is_ok_and(|x| x == 1e-3) && positive("0").is_err());
    }
}
