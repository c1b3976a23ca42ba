//! Writes a film as a Radiance picture (Radiance, "File Formats": Picture File Format): scan lines
//! from the top, each as four planes (three mantissas and the exponent) of runs and literal bytes.

use std::io::{self, Write};
use std::ops::Range;

use super::bands::write_bands;
use super::quantise::rgbe;
use super::record;
use crate::core::film::Film;

/// The widths whose scan lines may have runs.
const WIDTHS_WITH_RUNS: std::ops::RangeInclusive<usize> = 8..=32_767;
const MAX_RUN: usize = 127;
const MAX_LITERALS: usize = 128;

/// The encoded lines of a band, and for one line at a time its colours and a plane of them.
#[derive(Default)]
struct Band {
    lines: Vec<u8>,
    colors: Vec<[u8; 4]>,
    plane: Vec<u8>,
}

pub(super) fn write(film: &Film, text: Option<&str>, to: &mut dyn Write) -> io::Result<()> {
    let (width, height) = (film.width as usize, film.height as usize);
    to.write_all(b"#?RADIANCE\n")?;
    if let Some(text) = text {
        writeln!(to, "SOFTWARE={}", record::SOFTWARE)?;
        to.write_all(&record::hdr::lines(text))?;
    }
    write!(to, "FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n")?;
    let encode = |rows: Range<usize>, band: &mut Band| {
        band.lines.clear();
        rows.for_each(|row| band.append_line(&film.pixels[row * width..][..width]));
    };
    write_bands(height, width * 4, Band::default, encode, |band| to.write_all(&band.lines))
}

impl Band {
    fn append_line(&mut self, pixels: &[[f32; 3]]) {
        let width = pixels.len();
        self.colors.clear();
        self.colors.extend(pixels.iter().map(|p| rgbe(*p)));
        if !WIDTHS_WITH_RUNS.contains(&width) {
            return self.lines.extend_from_slice(self.colors.as_flattened());
        }
        self.lines.extend([2, 2, (width >> 8) as u8, width as u8]);
        for plane in 0..4 {
            self.plane.clear();
            self.plane.extend(self.colors.iter().map(|p| p[plane]));
            compress(&self.plane, &mut self.lines);
        }
    }
}

/// Compresses a plane: three or more equal bytes are a run (128 + length, byte), bytes between runs
/// are literal (length, bytes).
fn compress(bytes: &[u8], line: &mut Vec<u8>) {
    let literals = |bytes: &[u8], line: &mut Vec<u8>| {
        for part in bytes.chunks(MAX_LITERALS) {
            line.push(part.len() as u8);
            line.extend_from_slice(part);
        }
    };
    let (mut start, mut written) = (0, 0);
    while let Some(&byte) = bytes.get(start) {
        let run = bytes[start..].iter().take(MAX_RUN).take_while(|b| **b == byte).count();
        if run > 2 {
            literals(&bytes[written..start], line);
            line.extend([128 + run as u8, byte]);
            written = start + run;
        }
        start += run;
    }
    literals(&bytes[written..], line);
}
