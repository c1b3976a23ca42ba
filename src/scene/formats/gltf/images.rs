//! The images of a glTF texture that may be read. Input: the images of a texture, in the order of preference. Output: those
//! that are pictures, by their first bytes, and what is told of the others; or why none of them is.

use std::path::{Path, PathBuf};

use crate::core::error::Error;
use crate::mesh::gltf::{Content, Model, Texture};
use crate::texture::open_file::{check_bytes, check_file};
use crate::texture::source::TextureContent;

/// The images of a texture.
pub(super) struct Chosen {
    /// Index in the file of the preferred one.
    pub index: usize,
    /// The first that can be decoded.
    pub content: TextureContent,
    /// Why others could not be taken.
    pub note: Option<String>,
}

/// Returns the images, or nothing of a texture without any in a format that is read. The error names what is wrong with
/// each.
pub(super) fn chosen(path: &Path, model: &Model, texture: &Texture) -> Result<Option<Chosen>, String> {
    let mut faults: Vec<String> = Vec::new();
    let mut found: Vec<(usize, (String, TextureContent))> = Vec::new();
    for &index in &texture.sources {
        let place = |member: &str| format!("/images/{index}{member}");
        let (place, content, checked) = match &model.images[index].content {
            Content::Path(file) => {
                let file = path.parent().unwrap_or(Path::new("")).join(file);
                let checked = check_file(&file);
                (place("/uri"), TextureContent::File(file), checked)
            }
            Content::Bytes(bytes) => {
                let label = PathBuf::from(format!("{} (image {index})", path.display()));
                let checked = check_bytes(bytes, &label);
                (place(""), TextureContent::Embedded(label, bytes.clone()), checked)
            }
        };
        match checked {
            Err(error) => faults.push(fault(&place, &error)),
            Ok(()) => found.push((index, (place, content))),
        }
    }
    let Some(&(index, _)) = found.first() else {
        return if faults.is_empty() { Ok(None) } else { Err(faults.join("; ")) };
    };
    // What is wrong with a picture of less worth tells nobody anything.
    let preferred = texture.sources.iter().take_while(|&&other| other != index).count();
    faults.truncate(preferred);
    let note = (!faults.is_empty())
        .then(|| format!("/images/{index} is read in place of {}", faults.join(" and of ")));
    let content = TextureContent::FirstOf(found.into_iter().map(|(_, picture)| picture).collect());
    Ok(Some(Chosen { index, content, note }))
}

fn fault(place: &str, error: &Error) -> String {
    let help = error.help().map_or_else(String::new, |help| format!("; {help}"));
    format!("{place}: {error}{help}")
}
