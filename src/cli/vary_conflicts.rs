//! Settings that stand in each other's way. Input: what varies, and what is typed beside it. Output: an error where one of
//! them decides what another one names, for then the names of cells would not be true.

use super::display::DisplayArgs;
use super::overrides::Overrides;
use super::vary::Vary;
use crate::core::error::{Error, Result};
use crate::scene::Setting;

const SPP: &str = "sampling.spp";
const ALGORITHM: &str = "sampling.algorithm";

/// Options, and the keys of the scene in whose place they stand.
const KEYS: [(&str, &[&str]); 13] = [
    ("size", &["image.size", "image.width", "image.height"]),
    ("pixel-filter", &["image.pixel_filter", "image.pixel_filter_radius"]),
    ("pixel-filter-radius", &["image.pixel_filter_radius"]),
    ("spp", &[SPP]),
    ("algorithm", &[ALGORITHM]),
    ("pattern", &["sampling.pattern"]),
    ("seed", &["sampling.seed"]),
    ("shared", &["sampling.shared"]),
    ("footprint", &["sampling.footprint"]),
    ("precision", &["sampling.precision"]),
    ("filter", &["sampler.*.filter"]),
    ("method", &["sampler.*.method"]),
    ("mip", &["sampler.*.mip"]),
];
/// What a goal stands in place of, and what its algorithm does if no other is named.
const OF_GOAL: [&str; 2] = [SPP, ALGORITHM];
const OF_AUTO: [&str; 4] = [SPP, ALGORITHM, "sampling.pattern", "sampling.footprint"];

/// A setting that is typed or varies.
struct Named {
    /// What a person wrote.
    written: String,
    /// The option's name, or `set`.
    name: String,
    /// Where it goes, if it is a key of the scene.
    key: Option<Setting>,
    is_varied: bool,
}

impl Named {
    fn typed((name, value): (&'static str, String)) -> Named {
        let key = (name == "set").then(|| value.parse().ok()).flatten();
        let written = if name == "set" { format!("--set {value}") } else { format!("--{name}") };
        Named { written, name: name.to_owned(), key, is_varied: false }
    }

    fn varied(vary: &Vary) -> Named {
        let key = if vary.is_key() { format!("{}=0", vary.name).parse().ok() } else { None };
        let name = if vary.is_key() { "set".to_owned() } else { vary.name.clone() };
        Named { written: format!("--vary {}", vary.name), name, key, is_varied: true }
    }

    fn is_goal(&self) -> bool {
        matches!(self.name.as_str(), "budget" | "target-error")
    }

    fn keys(&self, names_algorithm: bool) -> &'static [&'static str] {
        match self.name.as_str() {
            _ if self.is_goal() && names_algorithm => &OF_GOAL,
            _ if self.is_goal() => &OF_AUTO,
            name => KEYS.iter().find(|(option, _)| *option == name).map_or(&[], |(_, keys)| keys),
        }
    }

    /// Returns true if nothing is left of `other`, which is applied before.
    fn decides(&self, other: &Named, names_algorithm: bool) -> bool {
        match (&self.key, &other.key) {
            (Some(own), Some(key)) => own.covers(key),
            (None, Some(key)) => self.keys(names_algorithm).iter().any(|own| {
                let own: Result<Setting, String> = format!("{own}=0").parse();
                own.is_ok_and(|own| own.covers(key))
            }),
            (None, None) => {
                self.name == other.name || self.is_goal() && (other.name == "spp" || other.is_goal())
            }
            (Some(_), None) => false,
        }
    }
}

/// Refuses settings of which one decides what another one names.
pub(super) fn check(varied: &[Vary], (overrides, display): (&Overrides, &DisplayArgs)) -> Result<()> {
    for (i, vary) in varied.iter().enumerate() {
        if varied[..i].iter().any(|other| other.name == vary.name) {
            return Err(Error::with_help(
                format!("--vary {} is given twice", vary.name),
                "name all of its values at once, separated by commas",
            ));
        }
    }
    let given = [overrides.given(), display.given()].concat().into_iter().map(Named::typed);
    let mut all: Vec<Named> = given.chain(varied.iter().map(Named::varied)).collect();
    // Options are applied after keys, and what varies after what is typed.
    all.sort_by_key(|one| (one.key.is_none(), one.is_varied));
    let names_algorithm = all.iter().any(|one| one.name == "algorithm");
    for (i, last) in all.iter().enumerate() {
        let before = all[..i].iter().chain(all[i + 1..].iter().filter(|other| other.name == "spp"));
        for first in before.filter(|first| first.is_varied || last.is_varied) {
            // A number beside a goal is told in a warning, as `moire render` does.
            let is_warned = first.name == "spp" && !first.is_varied && last.is_goal();
            if !is_warned && last.decides(first, names_algorithm) {
                return Err(refusal(first, last));
            }
        }
    }
    Ok(())
}

fn refusal(first: &Named, last: &Named) -> Error {
    let message = match (first.is_varied, last.is_varied) {
        (true, true) => format!("{} decides what {} varies", last.written, first.written),
        (false, _) => format!("{} fixes what {} varies", first.written, last.written),
        (true, false) => format!("{} fixes what {} varies", last.written, first.written),
    };
    let why = if last.is_goal() { "a time or an error to reach chooses the samples itself; " } else { "" };
    Error::with_help(message, format!("{why}leave one of them away"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::vary::names;

    #[test]
    fn every_option_has_its_keys_or_stands_in_no_keys_place() {
        let (goals, own) = (["budget", "target-error"], ["camera"]);
        let others: Vec<&str> = goals.into_iter().chain(own).chain(DisplayArgs::NAMES).collect();
        for name in names() {
            let has_keys = KEYS.iter().any(|(option, _)| *option == name);
            assert!(has_keys != others.contains(&name.as_str()), "{name}");
        }
        for key in KEYS.iter().flat_map(|(_, keys)| *keys).chain(&OF_AUTO) {
            assert!(format!("{key}=0").parse::<Setting>().is_ok(), "{key}");
        }
    }
}
