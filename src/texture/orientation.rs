//! Which way up a picture is stored. In: a JPEG, PNG or TIFF file. Out: what tag 274 says (TIFF 6.0,
//! "Orientation"; Exif 2.32, 4.6.4), and texels turned so that the first row is the top one. Exif data is
//! a TIFF structure, within an APP1 segment of a JPEG file or an eXIf chunk of a PNG file.

use std::io::{self, Read, Seek, SeekFrom};

use image::ImageFormat;

use super::data::TexelFormat;
use super::read_file::Texels;

/// Entries of one directory of tags that are looked at; files have some dozens.
const MAX_ENTRIES: u64 = 4096;
const ORIENTATION_TAG: u16 = 274;
/// Types of 16- and 32-bit numbers.
const SHORT: u64 = 3;
const LONG: u64 = 4;

/// Where the picture's top left corner is stored, and along what its rows run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// Rows of the picture are columns of the file.
    transposed: bool,
    /// In the file's own columns and rows, counted from the other end.
    reversed: [bool; 2],
}

impl Orientation {
    /// Returns the orientation behind the tag's value; none for the usual 1, and for what has no meaning.
    pub fn from_tag(value: u16) -> Option<Self> {
        let (transposed, reversed) = match value {
            2 => (false, [true, false]),
            3 => (false, [true, true]),
            4 => (false, [false, true]),
            5 => (true, [false, false]),
            6 => (true, [false, true]),
            7 => (true, [true, true]),
            8 => (true, [true, false]),
            _ => return None,
        };
        Some(Orientation { transposed, reversed })
    }

    /// Returns the texels as the picture is meant to be seen.
    pub(super) fn apply(self, texels: Texels) -> Texels {
        let (columns, rows) = (texels.width as usize, texels.height as usize);
        let size = texels.format.bytes_per_texel();
        let from_end = |reversed: bool, i: usize, count: usize| if reversed { count - 1 - i } else { i };
        let (width, height) = if self.transposed { (rows, columns) } else { (columns, rows) };
        let mut bytes = Vec::with_capacity(texels.bytes.len());
        for y in 0..height {
            for x in 0..width {
                let (column, row) = if self.transposed { (y, x) } else { (x, y) };
                let column = from_end(self.reversed[0], column, columns);
                let row = from_end(self.reversed[1], row, rows);
                let start = (row * columns + column) * size;
                bytes.extend_from_slice(&texels.bytes[start..start + size]);
            }
        }
        let (format, file_channels): (TexelFormat, usize) = (texels.format, texels.file_channels);
        Texels { width: width as u32, height: height as u32, format, file_channels, bytes }
    }
}

/// Returns how the file is turned; none where it does not say, or where what says it is damaged.
pub fn orientation_of(source: &mut (impl Read + Seek), format: ImageFormat) -> Option<Orientation> {
    let tag = match format {
        ImageFormat::Jpeg => in_jpeg(source),
        ImageFormat::Png => in_png(source),
        ImageFormat::Tiff => in_tiff(source),
        _ => return None,
    };
    tag.ok().flatten().and_then(Orientation::from_tag)
}

/// Looks through the segments before the first scan for one that begins with `Exif`.
fn in_jpeg(source: &mut (impl Read + Seek)) -> io::Result<Option<u16>> {
    const APP1: u8 = 0xe1;
    const START_OF_SCAN: u8 = 0xda;
    const EXIF: &[u8] = b"Exif\0\0";
    source.seek(SeekFrom::Start(2))?;
    loop {
        let marker = bytes::<2>(source)?;
        match marker {
            [0xff, 0xff] => {
                source.seek(SeekFrom::Current(-1))?;
                continue;
            }
            [0xff, START_OF_SCAN] => return Ok(None),
            [0xff, _] => {}
            _ => return Ok(None),
        }
        let length = u64::from(u16::from_be_bytes(bytes(source)?)).saturating_sub(2);
        let mut segment = Vec::new();
        source.by_ref().take(length).read_to_end(&mut segment)?;
        if let (APP1, Some(exif)) = (marker[1], segment.strip_prefix(EXIF)) {
            return in_tiff(&mut io::Cursor::new(exif));
        }
    }
}

/// The chunk may stand before or after the pixels.
fn in_png(source: &mut (impl Read + Seek)) -> io::Result<Option<u16>> {
    source.seek(SeekFrom::Start(8))?;
    loop {
        let length = u32::from_be_bytes(bytes(source)?);
        match &bytes::<4>(source)? {
            b"eXIf" => {
                let mut chunk = Vec::new();
                source.by_ref().take(length.into()).read_to_end(&mut chunk)?;
                return in_tiff(&mut io::Cursor::new(chunk));
            }
            b"IEND" => return Ok(None),
            _ => source.seek(SeekFrom::Current(i64::from(length) + 4))?,
        };
    }
}

