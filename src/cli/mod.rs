//! The command line: one file a subcommand, each with its arguments and a `run`.

pub mod compare;
pub mod devices;
mod overrides;
pub mod pattern;
mod progress;
pub mod render;
mod report;
pub mod stability;
pub mod study;
pub mod texture;
pub mod verify;

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::builder::{PossibleValuesParser, TypedValueParser};

use crate::error::{Error, Result};
use crate::panics;

/// A line on stderr. Where nobody can read it any more (a closed pipe, a full disk) there is nobody to
/// tell either: the work goes on and the exit code still says how it ended.
pub fn tell(line: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// The code of a command that has ended; an error is told.
pub fn exit_code(result: Result<ExitCode>) -> ExitCode {
    result.unwrap_or_else(|error| {
        let code = if matches!(error, Error::Interrupted) { 130 } else { 2 };
        let plain = error.to_string();
        // Showing lines of a scene file is work for a library too.
        let report = panics::contain(&"an error message", || Ok(format!("{:?}", miette::Report::new(error))));
        tell(report.unwrap_or(plain));
        ExitCode::from(code)
    })
}

/// A result on stdout. A reader that stops early, such as `head`, is no error.
fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::new(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}

/// Refuses to write over `input`, which is `what`.
fn check_input_kept(output: &Path, input: &Path, what: &str) -> Result<()> {
    let same = output.canonicalize().is_ok_and(|o| input.canonicalize().is_ok_and(|i| i == o));
    if !same {
        return Ok(());
    }
    Err(Error::with_help(
        format!("{}: this is {what}, which the picture would replace", output.display()),
        "choose another name for the picture with -o",
    ))
}

/// A value parser over a vocabulary: clap lists the names and suggests the nearest.
fn named_parser<T: Clone + Send + Sync + 'static>(
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names)
        .try_map(move |name| from_name(&name).ok_or_else(|| format!("\"{name}\" is not known")))
}
