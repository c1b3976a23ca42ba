//! Reads any picture file as linear RGB: 8- and 16-bit values are decoded from sRGB, or as the colour profile of the file
//! says, float values are linear; grey is replicated, alpha ignored. NaN is allowed: the comparison counts it.

use std::path::Path;

use crate::core::color::srgb_table;
use crate::core::error::Result;
use crate::core::film::{Film, Placement};
use crate::texture::data::Component;
use crate::texture::read_file::{self, ExrWindow, Picture};
use crate::texture::source::ReadOptions;

/// Reads a picture. `samples` is 0, because a file does not state the number of samples per pixel.
pub fn read_picture(path: &Path) -> Result<Film> {
    read_placed(path).map(|(film, _)| film)
}

/// Reads a picture with its placement in the file's display window.
pub fn read_placed(path: &Path) -> Result<(Film, Placement)> {
    let picture = read_file::read_window(path, &ReadOptions::default(), ExrWindow::Data)?;
    Ok((film_of(&picture), picture.placement))
}

/// Converts the texels of a file to a film. Colours that a profile places outside of sRGB are kept.
pub(crate) fn film_of(picture: &Picture) -> Film {
    let Picture { texels, facts, .. } = picture;
    let (channels, component) = (texels.format.channels(), texels.format.component());
    let bytes = &texels.bytes;
    let profile = facts.profile.as_ref().and_then(|profile| profile.colors(component));
    let code8 = |[code]: [u8; 1]| usize::from(code);
    let code16 = |code: [u8; 2]| usize::from(u16::from_ne_bytes(code));
    let pixels = match (component, profile) {
        (Component::Unorm8, Some(colors)) => {
            pixels::<1>(bytes, channels, |t| colors.linear(t.map(code8)).into())
        }
        (Component::Unorm16, Some(colors)) => {
            pixels::<2>(bytes, channels, |t| colors.linear(t.map(code16)).into())
        }
        (Component::Unorm8, None) => {
            let table = srgb_table(256);
            pixels::<1>(bytes, channels, |t| t.map(|code| table[code8(code)]))
        }
        (Component::Unorm16, None) => {
            let table = srgb_table(65_536);
            pixels::<2>(bytes, channels, |t| t.map(|code| table[code16(code)]))
        }
        (Component::Float32, _) => pixels::<4>(bytes, channels, |t| t.map(f32::from_ne_bytes)),
    };
    Film { width: texels.width, height: texels.height, pixels, samples: 0 }
}

/// Returns the colours of texels; grey is replicated.
fn pixels<const SIZE: usize>(
    bytes: &[u8],
    channels: usize,
    color: impl Fn([[u8; SIZE]; 3]) -> [f32; 3],
) -> Vec<[f32; 3]> {
    let (values, _) = bytes.as_chunks::<SIZE>();
    let texels = values.chunks_exact(channels);
    if channels < 3 {
        texels.map(|t| color([t[0]; 3])).collect()
    } else {
        texels.map(|t| color([t[0], t[1], t[2]])).collect()
    }
}
