//! A value given beside a scene's file, such as `sampler.ground.filter=ewa`. Input: the text. Output: the keys that lead
//! to the value and the value itself, each with its place in the text. What they mean is the format's affair.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use toml::de::DeValue;

use crate::core::error::{Error, Result};

/// Most keys that lead to a value; scenes have five (`material.floor.mapping.scale.0`).
const MAX_DEPTH: usize = 16;
const EXAMPLE: &str = "expected KEY=VALUE, such as sampling.spp=64 or sampler.ground.filter=ewa";

/// A key and a value that replace those of a scene's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    text: String,
    pub(super) keys: Vec<Key>,
    /// Where the value stands in the text.
    pub(super) value: Range<usize>,
    /// The value as TOML has it, if it was written as a number that TOML has not, such as `.5`.
    pub(super) number: Option<String>,
    /// The folder to which paths in the value are relative; the current one if it is empty.
    folder: PathBuf,
}

/// One of the keys that lead to a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Key {
    pub name: String,
    pub span: Range<usize>,
    /// A quoted key is a name, neither a number nor `*`.
    pub is_quoted: bool,
}

impl Key {
    /// Returns true for the word that means all tables of a section.
    pub(super) fn is_all(&self) -> bool {
        !self.is_quoted && self.name == "*"
    }
}

impl Setting {
    /// Reads `KEY=VALUE`. The key is dotted: a section, the name or number of one of its tables if there are several,
    /// and the key; a part that holds a dot or `=` is quoted. The value is TOML, or a word without quotes.
    pub fn parse(text: &str) -> Result<Setting> {
        text.parse().map_err(|what| Error::new(format!("--set {text:?}: {what}")))
    }

    /// Returns the setting with paths that are relative to this folder.
    pub fn within(mut self, folder: &Path) -> Setting {
        self.folder = folder.to_owned();
        self
    }

    /// Returns the names of the keys that lead to the value.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.keys.iter().map(|key| key.name.as_str())
    }

    /// Returns the folder to which paths in the value are relative.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the text that was read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns all strings within the value; a word without quotes is one.
    pub fn strings(&self) -> Vec<String> {
        let mut found = Vec::new();
        match DeValue::parse(self.value()) {
            Ok(value) => collect_strings(value.get_ref(), &mut found),
            Err(_) => found.push(self.value().to_owned()),
        }
        found
    }

    /// Returns true if nothing is left of another setting that is applied before this one: its key is the same, or lies
    /// within.
    pub fn covers(&self, other: &Setting) -> bool {
        let is_same = |own: &Key, key: &Key| own.name == key.name || own.is_all();
        self.keys.len() <= other.keys.len()
            && self.keys.iter().zip(&other.keys).all(|(own, key)| is_same(own, key))
    }

    /// Returns the value as it was written.
    pub(super) fn value(&self) -> &str {
        &self.text[self.value.clone()]
    }
}

impl FromStr for Setting {
    type Err = String;

    fn from_str(text: &str) -> Result<Setting, String> {
        let (keys, after) = keys(text)?;
        let value = trimmed(text, after..text.len());
        let word = &text[value.clone()];
        if word.is_empty() {
            return Err(format!("the value after the = is missing; {EXAMPLE}"));
        }
        Ok(Setting { keys, number: number(word), value, text: text.to_owned(), folder: PathBuf::new() })
    }
}

fn collect_strings(value: &DeValue<'_>, found: &mut Vec<String>) {
    match value {
        DeValue::String(text) => found.push(text.to_string()),
        DeValue::Array(values) => values.iter().for_each(|value| collect_strings(value.get_ref(), found)),
        DeValue::Table(table) => table.values().for_each(|value| collect_strings(value.get_ref(), found)),
        _ => {}
    }
}

/// Returns the keys before the first `=` that is not quoted, and where the text goes on behind it.
fn keys(text: &str) -> Result<(Vec<Key>, usize), String> {
    let mut keys = Vec::new();
    let mut start = 0;
    loop {
        let (key, end) = key(text, start)?;
        keys.push(key);
        if keys.len() > MAX_DEPTH {
            return Err(format!("the key has more than {MAX_DEPTH} parts; {EXAMPLE}"));
        }
        start = end + 1;
        if text.as_bytes()[end] == b'=' {
            return Ok((keys, start));
        }
    }
}

/// Reads a key that begins at `start`; returns it and the position of the dot or `=` behind it.
fn key(text: &str, start: usize) -> Result<(Key, usize), String> {
    let rest = &text[start..];
    let blank = rest.len() - rest.trim_start().len();
    let quote = rest[blank..].chars().next().filter(|c| matches!(c, '"' | '\''));
    let from = match quote {
        Some(quote) => {
            let first = start + blank;
            let length = quoted_length(&text[first..], quote)
                .ok_or_else(|| format!("a key begins with {quote} and does not end with it"))?;
            first + length
        }
        None => start,
    };
    let Some(end) = text[from..].find(['.', '=']).map(|at| from + at) else {
        return Err(if text.contains('=') { EXAMPLE.into() } else { format!("there is no =; {EXAMPLE}") });
    };
    let span = trimmed(text, start..end);
    let word = &text[span.clone()];
    if word.is_empty() {
        return Err(format!("a part of the key is empty; {EXAMPLE}"));
    }
    let name = match quote {
        // The TOML parser knows the escapes.
        Some(_) => match DeValue::parse(word).map(|value| value.into_inner()) {
            Ok(DeValue::String(name)) => name.into_owned(),
            _ => return Err(format!("{word} is no quoted key of TOML")),
        },
        None => word.to_owned(),
    };
    Ok((Key { name, span, is_quoted: quote.is_some() }, end))
}

