//! Reads PNG files (PNG specification, third edition). Its chunks are scanned first: a file that
//! lacks only its end is read with a note, and Apple's proprietary variant is refused by name.

use std::io::{Cursor, Read};
use std::path::Path;

use flate2::Crc;
use flate2::read::ZlibDecoder;
use png::{BitDepth, DecodingError, Transformations};

use super::data::Component;
use super::decoder::{self, Fault, Header};
use super::read_file::{MAX_BYTES, Picture, Texels, unsupported_kind};
use crate::core::error::Result;

const SIGNATURE_BYTES: usize = 8;
/// The bytes of a chunk's length, name and checksum.
const CHUNK_BYTES: usize = 12;
/// The size of an ICC profile beyond which it is cut; those of printers have a few MB.
const MAX_PROFILE_BYTES: u64 = 16 << 20;

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    if file.get(SIGNATURE_BYTES + 4..SIGNATURE_BYTES + 8) == Some(b"CgBI") {
        return Err(unsupported_kind(path, "a PNG of Apple's own kind (CgBI), as Xcode writes into apps"));
    }
    let Some(ended) = with_end(file) else { return decode(file, path).map(Picture::from) };
    let texels = decode(&ended, path)?;
    let note = format!("{}: the PNG data has no end (IEND); all texels are there", path.display());
    Ok(Picture::noted(texels, vec![note]))
}

fn decode(file: &[u8], path: &Path) -> Result<Texels> {
    let named = |fault: Fault| fault.in_file(path, "PNG");
    let (mut reader, header) = open(file).map_err(named)?;
    decoder::texels(header, "PNG", file.len(), path, |texels| {
        reader.next_frame(texels).map_err(fault)?;
        if header.component == Component::Unorm16 {
            texels.as_chunks_mut::<2>().0.iter_mut().for_each(|b| *b = u16::from_be_bytes(*b).to_ne_bytes());
        }
        Ok(())
    })
}

/// The decoder of a file in memory.
type Reader<'a> = png::Reader<Cursor<&'a [u8]>>;

/// Returns a decoder that has read up to the pixels, and the resulting format: palettes and fewer
/// than 8 bits are expanded.
fn open(file: &[u8]) -> std::result::Result<(Reader<'_>, Header), Fault> {
    // Width and height are checked here because the decoder's own error does not state which is
    // wrong.
    if file.get(16..24).is_some_and(|size| size.chunks(4).any(|side| side == [0; 4])) {
        return Err(Fault::ZeroSize);
    }
    let bytes = usize::try_from(MAX_BYTES).unwrap_or(usize::MAX);
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(file), png::Limits { bytes });
    decoder.set_ignore_text_chunk(true);
    decoder.set_transformations(Transformations::EXPAND);
    let reader = decoder.read_info().map_err(fault)?;
    let (width, height) = reader.info().size();
    let (channels, component) = match reader.output_color_type() {
        (color, BitDepth::Eight) => (color.samples(), Component::Unorm8),
        (color, BitDepth::Sixteen) => (color.samples(), Component::Unorm16),
        (color, depth) => return Err(Fault::Unsupported(format!("{color:?} texels of {depth:?} bits"))),
    };
    Ok((reader, Header { width, height, channels, component }))
}

fn fault(error: DecodingError) -> Fault {
    match error {
        DecodingError::LimitsExceeded => Fault::Memory,
        error => Fault::Damaged(error.to_string()),
    }
}

/// Returns the Exif data, which may precede or follow the pixels.
pub(super) fn exif(png: &[u8]) -> Option<&[u8]> {
    chunks(png).find(|chunk| chunk.name == b"eXIf").map(|chunk| chunk.data)
}

/// Returns the code points of the chunk cICP: primaries, transfer function, matrix, full range.
pub(super) fn code_points(png: &[u8]) -> Option<[u8; 4]> {
    before_pixels(png, b"cICP")?.try_into().ok()
}

/// Returns the ICC profile: behind its name and a byte for the method, by Deflate. Of a damaged one, returns what there is.
pub(super) fn color_profile(png: &[u8]) -> Option<Vec<u8>> {
    let data = before_pixels(png, b"iCCP")?;
    let name = data.iter().position(|byte| *byte == 0)?;
    let mut profile = Vec::new();
    // Damage shows when the profile is read.
    let _ = ZlibDecoder::new(data.get(name + 2..)?).take(MAX_PROFILE_BYTES).read_to_end(&mut profile);
    Some(profile)
}

/// Returns the data of a chunk that precedes the pixels.
fn before_pixels<'a>(png: &'a [u8], name: &[u8; 4]) -> Option<&'a [u8]> {
    chunks(png).take_while(|chunk| chunk.name != b"IDAT").find(|c| c.name == name).map(|c| c.data)
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
