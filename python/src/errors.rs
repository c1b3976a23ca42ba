//! Errors as exceptions. In: an error of the crate. Out: an exception of the class of `moire._errors` that its kind has.

use moire::{Error, ErrorKind};
use pyo3::prelude::*;

/// The module of Python that defines the classes.
const MODULE: &str = "moire._errors";

/// Returns the name of the class of a kind.
fn class_of(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::DeviceLost => "DeviceLostError",
        ErrorKind::OutOfDeviceMemory => "OutOfDeviceMemoryError",
        ErrorKind::OutOfHostMemory => "OutOfHostMemoryError",
        ErrorKind::NoDevice => "NoDeviceError",
        ErrorKind::Unsupported => "UnsupportedError",
        ErrorKind::File => "FileError",
        ErrorKind::Scene => "SceneError",
        ErrorKind::Options => "OptionsError",
        ErrorKind::Interrupted => "Interrupted",
        ErrorKind::Internal => "InternalError",
        _ => "Error",
    }
}

/// Returns a text with the options of the program as Python writes them, unless it has a command.
pub fn plain(text: &str) -> String {
    if text.contains("moire ") {
        return text.to_owned();
    }
    let word =
        |word: &str| word.strip_prefix("--").map_or(word.to_owned(), |option| option.replace('-', "_"));
    text.split_inclusive(' ').map(word).collect()
}

/// Returns the exception of an error.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let class = py.import(MODULE).and_then(|module| module.getattr(class_of(error.kind())));
    match class.and_then(|class| class.call1((plain(&error.to_string()), error.help().map(plain)))) {
        Ok(value) => PyErr::from_value(value),
        Err(other) => other,
    }
}

/// Returns the error with this kind, unless it has one other than [`ErrorKind::Options`], which errors have by default.
pub fn or_kind(error: Error, kind: ErrorKind) -> Error {
    if error.kind() == ErrorKind::Options { error.of_kind(kind) } else { error }
}
