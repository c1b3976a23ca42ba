//! The options of a command line as they were typed. In: what clap matched. Out: words that, parsed again, match the
//! same: one `--name=value` for each value, `--name` for a flag. Defaults are not among them, nor are arguments without
//! a name.

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};

/// An option and a value of it, if it takes any.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Typed {
    /// The identifier of the option in its command.
    pub id: String,
    /// The word of the command line.
    pub word: String,
}

/// Returns the typed options of a command.
pub fn options(command: &Command, matches: &ArgMatches) -> Vec<Typed> {
    command.get_arguments().flat_map(|arg| of(arg, matches)).collect()
}

fn of(arg: &Arg, matches: &ArgMatches) -> Vec<Typed> {
    let id = arg.get_id().as_str();
    let is_typed = matches.try_contains_id(id).unwrap_or(false)
        && matches.value_source(id) == Some(ValueSource::CommandLine);
    let Some(name) = arg.get_long().filter(|_| is_typed) else { return Vec::new() };
    let typed = |word: String| Typed { id: id.to_owned(), word };
    if matches!(arg.get_action(), ArgAction::SetTrue) {
        return vec![typed(format!("--{name}"))];
    }
    let values = matches.get_raw(id).into_iter().flatten();
    values.map(|value| typed(format!("--{name}={}", value.to_string_lossy()))).collect()
}
