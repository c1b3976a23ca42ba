//! The command line: one file a subcommand, each with its arguments and a `run`.

pub mod compare;
pub mod devices;
mod outputs;
mod overrides;
pub mod pattern;
mod progress;
pub mod render;
mod report;
pub mod stability;
pub mod study;
pub mod texture;
pub mod verify;

use std::ffi::OsStr;
use std::fmt::Display;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::builder::{PossibleValue, PossibleValuesParser, StyledStr, TypedValueParser};
use clap::error::{ContextKind, ContextValue};

use crate::core::error::{Error, Result};
use crate::core::panics;
use crate::gpu;
use crate::scene::synonyms::meant;

/// Groups of options in the help.
const OUTPUT: &str = "Output";
const SAMPLING: &str = "Sampling";
const TEXTURES: &str = "Textures";
const DEVICE: &str = "Device";
const MEASURING: &str = "Measuring";

/// To be called once, before anything else: a write beyond the size limit of files (`ulimit -f`) is then an error
/// like that of a full disk, where it would end the program and leave a temporary file; drivers find a cache that
/// they can write; and where no person reads stderr, messages keep to their own lines, so that what they quote
/// stays whole.
pub fn prepare_process() {
    gpu::prepare_driver_cache();
    #[cfg(unix)]
    {
        let noticed = std::sync::Arc::default();
        // Refused only for signals that cannot be caught, of which this is none.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noticed);
    }
    let wrapped = io::stderr().is_terminal();
    // An error only where a hook is set already.
    let _ = miette::set_hook(Box::new(move |_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(wrapped).break_words(false).build())
    }));
}

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

/// A picture on stdout, byte by byte.
fn print_bytes(bytes: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
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

/// A value parser over a vocabulary: clap lists the names and suggests the nearest, or the one that other programs
/// call by the word that was given.
fn named_parser<T: Clone + Send + Sync + 'static>(
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
) -> Named<T> {
    Named { names, from_name }
}

#[derive(Clone)]
struct Named<T> {
    names: &'static [&'static str],
    from_name: fn(&str) -> Option<T>,
}

impl<T: Clone + Send + Sync + 'static> TypedValueParser for Named<T> {
    type Value = T;

    fn parse_ref(
        &self,
        command: &clap::Command,
        arg: Option<&clap::Arg>,
        value: &OsStr,
    ) -> std::result::Result<T, clap::Error> {
        let name =
            PossibleValuesParser::new(self.names).parse_ref(command, arg, value).map_err(|mut error| {
                if let Some((name, also)) =
                    value.to_str().and_then(|word| meant(word, self.names.iter().copied()))
                {
                    error.insert(ContextKind::SuggestedValue, ContextValue::String(name.into()));
                    if let Some((key, value)) = also {
                        let tip = StyledStr::from(format!("with it goes '--{key} {value}'"));
                        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
                    }
                }
                error
            })?;
        (self.from_name)(&name).ok_or_else(|| clap::Error::new(clap::error::ErrorKind::InvalidValue))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names.iter().map(PossibleValue::new)))
    }
}
