//! Reads Radiance pictures (Radiance, "File Formats": Picture File Format) into floats, with rows
//! from the top and texels from the left whatever the file's order. Values are those of the file:
//! EXPOSURE and COLORCORR give the factor back to radiance, but nearly all programs that use such
//! files as textures leave values as they are; a note states the factor. GAMMA, PIXASPECT,
//! PRIMARIES and all other variables are ignored. A texel with bytes c and exponent e is c · 2^(e −
//! 136).

use std::path::Path;

use super::data::{Component, TexelFormat};
use super::read_file::{Picture, Texels, check_size, damaged, out_of_memory, unsupported_kind};
use crate::core::error::Result;

/// The length limit of a header line: a longer one is not a header.
const MAX_LINE_BYTES: usize = 64 << 10;

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let broken = |what: String| damaged(path, "HDR", &what);
    let mut rest = file;
    let (mut exposure, mut correction) = (1.0, [1.0; 3]);
    let _signature = line(&mut rest);
    let shape = loop {
        let Some(line) = line(&mut rest) else {
            return Err(broken("the file ends within the header".into()));
        };
        if let Some(format) = line.strip_prefix("FORMAT=").map(str::trim)
            && format != "32-bit_rle_rgbe"
        {
            let name = match format {
                "32-bit_rle_xyze" => "a Radiance HDR file of CIE XYZ values (FORMAT=32-bit_rle_xyze)".into(),
                other => {
                    format!("a Radiance HDR file with FORMAT={}", other.chars().take(40).collect::<String>())
                }
            };
            return Err(unsupported_kind(path, &name));
        }
        if let Some(value) = line.strip_prefix("EXPOSURE=") {
            exposure *= factor(value);
        } else if let Some(values) = line.strip_prefix("COLORCORR=") {
            let values = values.split_whitespace().map(factor);
            correction.iter_mut().zip(values).for_each(|(all, one)| *all *= one);
        } else if let Some(shape) = Shape::parse(&line) {
            break shape;
        }
    };
    let texels = decode(rest, &shape, path)?;
    let mut notes = Vec::new();
    let factors = correction.map(|c| exposure * c);
    if factors.iter().any(|f| (f - 1.0).abs() > 1e-3) {
        let [r, g, b] = factors;
        notes.push(format!(
            "{}: by EXPOSURE or COLORCORR the values are ({r}, {g}, {b}) times the radiance; they are used as stored",
            path.display()
        ));
    }
    Ok(Picture::noted(texels, notes))
}

/// Returns the text up to a line feed, without it and without a preceding carriage return.
fn line(rest: &mut &[u8]) -> Option<String> {
    let end = rest.iter().take(MAX_LINE_BYTES).position(|b| *b == b'\n')?;
    let line = String::from_utf8_lossy(&rest[..end]).trim().to_string();
    *rest = &rest[end + 1..];
    Some(line)
}

/// Returns the factor, or 1 if the text is not a positive number.
fn factor(text: &str) -> f64 {
    text.trim().parse().ok().filter(|f: &f64| f.is_finite() && *f > 0.0).unwrap_or(1.0)
}

/// The resolution line: `-Y 480 +X 640` for rows from the top, each from the left.
struct Shape {
    width: u64,
    height: u64,
    /// True if scan lines are columns of the picture.
    by_columns: bool,
    /// True if the first texel is at the right, and if it is at the bottom.
    reversed: [bool; 2],
}

impl Shape {
    fn parse(line: &str) -> Option<Shape> {
        let mut words = line.split_whitespace();
        let mut axis = || -> Option<(char, bool, u64)> {
            let word = words.next()?;
            let increases = match word.get(..1)? {
                "+" => true,
                "-" => false,
                _ => return None,
            };
            Some((word.get(1..)?.chars().next()?, increases, words.next()?.parse().ok()?))
        };
        let (first, second) = (axis()?, axis()?);
        let (x, y, by_columns) = match (first.0, second.0) {
            ('Y', 'X') => (second, first, false),
            ('X', 'Y') => (first, second, true),
            _ => return None,
        };
        // Radiance's y axis points upwards.
        Some(Shape { width: x.2, height: y.2, by_columns, reversed: [!x.1, y.1] })
    }

    /// Returns the index in the picture of a texel of a scan line.
    fn texel_index(&self, scan_line: usize, position: usize) -> usize {
        let (x, y) = if self.by_columns { (scan_line, position) } else { (position, scan_line) };
        let (width, height) = (self.width as usize, self.height as usize);
        let x = if self.reversed[0] { width - 1 - x } else { x };
        let y = if self.reversed[1] { height - 1 - y } else { y };
        y * width + x
    }
}

