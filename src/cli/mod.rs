//! The command line: one file a subcommand, each with its arguments and a `run`.

pub mod compare;
pub mod devices;
mod overrides;
mod progress;
pub mod render;
mod report;
pub mod texture;

use clap::builder::{PossibleValuesParser, TypedValueParser};

/// A value parser over a vocabulary: clap lists the names and suggests the nearest.
fn named_parser<T: Clone + Send + Sync + 'static>(
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names)
        .try_map(move |name| from_name(&name).ok_or_else(|| format!("\"{name}\" is not known")))
}
