//! A PNG file into texels (PNG specification, third edition). Its chunks are looked through first: a file that
//! lacks only the end is read with a note, and one of Apple's own kind is refused as that.

use std::io::Cursor;
use std::path::Path;

use flate2::Crc;
use image::codecs::png::PngDecoder;

use super::read_file::{MAX_BYTES, Picture, decode_with, unsupported_kind};
use crate::error::Result;

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

/// A file without an end, with one; of a last chunk that is cut off what there is of its pixels is kept.
/// None for a file that has its end, or whose chunks cannot be followed.
fn with_end(file: &[u8]) -> Option<Vec<u8>> {
    let mut at = SIGNATURE_BYTES;
    loop {
        let rest = file.get(at..)?;
        let (length, name) = match rest.split_first_chunk::<4>() {
            Some((length, name)) => (u32::from_be_bytes(*length) as usize, name.get(..4).unwrap_or(&[])),
            None => (0, &[][..]),
        };
        let is_whole = rest.len() >= CHUNK_BYTES && rest.len() - CHUNK_BYTES >= length;
        if is_whole && name == b"IEND" {
            return None;
        }
        if is_whole {
            at += CHUNK_BYTES + length;
            continue;
        }
        let mut ended = file[..at].to_vec();
        if name == b"IDAT" {
            ended.extend(chunk(*b"IDAT", &rest[8..rest.len().min(8 + length)]));
        }
        ended.extend(chunk(*b"IEND", &[]));
        return Some(ended);
    }
}

fn chunk(name: [u8; 4], data: &[u8]) -> Vec<u8> {
    let mut checksum = Crc::new();
    checksum.update(&name);
    checksum.update(data);
    [&(data.len() as u32).to_be_bytes()[..], &name, data, &checksum.sum().to_be_bytes()].concat()
}
