//! Reads any picture file as linear RGB: 8- and 16-bit values are decoded from sRGB, float values
//! are linear; grey is replicated, alpha ignored. NaN is allowed: the comparison counts it.

use std::path::Path;

use crate::core::color::srgb_table;
use crate::core::error::Result;
use crate::core::film::{Film, Placement};
use crate::texture::data::Component;
use crate::texture::read_file::{self, ExrWindow, Texels};
use crate::texture::source::ReadOptions;

/// Reads a picture. `samples` is 0, because a file does not state the number of samples per pixel.
pub fn read_picture(path: &Path) -> Result<Film> {
    read_placed(path).map(|(film, _)| film)
}

/// Reads a picture with its placement in the file's display window.
pub fn read_placed(path: &Path) -> Result<(Film, Placement)> {
    let picture = read_file::read_window(path, &ReadOptions::default(), ExrWindow::Data)?;
    Ok((film_of(&picture.texels), picture.placement))
}

/// Converts the texels of a file to a film.
pub(crate) fn film_of(texels: &Texels) -> Film {
    let channels = texels.format.channels();
    let pixels = match texels.format.component() {
        Component::Unorm8 => {
            let table = srgb_table(256);
            pixels::<1>(&texels.bytes, channels, |[v]| table[usize::from(v)])
        }
        Component::Unorm16 => {
            let table = srgb_table(65_536);
            pixels::<2>(&texels.bytes, channels, |v| table[usize::from(u16::from_ne_bytes(v))])
        }
        Component::Float32 => pixels::<4>(&texels.bytes, channels, f32::from_ne_bytes),
    };
    Film { width: texels.width, height: texels.height, pixels, samples: 0 }
}

fn pixels<const SIZE: usize>(
    bytes: &[u8],
    channels: usize,
    linear: impl Fn([u8; SIZE]) -> f32,
) -> Vec<[f32; 3]> {
    let (values, _) = bytes.as_chunks::<SIZE>();
    let texels = values.chunks_exact(channels);
    if channels < 3 {
        texels.map(|t| [linear(t[0]); 3]).collect()
    } else {
        texels.map(|t| [linear(t[0]), linear(t[1]), linear(t[2])]).collect()
    }
}
