//! Writes a finished film to a picture file whose extension names the format. The file appears
//! complete or not at all: it is written beside its final path and renamed. Folders are created by
//! `OutputFolder` only.

mod adaptation;
mod bands;
mod display;
mod encode;
mod exr;
mod folder;
mod gamut;
mod hdr;
mod icc;
mod jpeg;
mod png;
mod png_color;
mod png_filter;
mod quantise;
pub mod record;
mod sink;
mod target;
mod tiff;
mod tone_map;
mod unfinished;

use std::path::Path;

use crate::core::error::{Error, Result};
use crate::core::film::{Film, Placement};
use crate::core::layer::Layer;
use crate::core::panics;
pub use adaptation::{KELVINS, parse_kelvin, white_of};
pub use display::{DisplayTransform, STOPS, parse_stops, screen_pixels};
pub use encode::Format;
pub use folder::OutputFolder;
pub use gamut::Gamut;
pub use quantise::srgb8;
use target::Target;
pub use tone_map::ToneMap;
pub use unfinished::discard_and_end;

/// Every extension that names a format.
pub const ENDINGS: [(&str, Format); 7] = [
    ("exr", Format::Exr),
    ("hdr", Format::Hdr),
    ("png", Format::Png),
    ("jpg", Format::Jpeg),
    ("jpeg", Format::Jpeg),
    ("tif", Format::Tiff),
    ("tiff", Format::Tiff),
];
pub const ENDING_NAMES: [&str; 7] = {
    let mut names = [""; 7];
    let mut i = 0;
    while i < names.len() {
        names[i] = ENDINGS[i].0;
        i += 1;
    }
    names
};

#[derive(Clone, Copy, Debug)]
pub struct WriteOptions<'a> {
    /// Bits per channel of PNG files: 8 or 16.
    pub png_bits: u8,
    /// The quality of JPEG files: 1 to 100.
    pub jpeg_quality: u8,
    /// What becomes of colours in formats for screens: PNG, JPEG and TIFF.
    pub display: DisplayTransform,
    /// How the picture was made: ASCII on one line, which every format carries.
    pub record: Option<&'a str>,
    /// The film's placement in a larger picture, for formats that can store it (EXR).
    pub placement: Option<Placement>,
    /// More properties of the pixels, for formats that can store them (EXR).
    pub layers: &'a [Layer],
    /// False: files with layers have nothing else.
    pub has_colors: bool,
}

impl Default for WriteOptions<'_> {
    fn default() -> Self {
        WriteOptions {
            png_bits: 8,
            jpeg_quality: 95,
            display: DisplayTransform::default(),
            record: None,
            placement: None,
            layers: &[],
            has_colors: true,
        }
    }
}

impl WriteOptions<'_> {
    /// Returns an error that names the first value out of its range.
    pub fn check(&self) -> Result<()> {
        if !matches!(self.png_bits, 8 | 16) {
            return Err(Error::with_help(
                format!("PNG with {} bits per channel cannot be written", self.png_bits),
                "use 8 or 16",
            ));
        }
        if !(1..=100).contains(&self.jpeg_quality) {
            let what = format!("JPEG of quality {} cannot be written", self.jpeg_quality);
            return Err(Error::with_help(what, "use 1 (smallest files) to 100 (best)"));
        }
        self.display.check()
    }
}

/// Writes `film` to `path` and replaces an existing file; on failure that file is unchanged.
pub fn write(film: &Film, path: &Path, options: &WriteOptions) -> Result<()> {
    prepare(film, path, options)?.finish()
}

/// Writes `film` to every path. All files are complete before the first one is renamed to its final
/// path, so that a full disk leaves none of them.
pub fn write_all(film: &Film, paths: &[impl AsRef<Path>], options: &WriteOptions) -> Result<()> {
    write_all_after(film, paths, options, || Ok(()))
}

/// Like [`write_all`], but calls `first` once all files are complete; if it fails, no file is
/// renamed.
pub fn write_all_after(
    film: &Film,
    paths: &[impl AsRef<Path>],
    options: &WriteOptions,
    first: impl FnOnce() -> Result<()>,
) -> Result<()> {
    let pictures: Vec<Named<'_>> =
        paths.iter().map(|path| Named { film, path: path.as_ref(), options }).collect();
    write_pictures(&pictures, first)
}

/// A picture, its file, and how it is written.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    pub film: &'a Film,
    pub path: &'a Path,
    pub options: &'a WriteOptions<'a>,
}

/// Writes different pictures as [`write_all_after`] writes one.
pub fn write_pictures(pictures: &[Named<'_>], first: impl FnOnce() -> Result<()>) -> Result<()> {
    let prepared = pictures
        .iter()
        .map(|Named { film, path, options }| prepare(film, path, options))
        .collect::<Result<Vec<_>>>()?;
    first()?;
    prepared.into_iter().try_for_each(Target::finish)
}

/// Writes the whole file under its temporary name.
fn prepare(film: &Film, path: &Path, options: &WriteOptions) -> Result<Target> {
    let format = format_of(path)?;
    options.check()?;
    let mut target = Target::create(path)?;
    let failed = |e| {
        Error::with_help(
            format!(
                "{}: the {}×{} picture cannot be written as {format}: {e}",
                path.display(),
                film.width,
                film.height
            ),
            "nothing was written; check the disk's free space, or choose another format by its ending",
        )
    };
    let stage = format!("{}: writing this picture", path.display());
    panics::contain(&stage, || encode::encode(film, format, options, target.writer()).map_err(failed))?;
    target.complete()?;
    Ok(target)
}

/// Writes `bytes` unchanged, with the same guarantees as pictures.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let mut target = Target::create(path)?;
    target.writer().write_all(bytes).map_err(|e| Error::new(format!("{}: {e}", path.display())))?;
    target.complete()?;
    target.finish()
}

/// Returns the bytes of a picture file.
pub fn to_bytes(film: &Film, format: Format) -> Result<Vec<u8>> {
    to_bytes_with(film, format, &WriteOptions::default())
}

/// Returns the bytes of a picture file that is written with these options.
pub fn to_bytes_with(film: &Film, format: Format, options: &WriteOptions) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let failed = |e| Error::new(format!("a {format} picture of {}×{}: {e}", film.width, film.height));
    panics::contain(&format_args!("writing a {format} picture"), || {
        encode::encode(film, format, options, &mut bytes).map_err(failed)
    })?;
    Ok(bytes)
}

/// Returns the error that [`write_file`] would return for this path.
pub fn check_file_writable(path: &Path) -> Result<()> {
    Target::create(path).map(drop)
}

/// Returns any error of [`write()`] that does not depend on the picture. Called before a long
/// render.
pub fn check_writable(path: &Path) -> Result<()> {
    format_of(path)?;
    Target::create(path).map(drop)
}

/// Returns the format of a lower-case extension.
pub fn format_named(ending: &str) -> Option<Format> {
    ENDINGS.iter().find(|(name, _)| ending == *name).map(|(_, format)| *format)
}

/// Returns the format of the path's extension, in upper or lower case.
pub fn format_of(path: &Path) -> Result<Format> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    ending.as_deref().and_then(format_named).ok_or_else(|| {
        let found = ending.map_or("the name has no ending".into(), |e| format!("the ending .{e} is unknown"));
        let endings: Vec<String> = ENDINGS.iter().map(|(name, _)| format!(".{name}")).collect();
        Error::with_help(
            format!("{}: {found}, so no picture format is chosen", path.display()),
            format!("use one of {}", endings.join(", ")),
        )
    })
}
