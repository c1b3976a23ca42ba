//! The one error type: what kind of thing went wrong, where, and what to do about it. Every variant but an
//! interruption ends a command with exit code 2; none is ever a panic.

use std::fmt::Display;
use std::iter;
use std::sync::Arc;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode, SourceSpan};

/// The result of whatever may fail with an [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Which kind of thing went wrong, for programs that act on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The device stopped answering: its driver crashed, or a watchdog reset it.
    DeviceLost,
    /// The device has no memory left for what was asked of it.
    OutOfDeviceMemory,
    /// The host has no memory left.
    OutOfHostMemory,
    /// There is no Vulkan driver, or no device like the one that was asked for.
    NoDevice,
    /// The device cannot do what the scene or the options need.
    Unsupported,
    /// A file cannot be read, decoded or written.
    File,
    /// The scene breaks a rule or a limit.
    Scene,
    /// An option, or several together, make no sense.
    Options,
    /// The work was asked to stop.
    Interrupted,
    /// A fault of this crate, of a library that it uses, or of the driver.
    Internal,
}

impl ErrorKind {
    /// Returns whether the same work may succeed when it is tried again: on a device that is opened anew, or with
    /// more memory free.
    pub const fn is_transient(self) -> bool {
        matches!(self, ErrorKind::DeviceLost | ErrorKind::OutOfDeviceMemory | ErrorKind::OutOfHostMemory)
    }
}

/// What went wrong. Its `Display` is one sentence that names the place; [`help`](Error::help) says what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A mistake at a known place of a scene file. `message` already names file, line, column and
    /// key, so that it is complete even where the source excerpt is not shown.
    #[error("{message}")]
    #[non_exhaustive]
    Scene {
        /// File, line, column, key and what is wrong.
        message: String,
        /// What stands beside the caret.
        label: String,
        /// The scene file's text.
        source_code: Arc<NamedSource<String>>,
        /// Where in the text.
        span: SourceSpan,
        /// What to do about it, where the message does not say so.
        help: Option<String>,
    },
    /// Anything else a person can act on.
    #[error("{message}")]
    #[non_exhaustive]
    Plain {
        /// For programs.
        kind: ErrorKind,
        /// What was being done, to which object, and what is wrong.
        message: String,
        /// What to do about it, where the message does not say so.
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

    /// Returns the same with what to do about it.
    pub fn with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Error::new(message).and_help(Some(help.into()))
    }

    /// Returns the error with another help, or none.
    pub(crate) fn and_help(mut self, other: Option<String>) -> Self {
        if let Error::Scene { help, .. } | Error::Plain { help, .. } = &mut self {
            *help = other;
        }
        self
    }

    /// Returns the error as one of this kind; a mistake in a scene file and an interruption stay what they are.
    pub fn of_kind(mut self, other: ErrorKind) -> Self {
        if let Error::Plain { kind, .. } = &mut self {
            *kind = other;
        }
        self
    }

    /// Returns the error as one of this kind, unless it already says more than that an option makes no sense.
    pub(crate) fn or_kind(self, other: ErrorKind) -> Self {
        if self.kind() == ErrorKind::Options { self.of_kind(other) } else { self }
    }

    /// Returns the error with its message behind `place` and a colon.
    pub(crate) fn within(mut self, place: &str) -> Self {
        if let Error::Plain { message, .. } = &mut self {
            *message = format!("{place}: {message}");
        }
        self
    }

    /// Returns which kind of thing went wrong.
    pub fn kind(&self) -> ErrorKind {
        match self {
            Error::Scene { .. } => ErrorKind::Scene,
            Error::Plain { kind, .. } => *kind,
            Error::Interrupted => ErrorKind::Interrupted,
        }
    }

    /// Returns what to do about it, where the message does not say so.
    pub fn help(&self) -> Option<&str> {
        match self {
            Error::Scene { help, .. } | Error::Plain { help, .. } => help.as_deref(),
            Error::Interrupted => None,
        }
    }
}

/// What is shown of an error beside its message. Written out: the derive macro is ten seconds of a first build.
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
