//! The values of `--vary`: a list, in which a range of numbers stands for all of its values. Input: what stands behind the
//! equals sign. Output: the values as words.

use crate::lab::sheet::plan::MAX_CELLS;

/// How a range is written.
pub(super) const RANGES: &str =
    "ranges are 1..4 (each whole number), 1..64x4 (times 4) and -2..2+0.5 (in steps of 0.5), with both ends";

/// Returns the values of a list.
pub(super) fn values(list: &str) -> Result<Vec<String>, String> {
    let parts = split(list).into_iter().map(|part| expanded(&part).unwrap_or_else(|| Ok(vec![part])));
    Ok(parts.collect::<Result<Vec<_>, String>>()?.concat())
}

/// Returns the values of a range; `None` of a word that is none.
fn expanded(word: &str) -> Option<Result<Vec<String>, String>> {
    let (from, rest) = word.split_once("..")?;
    let from: f64 = number(from)?;
    // A sign directly behind the dots belongs to the number.
    let end = rest.char_indices().skip(1).find(|(_, letter)| matches!(letter, 'x' | '×' | '*' | '+'));
    let (to, step) = match end {
        Some((at, letter)) => (&rest[..at], Some((letter, &rest[at + letter.len_utf8()..]))),
        None => (rest, None),
    };
    let to: f64 = number(to.trim_start_matches('='))?;
    let wrong = |what: &str| Some(Err(format!("\"{word}\" {what}; {RANGES}")));
    let (is_product, step) = match step {
        None => (false, 1.0),
        Some((letter, step)) => match number(step) {
            Some(step) => (letter != '+', step),
            None => return wrong("has no number for its steps"),
        },
    };
    if to < from {
        return wrong("ends below its start");
    }
    if is_product && (step <= 1.0 || from <= 0.0) {
        return wrong("never comes to its end: it needs a factor above 1, and a start above 0");
    }
    if !is_product && step <= 0.0 {
        return wrong("never comes to its end: it needs a step above 0");
    }
    let mut values = Vec::new();
    let value = |i: i32| if is_product { from * step.powi(i) } else { from + f64::from(i) * step };
    // What a sum of steps like 0.1 is off by.
    let slack = 1e-9 * (to.abs() + step);
    for at in (0..).map(value).take_while(|at| *at <= to + slack) {
        if values.len() == MAX_CELLS {
            return wrong(&format!("has more values than the {MAX_CELLS} cells of a sheet"));
        }
        values.push(written(at));
    }
    Some(Ok(values))
}

fn number(word: &str) -> Option<f64> {
    word.trim().parse().ok().filter(|value: &f64| value.is_finite() && value.abs() <= 1e15)
}

/// Writes a number with twelve digits at most.
fn written(value: f64) -> String {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

/// Splits at commas outside of brackets and quotes.
fn split(list: &str) -> Vec<String> {
    let mut values = vec![String::new()];
    let (mut depth, mut quote) = (0i32, None);
    for letter in list.chars() {
        match (letter, quote) {
            (',', None) if depth == 0 => {
                values.push(String::new());
                continue;
            }
            ('[' | '{' | '(', None) => depth += 1,
            (']' | '}' | ')', None) => depth -= 1,
            ('"' | '\'', None) => quote = Some(letter),
            (own, Some(open)) if own == open => quote = None,
            _ => {}
        }
        if let Some(value) = values.last_mut() {
            value.push(letter);
        }
    }
    values.into_iter().map(|value| value.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_within_brackets_and_quotes_separate_nothing() {
        assert_eq!(split("a,b"), ["a", "b"]);
        assert_eq!(split("[1, 2],[3,[4]], {a=1,b=2}"), ["[1, 2]", "[3,[4]]", "{a=1,b=2}"]);
        assert_eq!(split("\"a,b\",'c,\"d'"), ["\"a,b\"", "'c,\"d'"]);
        assert_eq!(split("a,"), ["a", ""]);
    }
}
