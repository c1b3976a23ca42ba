//! The one error type: what went wrong, where, and what to do about it. Every variant ends a
//! command with exit code 2; none is ever a panic.

use std::sync::Arc;

use miette::{Diagnostic, NamedSource, SourceSpan};

pub type Result<T, E = Error> = std::result::Result<T, E>;

#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum Error {
    /// A mistake at a known place of a scene file. `message` already names file, line, column and
    /// key, so that it is complete even where the source excerpt is not shown.
    #[error("{message}")]
    Scene {
        message: String,
        label: String,
        #[source_code]
        source_code: Arc<NamedSource<String>>,
        #[label("{label}")]
        span: SourceSpan,
        #[help]
        help: Option<String>,
    },
    /// Anything else a person can act on.
    #[error("{message}")]
    Plain {
        message: String,
        #[help]
        help: Option<String>,
    },
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
