//! A scene's text and its path, and the settings given beside it, whose positions lie behind the text. Input: a byte range
//! and a message. Output: an [`Error::Scene`] whose one-line message names file, line and column (both from 1, columns in
//! characters), or the setting; also excerpts for messages.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::NamedSource;

use crate::core::error::Error;
use crate::scene::setting::Setting;
use crate::scene::suggestion::{LONGEST_EXCERPT, shorten};

#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub path: &'a Path,
    pub text: &'a str,
    pub settings: &'a [Setting],
}

/// The file's text or a setting's, and where it begins.
struct Part<'a> {
    text: &'a str,
    base: usize,
    setting: Option<&'a Setting>,
}

impl<'a> Source<'a> {
    /// Returns the settings, each with the position of its text.
    pub fn placed_settings(self) -> impl Iterator<Item = (&'a Setting, usize)> {
        let mut base = self.text.len() + 1;
        self.settings.iter().map(move |setting| {
            let own = base;
            base += setting.text().len() + 1;
            (setting, own)
        })
    }

    /// Returns true for a position in the file.
    pub fn is_of_file(self, at: usize) -> bool {
        at <= self.text.len()
    }

    /// Returns the path that a value means: relative to the file's folder, or to that of the setting.
    pub fn resolve(self, at: usize, path: &str) -> PathBuf {
        let folder = match self.part(at).setting {
            Some(setting) => Some(setting.folder()),
            None => self.path.parent(),
        };
        folder.unwrap_or(Path::new("")).join(path)
    }

    /// Returns an error; `label` is shown beside the caret, `what` in the message after `file:line:column: `.
    pub fn error(self, span: Range<usize>, what: &str, label: impl Into<String>) -> Error {
        let part = self.part(span.start);
        let start = floor_char(part.text, span.start - part.base);
        let end = floor_char(part.text, span.end.saturating_sub(part.base)).max(start);
        let (name, place) = match part.setting {
            Some(setting) => ("--set".to_owned(), format!("--set {}", shorten(setting.text()))),
            None => {
                let (line, column) = self.line_column(start);
                let path = self.path.display().to_string();
                let place = format!("{path}:{line}:{column}");
                (path, place)
            }
        };
        let source = NamedSource::new(name, part.text.to_owned());
        Error::Scene {
            message: one_line(&format!("{place}: {what}")),
            label: one_line(&label.into()),
            source_code: Arc::new(source),
            span: (start, end - start).into(),
            help: None,
        }
    }

    fn part(self, at: usize) -> Part<'a> {
        let setting = self.placed_settings().filter(|(_, base)| *base <= at).last();
        match setting {
            Some((setting, base)) => Part { text: setting.text(), base, setting: Some(setting) },
            None => Part { text: self.text, base: 0, setting: None },
        }
    }

    /// Returns the line that contains a byte offset.
    pub fn line(&self, at: usize) -> &str {
        let at = floor_char(self.text, at);
        let start = self.text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        self.text[start..].lines().next().unwrap_or_default()
    }

    /// Returns `line N`, or the setting of a position.
    pub fn place(self, at: usize) -> String {
        match self.part(at).setting {
            Some(setting) => one_line(&format!("--set {}", shorten(setting.text()))),
            None => format!("line {}", self.line_column(at).0),
        }
    }

    fn line_column(self, offset: usize) -> (usize, usize) {
        let before = &self.text[..floor_char(self.text, offset)];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
        let on_line = before[line_start..].trim_start_matches('\u{feff}');
        (line, on_line.chars().count() + 1)
    }

    /// Returns the source text of a value with runs of white space collapsed to one space.
    pub fn excerpt(self, span: Range<usize>) -> String {
        let part = self.part(span.start);
        let local = span.start - part.base..span.end.saturating_sub(part.base);
        let text = part.text.get(local).unwrap_or_default();
        // Enough of a long text for the shortened form.
        let head: String = text.chars().take(8 * LONGEST_EXCERPT).collect();
        shorten(&head.split_whitespace().collect::<Vec<_>>().join(" "))
    }
}

/// Returns the last character boundary at or before `offset`.
fn floor_char(text: &str, offset: usize) -> usize {
    (0..=offset.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}

/// Escapes control characters, so that terminals and line-based tools show a single line.
fn one_line(text: &str) -> String {
    let is_break = |c: char| c.is_control() || c == '\u{2028}' || c == '\u{2029}';
    if !text.contains(is_break) {
        return text.to_owned();
    }
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        if is_break(c) { line.extend(c.escape_default()) } else { line.push(c) }
    }
    line
}
