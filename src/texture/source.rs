//! Where a scene says that a texture's texels come from: one file or several, a ramp written in the
//! scene, a raw volume. Nothing is opened here; `load` makes [`TextureData`](super::data) of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::data::{ColorSpace, Dimension, MipKernel, TexelFormat};
use super::procedural::Procedural;
use crate::core::named::named_enum;

/// A texture as a scene has it: its texels may still be in files.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSource {
    /// For messages.
    pub name: String,
    /// Where the texels come from.
    pub content: TextureContent,
    /// The axes of its texels.
    pub dimension: Dimension,
    /// What the stored values mean.
    pub color_space: ColorSpace,
    /// Whether the scene says what the stored values mean.
    pub color_space_stated: bool,
    /// How files of pictures are read.
    pub reading: Reading,
    /// False: v = 0 is the file's first row. True: v grows upwards (the lecture's loader).
    pub flip_v: bool,
    /// What coarser levels are means over.
    pub mip_kernel: MipKernel,
}

/// Which picture of a file is read, and which way up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reading {
    /// What is done about a picture that is stored turned.
    pub orientation: OrientationUse,
    /// Of an OpenEXR file: a layer, a part, or a channel that is read as grey.
    pub layer: Option<String>,
}

impl Default for Reading {
    fn default() -> Self {
        Reading { orientation: OrientationUse::Apply, layer: None }
    }
}

named_enum! {
    /// What is done about a file that says how it is turned (Exif, TIFF tag 274).
    pub enum OrientationUse {
        /// The texels are turned, as programs that show pictures do.
        Apply = "apply",
        /// The texels stay as they are stored.
        Ignore = "ignore",
    }
}

/// Files are already joined with the scene file's folder.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureContent {
    /// A picture, or an NRRD volume.
    File(PathBuf),
    /// Linear light, one texel an entry: a 1D texture.
    Ramp(Vec<[f32; 4]>),
    /// All faces of a cube in one picture; without a layout its shape says which.
    CubeFile(PathBuf, Option<CubeLayout>),
    /// +x −x +y −y +z −z
    Faces([PathBuf; 6]),
    /// Pictures of one size, the first at w = 0.
    Slices(Vec<PathBuf>),
    /// A file of bare texels.
    Volume(VolumeSource),
    /// One picture, not of a file.
    Texels(Arc<PlainTexels>),
    /// No texels: computed where it is read.
    Procedural(Procedural),
}

named_enum! {
    /// How the six faces of a cube lie in one picture.
    pub enum CubeLayout {
        HorizontalCross = "horizontal-cross",
        VerticalCross = "vertical-cross",
        HorizontalStrip = "horizontal-strip",
        VerticalStrip = "vertical-strip",
        Grid = "grid",
    }
}

named_enum! {
    /// Byte order of a file's numbers.
    pub enum Endian {
        Little = "little",
        Big = "big",
    }
}

/// A picture in memory.
#[derive(Debug, PartialEq, Eq)]
pub struct PlainTexels {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Channels and number type of a texel.
    pub format: TexelFormat,
    /// Tightly packed rows, the first one on top, in the machine's byte order.
    pub bytes: Vec<u8>,
}

/// A file of bare texels: x runs fastest, then y, then z.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSource {
    /// The file.
    pub file: PathBuf,
    /// Width, height, depth.
    pub size: [u32; 3],
    /// Channels and number type of a texel.
    pub format: TexelFormat,
    /// Bytes before the first texel.
    pub offset: u64,
    /// The byte order of its numbers.
    pub endian: Endian,
}

impl TextureSource {
    /// The same under another name for every one that has the same texels: without its own name, and with its
    /// files as the system knows them.
    pub fn identity(&self) -> TextureSource {
        let mut identity = TextureSource { name: String::new(), ..self.clone() };
        for file in identity.content.files_mut() {
            // What is not there is told when it is read.
            if let Ok(path) = file.canonicalize() {
                *file = path;
            }
        }
        identity
    }
}

impl TextureContent {
    /// Returns the pattern, if it is one.
    pub fn procedural(&self) -> Option<&Procedural> {
        match self {
            TextureContent::Procedural(procedural) => Some(procedural),
            _ => None,
        }
    }

    /// All files named in the scene.
    pub fn files(&self) -> Vec<&Path> {
        match self {
            TextureContent::Ramp(_) | TextureContent::Texels(_) | TextureContent::Procedural(_) => Vec::new(),
            TextureContent::File(file) | TextureContent::CubeFile(file, _) => vec![file],
            TextureContent::Faces(files) => files.iter().map(PathBuf::as_path).collect(),
            TextureContent::Slices(files) => files.iter().map(PathBuf::as_path).collect(),
            TextureContent::Volume(volume) => vec![&volume.file],
        }
    }

    fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        match self {
            TextureContent::Ramp(_) | TextureContent::Texels(_) | TextureContent::Procedural(_) => Vec::new(),
            TextureContent::File(file) | TextureContent::CubeFile(file, _) => vec![file],
            TextureContent::Faces(files) => files.iter_mut().collect(),
            TextureContent::Slices(files) => files.iter_mut().collect(),
            TextureContent::Volume(volume) => vec![&mut volume.file],
        }
    }
}
