//! Reads PNG files (PNG specification, third edition). Its chunks are scanned first: a file that
//! lacks only its end is read with a note, and Apple's proprietary variant is refused by name.

use std::io::Cursor;
use std::path::Path;

use flate2::Crc;
use image::codecs::png::PngDecoder;

use super::read_file::{MAX_BYTES, Picture, decode_with, unsupported_kind};
use crate::core::error::Result;

const SIGNATURE_BYTES: usize = 8;
/// The bytes of a chunk's length, name and checksum.
const CHUNK_BYTES: usize = 12;

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let decode = |file: &[u8]| {
        let mut limits = image::Limits::no_limits();
        limits.max_alloc = Some(MAX_BYTES);
        decode_with(PngDecoder::with_limits(Cursor::new(file), limits), "PNG", file.len(), path)
    };
    if file.get(SIGNATURE_BYTES + 4..SIGNATURE_BYTES + 8) == Some(b"CgBI") {
        return Err(unsupported_kind(path, "a PNG of Apple's own kind (CgBI), as Xcode writes into apps"));
    }
    let Some(ended) = with_end(file) else { return decode(file).map(Picture::from) };
    let texels = decode(&ended)?;
    let note = format!("{}: the PNG data has no end (IEND); all texels are there", path.display());
    Ok(Picture::noted(texels, vec![note]))
}

/// Returns the Exif data, which may precede or follow the pixels.
pub(super) fn exif(png: &[u8]) -> Option<&[u8]> {
    chunks(png).find(|chunk| chunk.name == b"eXIf").map(|chunk| chunk.data)
}

struct Chunk<'a> {
    name: &'a [u8],
    data: &'a [u8],
    /// The offset of the next chunk.
    end: usize,
}

/// Iterates over the chunks that the file contains completely.
fn chunks(png: &[u8]) -> impl Iterator<Item = Chunk<'_>> {
    let mut at = SIGNATURE_BYTES;
    std::iter::from_fn(move || {
        let rest = png.get(at..)?;
        let length = u32::from_be_bytes(*rest.first_chunk()?) as usize;
        let whole = rest.get(..length.checked_add(CHUNK_BYTES)?)?;
        at += whole.len();
        Some(Chunk { name: &whole[4..8], data: &whole[8..8 + length], end: at })
    })
}

/// Returns a truncated file completed by an end, keeping the available pixels of a last, truncated
/// chunk; `None` if the file has its end.
fn with_end(file: &[u8]) -> Option<Vec<u8>> {
    let mut at = SIGNATURE_BYTES;
    for chunk in chunks(file) {
        if chunk.name == b"IEND" {
            return None;
        }
        at = chunk.end;
    }
    let cut = file.get(at..)?;
    let mut ended = file[..at].to_vec();
    if let (Some(length), Some(b"IDAT")) = (cut.first_chunk::<4>(), cut.get(4..8)) {
        let length = u32::from_be_bytes(*length) as usize;
        ended.extend(chunk(*b"IDAT", &cut[8..cut.len().min(length.saturating_add(8))]));
    }
    ended.extend(chunk(*b"IEND", &[]));
    Some(ended)
}

fn chunk(name: [u8; 4], data: &[u8]) -> Vec<u8> {
    let mut checksum = Crc::new();
    checksum.update(&name);
    checksum.update(data);
    [&(data.len() as u32).to_be_bytes()[..], &name, data, &checksum.sum().to_be_bytes()].concat()
}
