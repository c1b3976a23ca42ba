//! TOML tables with their position in the text. Input: a parsed table and the keys of its section. Output:
//! [`Field`]s to read, or an error for an unknown, missing or misplaced key.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::reader::Field;
use super::source::Source;
use super::vocabulary::{home_of, path_of};
use crate::core::error::{Error, Result};
use crate::scene::suggestion::{quoted, suggestion};

/// The notation of a table, for messages.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Root,
    Single,
    Repeated,
    Inline,
}

#[derive(Clone)]
pub(super) struct Table<'a> {
    pub source: Source<'a>,
    /// Dotted path of the section, which begins the paths of its keys; empty for the whole file.
    pub section: &'static str,
    form: Form,
    table: &'a DeTable<'a>,
    /// The header, or the whole of an inline table.
    pub span: Range<usize>,
}

impl<'a> Table<'a> {
    pub fn root(source: Source<'a>, table: &'a DeTable<'a>, keys: &[&str]) -> Result<Self> {
        let root = Table { source, section: "", form: Form::Root, table, span: 0..0 };
        root.allow_only(keys)?;
        Ok(root)
    }

    pub fn inline(field: Field<'a>, section: &'static str, keys: &[&str]) -> Result<Self> {
        let DeValue::Table(table) = field.value() else {
            return Err(field.expected(&format!("a table with the keys {}", keys.join(", "))));
        };
        let inline = Table { source: field.source, section, form: Form::Inline, table, span: field.span() };
        inline.allow_only(keys)?;
        Ok(inline)
    }

    /// Returns the table `[section]`, if the file has it.
    pub fn single(&self, section: &'static str, keys: &[&str]) -> Result<Option<Table<'a>>> {
        let Some(field) = self.get(section) else { return Ok(None) };
        let DeValue::Table(table) = field.value() else {
            return Err(field.expected(&format!("one table [{section}]")));
        };
        let single = Table { source: self.source, section, form: Form::Single, table, span: field.span() };
        single.allow_only(keys)?;
        Ok(Some(single))
    }

    pub fn required_single(&self, section: &'static str, keys: &[&str], needs: &str) -> Result<Table<'a>> {
        self.single(section, keys)?.ok_or_else(|| {
            let what = format!("section [{section}] is missing; it needs {needs}");
            self.error(&what, format!("no [{section}]"))
        })
    }

    /// Returns the tables `[[section]]` in the order of the file.
    pub fn repeated(&self, section: &'static str, keys: &[&str]) -> Result<Vec<Table<'a>>> {
        let Some(field) = self.get(section) else { return Ok(Vec::new()) };
        let DeValue::Array(array) = field.value() else {
            return Err(field.expected(&format!("tables, each headed [[{section}]]")));
        };
        array
            .iter()
            .map(|item| {
                let DeValue::Table(table) = item.get_ref() else {
                    let field = Field { item, ..field };
                    return Err(field.expected(&format!("tables, each headed [[{section}]]")));
                };
                let (source, form, span) = (self.source, Form::Repeated, item.span());
                let entry = Table { source, section, form, table, span };
                entry.allow_only(keys)?;
                Ok(entry)
            })
            .collect()
    }

    pub fn get(&self, key: &'static str) -> Option<Field<'a>> {
        let item = self.table.get(key)?;
        Some(Field { source: self.source, section: self.section, key, index: None, item })
    }

    pub fn required(&self, key: &'static str) -> Result<Field<'a>> {
        self.get(key).ok_or_else(|| self.lacks(key))
    }

    /// Returns the error for a missing key.
    pub fn lacks(&self, key: &str) -> Error {
        let what = format!("key \"{}.{key}\" is missing {}", self.section, self.place());
        self.error(&what, format!("needs {key}"))
    }

    /// Returns the line of its first character, in words.
    pub fn place_in_source(&self) -> String {
        self.source.place(self.span.start)
    }

    pub fn error(&self, what: &str, label: impl Into<String>) -> Error {
        self.source.error(self.span.clone(), what, label)
    }

    pub fn allow_only(&self, keys: &[&str]) -> Result<()> {
        match self.first_outside(keys) {
            Some(stray) => Err(self.unknown(stray, keys, &self.place())),
            None => Ok(()),
        }
    }

    /// Checks the keys of a section again once its kind is known.
    pub fn allow_only_with(&self, kind: &str, keys: &[&str]) -> Result<()> {
        match self.first_outside(keys) {
            Some(stray) => Err(self.unknown(stray, keys, &format!("{} of kind \"{kind}\"", self.place()))),
            None => Ok(()),
        }
    }

    /// Returns the first of several unknown keys in the file.
    fn first_outside(&self, keys: &[&str]) -> Option<Stray<'a>> {
        let stray = self.table.iter().filter(|(key, _)| !keys.contains(&key.get_ref().as_ref()));
        stray.map(|(key, _)| key).min_by_key(|key| key.span().start)
    }

    fn unknown(&self, stray: Stray<'_>, keys: &[&str], place: &str) -> Error {
        let name = stray.get_ref().as_ref();
        // A setting beside the file names the way to its key.
        let is_typed = self.form == Form::Root && !self.source.is_of_file(stray.span().start);
        let near = match (path_of(name).filter(|_| is_typed), home_of(self.section, name)) {
            (Some(path), _) => format!("; did you mean {}?", quoted(&path)),
            (None, Some(home)) => format!("; it belongs into {home}"),
            (None, None) => suggestion(name, keys.iter().copied()),
        };
        let end = if near.ends_with('?') { "" } else { ";" };
        let what = format!("unknown key {} {place}{near}{end} allowed: {}", quoted(name), keys.join(", "));
        self.source.error(stray.span(), &what, format!("unknown key{near}"))
    }

    fn place(&self) -> String {
        match self.form {
            Form::Root => "at the top level".to_owned(),
            Form::Single => format!("in [{}]", self.section),
            Form::Repeated => format!("in [[{}]]", self.section),
            Form::Inline => format!("in the table of {}", self.section),
        }
    }
}

type Stray<'a> = &'a Spanned<toml::de::DeString<'a>>;
