//! Resolves names of textures, samplers and materials. Input: the tables of one kind. Output: the index for a
//! reference, or an error for a duplicate or unknown name.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::suggestion::{quoted, suggestion};

/// Most names that a message lists.
const MAX_LISTED: usize = 12;

pub(super) struct Names<'a> {
    kind: &'static str,
    ordered: Vec<&'a str>,
    indices: HashMap<&'a str, usize>,
}

impl<'a> Names<'a> {
    pub fn collect(kind: &'static str, tables: &[Table<'a>]) -> Result<Self> {
        let mut names = Names { kind, ordered: Vec::new(), indices: HashMap::new() };
        let mut fields: Vec<Field<'a>> = Vec::with_capacity(tables.len());
        for table in tables {
            let field = table.required("name")?;
            let name = field.string()?;
            match names.indices.entry(name) {
                Entry::Vacant(entry) => entry.insert(fields.len()),
                Entry::Occupied(entry) => {
                    let first = fields[*entry.get()].span().start;
                    let place = field.source.place(first);
                    let what = format!(
                        "the name {} is taken by the [[{kind}]] of {place}; give each its own",
                        quoted(name)
                    );
                    return Err(field.error(&what, format!("also on {place}")));
                }
            };
            names.ordered.push(name);
            fields.push(field);
        }
        Ok(names)
    }

    pub fn resolve(&self, field: Field<'_>) -> Result<usize> {
        let name = field.string()?;
        if let Some(&index) = self.indices.get(name) {
            return Ok(index);
        }
        let kind = self.kind;
        if self.ordered.is_empty() {
            let what = format!("no [[{kind}]] is named {}: the scene has no [[{kind}]]", quoted(name));
            return Err(field.error(&what, format!("no such {kind}")));
        }
        let near = suggestion(name, self.ordered.iter().copied());
        let end = if near.is_empty() { ";" } else { "" };
        let known = listed(&self.ordered);
        let what = format!("no [[{kind}]] is named {}{near}{end} known: {known}", quoted(name));
        Err(field.error(&what, format!("no such {kind}{near}")))
    }
}

/// Returns names in quotes, not too many.
pub(super) fn listed(names: &[&str]) -> String {
    let shown: Vec<String> = names.iter().take(MAX_LISTED).map(|name| quoted(name)).collect();
    let rest = match names.len().saturating_sub(MAX_LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{}{rest}", shown.join(", "))
}
