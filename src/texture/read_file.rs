//! Reads a picture file into texels as stored: 8 bits stay 8, 16 stay 16, floats stay floats, grey
//! stays grey, three channels become four with opaque alpha. A colour profile is returned beside them.
//! Errors name the file and state what to do.

use std::io::{BufReader, Cursor, Read, Seek};
use std::path::Path;

use super::color_profile::ColorProfile;
use super::data::{ColorSpace, Dimension, TexelFormat};
use super::formats::{PictureFormat, Reader, supported};
use super::open_file::open;
use super::orientation::orientation_of;
use super::read_exr;
pub use super::read_exr::ExrWindow;
use super::sniff::{self, Content};
use super::source::{OrientationUse, ProfileUse, ReadOptions};
use crate::core::error::{Error, Result};
use crate::core::film::Placement;
use crate::core::panics;

/// Twice the largest image side of current GPUs; checked in the header, before any allocation.
const MAX_SIDE: u64 = 65_536;
/// The limit of the decoded size; the image crate's default of 512 MiB refuses an 8192² float
/// texture.
pub(super) const MAX_BYTES: u64 = 16 << 30;

/// Tightly packed rows in native byte order, the file's first row first.
pub struct Texels {
    pub width: u32,
    pub height: u32,
    pub format: TexelFormat,
    /// Channels of the file, before three were expanded to four.
    pub file_channels: usize,
    pub bytes: Vec<u8>,
}

/// The contents of a file, with notes for the user about how it was read; each note names the file.
pub struct Picture {
    pub texels: Texels,
    /// The placement of the texels in the file's picture.
    pub placement: Placement,
    pub notes: Vec<String>,
    pub facts: FileFacts,
}

/// The facts of a file beyond one array of texels.
pub struct FileFacts {
    pub dimension: Dimension,
    /// Slices of a volume, 6 for a cube, otherwise 1.
    pub depth: u32,
    /// The levels that the file stores, from level 1 on.
    pub levels: Vec<Texels>,
    /// The meaning of the values, if the file states it.
    pub color_space: Option<ColorSpace>,
    /// The colours that its codes mean, if the file states them.
    pub profile: Option<ColorProfile>,
    /// The formats of the file and of its texels, by name, where the texels do not tell them.
    pub encoding: Option<String>,
}

impl Default for FileFacts {
    /// Returns the facts of one flat picture.
    fn default() -> Self {
        FileFacts {
            dimension: Dimension::Two,
            depth: 1,
            levels: Vec::new(),
            color_space: None,
            profile: None,
            encoding: None,
        }
    }
}

impl Picture {
    /// Returns a complete picture with these notes.
    pub(super) fn noted(texels: Texels, notes: Vec<String>) -> Picture {
        let placement = Placement::whole(texels.width, texels.height);
        Picture { texels, placement, notes, facts: FileFacts::default() }
    }
}

impl From<Texels> for Picture {
    fn from(texels: Texels) -> Self {
        Picture::noted(texels, Vec::new())
    }
}

/// Reads a flat picture with the given options; by default it is turned upright and, if it has layers,
/// the unnamed one is read.
pub fn read_as(path: &Path, reading: &ReadOptions) -> Result<Picture> {
    read_window(path, reading, ExrWindow::Display)
}

/// Reads a flat picture with the given options; of an OpenEXR file only this part.
pub fn read_window(path: &Path, reading: &ReadOptions, window: ExrWindow) -> Result<Picture> {
    let picture = read_part(path, reading, window)?;
    check_dimension(&picture, Dimension::Two, path)?;
    Ok(picture)
}

/// Reads a file of texels of any dimension.
pub fn read_any(path: &Path, reading: &ReadOptions) -> Result<Picture> {
    read_part(path, reading, ExrWindow::Display)
}

