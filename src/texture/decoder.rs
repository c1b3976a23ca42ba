//! Common part of the PNG, JPEG and TGA readers. Takes the contents of a file's header and a
//! decoder of its rows; returns texels, with three channels widened to four, or an error that names
//! the file.

use std::path::Path;

use super::data::{Component, TexelFormat};
use super::read_file::{Texels, check_memory, check_size, damaged, out_of_memory, zero_size};
use crate::core::error::{Error, Result};

/// The largest number of texels per byte of a PNG file: Deflate expands a byte to at most 1032,
/// each with 8 texels. The other formats compress less.
const MAX_TEXELS_PER_BYTE: u64 = 1032 * 8;

/// The size of a picture and the format of its texels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    pub width: u32,
    pub height: u32,
    pub channels: usize,
    pub component: Component,
}

impl Header {
    fn format(&self) -> TexelFormat {
        TexelFormat::new(if self.channels == 3 { 4 } else { self.channels }, self.component)
    }
}

/// The reason why decoding failed.
#[derive(Debug)]
pub(super) enum Fault {
    Damaged(String),
    /// An unsupported feature of the file, by name.
    Unsupported(String),
    Memory,
    ZeroSize,
}

impl Fault {
    /// Returns the error for the user; `kind` is the format's name.
    pub fn in_file(self, path: &Path, kind: &str) -> Error {
        match self {
            Fault::Damaged(what) => damaged(path, kind, &what),
            Fault::Unsupported(what) => Error::with_help(
                format!("{}: this kind of {kind} file is not supported: {what}", path.display()),
                "convert it to 8-bit, 16-bit or 32-bit float grey or RGB, with or without alpha",
            ),
            Fault::Memory => out_of_memory(path),
            Fault::ZeroSize => zero_size(path),
        }
    }
}

/// Returns the texels of a file of `file_bytes` bytes of this kind. `decode` fills tightly packed
/// rows in native byte order, the picture's first row first.
pub(super) fn texels(
    header: Header,
    kind: &str,
    file_bytes: usize,
    path: &Path,
    decode: impl FnOnce(&mut [u8]) -> std::result::Result<(), Fault>,
) -> Result<Texels> {
    let Header { width, height, .. } = header;
    check_size(path, width.into(), height.into(), header.format().bytes_per_texel())?;
    if u64::from(width) * u64::from(height) > (file_bytes as u64).saturating_mul(MAX_TEXELS_PER_BYTE) {
        return Err(damaged(path, kind, &format!("{file_bytes} bytes cannot hold {width}×{height} texels")));
    }
    fill(header, kind, path, decode)
}

/// Returns the texels of a file like [`texels`], however few bytes it has.
pub(super) fn fill(
    header: Header,
    kind: &str,
    path: &Path,
    decode: impl FnOnce(&mut [u8]) -> std::result::Result<(), Fault>,
) -> Result<Texels> {
    let Header { width, height, channels: file_channels, component } = header;
    let format = header.format();
    check_size(path, width.into(), height.into(), format.bytes_per_texel())?;
    let pixels = width as usize * height as usize;

    // The texels are decoded into the front of the final buffer and widened in place, without a
    // second copy.
    check_memory(path, pixels * format.bytes_per_texel())?;
    let mut bytes = vec![0; pixels * format.bytes_per_texel()];
    let decoded = pixels * file_channels * component.bytes();
    decode(&mut bytes[..decoded]).map_err(|fault| fault.in_file(path, kind))?;
    if file_channels == 3 {
        widen_rgb(&mut bytes, component);
    }
    Ok(Texels { width, height, format, file_channels, bytes })
}

/// Expands three channels at the front of the buffer to four that fill it, with opaque alpha.
pub(super) fn widen_rgb(bytes: &mut [u8], component: Component) {
    match component {
        Component::Unorm8 => widen::<3, 4>(bytes, &[u8::MAX]),
        Component::Unorm16 => widen::<6, 8>(bytes, &u16::MAX.to_ne_bytes()),
        Component::Float32 => widen::<12, 16>(bytes, &1f32.to_ne_bytes()),
    }
}

/// Expands texels from `RGB` to `RGBA` bytes, the last texel first, so that each is read before it
/// is overwritten.
fn widen<const RGB: usize, const RGBA: usize>(bytes: &mut [u8], opaque: &[u8]) {
    let mut texel = [0u8; RGBA];
    texel[RGB..].copy_from_slice(opaque);
    for i in (0..bytes.len() / RGBA).rev() {
        texel[..RGB].copy_from_slice(&bytes[i * RGB..(i + 1) * RGB]);
        bytes[i * RGBA..(i + 1) * RGBA].copy_from_slice(&texel);
    }
}
