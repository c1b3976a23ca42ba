//! A film as a Radiance picture (Radiance, "File Formats": Picture File Format): scan lines from the top, each
//! as four planes (three mantissas and the exponent) of runs and literal bytes.

use std::io::{self, Write};

use rayon::prelude::*;

use super::quantise::rgbe;
use crate::core::film::Film;

/// Widths whose scan lines may have runs.
const WIDTHS_WITH_RUNS: std::ops::RangeInclusive<usize> = 8..=32_767;
const LONGEST_RUN: usize = 127;
const MOST_LITERALS: usize = 128;
/// Scan lines that are made at once.
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

/// Three equal bytes or more are a run (128 + length, byte), what lies between runs is literal (length, bytes).
fn compress(bytes: &[u8], line: &mut Vec<u8>) {
    let literals = |bytes: &[u8], line: &mut Vec<u8>| {
        for part in bytes.chunks(MOST_LITERALS) {
            line.push(part.len() as u8);
            line.extend_from_slice(part);
        }
    };
    let (mut at, mut told) = (0, 0);
    while let Some(&byte) = bytes.get(at) {
        let run = bytes[at..].iter().take(LONGEST_RUN).take_while(|b| **b == byte).count();
        if run > 2 {
            literals(&bytes[told..at], line);
            line.extend([128 + run as u8, byte]);
            told = at + run;
        }
        at += run;
    }
    literals(&bytes[told..], line);
}
