//! What is told of the materials of a glTF file. Input: words about one. Output: one sentence for all of which the same is
//! told, with the first of them.

use crate::mesh::gltf::{Material, Model};

/// The words, the first material of which they are true, and the number of these.
#[derive(Default)]
pub(in crate::scene::formats) struct MaterialNotes(Vec<(String, String, usize)>);

impl MaterialNotes {
    /// Tells something of a material.
    pub(super) fn add(&mut self, what: &str, model: &Model, material: &Material) {
        match self.0.iter_mut().find(|(words, ..)| words == what) {
            Some((.., count)) => *count += 1,
            None => self.0.push((what.to_owned(), named(model, material), 1)),
        }
    }

    /// Returns one sentence for all materials of which the same is told.
    pub fn sentences(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(what, first, count)| match count {
            1 => format!("{first}: {what}"),
            _ => format!("{count} materials, the first of them {first}: {what}"),
        })
    }
}

/// Returns a material as messages have it: by its name, or else by its JSON pointer.
fn named(model: &Model, material: &Material) -> String {
    let place = model.materials.iter().position(|other| std::ptr::eq(other, material));
    match (material.name.as_str(), place) {
        ("", Some(index)) => format!("/materials/{index}"),
        (name, _) => format!("material {name:?}"),
    }
}
