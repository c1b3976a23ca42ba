//! A texture named in a scene: file in, [`TextureData`] out, ready for upload. Adds to reading the
//! file what a texture needs: finite values (one NaN would spread through every filter that touches
//! it), a colour space that fits the numbers, and the row order that v asks for.

use std::path::Path;

use super::data::{ColorSpace, Component, Dimension, TextureData};
use super::read_file::{self, Texels};
use crate::error::{Error, Result};

pub fn decode(path: &Path, name: &str, color_space: ColorSpace, flip_v: bool) -> Result<TextureData> {
    let mut texels = read_file::read(path).map_err(|e| in_texture(name, e))?;
    if texels.format.component() == Component::Float32 {
        if color_space == ColorSpace::Srgb {
            return Err(Error::with_help(
                format!("texture \"{name}\": {}: float texels are linear light, not sRGB", path.display()),
                "set color_space = \"linear\"; sRGB is an encoding of 8- and 16-bit values",
            ));
        }
        check_finite(&texels, path, name)?;
    }
    if flip_v {
        reverse_rows(&mut texels);
    }
    Ok(TextureData {
        name: name.to_string(),
        dimension: Dimension::Two,
        width: texels.width,
        height: texels.height,
        depth: 1,
        format: texels.format,
        color_space,
        file_channels: texels.file_channels,
        texels: texels.bytes,
    })
}

fn in_texture(name: &str, error: Error) -> Error {
    match error {
        Error::Plain { message, help } => {
            Error::Plain { message: format!("texture \"{name}\": {message}"), help }
        }
        other => other,
    }
}

fn check_finite(texels: &Texels, path: &Path, name: &str) -> Result<()> {
    let values = texels.bytes.chunks_exact(4).map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
    let mut bad = values.enumerate().filter(|(_, v)| !v.is_finite());
    let Some((first, value)) = bad.next() else { return Ok(()) };
    let count = 1 + bad.count();
    let channels = texels.format.channels();
    let names: &[&str] = if channels < 3 { &["grey", "alpha"] } else { &["red", "green", "blue", "alpha"] };
    let (x, y) = (first / channels % texels.width as usize, first / channels / texels.width as usize);
    let values =
        if count == 1 { "1 value of the file is".into() } else { format!("{count} values of the file are") };
    Err(Error::with_help(
        format!(
            "texture \"{name}\": {}: texel ({x}, {y}), channel {}, is {value}; {values} not finite",
            path.display(),
            names[first % channels],
        ),
        "replace NaN and infinite texels before use, column and row are counted from the top left",
    ))
}

fn reverse_rows(texels: &mut Texels) {
    let row = texels.width as usize * texels.format.bytes_per_texel();
    let half = texels.height as usize / 2 * row;
    let (top, rest) = texels.bytes.split_at_mut(half);
    top.chunks_exact_mut(row).zip(rest.chunks_exact_mut(row).rev()).for_each(|(a, b)| a.swap_with_slice(b));
}
