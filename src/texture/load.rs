//! A texture as a scene describes it, in; its texels, ready for upload, out. Mistakes in the files
//! are errors that name the texture and the file.

use super::data::TextureData;
use super::decode::decode;
use super::source::{TextureContent, TextureSource};
use crate::error::{Error, Result};

pub fn load(source: &TextureSource) -> Result<TextureData> {
    match &source.content {
        TextureContent::File(file) => decode(file, &source.name, source.color_space, source.flip_v),
        _ => Err(Error::new(format!("texture \"{}\": this content is not read", source.name))),
    }
}