/// Reads the first directory of a TIFF or BigTIFF structure.
fn in_tiff(source: &mut (impl Read + Seek)) -> io::Result<Option<u16>> {
    source.seek(SeekFrom::Start(0))?;
    let [order, _, version @ ..] = bytes::<4>(source)?;
    let little = order == b'I';
    let number = |bytes: &[u8]| {
        let digit = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        if little { bytes.iter().rev().fold(0, digit) } else { bytes.iter().fold(0, digit) }
    };
    let big = match number(&version) {
        42 => false,
        43 => true,
        _ => return Ok(None),
    };
    let (count, entry_bytes) = if big {
        let _ = bytes::<4>(source)?;
        let directory = number(&bytes::<8>(source)?);
        source.seek(SeekFrom::Start(directory))?;
        (number(&bytes::<8>(source)?), 20)
    } else {
        let directory = number(&bytes::<4>(source)?);
        source.seek(SeekFrom::Start(directory))?;
        (number(&bytes::<2>(source)?), 12)
    };
    for _ in 0..count.min(MAX_ENTRIES) {
        let mut entry = [0; 20];
        source.read_exact(&mut entry[..entry_bytes])?;
        let [tag, kind] = [number(&entry[..2]), number(&entry[2..4])];
        if tag == u64::from(ORIENTATION_TAG) {
            let value = &entry[if big { 12 } else { 8 }..];
            let value = match kind {
                SHORT => number(&value[..2]),
                LONG => number(&value[..4]),
                _ => return Ok(None),
            };
            return Ok(u16::try_from(value).ok());
        }
    }
    Ok(None)
}

fn bytes<const N: usize>(source: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    source.read_exact(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::Component;

    /// Texels 0 1 2 / 3 4 5.
    fn numbered() -> Texels {
        let format = TexelFormat::new(1, Component::Unorm8);
        Texels { width: 3, height: 2, format, file_channels: 1, bytes: vec![0, 1, 2, 3, 4, 5] }
    }

    #[test]
    fn all_eight_orientations_show_the_picture_upright() {
        // By the words of the TIFF specification: where row 0 and column 0 of the file are to be seen.
        let seen: [(u16, u32, [u8; 6]); 7] = [
            (2, 3, [2, 1, 0, 5, 4, 3]), // top, right
            (3, 3, [5, 4, 3, 2, 1, 0]), // bottom, right
            (4, 3, [3, 4, 5, 0, 1, 2]), // bottom, left
            (5, 2, [0, 3, 1, 4, 2, 5]), // left, top
            (6, 2, [3, 0, 4, 1, 5, 2]), // right, top
            (7, 2, [5, 2, 4, 1, 3, 0]), // right, bottom
            (8, 2, [2, 5, 1, 4, 0, 3]), // left, bottom
        ];
        for (tag, width, want) in seen {
            let turned = Orientation::from_tag(tag).expect("a tag from 2 to 8").apply(numbered());
            assert_eq!((turned.width, turned.bytes.as_slice()), (width, &want[..]), "orientation {tag}");
        }
        assert!([0, 1, 9, 65_535].iter().all(|&tag| Orientation::from_tag(tag).is_none()));
    }

    #[test]
    fn tag_is_found_in_either_byte_order_and_in_big_tiff() {
        let little = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
        let big_endian = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0";
        let mut big = b"II+\0\x08\0\0\0\x10\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0".to_vec();
        big.extend_from_slice(b"\x12\x01\x03\0\x01\0\0\0\0\0\0\0\x06\0\0\0\0\0\0\0");
        for (name, file) in [("II", &little[..]), ("MM", big_endian), ("BigTIFF", &big)] {
            let found = orientation_of(&mut io::Cursor::new(file), ImageFormat::Tiff);
            assert_eq!(found, Orientation::from_tag(6), "{name}");
        }
    }

    #[test]
    fn damaged_structures_say_nothing() {
        for file in [&b""[..], b"II", b"II*\0\xff\xff\xff\xff", b"II*\0\x08\0\0\0\xff\xff\x12\x01"] {
            assert_eq!(orientation_of(&mut io::Cursor::new(file), ImageFormat::Tiff), None);
        }
        let endless = b"\xff\xd8\xff\xff\xff\xff\xff\xff";
        assert_eq!(orientation_of(&mut io::Cursor::new(endless), ImageFormat::Jpeg), None);
    }
}
