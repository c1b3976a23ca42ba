//! Image orientation of JPEG, PNG, TIFF and WebP files. Reads tag 274 (TIFF 6.0, "Orientation"; Exif
//! 2.32, 4.6.4) and turns texels so that the first row is the top one. Exif data is a TIFF
//! structure in an APP1 segment of a JPEG file, an eXIf chunk of a PNG file or an EXIF chunk of a WebP file.

use super::data::TexelFormat;
use super::formats::PictureFormat;
use super::read_file::Texels;
use super::{read_jpeg, read_png, read_webp, tiff};

/// The corner at which the picture's top left is stored, and the direction of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// True if rows of the picture are columns of the file.
    transposed: bool,
    /// True for columns or rows of the file that are in reverse order.
    reversed: [bool; 2],
}

impl Orientation {
    /// Returns the orientation for the tag's value; `None` for the default 1 and for undefined
    /// values.
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

    /// Returns the texels in upright orientation.
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

/// Returns the file's orientation; `None` if it has none or if the metadata is damaged.
pub fn orientation_of(file: &[u8], format: PictureFormat) -> Option<Orientation> {
    let tagged = match format {
        PictureFormat::Jpeg => read_jpeg::exif(file)?,
        PictureFormat::Png => read_png::exif(file)?,
        PictureFormat::Tiff => file,
        PictureFormat::WebP => read_webp::exif(file)?,
        _ => return None,
    };
    tiff::orientation(tagged).and_then(Orientation::from_tag)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::Component;

    /// Returns the texels 0 1 2 / 3 4 5.
    fn numbered() -> Texels {
        let format = TexelFormat::new(1, Component::Unorm8);
        Texels { width: 3, height: 2, format, file_channels: 1, bytes: vec![0, 1, 2, 3, 4, 5] }
    }

    #[test]
    fn all_eight_orientations_show_the_picture_upright() {
        // In the terms of the TIFF specification: the visual positions of row 0 and column 0 of the
        // file.
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
            let found = orientation_of(file, PictureFormat::Tiff);
            assert_eq!(found, Orientation::from_tag(6), "{name}");
        }
    }

    #[test]
    fn damaged_structures_say_nothing() {
        for file in [&b""[..], b"II", b"II*\0\xff\xff\xff\xff", b"II*\0\x08\0\0\0\xff\xff\x12\x01"] {
            assert_eq!(orientation_of(file, PictureFormat::Tiff), None);
        }
        let endless = b"\xff\xd8\xff\xff\xff\xff\xff\xff";
        assert_eq!(orientation_of(endless, PictureFormat::Jpeg), None);
    }
}
