//! `--vary NAME=VALUE,VALUE`: a setting that differs from cell to cell of a sheet. Input: an option of `moire render` by
//! its name, or a key of the scene, with values. Output: the settings of each cell, parsed as the command line itself is.

use std::collections::BTreeMap;

use clap::{CommandFactory, Parser};

use super::display::DisplayArgs;
use super::overrides::Overrides;
use super::vary_mistakes::{unknown, wrong};
use super::vary_values::values;
use crate::core::error::{Error, Result};
use crate::lab::sheet::plan::{Axis, MAX_AXES, MAX_CELLS};
use crate::lab::study::label;

/// The options that can vary, as a command line of their own.
#[derive(Parser, Debug)]
#[command(no_binary_name = true, disable_help_flag = true)]
struct CellArgs {
    #[command(flatten)]
    overrides: Overrides,
    #[command(flatten)]
    display: DisplayArgs,
}

/// A name with its values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Vary {
    pub(super) name: String,
    values: Vec<String>,
}

impl Vary {
    /// Returns true if the name is a key of the scene, not an option.
    pub(super) fn is_key(&self) -> bool {
        is_key(&self.name)
    }
}

/// A combination of values.
pub(super) struct Combination {
    /// The index into the values of each axis.
    pub(super) at: Vec<usize>,
    pub(super) settings: BTreeMap<String, String>,
    pub(super) overrides: Overrides,
    pub(super) display: DisplayArgs,
    /// The first combination that differs in nothing but how its film is shown.
    pub(super) film_of: usize,
}

/// Parses the value of `--vary`.
pub(super) fn parse(text: &str) -> Result<Vary, String> {
    const EXPECTED: &str = "expected NAME=VALUE,VALUE,…, such as filter=nearest,linear,ewa or spp=1..64x4";
    let (name, list) = text.split_once('=').ok_or(EXPECTED)?;
    let name = name.trim().trim_start_matches('-');
    if name.is_empty() {
        return Err(format!("a name is missing; {EXPECTED}"));
    }
    let typed = name;
    let name = if is_key(name) { name.to_owned() } else { name.replace('_', "-").to_lowercase() };
    if !is_key(&name) && !names().contains(&name) {
        return Err(unknown(typed, &names()));
    }
    let told = |what: String| format!("{name}: {what}");
    let values = values(list).map_err(told)?;
    if values.iter().any(String::is_empty) {
        return Err(format!("{name}: a value is missing; {EXPECTED}"));
    }
    let twice = values.iter().enumerate().find(|(i, value)| values[..*i].contains(value));
    if let Some((_, value)) = twice {
        return Err(format!("{name}: {value} is named twice"));
    }
    Ok(Vary { name, values })
}

fn is_key(name: &str) -> bool {
    name.contains('.')
}

/// Returns the options that can vary.
pub(super) fn names() -> Vec<String> {
    let longs = CellArgs::command();
    let longs = longs.get_arguments().filter_map(|arg| arg.get_long());
    // Keys of the scene are named themselves.
    longs.filter(|long| *long != "set").map(str::to_owned).collect()
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
pub(super) fn combine(
    varied: &[Vary],
    base: (&Overrides, &DisplayArgs),
) -> Result<(Vec<Axis>, Vec<Combination>)> {
    check(varied)?;
    for vary in varied {
        for value in &vary.values {
            CellArgs::try_parse_from(words(&vary.name, value)).map_err(|e| wrong(&vary.name, value, &e))?;
        }
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
        let CellArgs { overrides, display } = CellArgs::try_parse_from(all).map_err(|e| wrong("", "", &e))?;
        combinations.push(Combination {
            overrides: overrides.over(base.0),
            display: display.over(base.1),
            film_of: film_of(varied, &at),
            settings: chosen().map(|(name, value)| (name.clone(), value.clone())).collect(),
            at,
        });
    }
    let label = |vary: &Vary| vary.values.iter().map(|value| label::setting(&vary.name, value)).collect();
    let axis = |vary: &Vary| Axis { name: vary.name.clone(), labels: label(vary) };
    Ok((varied.iter().map(axis).collect(), combinations))
}

/// Returns the combination with the first of all values that change how a film is shown, and nothing else.
fn film_of(varied: &[Vary], at: &[usize]) -> usize {
    let shows = |vary: &Vary| DisplayArgs::NAMES.contains(&vary.name.as_str());
    let place = |(vary, at): (&Vary, &usize)| [vary.values.len(), if shows(vary) { 0 } else { *at }];
    let places = varied.iter().zip(at).map(place);
    // The first axis is the fastest.
    places.rev().fold(0, |index, [count, at]| index * count + at)
}

fn check(varied: &[Vary]) -> Result<()> {
    if varied.len() > MAX_AXES {
        return Err(Error::with_help(
            format!("--vary is given {} times, and a sheet has columns, rows and blocks", varied.len()),
            "vary at most three settings, and fix the others",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!(wrong("spp=1,4,1").contains("spp: 1 is named twice"));
        assert!(wrong("=1,4").contains("a name is missing"));
        assert!(wrong("crop=0,0,9,9").contains("\"crop\" is no option that can vary"));
        assert!(wrong("max_anisotropy=1,16").contains("did you mean \"sampler.*.max_anisotropy\"?"));
        assert!(wrong("fov=30,60").contains("did you mean \"camera.vertical_fov\"?"));
    }
}