/// Checks that a file holds texels of this dimension; a picture is flat.
pub(super) fn check_dimension(picture: &Picture, wanted: Dimension, path: &Path) -> Result<()> {
    let FileFacts { dimension, depth, .. } = picture.facts;
    if dimension == wanted {
        return Ok(());
    }
    let Texels { width, height, .. } = picture.texels;
    let holds = match dimension {
        Dimension::Cube => format!("a cube with faces of {width}×{height} texels"),
        Dimension::Three => format!("a volume of {width}×{height}×{depth} texels"),
        Dimension::One | Dimension::Two => format!("one flat picture of {width}×{height} texels"),
    };
    Err(Error::with_help(
        format!("{}: the file holds {holds}, and one of dimension \"{wanted}\" is needed", path.display()),
        format!("of a texture, set dimension = \"{dimension}\"; else name another file"),
    ))
}

fn read_part(path: &Path, reading: &ReadOptions, window: ExrWindow) -> Result<Picture> {
    let stage = format!("{}: reading this picture", path.display());
    panics::contain(&stage, || {
        let file = open(path)?;
        let length = file.length().map_err(|e| unreadable(path, &e))? as usize;
        read_by_content(file, length, path, reading, window)
    })
}

/// Reads a picture from the bytes of a file that is known by this name.
pub(super) fn read_bytes(bytes: &[u8], name: &Path, reading: &ReadOptions) -> Result<Picture> {
    let stage = format!("{}: reading this picture", name.display());
    panics::contain(&stage, || {
        let picture = read_by_content(Cursor::new(bytes), bytes.len(), name, reading, ExrWindow::Display)?;
        check_dimension(&picture, Dimension::Two, name)?;
        Ok(picture)
    })
}

fn read_by_content(
    mut source: impl Read + Seek,
    length: usize,
    path: &Path,
    reading: &ReadOptions,
    window: ExrWindow,
) -> Result<Picture> {
    let failed = |e: std::io::Error| unreadable(path, &e);
    let format = match identify(&mut source).map_err(failed)? {
        Content::Picture(format) => format,
        Content::Other(what) => return Err(no_picture(path, &what)),
    };
    let read = match format.properties().reader {
        Reader::Layered => {
            let layer = reading.layer.as_deref();
            let (texels, placement) = read_exr::read(&mut BufReader::new(source), layer, window, path)?;
            return Ok(Picture { placement, ..Picture::from(texels) });
        }
        Reader::Whole(read) => read,
    };
    if let Some(layer) = &reading.layer {
        return Err(no_layers(path, format, layer));
    }
    let file = read_whole(source, length, path)?;
    let mut picture = read(&file, path)?;
    if reading.color_profile == ProfileUse::Apply {
        picture.facts.profile = ColorProfile::of_file(&file, format);
    }
    let orientation = match reading.orientation {
        OrientationUse::Apply => orientation_of(&file, format),
        OrientationUse::Ignore => None,
    };
    drop(file);
    let Some(orientation) = orientation else { return Ok(picture) };
    check_memory(path, picture.texels.bytes.len())?;
    let Picture { texels, notes, facts, .. } = picture;
    Ok(Picture { facts, ..Picture::noted(orientation.apply(texels), notes) })
}

pub(super) fn read_whole(mut source: impl Read, length: usize, path: &Path) -> Result<Vec<u8>> {
    let failed = |e: std::io::Error| unreadable(path, &e);
    let mut file = Vec::new();
    file.try_reserve_exact(length).map_err(|_| out_of_memory(path))?;
    source.read_to_end(&mut file).map_err(failed)?;
    Ok(file)
}

pub(super) fn identify(source: &mut (impl Read + Seek)) -> std::io::Result<Content> {
    let mut head = Vec::with_capacity(sniff::HEAD_BYTES);
    source.by_ref().take(sniff::HEAD_BYTES as u64).read_to_end(&mut head)?;
    source.rewind()?;
    Ok(sniff::identify(&head))
}

/// Returns true if the file is of a format that may hold cubes and volumes.
pub(super) fn is_container(path: &Path) -> bool {
    let content = open(path).ok().and_then(|mut source| identify(&mut source).ok());
    matches!(content, Some(Content::Picture(format)) if format.properties().is_container)
}

/// Returns true if the file's metadata states that the picture is stored rotated or mirrored.
pub fn is_turned(path: &Path) -> bool {
    stated(path, orientation_of).is_some()
}