fn decode(mut data: &[u8], shape: &Shape, path: &Path) -> Result<Texels> {
    let format = TexelFormat::new(4, Component::Float32);
    let size = format.bytes_per_texel();
    check_size(path, shape.width, shape.height, size)?;
    let (width, height) = (shape.width as usize, shape.height as usize);
    let (lines, length) = if shape.by_columns { (width, height) } else { (height, width) };
    // The first texel of each scan line is stored uncompressed.
    if data.len() / 4 < lines {
        let what = format!("{} bytes cannot hold {width}×{height} texels", data.len());
        return Err(damaged(path, "HDR", &what));
    }
    let mut texels: Vec<[u8; 4]> = Vec::new();
    for scan_line in 0..lines {
        texels.try_reserve(length).map_err(|_| out_of_memory(path))?;
        if read_line(&mut data, length, &mut texels).is_none() {
            let what = format!("scan line {} of {lines} ends early", scan_line + 1);
            return Err(damaged(path, "HDR", &what));
        }
    }
    let mut bytes: Vec<u8> = Vec::new();
    bytes.try_reserve_exact(texels.len() * size).map_err(|_| out_of_memory(path))?;
    bytes.resize(texels.len() * size, 0);
    for (i, rgbe) in texels.iter().enumerate() {
        let start = shape.texel_index(i / length, i % length) * size;
        bytes[start..start + size].copy_from_slice(bytemuck::bytes_of(&color(*rgbe)));
    }
    Ok(Texels { width: width as u32, height: height as u32, format, file_channels: 3, bytes })
}

fn color([r, g, b, e]: [u8; 4]) -> [f32; 4] {
    let scale = if e == 0 { 0.0 } else { 2f64.powi(i32::from(e) - 136) };
    let value = |c: u8| (f64::from(c) * scale) as f32;
    [value(r), value(g), value(b), 1.0]
}

/// Appends the texels of a scan line, or returns `None` if the data ends or is inconsistent.
fn read_line(data: &mut &[u8], length: usize, texels: &mut Vec<[u8; 4]>) -> Option<()> {
    const RUNS_OF_CHANNELS: std::ops::RangeInclusive<usize> = 8..=0x7fff;
    let (head, rest) = data.split_first_chunk::<4>()?;
    if RUNS_OF_CHANNELS.contains(&length) && head[..2] == [2, 2] && head[2] < 128 {
        *data = rest;
        let stated = usize::from(u16::from_be_bytes([head[2], head[3]]));
        return (stated == length).then(|| read_channels(data, length, texels))?;
    }
    read_texels(data, length, texels)
}

/// Reads one channel after the other: a count above 128 repeats the next byte, others are followed
/// by as many bytes.
fn read_channels(data: &mut &[u8], length: usize, texels: &mut Vec<[u8; 4]>) -> Option<()> {
    let start = texels.len();
    texels.resize(start + length, [0; 4]);
    for channel in 0..4 {
        let mut next = start;
        while next < texels.len() {
            let (&count, rest) = data.split_first()?;
            let (run, repeats) = if count > 128 { (count - 128, true) } else { (count, false) };
            let bytes = rest.get(..if repeats { 1 } else { run.into() })?;
            let run_texels =
                texels.get_mut(next..next + usize::from(run)).filter(|texels| !texels.is_empty())?;
            for (i, texel) in run_texels.iter_mut().enumerate() {
                texel[channel] = bytes[if repeats { 0 } else { i }];
            }
            next += usize::from(run);
            *data = &rest[bytes.len()..];
        }
    }
    Some(())
}

/// Reads four bytes per texel. 1, 1, 1, n repeats the previous texel n times; directly after
/// another such code, n · 256 times, and so on.
fn read_texels(data: &mut &[u8], length: usize, texels: &mut Vec<[u8; 4]>) -> Option<()> {
    let end = texels.len() + length;
    let mut shift = 0;
    while texels.len() < end {
        let (texel, rest) = data.split_first_chunk::<4>()?;
        *data = rest;
        if let [1, 1, 1, n] = *texel {
            let count = usize::from(n).checked_shl(shift).filter(|_| shift < 32)?;
            let before = *texels.last()?;
            let room = end - texels.len();
            texels.extend(std::iter::repeat_n(before, count.min(room)));
            shift += 8;
        } else {
            texels.push(*texel);
            shift = 0;
        }
    }
    Some(())
}
