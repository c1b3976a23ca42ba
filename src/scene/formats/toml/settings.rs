//! Puts settings into a parsed scene file, before anything is read of it. Input: the document, and the source with its
//! settings. Output: the document with their values, whose positions lie behind the file's own text.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::names::listed;
use super::source::Source;
use super::vocabulary::replaced_by;
use crate::core::error::{Error, Result};
use crate::scene::setting::{Key, Setting};
use crate::scene::suggestion::{quoted, suggestion};
use crate::texture::sampler_spec::Filter;

/// The word for all tables of a section.
const ALL: &str = "*";

type Value<'a> = Spanned<DeValue<'a>>;

/// Puts each setting into the document, in their order. Sections in `repeated` are lists of tables.
pub(super) fn apply<'a>(document: &mut DeTable<'a>, source: Source<'a>, repeated: &[&str]) -> Result<()> {
    for (setting, base) in source.placed_settings() {
        let value = value(setting, base, source)?;
        let way = Way { setting, base, source, repeated };
        way.set_in_table(document, 0, &value)?;
    }
    Ok(())
}

/// Reads the value: TOML, or a word.
fn value<'a>(setting: &'a Setting, base: usize, source: Source<'_>) -> Result<Value<'a>> {
    let span = moved(&setting.value, base);
    let word = setting.value();
    let text = setting.number.as_deref().unwrap_or(word);
    match DeValue::parse(text) {
        // No key holds a date.
        Ok(value) if value.get_ref().is_datetime() => Ok(Spanned::new(span, DeValue::String(word.into()))),
        // Its parts stand elsewhere in what was typed.
        Ok(value) if setting.number.is_some() => Ok(at_once(value, &span)),
        Ok(value) => Ok(shifted(value, span.start)),
        Err(error) if word.starts_with(['[', '{', '"', '\'']) => {
            let at = moved(&error.span().unwrap_or(0..0), span.start);
            Err(source.error(at, &format!("TOML syntax: {}", error.message()), error.message()))
        }
        Err(_) => Ok(Spanned::new(span, DeValue::String(word.into()))),
    }
}

fn moved(range: &Range<usize>, by: usize) -> Range<usize> {
    range.start + by..range.end + by
}

/// Returns the value with all its parts at one position.
fn at_once<'a>(value: Value<'a>, span: &Range<usize>) -> Value<'a> {
    let value = match value.into_inner() {
        DeValue::Array(items) => DeValue::Array(items.into_iter().map(|item| at_once(item, span)).collect()),
        plain => plain,
    };
    Spanned::new(span.clone(), value)
}

/// Returns the value with all its positions further behind.
fn shifted(value: Value<'_>, by: usize) -> Value<'_> {
    let span = moved(&value.span(), by);
    let value = match value.into_inner() {
        DeValue::Array(items) => DeValue::Array(items.into_iter().map(|item| shifted(item, by)).collect()),
        DeValue::Table(table) => {
            let entry = |(key, item): (Spanned<_>, _)| {
                (Spanned::new(moved(&key.span(), by), key.into_inner()), shifted(item, by))
            };
            DeValue::Table(table.into_iter().map(entry).collect())
        }
        plain => plain,
    };
    Spanned::new(span, value)
}

/// The way of one setting through the document.
struct Way<'s, 'a> {
    setting: &'a Setting,
    base: usize,
    source: Source<'a>,
    repeated: &'s [&'s str],
}

