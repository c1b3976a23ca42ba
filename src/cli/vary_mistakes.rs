//! What is wrong with a `--vary`. Input: names and values that do not fit. Output: messages that name the axis, the value,
//! what is allowed there, and the nearest of it.

use std::collections::BTreeMap;
use std::error::Error as _;
use std::sync::Arc;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use miette::NamedSource;

use super::vary_values::RANGES;
use crate::core::error::Error;
use crate::scene::synonyms::meant;
use crate::scene::{path_of, suggestion};

/// Returns the message for a name that is not among `names`.
pub(super) fn unknown(name: &str, names: &[String]) -> String {
    let option = name.replace('_', "-");
    let options = names.iter().map(String::as_str);
    let near = match path_of(name).filter(|_| meant(&option, options.clone()).is_none()) {
        Some(path) => format!("; did you mean \"{path}\"?"),
        None => suggestion(&option, options),
    };
    format!(
        "\"{name}\" is no option that can vary: {}; and keys of the scene, such as sampler.NAME.address{near}",
        names.join(", ")
    )
}

/// Returns the error for a value that does not parse; without a name, for a combination of values.
pub(super) fn wrong(name: &str, value: &str, error: &clap::Error) -> Error {
    if name.is_empty() {
        let text = error.to_string();
        let said = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        return Error::with_help(format!("--vary: {said}"), "vary one of them, and leave the other away");
    }
    let what = match (error.kind(), error.get(ContextKind::ValidValue), error.source()) {
        (ErrorKind::InvalidValue, Some(ContextValue::Strings(allowed)), _) => {
            let near = suggestion(value, allowed.iter().map(String::as_str));
            format!("\"{value}\" is none of its values: {}{near}", allowed.join(", "))
        }
        (_, _, Some(source)) => format!("\"{value}\": {source}"),
        _ => {
            let text = error.to_string();
            format!("\"{value}\": {}", text.lines().next().unwrap_or_default().trim_start_matches("error: "))
        }
    };
    let what = format!("--vary {name}: {what}");
    // Who writes dots means a range.
    if value.contains("..") { Error::with_help(what, RANGES) } else { Error::new(what) }
}

/// Returns an error of a scene as one of `--vary`, where it is one of a key or an option that varies.
pub(super) fn of_scene(settings: &BTreeMap<String, String>, error: Error) -> Error {
    let renamed = |text: String| {
        settings.iter().fold(text, |text, (name, value)| {
            let told = format!("--vary {name}: {value}");
            match text.strip_prefix(&format!("--{name}: ")) {
                Some(rest) => format!("{told}: {rest}"),
                None => text.replace(&format!("--set {name}={value}"), &told),
            }
        })
    };
    match error {
        Error::Scene { message, label, source_code, span, help } => {
            let text = source_code.inner();
            let is_varied = settings.iter().any(|(name, value)| *text == format!("{name}={value}"));
            let source_code = match is_varied && source_code.name() == "--set" {
                true => Arc::new(NamedSource::new("--vary", text.clone())),
                false => source_code,
            };
            Error::Scene { message: renamed(message), label, source_code, span, help }
        }
        Error::Plain { kind, message, help } => Error::Plain { kind, message: renamed(message), help },
        Error::Interrupted => error,
    }
}
