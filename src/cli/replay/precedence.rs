//! Which options are in force of a record's and of those beside `--from`. In: both, and the names of `--without`. Out: one
//! command line, in which what is typed prevails, also where a setting of the scene and an option say the same thing.

use clap::{ArgAction, Command};

use crate::cli::overrides;
use crate::cli::typed::Typed;
use crate::scene::Setting;
use crate::scene::model::Algorithm;

/// Options that say what `--set` can say, too: identifier, section, key.
const ALSO_SETTINGS: [(&str, &str, &str); 13] = [
    ("size", "image", "size"),
    ("pixel_filter", "image", "pixel_filter"),
    ("pixel_filter_radius", "image", "pixel_filter_radius"),
    ("spp", "sampling", "spp"),
    ("algorithm", "sampling", "algorithm"),
    ("pattern", "sampling", "pattern"),
    ("seed", "sampling", "seed"),
    ("shared", "sampling", "shared"),
    ("footprint", "sampling", "footprint"),
    ("precision", "sampling", "precision"),
    ("filter", SAMPLER, "filter"),
    ("mip", SAMPLER, "mip"),
    ("method", SAMPLER, "method"),
];
const SAMPLER: &str = "sampler";
const GOALS: [&str; 2] = ["budget", "target_error"];
const SETTING: &str = "set";

/// A command line of recorded and typed options.
pub(super) struct Merged {
    pub words: Vec<String>,
    /// How many of its settings are recorded ones; they come first.
    pub settings: usize,
}

/// Returns the options of both in one command line. `without`: names of recorded options that are left out.
pub(super) fn merged(command: &Command, recorded: Vec<Typed>, typed: &[Typed], without: &[String]) -> Merged {
    let beside = Beside::new(typed);
    let is_left_out = |option: &Typed| {
        let name = option.word.trim_start_matches('-').split('=').next().unwrap_or_default();
        without.iter().any(|other| other == name)
    };
    let mut words = Vec::new();
    let mut settings = 0;
    for option in recorded.into_iter().filter(|option| !is_left_out(option)) {
        if gives_way(command, &option, typed) || beside.ends(&option) {
            continue;
        }
        let as_settings = beside.as_settings(&option);
        settings += as_settings.len() + usize::from(option.id == SETTING);
        if as_settings.is_empty() {
            words.push(option.word);
        }
        words.extend(as_settings);
    }
    words.extend(typed.iter().map(|option| option.word.clone()));
    Merged { words, settings }
}

/// Returns the value of an option.
fn value(option: &Typed) -> &str {
    option.word.split_once('=').map_or("", |(_, value)| value)
}

/// What the typed options say of goals and settings.
struct Beside {
    settings: Vec<Setting>,
    has_goal: bool,
    has_spp: bool,
    algorithm: Option<Algorithm>,
}

impl Beside {
    fn new(typed: &[Typed]) -> Beside {
        let of = |id: &'static str| typed.iter().filter(move |option| option.id == id);
        let settings: Vec<Setting> = of(SETTING).filter_map(|option| value(option).parse().ok()).collect();
        let sets = |key: &str| settings.iter().rfind(|setting| is_at(setting, "sampling", key));
        let algorithm = of("algorithm").next_back().map(value);
        let algorithm = algorithm.map(str::to_owned).or(sets("algorithm").and_then(|s| s.strings().pop()));
        Beside {
            has_goal: GOALS.iter().any(|id| of(id).next().is_some()),
            has_spp: of("spp").next().is_some() || sets("spp").is_some(),
            algorithm: algorithm.and_then(|name| Algorithm::from_name(&name)),
            settings,
        }
    }

    /// Returns true for a recorded goal where a number of samples or an algorithm without a goal is typed, and for what
    /// excludes a typed goal.
    fn ends(&self, recorded: &Typed) -> bool {
        match recorded.id.as_str() {
            id if GOALS.contains(&id) => {
                let takes_none = self.algorithm.is_some_and(|algorithm| !algorithm.is_adaptive());
                !self.has_goal && (self.has_spp || takes_none)
            }
            "spp" => self.has_goal,
            "algorithm" => {
                let named = Algorithm::from_name(value(recorded));
                self.has_goal && named.is_some_and(|algorithm| !algorithm.is_adaptive())
            }
            _ => false,
        }
    }

    /// Returns the recorded option as settings where a typed setting is about the same, else none: settings are put in in
    /// their order, and options behind all of them.
    fn as_settings(&self, recorded: &Typed) -> Vec<String> {
        let Some((id, section, key)) = ALSO_SETTINGS.iter().find(|(id, ..)| *id == recorded.id) else {
            return Vec::new();
        };
        let Some(typed) = self.settings.iter().find(|setting| is_at(setting, section, key)) else {
            return Vec::new();
        };
        let value = value(recorded);
        let section = if *section == SAMPLER { "sampler.*" } else { section };
        let set = |key: &str, value: &str| format!("--set={section}.{key}={value}");
        match (*id, overrides::parse_size(value)) {
            // The scene has either both lengths or the size.
            ("size", Ok([width, height])) if typed.names().nth(1) == Some("size") => {
                vec![set("size", &format!("[{width},{height}]"))]
            }
            ("size", Ok(lengths)) => {
                ["width", "height"].iter().zip(lengths).map(|(key, own)| set(key, &own.to_string())).collect()
            }
            _ => vec![set(key, value)],
        }
    }
}

/// Returns true if a setting is of this key, or of a part of it, in this section.
fn is_at(setting: &Setting, section: &str, key: &str) -> bool {
    let names: Vec<&str> = setting.names().collect();
    // Tables of which there may be several have a name or a number.
    let own = names.get(if section == SAMPLER { 2 } else { 1 });
    let is_part = |own: &&str| *own == key || (key == "size" && matches!(*own, "width" | "height"));
    names.first() == Some(&section) && own.is_some_and(is_part)
}

/// Returns true if a recorded option is not to be used beside the typed ones: it is typed, or excluded by one of them. Of
/// overrides that may be given several times those of both count.
fn gives_way(command: &Command, recorded: &Typed, typed: &[Typed]) -> bool {
    let arg = |id: &str| command.get_arguments().find(|arg| arg.get_id() == id);
    let excludes = |a: &str, b: &str| {
        arg(a).is_some_and(|a| command.get_arg_conflicts_with(a).iter().any(|other| other.get_id() == b))
    };
    typed.iter().any(|option| {
        if option.id == recorded.id {
            let adds = |arg: &clap::Arg| matches!(arg.get_action(), ArgAction::Append);
            return !(super::overrides(&option.id) && arg(&option.id).is_some_and(adds));
        }
        excludes(&option.id, &recorded.id) || excludes(&recorded.id, &option.id)
    })
}
