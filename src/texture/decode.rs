//! Decodes a picture file into a texture that is ready for upload. In addition to reading the file
//! it checks that values are finite unless others are allowed, that the colour space fits the
//! component type, and applies the row order of v.

use std::path::Path;

use super::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};
use super::read_file::{self, FileFacts, Picture, Texels};
use super::source::ReadOptions;
use crate::core::error::{Error, ErrorKind, Result};

/// The float values that a file may hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AllowedFloats {
    /// NaN and infinity are errors: in nearly every file that has them they are mistakes.
    #[default]
    Finite,
    Any,
}

/// Decodes a 2D texture from one picture.
pub fn decode(path: &Path, name: &str, color_space: ColorSpace, flip_v: bool) -> Result<TextureData> {
    let picture = read_checked(path, &ReadOptions::default(), color_space, AllowedFloats::Finite);
    let mut picture = picture.map_err(|e| in_texture(name, e))?;
    if flip_v {
        picture.reverse_rows();
    }
    Ok(texture_of(name, Dimension::Two, color_space, picture))
}

/// Makes a texture of a file's levels.
pub(crate) fn texture_of(
    name: &str,
    dimension: Dimension,
    color_space: ColorSpace,
    picture: Picture,
) -> TextureData {
    let FileFacts { depth, levels, .. } = picture.facts;
    let level = |texels: Texels, depth, stored_levels| TextureData {
        name: name.to_string(),
        dimension,
        width: texels.width,
        height: texels.height,
        depth,
        format: texels.format,
        color_space,
        file_channels: texels.file_channels,
        texels: texels.bytes,
        stored_levels,
    };
    let halved = |index: usize| if dimension == Dimension::Three { (depth >> index).max(1) } else { depth };
    let levels = levels.into_iter().enumerate().map(|(i, texels)| level(texels, halved(i + 1), Vec::new()));
    let levels = levels.collect();
    level(picture.texels, depth, levels)
}

pub(super) fn read_checked(
    path: &Path,
    reading: &ReadOptions,
    color_space: ColorSpace,
    values: AllowedFloats,
) -> Result<Picture> {
    check_picture(read_file::read_as(path, reading)?, color_space, values, path)
}

/// Returns a picture whose values are as they have to be, in all levels; colours of another space become those of sRGB.
pub(super) fn check_picture(
    mut picture: Picture,
    color_space: ColorSpace,
    values: AllowedFloats,
    path: &Path,
) -> Result<Picture> {
    check_meaning(picture.texels.format, color_space, path)?;
    check_values(&picture.texels, values, path)?;
    picture.facts.levels.iter().try_for_each(|level| check_values(level, values, path))?;
    if color_space == ColorSpace::Srgb {
        picture.apply_profile(path);
    }
    Ok(picture)
}

/// Reads a picture that lies within another file.
pub(super) fn read_embedded(
    name: &Path,
    bytes: &[u8],
    reading: &ReadOptions,
    color_space: ColorSpace,
) -> Result<Picture> {
    check_picture(read_file::read_bytes(bytes, name, reading)?, color_space, AllowedFloats::Finite, name)
}

pub(super) fn in_texture(name: &str, error: Error) -> Error {
    error.or_kind(ErrorKind::File).within(&format!("texture \"{name}\""))
}

pub(super) fn check_meaning(format: TexelFormat, color_space: ColorSpace, path: &Path) -> Result<()> {
    if format.component() != Component::Float32 || color_space == ColorSpace::Linear {
        return Ok(());
    }
    Err(Error::with_help(
        format!("{}: float texels are linear light, not sRGB", path.display()),
        "set color_space = \"linear\"; sRGB is an encoding of 8- and 16-bit values",
    ))
}

/// Checks that all values are allowed. The message states the slice if there are several.
pub(super) fn check_values(texels: &Texels, allowed: AllowedFloats, path: &Path) -> Result<()> {
    if allowed == AllowedFloats::Any || texels.format.component() != Component::Float32 {
        return Ok(());
    }
    let values = texels.bytes.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
    let mut bad = values.enumerate().filter(|(_, v)| !v.is_finite());
    let Some((first, value)) = bad.next() else { return Ok(()) };
    let count = 1 + bad.count();
    let channels = texels.format.channels();
    let names: &[&str] = if channels < 3 { &["grey", "alpha"] } else { &["red", "green", "blue", "alpha"] };
    let (width, height) = (texels.width as usize, texels.height as usize);
    let (x, row) = (first / channels % width, first / channels / width);
    let slices = texels.bytes.len() / (width * height * texels.format.bytes_per_texel());
    let slice = if slices > 1 { format!(", {}", row / height) } else { String::new() };
    let values =
        if count == 1 { "1 value of the file is".into() } else { format!("{count} values of the file are") };
    Err(Error::with_help(
        format!(
            "{}: texel ({x}, {}{slice}), channel {}, is {value}; {values} not finite",
            path.display(),
            row % height,
            names[first % channels],
        ),
        "replace them before use (column and row are counted from the top left), or let them in: \
         moire render --allow-nonfinite",
    ))
}

impl Picture {
    /// Converts codes to those of sRGB, if the file states that they mean other colours; a profile that cannot be applied is
    /// noted. Returns the share of the texels that are outside of sRGB and are clipped, if any were converted.
    pub(crate) fn apply_profile(&mut self, path: &Path) -> Option<f64> {
        let profile = self.facts.profile.take()?;
        if let Some(why) = profile.fault() {
            let (path, name) = (path.display(), &profile.name);
            self.notes.push(format!(
                "{path}: its colour profile ({name}) {why}; its colours are read as those of sRGB"
            ));
        }
        profile.convert(&mut self.texels)
    }

    /// Reverses the row order within each slice of each level.
    pub(super) fn reverse_rows(&mut self) {
        for level in std::iter::once(&mut self.texels).chain(&mut self.facts.levels) {
            let height = level.height;
            reverse_rows(level, height);
        }
    }
}

/// Reverses the row order within each slice of `height` rows.
pub(super) fn reverse_rows(texels: &mut Texels, height: u32) {
    let row = texels.width as usize * texels.format.bytes_per_texel();
    let (height, half) = (height as usize, height as usize / 2 * row);
    for slice in texels.bytes.chunks_exact_mut(row * height) {
        let (top, rest) = slice.split_at_mut(half);
        let rows = top.chunks_exact_mut(row).zip(rest.chunks_exact_mut(row).rev());
        rows.for_each(|(a, b)| a.swap_with_slice(b));
    }
}
