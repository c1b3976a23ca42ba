//! Reads one value of a scene file, with its key and position. Input: the type that a section expects.
//! Output: the typed value, or an error that quotes the value and lists what is allowed.

use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;

use glam::{DVec2, DVec3};
use toml::Spanned;
use toml::de::DeValue;

use super::source::Source;
use crate::core::error::{Error, Result};
use crate::scene::suggestion::{quoted, suggestion};

#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    pub source: Source<'a>,
    pub section: &'static str,
    pub key: &'static str,
    /// Set for an element of the key's array.
    pub index: Option<usize>,
    pub item: &'a Spanned<DeValue<'a>>,
}

impl<'a> Field<'a> {
    pub fn value(&self) -> &'a DeValue<'a> {
        self.item.get_ref()
    }

    pub fn span(&self) -> Range<usize> {
        self.item.span()
    }

    /// Returns the error `key "section.key": what`, pointing at the value.
    pub fn error(&self, what: &str, label: impl Into<String>) -> Error {
        self.error_at(self.span(), what, label)
    }

    pub fn error_at(&self, span: Range<usize>, what: &str, label: impl Into<String>) -> Error {
        let dot = if self.section.is_empty() { "" } else { "." };
        let index = self.index.map_or_else(String::new, |index| format!("[{index}]"));
        let what = format!("key \"{}{dot}{}{index}\": {what}", self.section, self.key);
        self.source.error(span, &what, label)
    }

    pub fn expected(&self, wanted: &str) -> Error {
        self.expected_at(self.span(), wanted)
    }

    pub fn expected_at(&self, span: Range<usize>, wanted: &str) -> Error {
        let kind = match self.value() {
            DeValue::String(_) => "the string ",
            DeValue::Datetime(_) => "the date-time ",
            DeValue::Table(_) => "the table ",
            _ => "",
        };
        let found = self.source.excerpt(self.span());
        self.error_at(span, &format!("expected {wanted}, found {kind}{found}"), format!("expected {wanted}"))
    }

    /// Returns the keys and values of a table, in no order of meaning; nothing of other values.
    pub fn entries(self) -> impl Iterator<Item = (&'a str, Field<'a>)> {
        let table = match self.value() {
            DeValue::Table(table) => Some(table),
            _ => None,
        };
        let entries = table.into_iter().flat_map(|table| table.iter());
        entries.map(move |(key, item)| (key.get_ref().as_ref(), Field { item, ..self }))
    }

    /// Returns a number of any size; the builder checks the limits.
    pub fn number(self) -> Result<f64> {
        real(self.value()).ok_or_else(|| self.expected("a finite number"))
    }

    pub fn numbers<const N: usize>(self) -> Result<[f64; N]> {
        let wanted = || format!("{N} finite numbers");
        let array = match self.value() {
            DeValue::Array(array) if array.len() == N => array,
            _ => return Err(self.expected(&wanted())),
        };
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(array) {
            *number = real(item.get_ref()).ok_or_else(|| self.expected_at(item.span(), &wanted()))?;
        }
        Ok(numbers)
    }

    pub fn vec2(self) -> Result<DVec2> {
        self.numbers().map(DVec2::from_array)
    }

    pub fn vec3(self) -> Result<DVec3> {
        self.numbers().map(DVec3::from_array)
    }

    /// Reads an array of exactly `N` elements, each by `read` in place of one of `values`.
    pub fn array<const N: usize, T>(
        self,
        wanted: &str,
        mut values: [T; N],
        read: impl Fn(Field<'a>) -> Result<T>,
    ) -> Result<[T; N]> {
        let array = match self.value() {
            DeValue::Array(array) if array.len() == N => array,
            _ => return Err(self.expected(wanted)),
        };
        for (index, (value, item)) in values.iter_mut().zip(array).enumerate() {
            *value = read(Field { index: Some(index), item, ..self })?;
        }
        Ok(values)
    }

    /// Reads an array of 1 to `most` elements.
    pub fn list<T>(self, of: &str, most: u32, read: impl Fn(Field<'a>) -> Result<T>) -> Result<Vec<T>> {
        let array = match self.value() {
            DeValue::Array(array) if (1..=most as usize).contains(&array.len()) => array,
            _ => return Err(self.expected(&format!("an array of 1 to {most} {of}"))),
        };
        let element = |(index, item)| read(Field { index: Some(index), item, ..self });
        array.iter().enumerate().map(element).collect()
    }

    pub fn integer(self, range: &RangeInclusive<u32>) -> Result<u32> {
        let found = match self.value() {
            DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix()).ok(),
            _ => None,
        };
        let integer = found.and_then(|integer| u32::try_from(integer).ok());
        integer
            .filter(|integer| range.contains(integer))
            .ok_or_else(|| self.expected(&format!("an integer from {} to {}", range.start(), range.end())))
    }

    pub fn boolean(self) -> Result<bool> {
        self.value().as_bool().ok_or_else(|| self.expected("true or false"))
    }

    pub fn string(self) -> Result<&'a str> {
        match self.value().as_str() {
            Some(text) if !text.is_empty() => Ok(text),
            _ => Err(self.expected("a string that is not empty")),
        }
    }

    /// Reads a path, relative to the folder where it was written.
    pub fn path(self) -> Result<PathBuf> {
        self.string().map(|path| self.source.resolve(self.span().start, path))
    }

    /// Reads one value of a vocabulary by its name.
    pub fn choice<T: Copy>(self, names: &[&str], values: &[T]) -> Result<T> {
        let Some(word) = self.value().as_str() else {
            return Err(self.expected(&format!("a string, one of {}", names.join(", "))));
        };
        let found = names.iter().zip(values).find(|(name, _)| **name == word);
        found.map(|(_, value)| *value).ok_or_else(|| {
            let near = suggestion(word, names.iter().copied());
            let end = if near.is_empty() { ";" } else { "" };
            let what = format!("unknown value {}{near}{end} allowed: {}", quoted(word), names.join(", "));
            self.error(&what, format!("unknown value{near}"))
        })
    }
}

/// Returns a number, which may be written as an integer.
fn real(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|i| i as f64)
        }
        _ => None,
    }
}
