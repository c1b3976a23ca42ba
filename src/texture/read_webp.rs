//! Reads WebP files (RFC 9649): one picture, lossy or lossless, with or without alpha, in 8 bits per channel. Animations
//! are refused by name. Takes the bytes of a file; returns its texels, and its Exif data to whoever turns pictures.

use std::io::Cursor;
use std::path::Path;

use image_webp::{DecodingError, WebPDecoder};

use super::data::Component;
use super::decoder::{self, Fault, Header};
use super::read_file::{MAX_BYTES, Picture, unsupported_kind};
use crate::core::error::Result;

/// The texels that any file may have, however short it is: a picture of one colour takes a few bytes whatever its size,
/// and only larger ones must be borne out by the file's length.
const ALWAYS_PLAUSIBLE: u64 = 1 << 26;
/// The bytes of the outer header, and those before the data of a chunk.
const RIFF_BYTES: usize = 12;
const CHUNK_BYTES: usize = 8;

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let named = |fault: Fault| fault.in_file(path, "WebP");
    let mut decoder = WebPDecoder::new(Cursor::new(file)).map_err(|e| named(fault(e)))?;
    decoder.set_memory_limit(usize::try_from(MAX_BYTES).unwrap_or(usize::MAX));
    if decoder.is_animated() {
        return Err(unsupported_kind(path, "an animated WebP"));
    }
    let (width, height) = decoder.dimensions();
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let header = Header { width, height, channels, component: Component::Unorm8 };
    let decode = |texels: &mut [u8]| decoder.read_image(texels).map_err(fault);
    let is_plausible = u64::from(width) * u64::from(height) <= ALWAYS_PLAUSIBLE;
    let texels = if is_plausible {
        decoder::fill(header, "WebP", path, decode)?
    } else {
        decoder::texels(header, "WebP", file.len(), path, decode)?
    };
    Ok(Picture::from(texels))
}

fn fault(error: DecodingError) -> Fault {
    match error {
        DecodingError::ImageTooLarge | DecodingError::MemoryLimitExceeded => Fault::Memory,
        DecodingError::UnsupportedFeature(what) => Fault::Unsupported(what),
        error => Fault::Damaged(error.to_string()),
    }
}

/// Returns the Exif data.
pub(super) fn exif(webp: &[u8]) -> Option<&[u8]> {
    let data = chunk(webp, b"EXIF")?;
    Some(data.strip_prefix(b"Exif\0\0").unwrap_or(data))
}

/// Returns the ICC profile.
pub(super) fn color_profile(webp: &[u8]) -> Option<&[u8]> {
    chunk(webp, b"ICCP")
}

/// Returns the data of the first chunk of this name.
fn chunk<'a>(webp: &'a [u8], name: &[u8; 4]) -> Option<&'a [u8]> {
    let mut at = RIFF_BYTES;
    loop {
        let header = webp.get(at..at.checked_add(CHUNK_BYTES)?)?;
        let length = u32::from_le_bytes(*header.last_chunk()?) as usize;
        let end = (at + CHUNK_BYTES).checked_add(length)?;
        if header.starts_with(name) {
            return webp.get(at + CHUNK_BYTES..end);
        }
        at = end.checked_add(length % 2)?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exif_is_found_behind_other_chunks() {
        let file = b"RIFF\0\0\0\0WEBPVP8X\x03\0\0\0abc\0EXIF\x02\0\0\0II";
        assert_eq!(exif(file), Some(&b"II"[..]));
        assert_eq!(exif(&file[..file.len() - 1]), None);
        assert_eq!(exif(b"RIFF\0\0\0\0WEBPVP8X\xff\xff\xff\xff"), None);
    }
}
