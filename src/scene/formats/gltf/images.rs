//! The image of a glTF texture that is read. Input: the images of a texture, in the order of preference. Output: the first
//! that is a picture, by its first bytes, and what is told of those before it; or why none of them is.

use std::path::{Path, PathBuf};

use crate::core::error::Error;
use crate::mesh::gltf::{Content, Model, Texture};
use crate::texture::open_file::{check_bytes, check_file};
use crate::texture::source::TextureContent;

/// An image of a texture.
pub(super) struct Chosen {
    /// Index in the file.
    pub index: usize,
    pub content: TextureContent,
    /// Why others could not be taken.
    pub note: Option<String>,
}

/// Returns the image, or nothing of a texture without any in a format that is read. The error names what is wrong with
/// each.
pub(super) fn chosen(path: &Path, model: &Model, texture: &Texture) -> Result<Option<Chosen>, String> {
    let mut faults: Vec<String> = Vec::new();
    for &index in &texture.sources {
        let (content, checked) = match &model.images[index].content {
            Content::Path(file) => {
                let file = path.parent().unwrap_or(Path::new("")).join(file);
                let checked = check_file(&file);
                (TextureContent::File(file), checked.map_err(|e| fault(index, "/uri", &e)))
            }
            Content::Bytes(bytes) => {
                let label = PathBuf::from(format!("{} (image {index})", path.display()));
                let checked = check_bytes(bytes, &label).map_err(|e| fault(index, "", &e));
                (TextureContent::Embedded(label, bytes.clone()), checked)
            }
        };
        match checked {
            Err(fault) => faults.push(fault),
            Ok(()) => {
                let note = (!faults.is_empty())
                    .then(|| format!("/images/{index} is read in place of {}", faults.join(" and of ")));
                return Ok(Some(Chosen { index, content, note }));
            }
        }
    }
    if faults.is_empty() { Ok(None) } else { Err(faults.join("; ")) }
}

fn fault(index: usize, member: &str, error: &Error) -> String {
    let help = error.help().map_or_else(String::new, |help| format!("; {help}"));
    format!("/images/{index}{member}: {error}{help}")
}
