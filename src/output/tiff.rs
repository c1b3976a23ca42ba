//! Writes a film as an uncompressed TIFF file (TIFF 6.0, baseline RGB), sRGB-encoded: one strip after the header, then
//! the directory that describes it.

use std::io::Write;
use std::ops::Range;

use super::bands::write_bands;
use super::quantise::srgb8;
use crate::core::film::Film;

const HEADER_BYTES: usize = 8;
const SHORT: u16 = 3;
const LONG: u16 = 4;
const RATIONAL: u16 = 5;

pub(super) fn write(film: &Film, to: &mut dyn Write) -> Result<(), String> {
    let (width, height) = (film.width, film.height);
    let row_bytes = width as usize * 3;
    let strip = row_bytes * height as usize;
    // Entries begin on even bytes.
    let padding = strip % 2;
    let directory = HEADER_BYTES + strip + padding;
    let entry = |tag: u16, kind: u16, count: u32, value: u32| -> [u8; 12] {
        let mut bytes = [0; 12];
        bytes[..2].copy_from_slice(&tag.to_le_bytes());
        bytes[2..4].copy_from_slice(&kind.to_le_bytes());
        bytes[4..8].copy_from_slice(&count.to_le_bytes());
        bytes[8..].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    // Values that do not fit into an entry follow the 12 entries, their number and the offset of
    // the next directory.
    let behind = directory + 2 + 12 * 12 + 4;
    let Ok(end) = u32::try_from(behind + 14) else {
        return Err("TIFF files have at most 4 GiB; write OpenEXR or PNG".into());
    };
    let (bits, resolution) = (end - 14, end - 8);
    let entries = [
        entry(256, LONG, 1, width),
        entry(257, LONG, 1, height),
        entry(258, SHORT, 3, bits),               // BitsPerSample
        entry(259, SHORT, 1, 1),                  // Compression: none
        entry(262, SHORT, 1, 2),                  // PhotometricInterpretation: RGB
        entry(273, LONG, 1, HEADER_BYTES as u32), // StripOffsets
        entry(277, SHORT, 1, 3),                  // SamplesPerPixel
        entry(278, LONG, 1, height),              // RowsPerStrip
        entry(279, LONG, 1, strip as u32),        // StripByteCounts
        entry(282, RATIONAL, 1, resolution),      // XResolution
        entry(283, RATIONAL, 1, resolution),      // YResolution
        entry(296, SHORT, 1, 1),                  // ResolutionUnit: none
    ];
    let head = [&b"II*\0"[..], &(directory as u32).to_le_bytes()].concat();
    let count = (entries.len() as u16).to_le_bytes();
    let tail: Vec<u8> = [8u16, 8, 8].iter().flat_map(|v| v.to_le_bytes()).collect();
    let one = [1u32, 1].map(u32::to_le_bytes).concat();
    let encode = |rows: Range<usize>, band: &mut Vec<u8>| {
        let pixels = &film.pixels[rows.start * width as usize..rows.end * width as usize];
        band.resize(pixels.len() * 3, 0);
        band.chunks_exact_mut(3).zip(pixels).for_each(|(to, p)| to.copy_from_slice(&p.map(srgb8)));
    };
    to.write_all(&head)
        .and_then(|()| write_bands(height as usize, row_bytes, Vec::new, encode, |band| to.write_all(band)))
        .and_then(|()| {
            let behind = [&[0][..padding], &count, &entries.concat(), &[0; 4], &tail, &one];
            behind.into_iter().try_for_each(|part| to.write_all(part))
        })
        .map_err(|e| e.to_string())
}
