//! The error type: kind, place, and the next step. Every variant except an interruption ends a command with exit code
//! 2; none is a panic.

use std::borrow::Cow;
use std::fmt::Display;
use std::iter;
use std::sync::Arc;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode, SourceSpan};

use super::printable::{printable, printable_in_place};

/// The result of operations that may fail with an [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// The kind of an error, for programs that act on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The device stopped answering: its driver crashed, or a watchdog reset it.
    DeviceLost,
    /// The device is out of memory.
    OutOfDeviceMemory,
    /// The host is out of memory.
    OutOfHostMemory,
    /// There is no Vulkan driver, or no device that matches the request.
    NoDevice,
    /// The device lacks a feature that the scene or the options need.
    Unsupported,
    /// A file cannot be read, decoded or written.
    File,
    /// The scene breaks a rule or a limit.
    Scene,
    /// An option, or a combination of options, is invalid.
    Options,
    /// The work was cancelled.
    Interrupted,
    /// A fault of this crate, of a library that it uses, or of the driver.
    Internal,
}

impl ErrorKind {
    /// Returns true if the same work may succeed when it is retried: on a device that is opened anew, or with more free
    /// memory.
    pub const fn is_transient(self) -> bool {
        matches!(self, ErrorKind::DeviceLost | ErrorKind::OutOfDeviceMemory | ErrorKind::OutOfHostMemory)
    }
}

/// An error. Its `Display` is one sentence that names the place; [`help`](Error::help) is the next step.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A mistake at a known place of a scene file. `message` already names file, line, column and key, so that it is
    /// complete even without the source excerpt.
    #[error("{message}")]
    #[non_exhaustive]
    Scene {
        /// File, line, column, key and the mistake.
        message: String,
        /// The label beside the caret.
        label: String,
        /// The scene file's text.
        source_code: Arc<NamedSource<String>>,
        /// The byte range in the text.
        span: SourceSpan,
        /// The next step, if the message does not state it.
        help: Option<String>,
    },
    /// Any other error on which the user can act.
    #[error("{message}")]
    #[non_exhaustive]
    Plain {
        /// The kind, for programs.
        kind: ErrorKind,
        /// The operation, the object, and the fault.
        message: String,
        /// The next step, if the message does not state it.
        help: Option<String>,
    },
    /// Ctrl-C: the device has finished its slice, nothing was written.
    #[error("interrupted: nothing was written")]
    Interrupted,
}

impl Error {
    /// Returns an error of kind [`ErrorKind::Options`], which [`of_kind`](Error::of_kind) changes.
    pub fn new(message: impl Into<String>) -> Self {
        Error::Plain { kind: ErrorKind::Options, message: message.into(), help: None }
    }

    /// Returns the error with a next step.
    pub fn with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Error::new(message).and_help(Some(help.into()))
    }

    /// Returns the error with another next step, or none.
    pub(crate) fn and_help(mut self, other: Option<String>) -> Self {
        if let Error::Scene { help, .. } | Error::Plain { help, .. } = &mut self {
            *help = other;
        }
        self
    }

    /// Returns the error with this kind; a mistake in a scene file and an interruption keep theirs.
    pub fn of_kind(mut self, other: ErrorKind) -> Self {
        if let Error::Plain { kind, .. } = &mut self {
            *kind = other;
        }
        self
    }

    /// Returns the error with this kind, unless it has one other than [`ErrorKind::Options`].
    pub(crate) fn or_kind(self, other: ErrorKind) -> Self {
        if self.kind() == ErrorKind::Options { self.of_kind(other) } else { self }
    }

    /// Returns the error with `place` and a colon before its message.
    pub(crate) fn within(mut self, place: &str) -> Self {
        if let Error::Plain { message, .. } = &mut self {
            *message = format!("{place}: {message}");
        }
        self
    }

    /// Returns the error without characters that a terminal obeys.
    pub(crate) fn printable(mut self) -> Self {
        let in_line = |text: &mut String| {
            if let Cow::Owned(shown) = printable(text) {
                *text = shown;
            }
        };
        match &mut self {
            Error::Scene { message, label, source_code, help, .. } => {
                [message, label].into_iter().chain(help).for_each(in_line);
                let name = printable(source_code.name()).into_owned();
                *source_code = Arc::new(NamedSource::new(name, printable_in_place(source_code.inner())));
            }
            Error::Plain { message, help, .. } => iter::once(message).chain(help).for_each(in_line),
            Error::Interrupted => {}
        }
        self
    }

    /// Returns a mistake in a text as one in a copy of it that is kept elsewhere.
    pub(crate) fn in_copy(mut self, place: &str) -> Self {
        match &mut self {
            Error::Scene { message, source_code, .. } => {
                let name = format!("{} in {place}", source_code.name());
                *source_code = Arc::new(NamedSource::new(name, source_code.inner().clone()));
                *message = format!("{place}: {message}");
                self
            }
            _ => self.within(place),
        }
    }

    /// Returns the kind of the error.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Error::Scene { .. } => ErrorKind::Scene,
            Error::Plain { kind, .. } => *kind,
            Error::Interrupted => ErrorKind::Interrupted,
        }
    }

    /// Returns the next step, if the message does not state it.
    pub fn help(&self) -> Option<&str> {
        match self {
            Error::Scene { help, .. } | Error::Plain { help, .. } => help.as_deref(),
            Error::Interrupted => None,
        }
    }
}

/// The parts of an error shown beside its message. Written out: the derive macro takes ten seconds of a first build.
impl Diagnostic for Error {
    fn help(&self) -> Option<Box<dyn Display + '_>> {
        Error::help(self).map(|help| Box::new(help) as Box<dyn Display + '_>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self {
            Error::Scene { source_code, .. } => Some(source_code),
            _ => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        match self {
            Error::Scene { label, span, .. } => {
                Some(Box::new(iter::once(LabeledSpan::new_with_span(Some(label.clone()), *span))))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_that_is_known_is_kept() {
        let lost = || Error::new("lost").of_kind(ErrorKind::DeviceLost);
        assert_eq!(lost().or_kind(ErrorKind::File).kind(), ErrorKind::DeviceLost);
        assert_eq!(Error::new("x").or_kind(ErrorKind::File).kind(), ErrorKind::File);
        assert_eq!(Error::Interrupted.of_kind(ErrorKind::File).kind(), ErrorKind::Interrupted);
        assert!(lost().kind().is_transient() && !Error::new("x").kind().is_transient());
        assert_eq!(Error::with_help("a", "b").within("c").to_string(), "c: a");
    }
}
