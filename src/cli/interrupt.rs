//! Ctrl-C in commands that are over in a moment, or that cannot stop half-way and go on later. In: the signal. Out: the end of
//! the program with exit code 130, and nothing unfinished on the disk.

use crate::core::error::{Error, Result};
use crate::output::discard_and_end;

/// The exit code of an interrupted program.
const INTERRUPTED: i32 = 130;

/// Has Ctrl-C, and a request to terminate, end the program at once.
pub fn ends_at_once() -> Result<()> {
    ctrlc::set_handler(|| discard_and_end(end))
        .map_err(|e| Error::new(format!("cannot listen to Ctrl-C: {e}")))
}

/// Ends without running what other threads may be in the middle of.
#[cfg(unix)]
fn end() {
    signal_hook::low_level::exit(INTERRUPTED);
}

#[cfg(not(unix))]
fn end() {
    std::process::exit(INTERRUPTED);
}
