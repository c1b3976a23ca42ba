//! The process that works. In: each call that starts threads or devices. Out: an error where the process was forked from one
//! that had done so: threads and devices do not come along, and whoever waits for them waits forever.

use std::process;
use std::sync::atomic::{AtomicU32, Ordering};

use moire::{Error, ErrorKind, Result};
use pyo3::prelude::*;

use crate::errors::exception;

/// The process that has begun to work; 0 before.
static OWNER: AtomicU32 = AtomicU32::new(0);

/// Returns true if this process was forked from one that had begun to work.
pub fn is_forked() -> bool {
    ![0, process::id()].contains(&OWNER.load(Ordering::Relaxed))
}

/// Refuses work in a forked process.
pub fn check(py: Python<'_>) -> PyResult<()> {
    let refused = || -> Result<()> {
        let what = "this process was forked from one that had worked with moire: its threads and devices did not come along";
        let help =
            "start processes with multiprocessing.get_context(\"spawn\"), or call moire only in the new ones";
        Err(Error::with_help(what, help).of_kind(ErrorKind::Unsupported))
    };
    if is_forked() { refused().map_err(|error| exception(py, &error)) } else { Ok(()) }
}

/// Begins to work in this process, or refuses to.
pub fn begin(py: Python<'_>) -> PyResult<()> {
    check(py)?;
    OWNER.store(process::id(), Ordering::Relaxed);
    Ok(())
}