/// Returns how many bytes a quoted string takes that the text begins with.
fn quoted_length(text: &str, quote: char) -> Option<usize> {
    let mut is_escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        if c == quote && !is_escaped {
            return Some(at + 1);
        }
        is_escaped = c == '\\' && quote == '"' && !is_escaped;
    }
    None
}

/// Returns the range without white space at its ends.
fn trimmed(text: &str, range: Range<usize>) -> Range<usize> {
    let word = &text[range.clone()];
    let start = range.start + (word.len() - word.trim_start().len());
    start..start + word.trim().len()
}

/// Returns a number that TOML has not, or a list with such numbers, written as TOML has it.
fn number(word: &str) -> Option<String> {
    if DeValue::parse(word).is_ok() {
        return None;
    }
    if !word.starts_with('[') {
        return plain(word);
    }
    let mut list = String::new();
    for part in word.split_inclusive(['[', ']', ',']) {
        let number = part.trim_end_matches(['[', ']', ',']);
        let known = plain(number.trim()).filter(|_| DeValue::parse(number.trim()).is_err());
        list += known.as_deref().unwrap_or(number);
        list += &part[number.len()..];
    }
    DeValue::parse(&list).is_ok().then_some(list)
}

/// Returns a finite number of digits, signs, dots and exponents as TOML has it.
fn plain(word: &str) -> Option<String> {
    let is_plain = word.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    let number = word.parse::<f64>().ok().filter(|number| is_plain && number.is_finite())?;
    Some(format!("{number:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        Setting::parse(text).unwrap().keys.into_iter().map(|key| key.name).collect()
    }

    #[test]
    fn keys_are_parts_between_dots_and_quotes_keep_dots_together() {
        assert_eq!(names("sampling.spp=64"), ["sampling", "spp"]);
        assert_eq!(names(" a . b =1"), ["a", "b"]);
        assert_eq!(names("material.my floor.color=[1, 1, 1]"), ["material", "my floor", "color"]);
        assert_eq!(names(r#"material."a.b=c \"d\"".color=x"#), ["material", r#"a.b=c "d""#, "color"]);
        assert_eq!(names(r"material.'a.b\'.color=x"), ["material", r"a.b\", "color"]);
        assert_eq!(Setting::parse("a.b= x=y ").unwrap().value(), "x=y");
    }

    #[test]
    fn a_setting_covers_those_whose_keys_are_its_own_or_lie_within() {
        let covers =
            |own: &str, other: &str| Setting::parse(own).unwrap().covers(&Setting::parse(other).unwrap());
        for (own, other) in [
            ("a.b=1", "a.b=2"),
            ("a.b=1", "a.\"b\"=2"),
            ("a.eye=[0, 0, 0]", "a.eye.0=1"),
            ("a.*.c=1", "a.b.c=1"),
        ] {
            assert!(covers(own, other), "{own} leaves {other}");
        }
        for (own, other) in [
            ("a.b=1", "a.c=1"),
            ("a.eye.0=1", "a.eye=[0]"),
            ("a.b.c=1", "a.*.c=1"),
            ("a.\"*\".c=1", "a.b.c=1"),
        ] {
            assert!(!covers(own, other), "{own} covers {other}");
        }
    }

    #[test]
    fn what_is_no_key_with_a_value_is_refused_with_an_example() {
        let dots = ".".repeat(1000) + "=1";
        let deep = "a.".repeat(1000) + "a=1";
        for text in ["", "=", "=x", "a", "a.b", "a=", "a= \n", ".a=1", "a..b=1", "a.=1", &dots, &deep] {
            let said = Setting::parse(text).unwrap_err().to_string();
            assert!(said.contains("expected KEY=VALUE, such as sampling.spp=64"), "{text:.20}: {said:.200}");
        }
        for text in ["\"a=1", "'a.b=1", r#""a\"=1"#, "\"a\\q\"=1"] {
            let said = Setting::parse(text).unwrap_err().to_string();
            assert!(said.contains("does not end with it") || said.contains("no quoted key"), "{said}");
        }
    }

    #[test]
    fn strings_are_found_within_values() {
        let strings = |text: &str| Setting::parse(text).unwrap().strings();
        assert_eq!(strings("a=b/c.png"), ["b/c.png"]);
        assert_eq!(strings("a=\"b\""), ["b"]);
        assert_eq!(strings("a={ x = [\"b\", 1], y = { z = 'c' } }"), ["b", "c"]);
        assert!(strings("a=[1, 2.5, true]").is_empty());
    }

    #[test]
    fn numbers_of_other_languages_are_numbers() {
        let number = |text: &str| Setting::parse(text).unwrap().number;
        assert_eq!(number("a=.5").as_deref(), Some("0.5"));
        assert_eq!(number("a=2.").as_deref(), Some("2.0"));
        assert_eq!(number("a=-.5e3").as_deref(), Some("-500.0"));
        assert_eq!(number("a=[.5, 1., -3]").as_deref(), Some("[0.5,1.0, -3]"));
        assert_eq!(number("a=[[.5,1],[2.,3]]").as_deref(), Some("[[0.5,1],[2.0,3]]"));
        for text in ["a=[1, 2.5]", "a=[1, x]", "a=[.5, \"x", "a=[.5", "a=[\"a,.5\"]"] {
            assert_eq!(number(text), None, "{text}");
        }
        for text in ["a=1", "a=0.5", "a=inf", "a=e", "a=1.2.3", "a=9e999"] {
            assert_eq!(number(text), None, "{text}");
        }
    }
}
