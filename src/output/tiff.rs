//! Writes a film as an uncompressed TIFF file (TIFF 6.0, baseline RGB), sRGB-encoded: one strip after the header, then
//! the directory that describes it.

use std::io::Write;
use std::ops::Range;

use super::bands::write_bands;
use super::quantise::srgb8;
use super::record::SOFTWARE;
use super::{WriteOptions, icc};
use crate::core::film::Film;

const HEADER_BYTES: usize = 8;
const ASCII: u16 = 2;
const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;
const UNDEFINED: u16 = 7;

/// The entries of a directory, and the values that do not fit into them, which follow it.
#[derive(Default)]
struct Directory {
    entries: Vec<(u16, u16, u32, Value)>,
    values: Vec<u8>,
}

enum Value {
    Own(u32),
    /// Its place among the values.
    Behind(usize),
}

impl Directory {
    fn own(&mut self, tag: u16, kind: u16, value: u32) {
        self.entries.push((tag, kind, 1, Value::Own(value)));
    }

    /// Adds values, `count` of this kind.
    fn behind(&mut self, tag: u16, kind: u16, count: usize, bytes: &[u8]) {
        self.entries.push((tag, kind, count as u32, Value::Behind(self.values.len())));
        self.values.extend(bytes);
        // Values begin at even bytes.
        self.values.resize(self.values.len().next_multiple_of(2), 0);
    }

    /// Returns the bytes of the directory at this place of the file; `None` beyond 4 GiB.
    fn bytes(&self, at: usize) -> Option<Vec<u8>> {
        let values = at + 2 + 12 * self.entries.len() + 4;
        u32::try_from(values + self.values.len()).ok()?;
        let mut bytes = (self.entries.len() as u16).to_le_bytes().to_vec();
        for (tag, kind, count, value) in &self.entries {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend(count.to_le_bytes());
            let value = match value {
                Value::Own(value) => *value,
                Value::Behind(place) => (values + place) as u32,
            };
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([0; 4]);
        bytes.extend(&self.values);
        Some(bytes)
    }
}

pub(super) fn write(film: &Film, options: &WriteOptions, to: &mut dyn Write) -> Result<(), String> {
    let (width, height) = (film.width, film.height);
    let row_bytes = width as usize * 3;
    let strip = row_bytes * height as usize;
    // The directory begins at an even byte.
    let padding = strip % 2;
    let at = HEADER_BYTES + strip + padding;
    let text = |text: &str| [text.as_bytes(), &[0]].concat();
    let one = [1u32, 1].map(u32::to_le_bytes).concat();
    let profile = icc::profile(options.display.gamut);

    let mut directory = Directory::default();
    directory.own(256, LONG, width);
    directory.own(257, LONG, height);
    directory.behind(258, SHORT, 3, &[8u16; 3].map(u16::to_le_bytes).concat()); // BitsPerSample
    directory.own(259, SHORT, 1); // Compression: none
    directory.own(262, SHORT, 2); // PhotometricInterpretation: RGB
    if let Some(record) = options.record {
        directory.behind(270, ASCII, record.len() + 1, &text(record)); // ImageDescription
    }
    directory.own(273, LONG, HEADER_BYTES as u32); // StripOffsets
    directory.own(277, SHORT, 3); // SamplesPerPixel
    directory.own(278, LONG, height); // RowsPerStrip
    directory.own(279, LONG, strip as u32); // StripByteCounts
    directory.behind(282, RATIONAL, 1, &one); // XResolution
    directory.behind(283, RATIONAL, 1, &one); // YResolution
    directory.own(296, SHORT, 1); // ResolutionUnit: none
    if options.record.is_some() {
        directory.behind(305, ASCII, SOFTWARE.len() + 1, &text(SOFTWARE)); // Software
    }
    directory.behind(34_675, UNDEFINED, profile.len(), &profile); // ICC profile
    let Some(behind) = directory.bytes(at) else {
        return Err("TIFF files have at most 4 GiB; write OpenEXR or PNG".into());
    };
    let display = options.display.prepare();
    let encode = |rows: Range<usize>, band: &mut Vec<u8>| {
        let pixels = display.colors(&film.pixels[rows.start * width as usize..rows.end * width as usize]);
        band.resize(pixels.len() * 3, 0);
        band.chunks_exact_mut(3).zip(&*pixels).for_each(|(to, p)| to.copy_from_slice(&p.map(srgb8)));
    };
    to.write_all(&[&b"II*\0"[..], &(at as u32).to_le_bytes()].concat())
        .and_then(|()| write_bands(height as usize, row_bytes, Vec::new, encode, |band| to.write_all(band)))
        .and_then(|()| to.write_all(&[0][..padding]))
        .and_then(|()| to.write_all(&behind))
        .map_err(|e| e.to_string())
}
