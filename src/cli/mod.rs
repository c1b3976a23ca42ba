//! The command line: one file a subcommand, each with its arguments and a `run`.

pub mod compare;
pub mod devices;
mod overrides;
mod progress;
pub mod render;
mod report;

use std::io::{self, ErrorKind, Write};

use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::error::{Error, Result};

/// One piece of text to stdout. A reader that stops early, such as `head`, is no error.
fn print(text: &str) -> Result<()> {
    match writeln!(io::stdout().lock(), "{text}") {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::new(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}

/// A value parser over a vocabulary: clap lists the names and suggests the nearest.
fn named_parser<T: Clone + Send + Sync + 'static>(
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names)
        .try_map(move |name| from_name(&name).ok_or_else(|| format!("\"{name}\" is not known")))
}
