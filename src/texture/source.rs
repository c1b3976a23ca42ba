//! The source of a texture's texels as a scene states it: one file or several, a ramp written in
//! the scene, a raw volume. No file is opened here; `load` makes [`TextureData`](super::data) of
//! it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::data::{ColorSpace, Dimension, MipKernel, TexelFormat};
use super::procedural::Procedural;
use super::tiles::TileSet;
use crate::core::named::named_enum;

/// A texture as a scene has it: its texels may still be in files.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSource {
    /// For messages.
    pub name: String,
    /// The source of the texels.
    pub content: TextureContent,
    /// The axes of its texels.
    pub dimension: Dimension,
    /// The meaning of the stored values.
    pub color_space: ColorSpace,
    /// True if the scene states the meaning of stored values.
    pub color_space_stated: bool,
    /// The options for reading picture files.
    pub reading: ReadOptions,
    /// False: v = 0 is the file's first row. True: v grows upwards (the lecture's loader).
    pub flip_v: bool,
    /// The kernel of coarser mip levels.
    pub mip_kernel: MipKernel,
}

/// The options of reading a file: orientation, colour profile, and layer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadOptions {
    /// The treatment of pictures that are stored rotated.
    pub orientation: OrientationUse,
    /// The treatment of pictures whose colours are not those of sRGB.
    pub color_profile: ProfileUse,
    /// For OpenEXR files, a layer, a part, or a channel that is read as grey.
    pub layer: Option<String>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        ReadOptions { orientation: OrientationUse::Apply, color_profile: ProfileUse::Apply, layer: None }
    }
}

named_enum! {
    /// The treatment of a file whose metadata states its orientation (Exif, TIFF tag 274).
    pub enum OrientationUse {
        /// The texels are turned upright, as image viewers do.
        Apply = "apply",
        /// The texels stay as stored.
        Ignore = "ignore",
    }
}

named_enum! {
    /// The treatment of a colour profile (ICC, cICP) of a file that is read as sRGB.
    pub enum ProfileUse {
        /// Colours are converted to sRGB, as image viewers do.
        Apply = "apply",
        /// Codes are read as those of sRGB.
        Ignore = "ignore",
    }
}

/// The content of a texture. Paths are already joined with the scene file's folder.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureContent {
    /// A picture or an NRRD volume.
    File(PathBuf),
    /// A 1D texture in linear light, one texel per entry.
    Ramp(Vec<[f32; 4]>),
    /// All faces of a cube in one picture; without a layout the aspect ratio determines it.
    CubeFile(PathBuf, Option<CubeLayout>),
    /// The six faces in the order +x −x +y −y +z −z.
    Faces([PathBuf; 6]),
    /// Pictures of equal size, the first at w = 0.
    Slices(Vec<PathBuf>),
    /// A picture of colours, white without one, with the opacity of another.
    Cutout {
        /// The picture of the colours.
        color: Option<PathBuf>,
        /// The picture of the opacity.
        opacity: PathBuf,
    },
    /// One picture of the tiles of several files.
    Tiles(TileSet),
    /// A file of bare texels.
    Volume(VolumeSource),
    /// A picture file within another, known by this name.
    Embedded(PathBuf, Arc<[u8]>),
    /// The first of these pictures that can be read; each with its place in the file that names it.
    FirstOf(Vec<(String, TextureContent)>),
    /// One picture, not of a file.
    Texels(Arc<PlainTexels>),
    /// No texels; the pattern is evaluated at each lookup.
    Procedural(Procedural),
}

named_enum! {
    /// The layout of a cube's six faces in one picture.
    pub enum CubeLayout {
        HorizontalCross = "horizontal-cross",
        VerticalCross = "vertical-cross",
        HorizontalStrip = "horizontal-strip",
        VerticalStrip = "vertical-strip",
        Grid = "grid",
    }
}

named_enum! {
    /// The byte order of a file's numbers.
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

/// A file of raw texels: x runs fastest, then y, then z.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSource {
    /// The file.
    pub file: PathBuf,
    /// Width, height and depth.
    pub size: [u32; 3],
    /// Channels and number type of a texel.
    pub format: TexelFormat,
    /// Bytes before the first texel.
    pub offset: u64,
    /// The byte order of its numbers.
    pub endian: Endian,
}

impl TextureSource {
    /// Returns an equal value for all sources with the same texels: without the texture's name and
    /// with canonical file paths.
    pub fn identity(&self) -> TextureSource {
        let mut identity = TextureSource { name: String::new(), ..self.clone() };
        for file in identity.content.files_mut() {
            // A missing file is reported when it is read.
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

    /// Returns all files named in the scene.
    pub fn files(&self) -> Vec<&Path> {
        match self {
            TextureContent::Ramp(_)
            | TextureContent::Embedded(..)
            | TextureContent::Texels(_)
            | TextureContent::Procedural(_) => Vec::new(),
            TextureContent::File(file) | TextureContent::CubeFile(file, _) => vec![file],
            TextureContent::Faces(files) => files.iter().map(PathBuf::as_path).collect(),
            TextureContent::Slices(files) => files.iter().map(PathBuf::as_path).collect(),
            TextureContent::Cutout { color, opacity } => {
                color.iter().chain([opacity]).map(PathBuf::as_path).collect()
            }
            TextureContent::Tiles(set) => set.tiles.iter().map(|tile| tile.file.as_path()).collect(),
            TextureContent::Volume(volume) => vec![&volume.file],
            TextureContent::FirstOf(pictures) => pictures.iter().flat_map(|(_, own)| own.files()).collect(),
        }
    }

    /// Returns the content of a flat texture by its name, which may stand for several tiles.
    pub fn flat_file(path: PathBuf) -> TextureContent {
        TileSet::of_name(&path).map_or(TextureContent::File(path), TextureContent::Tiles)
    }

    /// Returns all files named in the scene, to change them.
    pub fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        match self {
            TextureContent::Ramp(_)
            | TextureContent::Embedded(..)
            | TextureContent::Texels(_)
            | TextureContent::Procedural(_) => Vec::new(),
            TextureContent::File(file) | TextureContent::CubeFile(file, _) => vec![file],
            TextureContent::Faces(files) => files.iter_mut().collect(),
            TextureContent::Slices(files) => files.iter_mut().collect(),
            TextureContent::Cutout { color, opacity } => color.iter_mut().chain([opacity]).collect(),
            TextureContent::Tiles(set) => set.tiles.iter_mut().map(|tile| &mut tile.file).collect(),
            TextureContent::Volume(volume) => vec![&mut volume.file],
            TextureContent::FirstOf(pictures) => {
                pictures.iter_mut().flat_map(|(_, own)| own.files_mut()).collect()
            }
        }
    }
}