/// Returns the colour profile that the file states.
pub fn color_profile(path: &Path) -> Option<ColorProfile> {
    stated(path, ColorProfile::of_file)
}

/// Returns what a picture file states of itself, by a function of its bytes.
fn stated<T>(path: &Path, of_file: fn(&[u8], PictureFormat) -> Option<T>) -> Option<T> {
    let mut source = open(path).ok()?;
    match identify(&mut source).ok()? {
        // A large file in parts, which states none of these things.
        Content::Picture(PictureFormat::OpenExr) | Content::Other(_) => None,
        Content::Picture(format) => {
            let length = source.length().map_or(0, |length| length as usize);
            of_file(&read_whole(source, length, path).ok()?, format)
        }
    }
}

pub(super) fn no_picture(path: &Path, what: &str) -> Error {
    Error::with_help(
        format!("{}: not a picture that can be read: the content {what}", path.display()),
        format!("supported are {}, whatever the ending of the name", supported()),
    )
}

pub(super) fn check_size(path: &Path, width: u64, height: u64, bytes_per_texel: usize) -> Result<()> {
    if width == 0 || height == 0 {
        return Err(zero_size(path));
    }
    if width.max(height) > MAX_SIDE {
        return Err(Error::with_help(
            format!("{}: {width}×{height} texels are too many", path.display()),
            format!("at most {MAX_SIDE} texels a side are read; scale the picture down or cut it"),
        ));
    }
    if width * height * bytes_per_texel as u64 > MAX_BYTES {
        return Err(out_of_memory(path));
    }
    Ok(())
}

/// Checks several slices or faces: the limits of one, and that of all texels together.
pub(super) fn check_volume(path: &Path, size: [u32; 3], bytes_per_texel: usize) -> Result<()> {
    let [width, height, depth] = size.map(u64::from);
    if depth > MAX_SIDE {
        return Err(Error::with_help(
            format!("{}: {width}×{height}×{depth} texels are too many", path.display()),
            format!("at most {MAX_SIDE} texels a side are read"),
        ));
    }
    check_size(path, width, height, bytes_per_texel)?;
    if width * height * depth.max(1) * bytes_per_texel as u64 > MAX_BYTES {
        return Err(out_of_memory(path));
    }
    if depth == 0 { Err(zero_size(path)) } else { Ok(()) }
}

/// Asks the allocator for memory before `vec!` does, so that a size invented by a damaged header is
/// an error and not an abort. The memory is not touched, and zeroed pages are touched only as they
/// are filled.
pub(super) fn check_memory(path: &Path, bytes: usize) -> Result<()> {
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| out_of_memory(path))
}

pub(super) fn unreadable(path: &Path, error: &std::io::Error) -> Error {
    Error::with_help(
        format!("{}: cannot be read: {error}", path.display()),
        "check the path and the file's permissions",
    )
}

pub(super) fn damaged(path: &Path, kind: &str, error: &dyn std::fmt::Display) -> Error {
    Error::with_help(
        format!("{}: the {kind} data is damaged or truncated: {error}", path.display()),
        "fetch or export the picture again",
    )
}

fn no_layers(path: &Path, format: PictureFormat, layer: &str) -> Error {
    let kind = format.name();
    Error::with_help(
        format!("{}: layer \"{layer}\" of a {kind} file: only OpenEXR files have layers", path.display()),
        "leave layer out",
    )
}

pub(super) fn zero_size(path: &Path) -> Error {
    Error::with_help(
        format!("{}: the picture has zero size", path.display()),
        "a picture needs at least one texel in width and in height",
    )
}

pub(super) fn out_of_memory(path: &Path) -> Error {
    Error::with_help(
        format!("{}: the decoded picture does not fit into memory", path.display()),
        format!("at most {} GiB of texels are read; scale the picture down", MAX_BYTES >> 30),
    )
}

/// Returns the error for an unsupported kind of file. `name` states the kind, with its article if
/// it has one.
pub(super) fn unsupported_kind(path: &Path, name: &str) -> Error {
    Error::with_help(
        format!("{}: this file is {name}, which is not read", path.display()),
        "convert it, for example to PNG of 8 or 16 bits, or to OpenEXR",
    )
}
