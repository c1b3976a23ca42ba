//! Converts panics of this program and of its libraries into errors that name the stage. A decoder
//! that fails on an unexpected file then ends the command with a message and exit code 2, like any
//! other invalid input.

use std::any::Any;
use std::fmt::Display;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Mutex;

use crate::core::error::{Error, ErrorKind, Result};

/// The message and location of the last panic of any thread: a panic in a joined thread reaches the
/// guard without its location.
static LAST: Mutex<Option<String>> = Mutex::new(None);

/// Records panic messages for the error instead of Rust's own output on stderr. Intended for a
/// program, not for a library.
pub fn record() {
    panic::set_hook(Box::new(|info| {
        let place =
            info.location().map_or(String::new(), |at| format!(" ({}:{})", short(at.file()), at.line()));
        let said = format!("{}{place}", message(info.payload()));
        *LAST.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(said);
    }));
}

/// Runs `work` and returns a panic in it, or in a thread that it joins, as an error. The state of
/// `work` is not used afterwards.
pub fn contain<T>(stage: &dyn Display, work: impl FnOnce() -> Result<T>) -> Result<T> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let last = LAST.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
        let said = last.unwrap_or_else(|| message(&*payload));
        Err(Error::with_help(
            format!("{stage}: the program failed where it should not: {said}"),
            "this is a fault of moire or of a library that it uses: please report it with the input that it fails on",
        )
        .of_kind(ErrorKind::Internal))
    })
}

fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    text.or(payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message").to_string()
}

/// Returns crate and file without the machine's own folders.
fn short(file: &str) -> &str {
    let start = file.match_indices(['/', '\\']).map(|(at, _)| at + 1).rev().nth(2);
    start.map_or(file, |at| &file[at..])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message_of(work: impl FnOnce() -> Result<()>) -> String {
        contain(&"reading a.tif", work).expect_err("it panics").to_string()
    }

    #[test]
    fn panics_of_any_thread_are_errors_that_name_the_stage() {
        use rayon::prelude::*;
        let empty: &[u8] = &[];
        let in_rayon =
            || (0..64).into_par_iter().try_for_each(|i| if i == 63 { panic!("row {i}") } else { Ok(()) });
        let in_scope = || {
            std::thread::scope(|scope| {
                let joined = scope.spawn(|| panic!("in a thread")).join();
                joined.unwrap_or_else(|payload| panic::resume_unwind(payload))
            })
        };
        for message in [
            message_of(|| panic!("a literal")),
            message_of(|| Err(Error::new(format!("{}", empty[0])))),
            message_of(in_rayon),
            message_of(in_scope),
        ] {
            assert!(message.starts_with("reading a.tif: the program failed"), "{message}");
        }
        assert!(matches!(contain(&"x", || Ok(7)), Ok(7)));
        let refused = contain::<()>(&"x", || Err(Error::new("as it was"))).expect_err("an error").to_string();
        assert_eq!(refused, "as it was");
    }

    #[test]
    fn places_do_not_tell_folders_of_the_machine() {
        assert_eq!(short("/home/a/.cargo/registry/src/index/tiff-0.1/src/lib.rs"), "tiff-0.1/src/lib.rs");
        assert_eq!(short("src/main.rs"), "src/main.rs");
    }
}