impl<'a> Way<'_, 'a> {
    /// Follows the keys from `at` on into a table.
    fn set_in_table(&self, table: &mut DeTable<'a>, at: usize, value: &Value<'a>) -> Result<()> {
        let key = &self.setting.keys[at];
        let span = self.span(key);
        if at + 1 == self.setting.keys.len() {
            self.clear_alternatives(table, at);
            // Inserting would keep the position of an equal key.
            table.remove(key.name.as_str());
            table.insert(Spanned::new(span, key.name.as_str().into()), value.clone());
            return Ok(());
        }
        if let Some(item) = table.get_mut(key.name.as_str()) {
            return self.set_in_value(item, at + 1, value);
        }
        if at == 0 && self.repeated.contains(&key.name.as_str()) {
            return Err(self.error(key, &format!("the scene has no [[{}]]", key.name), "none to change"));
        }
        let mut added = DeTable::new();
        self.set_in_table(&mut added, at + 1, value)?;
        table.insert(
            Spanned::new(span.clone(), key.name.as_str().into()),
            Spanned::new(span, DeValue::Table(added)),
        );
        Ok(())
    }

    fn set_in_value(&self, item: &mut Value<'a>, at: usize, value: &Value<'a>) -> Result<()> {
        self.spread_filter(item, at);
        match item.get_mut() {
            DeValue::Table(table) => self.set_in_table(table, at, value),
            DeValue::Array(items) => {
                let chosen = self.chosen(items, at)?;
                let is_last = at + 1 == self.setting.keys.len();
                for item in items.iter_mut().take(chosen.end).skip(chosen.start) {
                    match is_last {
                        true => *item = value.clone(),
                        false => self.set_in_value(item, at + 1, value)?,
                    }
                }
                if is_last && at > 1 {
                    // What is wrong with the whole is so by this component.
                    let whole = std::mem::replace(item.get_mut(), DeValue::Boolean(false));
                    *item = Spanned::new(value.span(), whole);
                }
                Ok(())
            }
            other => {
                let what = format!("{} has no keys: it is a value ({})", self.path(at), other.type_str());
                Err(self.error(&self.setting.keys[at], &what, "below a value"))
            }
        }
    }

    /// Replaces a sampler's filter that is one word by the table that it stands for, as one of its keys is set.
    fn spread_filter(&self, item: &mut Value<'a>, at: usize) {
        let [section, _, key, _] = &self.setting.keys[..] else { return };
        if at != 3 || section.name != "sampler" || key.name != "filter" {
            return;
        }
        let span = item.span();
        let Some(filter) = item.get_ref().as_str().and_then(Filter::from_name) else { return };
        let (mag, min) = filter.both();
        let table = [("mag", mag), ("min", min)].into_iter().map(|(key, filter)| {
            let word = DeValue::String(filter.name().into());
            (Spanned::new(span.clone(), key.into()), Spanned::new(span.clone(), word))
        });
        *item = Spanned::new(span.clone(), DeValue::Table(table.collect()));
    }

    /// Returns the items of an array that a key means: the one of that name, else of that number, or all.
    fn chosen(&self, items: &DeArray<'a>, at: usize) -> Result<Range<usize>> {
        let key = &self.setting.keys[at];
        let name_of = |item: &'_ Value<'a>| {
            Some(item.get_ref().as_table()?.get("name")?.get_ref().as_str()?.to_owned())
        };
        let names: Vec<Option<String>> = items.iter().map(name_of).collect();
        if let Some(index) = names.iter().position(|name| name.as_ref() == Some(&key.name)) {
            return Ok(index..index + 1);
        }
        if key.is_all() {
            return Ok(0..items.len());
        }
        let number = key.name.parse().ok().filter(|&number| !key.is_quoted && number < items.len());
        if let Some(index) = number {
            return Ok(index..index + 1);
        }
        let names: Vec<&str> = names.iter().flatten().map(String::as_str).collect();
        Err(self.not_found(key, at, items.len(), &names))
    }

    fn not_found(&self, key: &Key, at: usize, count: usize, names: &[&str]) -> Error {
        let path = self.path(at);
        let near = suggestion(&key.name, names.iter().copied());
        let end = if near.is_empty() { ";" } else { "" };
        let numbers = match count {
            0 => return self.error(key, &format!("{path} is empty"), "none to change"),
            1 => "0".to_owned(),
            _ => format!("0 to {}", count - 1),
        };
        let known = match names {
            [] => numbers,
            _ => format!("{}, or by number {numbers}", listed(names)),
        };
        let is_key = at == 1 && at + 1 == self.setting.keys.len();
        let before = match is_key {
            true => format!("; say which before the key, as in {path}.0.{}", key.name),
            false => String::new(),
        };
        let what = format!(
            "{path} has no item {}{near}{end} known: {known}, or {ALL} for all{before}",
            quoted(&key.name)
        );
        self.error(key, &what, format!("no such item{near}"))
    }

    /// Takes away what the file has in place of this key, such as another field of view.
    fn clear_alternatives(&self, table: &mut DeTable<'a>, at: usize) {
        let keys = &self.setting.keys;
        let in_list = usize::from(self.repeated.contains(&keys[0].name.as_str()));
        if at != 1 + in_list {
            return;
        }
        for other in replaced_by(&keys[0].name, &keys[at].name) {
            if table.get_key_value(other).is_some_and(|(key, _)| self.source.is_of_file(key.span().start)) {
                table.remove(other);
            }
        }
    }

    /// Returns the keys before one of them, as they were written.
    fn path(&self, at: usize) -> &'a str {
        let keys = &self.setting.keys;
        &self.setting.text()[keys[0].span.start..keys[at - 1].span.end]
    }

    fn span(&self, key: &Key) -> Range<usize> {
        moved(&key.span, self.base)
    }

    fn error(&self, key: &Key, what: &str, label: impl Into<String>) -> Error {
        self.source.error(self.span(key), what, label)
    }
}
