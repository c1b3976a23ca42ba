//! Finds the position in a TOML file for a refusal. Input: the file's tables and the refusal. Output: an error at the
//! key's value, or at its item if the key is not given.

use toml::Spanned;
use toml::de::DeValue;

use super::reader::Field;
use super::table::Table;
use crate::core::error::Error;
use crate::scene::refusal::{Fault, Key, Refusal};

/// Values that the file may give by another key: section, the value's own key, the other one.
const INSTEAD: [(&str, &str, &str); 1] = [("light", "radiance", "intensity")];

pub(super) fn error(root: &Table<'_>, refusal: &Refusal) -> Error {
    let key = refusal.key;
    let Some(section) = root.get(key.section) else { return root.error(&refusal.to_string(), "not given") };
    let item = match section.value() {
        DeValue::Array(array) => array.get(key.item).unwrap_or(section.item),
        _ => section.item,
    };
    if key.name.is_empty() {
        return said(Field { item, ..section }, refusal, |field, what, label| {
            field.source.error(field.span(), what, label)
        });
    }
    let other = INSTEAD.iter().find(|(section, name, _)| (*section, *name) == (key.section, key.name));
    let names = [Some(key.name), other.map(|(_, _, other)| *other)];
    let found = names.into_iter().flatten().find_map(|name| Some((name, below(item, name)?)));
    let Some((name, value)) = found else { return not_given(Field { item, ..section }, key, refusal) };
    let field = Field { source: root.source, section: key.section, key: name, index: None, item: value };
    let field = element(field, key.element).map_or(field, |item| Field { index: key.element, item, ..field });
    let span = element(field, key.component).unwrap_or(field.item).span();
    match &refusal.fault {
        Fault::Expected { wanted, .. } => field.expected_at(span, wanted),
        Fault::Rule { what, label } => field.error_at(span, what, label),
    }
}

/// Returns the value of a key whose name may lead through inline tables.
fn below<'a>(item: &'a Spanned<DeValue<'a>>, name: &str) -> Option<&'a Spanned<DeValue<'a>>> {
    name.split('.').try_fold(item, |value, key| value.get_ref().as_table()?.get(key))
}

fn element<'a>(field: Field<'a>, index: Option<usize>) -> Option<&'a Spanned<DeValue<'a>>> {
    field.value().as_array()?.get(index?)
}

fn not_given(item: Field<'_>, key: Key, refusal: &Refusal) -> Error {
    let path = format!("key \"{}.{}\"", key.section, key.name);
    said(item, refusal, |field, what, label| {
        let what = match key.default {
            Some(default) => format!("{path}: the default {default} for {what}"),
            None => format!("{path} is missing in [[{}]]: {what}", key.section),
        };
        field.source.error(field.span(), &what, label)
    })
}

fn said(item: Field<'_>, refusal: &Refusal, error: impl Fn(Field<'_>, &str, &str) -> Error) -> Error {
    match &refusal.fault {
        Fault::Expected { wanted, found } => {
            error(item, &format!("expected {wanted}, found {found}"), &format!("expected {wanted}"))
        }
        Fault::Rule { what, label } => error(item, what, label),
    }
}
