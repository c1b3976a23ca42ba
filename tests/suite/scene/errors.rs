//! Requirements of every scene error, and tables of (rule, scene, words that the message must
//! contain).

use std::path::Path;

use miette::GraphicalReportHandler;
use moire::internal::core::error::Error;
use moire::internal::scene::parse;

use super::HEAD;

pub const PATH: &str = "scenes/a.toml";

/// Returns the message, after checking the requirements of every scene error: one line, a position, a caret
/// within the text.
pub fn message(text: &str) -> Result<String, String> {
    let Err(error) = parse(Path::new(PATH), text) else { return Err("no error".to_owned()) };
    let Error::Scene { message, label, span, source_code, .. } = &error else {
        return Err(format!("not a scene error: {error}"));
    };
    let place = message.strip_prefix("scenes/a.toml:").and_then(|rest| rest.split_once(": "));
    let (line, column) = place.and_then(|(place, _)| place.split_once(':')).unwrap_or_default();
    let numbers = line.parse::<usize>().and(column.parse::<usize>());
    if numbers.is_err() || message.contains('\n') || label.is_empty() {
        return Err(format!("malformed message or label: {message:?} {label:?}"));
    }
    if span.offset() + span.len() > source_code.inner().len() {
        return Err(format!("span {span:?} ends beyond the text"));
    }
    let mut report = String::new();
    let rendered = GraphicalReportHandler::new().render_report(&mut report, &error);
    rendered.map_err(|_| format!("no report for {message}"))?;
    Ok(message.clone())
}

pub fn check(cases: &[(&str, &str, &[&str])]) {
    let mut failures = String::new();
    for (rule, text, fragments) in cases {
        match message(text) {
            Err(fault) => failures += &format!("\n{rule}: {fault}"),
            Ok(message) => {
                for fragment in fragments.iter().filter(|fragment| !message.contains(**fragment)) {
                    failures += &format!("\n{rule}: {fragment:?} is not in: {message}");
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

/// Cases whose snippet follows a good camera and image.
pub fn check_behind_head(cases: &[(&str, &str, &[&str])]) {
    let texts: Vec<String> = cases.iter().map(|(_, snippet, _)| format!("{HEAD}{snippet}\n")).collect();
    let cases: Vec<_> = cases
        .iter()
        .zip(&texts)
        .map(|((rule, _, fragments), text)| (*rule, text.as_str(), *fragments))
        .collect();
    check(&cases);
}

/// Cases that replace one piece of a good camera and image.
pub fn check_replaced(cases: &[(&str, &str, &str, &[&str])]) {
    let texts: Vec<String> = cases
        .iter()
        .map(|(rule, from, to, _)| {
            assert!(HEAD.contains(from), "{rule}");
            HEAD.replace(from, to)
        })
        .collect();
    let cases: Vec<_> =
        cases.iter().zip(&texts).map(|((rule, _, _, f), text)| (*rule, text.as_str(), *f)).collect();
    check(&cases);
}
