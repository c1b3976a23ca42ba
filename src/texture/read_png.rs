//! A PNG file into texels (PNG specification, third edition). Its chunks are looked through first: a file that
//! lacks only the end is read with a note, and one of Apple's own kind is refused as that.

use std::io::Cursor;
use std::path::Path;

use flate2::Crc;
use image::codecs::png::PngDecoder;

use super::read_file::{MAX_BYTES, Picture, decode_with, unsupported_kind};
use crate::core::error::Result;

const SIGNATURE_BYTES: usize = 8;
/// Length, name and checksum.
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

/// The Exif data, which may stand before or after the pixels.
pub(super) fn exif(png: &[u8]) -> Option<&[u8]> {
    chunks(png).find(|chunk| chunk.name == b"eXIf").map(|chunk| chunk.data)
}

struct Chunk<'a> {
    name: &'a [u8],
    data: &'a [u8],
    /// Where the next one begins.
    end: usize,
}

/// Those that the file has to their ends.
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

/// A file without an end, with one; of a last chunk that is cut off what there is of its pixels is kept.
/// None for a file that has its end.
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
