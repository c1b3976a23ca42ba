//! Writes a film as a Radiance picture (Radiance, "File Formats": Picture File Format): scan lines
//! from the top, each as four planes (three mantissas and the exponent) of runs and literal bytes.

use std::io::{self, Write};

use rayon::prelude::*;

use super::quantise::rgbe;
use crate::core::film::Film;

/// The widths whose scan lines may have runs.
const WIDTHS_WITH_RUNS: std::ops::RangeInclusive<usize> = 8..=32_767;
const MAX_RUN: usize = 127;
const MAX_LITERALS: usize = 128;
/// The number of scan lines encoded in parallel.
const BAND: usize = 256;

pub(super) fn write(film: &Film, mut to: impl Write) -> io::Result<()> {
    let (width, height) = (film.width as usize, film.height as usize);
    write!(to, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n")?;
    for band in film.pixels.chunks(width * BAND) {
        let lines: Vec<Vec<u8>> = band.par_chunks(width).map(scan_line).collect();
        lines.iter().try_for_each(|line| to.write_all(line))?;
    }
    Ok(())
}

fn scan_line(pixels: &[[f32; 3]]) -> Vec<u8> {
    let width = pixels.len();
    if !WIDTHS_WITH_RUNS.contains(&width) {
        return pixels.iter().flat_map(|p| rgbe(*p)).collect();
    }
    let bytes: Vec<[u8; 4]> = pixels.iter().map(|p| rgbe(*p)).collect();
    let mut line = vec![2, 2, (width >> 8) as u8, width as u8];
    for plane in 0..4 {
        let plane: Vec<u8> = bytes.iter().map(|p| p[plane]).collect();
        compress(&plane, &mut line);
    }
    line
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
