//! The command line: one file per subcommand, each with its arguments and a `run`.

pub mod account;
mod checksums;
pub mod compare;
pub mod completions;
pub mod devices;
mod display;
mod help;
mod inputs;
pub mod inspect;
mod interrupt;
mod layers;
pub mod man;
pub mod new;
mod outputs;
mod overrides;
pub mod pattern;
pub mod program;
mod progress;
pub mod quantity;
pub mod record;
pub mod render;
mod render_args;
mod replay;
mod report;
pub mod sheet;
pub mod stability;
pub mod study;
pub mod texture;
mod texture_levels;
mod typed;
mod vary;
mod vary_conflicts;
mod vary_mistakes;
mod vary_values;
pub mod verify;
pub mod version;
pub mod view;
mod watch;
mod words;

use std::fmt::Display;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::process::ExitCode;

use crate::core::error::{Error, Result};
use crate::core::panics;
use crate::core::printable::printable;
use crate::gpu;
use words::named_parser;

/// Headings of option groups in the help: what a person wants to do.
const VIEW: &str = "Choose what is seen";
const OUTPUT: &str = "Write files";
const REPORT: &str = "Tell more or less";
const DISPLAY: &str = "Show on a screen";
const SAMPLING: &str = "Take samples";
const GOAL: &str = "Stop at a goal";
const PIXELS: &str = "Filter pixels";
const TEXTURES: &str = "Filter textures";
const DEVICE: &str = "Choose devices";
const MEASURING: &str = "Measure";

/// Prepares the process. Must be called once, before anything else: a write beyond the file size
/// limit (`ulimit -f`) then returns an error like a full disk, instead of a signal that would end
/// the program and leave a temporary file; drivers get a writable shader cache; large blocks of
/// memory go back to the system when they are freed; and if stderr is not a terminal, messages are
/// not wrapped, so that quoted text stays intact.
pub fn prepare_process() {
    gpu::prepare_driver_cache();
    gpu::prepare_host_memory();
    #[cfg(unix)]
    {
        let noticed = std::sync::Arc::default();
        // Registration fails only for signals that cannot be caught, of which this is none.
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noticed);
    }
    let wrapped = io::stderr().is_terminal();
    // This fails only if a hook is set already.
    let _ = miette::set_hook(Box::new(move |_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(wrapped).break_words(false).build())
    }));
}

/// Prints a line on stderr, without characters that a terminal obeys, as files may have them in names and texts. If
/// stderr cannot be written (a closed pipe, a full disk) the work continues, and the exit code still reports the result.
pub fn notify(line: impl Display) {
    notify_styled(&printable(&line.to_string()));
}

/// Prints lines that may have styles of our own.
fn notify_styled(lines: &str) {
    let _ = writeln!(io::stderr().lock(), "{lines}");
}

/// Returns the exit code of a command and prints its error.
pub fn exit_code(result: Result<ExitCode>) -> ExitCode {
    result.unwrap_or_else(|error| {
        let code = if matches!(error, Error::Interrupted) { 130 } else { 2 };
        tell(error);
        ExitCode::from(code)
    })
}

/// Prints an error with its place and help.
fn tell(error: Error) {
    let error = error.printable();
    let plain = error.to_string();
    // The excerpt of a scene file is formatted by a library, whose panics are contained too.
    let report = panics::contain(&"an error message", || Ok(format!("{:?}", miette::Report::new(error))));
    notify_styled(&report.unwrap_or(plain));
}

/// Prints a result on stdout, without characters that a terminal obeys. A reader that stops early, such as `head`, is not
/// an error.
fn print(text: &str) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match writeln!(stdout, "{}", printable(text)).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::new(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}

/// Writes a picture to stdout as bytes.
fn print_bytes(bytes: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(Error::new(format!("standard output: {e}"))),
        _ => Ok(()),
    }
}
