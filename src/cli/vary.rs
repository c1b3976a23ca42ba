//! `--vary NAME=VALUE,VALUE`: a setting that differs from cell to cell of a sheet. Input: an option of `moire render` by
//! its name, or a key of the scene, with values. Output: the settings of each cell, parsed as the command line itself is.

use std::collections::BTreeMap;

use clap::{CommandFactory, Parser};

use super::overrides::Overrides;
use crate::core::error::{Error, Result};
use crate::lab::sheet::plan::{Axis, MAX_AXES, MAX_CELLS};
use crate::lab::study::label;
use crate::scene::suggestion;

/// The options that can vary, as a command line of their own.
#[derive(Parser, Debug)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct CellArgs {
    #[command(flatten)]
    overrides: Overrides,
}

/// A name with its values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Vary {
    pub(super) name: String,
    values: Vec<String>,
}

/// A combination of values.
pub(super) struct Combination {
    /// The index into the values of each axis.
    pub(super) at: Vec<usize>,
    pub(super) settings: BTreeMap<String, String>,
    pub(super) overrides: Overrides,
}

/// Parses the value of `--vary`.
pub(super) fn parse(text: &str) -> Result<Vary, String> {
    let expected = "expected NAME=VALUE,VALUE,…, such as filter=nearest,linear,ewa";
    let (name, list) = text.split_once('=').ok_or(expected)?;
    let name = name.trim().trim_start_matches('-');
    let values = split(list);
    if values.iter().any(String::is_empty) {
        return Err(format!("a value is missing; {expected}"));
    }
    let twice = values.iter().enumerate().find(|(i, value)| values[..*i].contains(value));
    if let Some((_, value)) = twice {
        return Err(format!("{value} is named twice"));
    }
    let name = if is_key(name) { name.to_owned() } else { name.replace('_', "-") };
    if !is_key(&name) && !names().contains(&name) {
        return Err(unknown(&name));
    }
    Ok(Vary { name, values })
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

fn is_key(name: &str) -> bool {
    name.contains('.')
}

fn names() -> Vec<String> {
    let longs = CellArgs::command();
    let longs = longs.get_arguments().filter_map(|arg| arg.get_long());
    // Keys of the scene are named themselves.
    longs.filter(|long| *long != "set").map(str::to_owned).collect()
}

fn unknown(name: &str) -> String {
    let names = names();
    let near = suggestion(name, names.iter().map(String::as_str));
    format!(
        "\"{name}\" is no option that can vary: {}; and keys of the scene, such as sampler.NAME.address{near}",
        names.join(", ")
    )
}

/// Returns the words of a setting on a command line.
fn words(name: &str, value: &str) -> Vec<String> {
    if is_key(name) {
        return vec!["--set".into(), format!("{name}={value}")];
    }
    let bare = value.trim_matches(|c| matches!(c, '"' | '\''));
    vec![format!("--{name}={bare}")]
}

/// Returns the axes of a sheet, and all combinations of their values, the first axis fastest.
pub(super) fn combine(varied: &[Vary], base: &Overrides) -> Result<(Vec<Axis>, Vec<Combination>)> {
    check(varied, base)?;
    for vary in varied {
        vary.values.iter().try_for_each(|value| parsed(&words(&vary.name, value), &vary.name).map(drop))?;
    }
    let count = varied.iter().map(|vary| vary.values.len()).product::<usize>();
    if count > MAX_CELLS {
        return Err(Error::with_help(
            format!("these values make {count} cells, and a sheet has at most {MAX_CELLS}"),
            "name fewer values, or make several sheets",
        ));
    }
    let mut combinations = Vec::with_capacity(count);
    for index in 0..count {
        let mut rest = index;
        let mut at = Vec::with_capacity(varied.len());
        for vary in varied {
            at.push(rest % vary.values.len());
            rest /= vary.values.len();
        }
        let chosen = || varied.iter().zip(&at).map(|(vary, at)| (&vary.name, &vary.values[*at]));
        let all: Vec<String> = chosen().flat_map(|(name, value)| words(name, value)).collect();
        combinations.push(Combination {
            overrides: parsed(&all, "")?.over(base),
            settings: chosen().map(|(name, value)| (name.clone(), value.clone())).collect(),
            at,
        });
    }
    let label = |vary: &Vary| vary.values.iter().map(|value| label::setting(&vary.name, value)).collect();
    let axis = |vary: &Vary| Axis { name: vary.name.clone(), labels: label(vary) };
    Ok((varied.iter().map(axis).collect(), combinations))
}

fn check(varied: &[Vary], base: &Overrides) -> Result<()> {
    if varied.len() > MAX_AXES {
        return Err(Error::with_help(
            format!("--vary is given {} times, and a sheet has columns, rows and blocks", varied.len()),
            "vary at most three settings, and fix the others",
        ));
    }
    let given = base.given();
    for (i, vary) in varied.iter().enumerate() {
        if varied[..i].iter().any(|other| other.name == vary.name) {
            return Err(Error::with_help(
                format!("--vary {} is given twice", vary.name),
                "name all of its values at once, separated by commas",
            ));
        }
        if given.iter().any(|(name, _)| *name == vary.name) {
            return Err(Error::with_help(
                format!("--{0} fixes what --vary {0} varies", vary.name),
                "leave one of them away",
            ));
        }
    }
    Ok(())
}

fn parsed(words: &[String], varied: &str) -> Result<Overrides> {
    let wrong = |error: clap::Error| {
        let text = error.to_string();
        let lines =
            text.lines().take_while(|line| !line.starts_with("Usage") && !line.starts_with("For more"));
        let said: Vec<&str> = lines.map(str::trim).filter(|line| !line.is_empty()).collect();
        let said = said.join("; ");
        let place = if varied.is_empty() { "--vary".to_owned() } else { format!("--vary {varied}") };
        Error::new(format!("{place}: {}", said.trim_start_matches("error: ")))
    };
    CellArgs::try_parse_from(words).map(|args| args.overrides).map_err(wrong)
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

    #[test]
    fn names_are_those_of_options_or_keys() {
        let vary = |text: &str| parse(text).map(|v| (v.name, v.values.len()));
        assert_eq!(vary("filter=nearest,ewa"), Ok(("filter".into(), 2)));
        assert_eq!(vary("--pixel_filter=tent"), Ok(("pixel-filter".into(), 1)));
        assert_eq!(
            vary("sampler.a_b.border_color=[0,0,0,0],[1,1,1,1]"),
            Ok(("sampler.a_b.border_color".into(), 2))
        );
        let wrong = |text: &str| vary(text).unwrap_err();
        assert!(wrong("fliter=a").contains("did you mean \"filter\"?"));
        assert!(wrong("samples=1").contains("did you mean \"spp\"?"));
        assert!(wrong("filter").contains("expected NAME=VALUE") && wrong("filter=a,,b").contains("missing"));
        assert!(wrong("spp=1,4,1").contains("1 is named twice"));
    }
}
