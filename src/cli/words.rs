//! Words of the command line that are not known. In: the word, and those that stand for something in its place: values of an
//! option, options, commands. Out: an error that names the most similar one, or the one that other programs' word means.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, PossibleValuesParser, StyledStr, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};

use crate::scene::nearest;
use crate::scene::synonyms::absent;

/// Returns a value parser of a vocabulary.
pub fn named_parser<T: Clone + Send + Sync + 'static>(
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
) -> Named<T> {
    Named { names, from_name }
}

#[derive(Clone)]
pub struct Named<T> {
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
}

impl<T: Clone + Send + Sync + 'static> TypedValueParser for Named<T> {
    type Value = T;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<T, Error> {
        let name = PossibleValuesParser::new(self.names).parse_ref(command, arg, value).map_err(|error| {
            let option = arg.and_then(Arg::get_long).unwrap_or_default();
            with_value(error, value.to_str().unwrap_or_default(), option, self.names)
        })?;
        (self.from_name)(&name).ok_or_else(|| Error::new(ErrorKind::InvalidValue))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names.iter().map(PossibleValue::new)))
    }
}

/// Adds what was meant to the error of an unknown value of an option.
fn with_value(mut error: Error, word: &str, option: &str, names: &[&str]) -> Error {
    if let Some((name, also)) = nearest(word, names.iter().copied()) {
        error.insert(ContextKind::SuggestedValue, ContextValue::String(name.into()));
        // A word for two options may stand at either.
        if let Some((key, value)) = also.filter(|(key, _)| *key != option) {
            error.insert(ContextKind::Suggested, tip(format!("with it goes '--{key} {value}'")));
        }
    } else if let Some(instead) = absent(word) {
        error.insert(ContextKind::Suggested, tip(format!("{word}: {instead}")));
    }
    error
}

fn tip(text: String) -> ContextValue {
    ContextValue::StyledStrs(vec![StyledStr::from(text)])
}

/// Adds what was meant to the error of an unknown command or option. `arguments`: all words behind the program's name.
pub fn advised(mut error: Error, command: &Command, arguments: &[String]) -> Error {
    let text = |error: &Error, kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.clone(),
        _ => String::new(),
    };
    match error.kind() {
        ErrorKind::InvalidSubcommand => {
            let word = text(&error, ContextKind::InvalidSubcommand);
            let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
            if let Some((name, _)) = nearest(&word, names.iter().copied()) {
                error.insert(ContextKind::SuggestedSubcommand, ContextValue::String(name.into()));
            }
        }
        ErrorKind::UnknownArgument => {
            let word = text(&error, ContextKind::InvalidArg);
            let own = arguments.iter().find_map(|word| command.find_subcommand(word)).unwrap_or(command);
            let names: Vec<&str> = own.get_arguments().filter_map(Arg::get_long).collect();
            let word = word.trim_start_matches('-').replace('_', "-");
            if let Some((name, _)) = nearest(&word, names.iter().copied()) {
                error.insert(ContextKind::SuggestedArg, ContextValue::String(format!("--{name}")));
                error.remove(ContextKind::Suggested);
                // It shows the option that the parser took it for.
                error.remove(ContextKind::Usage);
            }
        }
        _ => {}
    }
    error
}
