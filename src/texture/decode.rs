//! Decodes a picture file into a texture that is ready for upload. In addition to reading the file
//! it checks that values are finite unless others are allowed, that the colour space fits the
//! component type, and applies the row order of v.

use std::path::Path;

use super::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};
use super::read_file::{self, Picture, Texels};
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
    let mut texels = picture.map_err(|e| in_texture(name, e))?.texels;
    if flip_v {
        let height = texels.height;
        reverse_rows(&mut texels, height);
    }
    Ok(texture_of(name, Dimension::Two, color_space, texels, 1))
}

/// Makes a texture of `texels`, which hold `depth` slices of its height.
pub(super) fn texture_of(
    name: &str,
    dimension: Dimension,
    color_space: ColorSpace,
    texels: Texels,
    depth: u32,
) -> TextureData {
    TextureData {
        name: name.to_string(),
        dimension,
        width: texels.width,
        height: texels.height,
        depth,
        format: texels.format,
        color_space,
        file_channels: texels.file_channels,
        texels: texels.bytes,
    }
}

pub(super) fn read_checked(
    path: &Path,
    reading: &ReadOptions,
    color_space: ColorSpace,
    values: AllowedFloats,
) -> Result<Picture> {
    let picture = read_file::read_as(path, reading)?;
    check_meaning(picture.texels.format, color_space, path)?;
    check_values(&picture.texels, values, path)?;
    Ok(picture)
}

/// Reads a picture that lies within another file. It has integers, as PNG and JPEG have.
pub(super) fn read_embedded(
    name: &Path,
    bytes: &[u8],
    reading: &ReadOptions,
    color_space: ColorSpace,
) -> Result<Picture> {
    let picture = read_file::read_bytes(bytes, name, reading)?;
    check_meaning(picture.texels.format, color_space, name)?;
    check_values(&picture.texels, AllowedFloats::Finite, name)?;
    Ok(picture)
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
