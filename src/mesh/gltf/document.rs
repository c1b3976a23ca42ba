//! The parts of a glTF file. Input: the text of its JSON. Output: the elements of its lists, one at a time, as parsed
//! values; files that are no JSON, or that would fill the memory, are refused.

use std::collections::HashMap;

use serde_json::value::RawValue;
use serde_json::{Map, Value};

use super::json::{Json, shown};
use crate::mesh::Fault;

/// The most nodes, meshes, accessors and views.
const MOST_SMALL: usize = 1_000_000;

/// The most elements of any other list, such as materials, which take more memory than text.
const MOST_LARGE: usize = 100_000;

/// The most values in an element. Each may take a hundred times as much memory as its text.
const MOST_VALUES: usize = 1 << 21;

/// The members of the file, not looked into yet: as values, a large file would fill the memory.
pub(super) struct Document<'a> {
    members: HashMap<String, &'a RawValue>,
}

impl<'a> Document<'a> {
    /// Reads the outermost object of a text.
    pub(super) fn read(text: &'a str) -> Result<Document<'a>, Fault> {
        match serde_json::from_str(text) {
            Ok(members) => Ok(Document { members }),
            Err(e) if e.is_data() => Err(Fault::new("header", "its JSON is not an object")),
            Err(e) => {
                let place = format!("line {} column {}", e.line(), e.column());
                Err(Fault::new(place, format!("it is not valid JSON: {}", message(&e))))
            }
        }
    }

    /// Returns a list, empty if the file has none.
    pub(super) fn list(&self, name: &'static str) -> Result<List<'a>, Fault> {
        let Some(raw) = self.members.get(name).filter(|raw| raw.get() != "null") else {
            return Ok(List { name, items: Vec::new() });
        };
        let items: Vec<&RawValue> = serde_json::from_str(raw.get())
            .map_err(|_| Fault::new(format!("/{name}"), "it is not a list"))?;
        let most = match name {
            "nodes" | "meshes" | "accessors" | "bufferViews" => MOST_SMALL,
            _ => MOST_LARGE,
        };
        if items.len() > most {
            let what = format!("it has {} elements; at most {most} are allowed", items.len());
            return Err(Fault::new(format!("/{name}"), what));
        }
        Ok(List { name, items })
    }

    /// Returns an object with those of these members that the file has.
    pub(super) fn members(&self, names: &[&str]) -> Result<Element, Fault> {
        let mut object = Map::new();
        for name in names {
            if let Some(raw) = self.members.get(*name) {
                object.insert((*name).to_owned(), parsed(raw, &format!("/{name}"))?);
            }
        }
        Ok(Element { place: String::new(), value: Value::Object(object) })
    }
}

/// A list of the file, whose elements are not looked into yet.
pub(super) struct List<'a> {
    name: &'static str,
    items: Vec<&'a RawValue>,
}

impl List<'_> {
    /// Returns the number of elements.
    pub(super) fn len(&self) -> usize {
        self.items.len()
    }

    /// Returns an element, which has to be an object.
    pub(super) fn element(&self, index: usize) -> Result<Element, Fault> {
        let place = format!("/{}/{index}", self.name);
        let raw = self.items.get(index).ok_or_else(|| Fault::new(&place, "it does not exist"))?;
        let value = parsed(raw, &place)?;
        if !value.is_object() {
            return Err(Fault::new(place, format!("it is {}; an object is needed", shown(&value))));
        }
        Ok(Element { place, value })
    }

    /// Returns all elements, one after the other.
    pub(super) fn elements(&self) -> impl Iterator<Item = Result<Element, Fault>> {
        (0..self.len()).map(|index| self.element(index))
    }
}

/// A part of the file, looked into.
pub(super) struct Element {
    place: String,
    value: Value,
}

impl Element {
    /// Returns its outermost value.
    pub(super) fn json(&self) -> Json<'_> {
        Json::new(&self.place, &self.value)
    }
}

/// Parses a part of the file, whose syntax may still nest too deeply or have numbers out of range.
fn parsed(raw: &RawValue, place: &str) -> Result<Value, Fault> {
    // Separators within texts count as well, but there are few of them.
    let values = raw.get().bytes().filter(|byte| matches!(byte, b',' | b':')).count();
    if values > MOST_VALUES {
        return Err(Fault::new(place, format!("it has more than {MOST_VALUES} values")));
    }
    serde_json::from_str(raw.get())
        .map_err(|e| Fault::new(place, format!("it is not valid: {}", message(&e))))
}

/// Returns what the parser says, without the place.
fn message(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}
