//! The one error type: what went wrong, where, and what to do about it. Every variant ends a
//! command with exit code 2; none is ever a panic.

use std::fmt::Display;
use std::iter;
use std::sync::Arc;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode, SourceSpan};

pub type Result<T, E = Error> = std::result::Result<T, E>;

#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A mistake at a known place of a scene file. `message` already names file, line, column and
    /// key, so that it is complete even where the source excerpt is not shown.
    #[error("{message}")]
    Scene {
        message: String,
        label: String,
        source_code: Arc<NamedSource<String>>,
        span: SourceSpan,
        help: Option<String>,
    },
    /// Anything else a person can act on.
    #[error("{message}")]
    Plain { message: String, help: Option<String> },
    /// Ctrl-C: the device has finished its slice, nothing was written.
    #[error("interrupted: nothing was written")]
    Interrupted,
}

impl Error {
    pub fn new(message: impl Into<String>) -> Self {
        Error::Plain { message: message.into(), help: None }
    }

    pub fn with_help(message: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Plain { message: message.into(), help: Some(help.into()) }
    }
}

/// What is shown of an error beside its message. Written out: the derive macro is ten seconds of a first build.
impl Diagnostic for Error {
    fn help(&self) -> Option<Box<dyn Display + '_>> {
        match self {
            Error::Scene { help, .. } | Error::Plain { help, .. } => {
                help.as_ref().map(|help| Box::new(help) as Box<dyn Display + '_>)
            }
            Error::Interrupted => None,
        }
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
