//! Images, samplers and textures, which join the two. Input: the file's lists of them and the bytes of its views.
//! Output: the same lists; embedded images as bytes that nobody looked into, others as paths that nobody opened.

use std::collections::HashMap;
use std::sync::Arc;

use super::buffers::Buffers;
use super::document::Document;
use super::json::Json;
use super::uri::Uri;
use crate::mesh::Fault;

/// A texture: an image and how it is looked up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Texture {
    /// Empty if it has none.
    pub name: String,
    /// Indices of images that show the same, those in formats of extensions first. It may be empty.
    pub sources: Vec<usize>,
    /// Index of the sampler. Without one, everything is as in an empty sampler.
    pub sampler: Option<usize>,
}

/// An image as the file holds it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Empty if it has none.
    pub name: String,
    /// The image itself or where it is.
    pub content: Content,
    /// The media type that the file states, such as `image/png`; it may be wrong.
    pub mime: Option<String>,
}

/// Where an image is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Content {
    /// In the glTF file or one of its buffers. Images of the same view share their bytes.
    Bytes(Arc<[u8]>),
    /// In a file of its own. The path is relative to the folder of the glTF file and stays in it.
    Path(String),
}

/// How a texture is looked up; filters that the file leaves open are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampler {
    /// If a texel is larger than a pixel.
    pub mag: Option<Weighting>,
    /// If a texel is smaller than a pixel: the filter within a level, and between levels, if these are used.
    pub min: Option<(Weighting, Option<Weighting>)>,
    /// Outside 0 to 1, along u and v.
    pub wrap: [Wrap; 2],
}

/// How neighbours are weighted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// The nearest one alone.
    Nearest,
    /// By distance.
    Linear,
}

/// What lies outside a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The texture mirrored.
    Mirror,
    /// The texels of the edge.
    Clamp,
}

/// Reads all images.
pub(super) fn images(document: &Document, buffers: &Buffers) -> Result<Vec<Image>, Fault> {
    let mut views: HashMap<usize, Arc<[u8]>> = HashMap::new();
    // Views may overlap, but a file whose images are larger than all of its bytes only wants to fill the memory.
    let mut left = buffers.byte_count();
    let mut image = |json: Json| {
        let mut mime = json.text("mimeType")?.map(str::to_owned);
        let content =
            match (json.text("uri")?, json.index("bufferView", buffers.view_count(), "buffer views")?) {
                (Some(uri), None) => match Uri::read(uri).map_err(|what| json.fault_at("uri", what))? {
                    Uri::Path(path) => Content::Path(path),
                    Uri::Data(bytes, stated) => {
                        mime = mime.or(Some(stated).filter(|stated| !stated.is_empty()));
                        Content::Bytes(bytes.into())
                    }
                },
                (None, Some(view)) => match views.get(&view) {
                    Some(bytes) => Content::Bytes(Arc::clone(bytes)),
                    None => {
                        let (bytes, _) = buffers.view_bytes(json, "bufferView")?;
                        left = left.checked_sub(bytes.len()).ok_or_else(|| {
                            json.fault_at(
                                "bufferView",
                                "the images together have more bytes than all buffers",
                            )
                        })?;
                        let bytes: Arc<[u8]> = bytes.into();
                        views.insert(view, Arc::clone(&bytes));
                        Content::Bytes(bytes)
                    }
                },
                _ => return Err(json.fault("it needs either uri or bufferView")),
            };
        Ok(Image { name: json.name()?, content, mime })
    };
    document.list("images")?.elements().map(|element| image(element?.json())).collect()
}

/// Reads all samplers.
pub(super) fn samplers(document: &Document) -> Result<Vec<Sampler>, Fault> {
    document.list("samplers")?.elements().map(|element| sampler(element?.json())).collect()
}

/// Reads all textures.
pub(super) fn textures(document: &Document, images: usize, samplers: usize) -> Result<Vec<Texture>, Fault> {
    let texture = |json: Json| {
        let mut sources = Vec::new();
        // In the order of what is lost least: super-compressed but with levels, blocks with levels, a picture.
        for name in ["KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_webp"] {
            if let Some(extension) = json.extension(name)? {
                sources.extend(extension.index("source", images, "images")?);
            }
        }
        sources.extend(json.index("source", images, "images")?);
        Ok(Texture { name: json.name()?, sources, sampler: json.index("sampler", samplers, "samplers")? })
    };
    document.list("textures")?.elements().map(|element| texture(element?.json())).collect()
}

/// Reads a sampler.
fn sampler(json: Json) -> Result<Sampler, Fault> {
    use Weighting::{Linear, Nearest};
    let chosen = |key, allowed| {
        let refuse = move |code| json.fault_at(key, format!("it is {code}; {allowed} are allowed"));
        json.whole(key).map(|code| (code, refuse))
    };
    let (code, refuse) = chosen("magFilter", "9728 and 9729")?;
    let mag = match code {
        None => None,
        Some(9728) => Some(Nearest),
        Some(9729) => Some(Linear),
        Some(code) => return Err(refuse(code)),
    };
    let (code, refuse) = chosen("minFilter", "9728, 9729 and 9984 to 9987")?;
    let min = match code {
        None => None,
        Some(9728) => Some((Nearest, None)),
        Some(9729) => Some((Linear, None)),
        Some(9984) => Some((Nearest, Some(Nearest))),
        Some(9985) => Some((Linear, Some(Nearest))),
        Some(9986) => Some((Nearest, Some(Linear))),
        Some(9987) => Some((Linear, Some(Linear))),
        Some(code) => return Err(refuse(code)),
    };
    let wrap = |key| {
        let (code, refuse) = chosen(key, "33071, 33648 and 10497")?;
        match code {
            None | Some(10497) => Ok(Wrap::Repeat),
            Some(33648) => Ok(Wrap::Mirror),
            Some(33071) => Ok(Wrap::Clamp),
            Some(code) => Err(refuse(code)),
        }
    };
    Ok(Sampler { mag, min, wrap: [wrap("wrapS")?, wrap("wrapT")?] })
}
