//! Reads TGA files (Truevision TGA 2.0) into 8 bits per channel, with rows from the top and texels
//! from the left whatever the file's order. Texels of 15 or 16 bits have five per channel; the
//! remaining bit is not used as alpha. Footers and extension areas are ignored.

use std::path::Path;

use super::data::Component;
use super::decoder::{self, Fault, Header};
use super::read_file::Picture;
use crate::core::error::Result;

const HEADER_BYTES: usize = 18;

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let tga = Tga::new(file).map_err(|fault| fault.in_file(path, "TGA"))?;
    let texels = decoder::texels(tga.header, "TGA", file.len(), path, |texels| tga.decode(texels))?;
    Ok(Picture::from(texels))
}

/// A file whose header and palette have been read.
struct Tga<'a> {
    header: Header,
    /// The bytes per texel in `data`: an index or a colour.
    stored_bytes: usize,
    palette: Option<Palette<'a>>,
    has_runs: bool,
    /// True if the first texel is at the right, and if it is at the bottom.
    reversed: [bool; 2],
    data: &'a [u8],
}

struct Palette<'a> {
    first: usize,
    entry_bytes: usize,
    entries: &'a [u8],
}

impl<'a> Tga<'a> {
    fn new(file: &'a [u8]) -> std::result::Result<Self, Fault> {
        let (h, rest) = file.split_first_chunk::<HEADER_BYTES>().ok_or_else(ends_early)?;
        let word = |at: usize| usize::from(u16::from_le_bytes([h[at], h[at + 1]]));
        let (id_bytes, has_palette, kind, entry_bits) = (usize::from(h[0]), h[1] == 1, h[2], h[7]);
        let (bits, flags) = (h[16], h[17]);
        let [entry_bytes, stored_bytes] = [entry_bits, bits].map(|bits| usize::from(bits).div_ceil(8));

        let rest = rest.get(id_bytes..).ok_or_else(ends_early)?;
        let palette_bytes = if has_palette { word(5) * entry_bytes } else { 0 };
        let (entries, data) = rest.split_at_checked(palette_bytes).ok_or_else(ends_early)?;
        // A true-colour file may also have a palette, for indexed displays.
        let is_indexed = matches!(kind, 1 | 9);
        let palette = is_indexed.then_some(Palette { first: word(3), entry_bytes, entries });
        if is_indexed && (!has_palette || bits > entry_bits) {
            return Err(Fault::Unsupported("indices that are wider than colors, or have no palette".into()));
        }

        let color_bits = if is_indexed { entry_bits } else { bits };
        let channels = match (flags & 0xf, color_bits, matches!(kind, 3 | 11)) {
            (0 | 8, 32, false) => 4,
            (0, 24 | 16 | 15, false) | (1, 16, false) => 3,
            (8, 16, true) => 2,
            (0 | 8, 8, true) => 1,
            (alpha, _, _) => {
                return Err(Fault::Unsupported(format!("{alpha} alpha bits among {color_bits} of a texel")));
            }
        };
        let [width, height] = [word(12), word(14)].map(|n| n as u32);
        Ok(Tga {
            header: Header { width, height, channels, component: Component::Unorm8 },
            stored_bytes,
            palette,
            has_runs: kind >= 9,
            reversed: [flags & 0x10 != 0, flags & 0x20 == 0],
            data,
        })
    }

    fn decode(&self, texels: &mut [u8]) -> std::result::Result<(), Fault> {
        let (width, height) = (self.header.width as usize, self.header.height as usize);
        let size = self.header.channels;
        let mut stored = Stored { rest: self.data, bytes: self.stored_bytes, packet: Packet::Literal(0) };
        if !self.has_runs {
            stored.packet = Packet::Literal(width * height);
        }
        for row in 0..height {
            let y = if self.reversed[1] { height - 1 - row } else { row };
            for column in 0..width {
                let x = if self.reversed[0] { width - 1 - column } else { column };
                let texel = stored.next().ok_or_else(ends_early)?;
                let color = match &self.palette {
                    Some(palette) => palette.color(texel)?,
                    None => texel,
                };
                let at = (y * width + x) * size;
                expand(color, &mut texels[at..at + size]);
            }
        }
        Ok(())
    }
}

impl<'a> Palette<'a> {
    fn color(&self, index: &[u8]) -> std::result::Result<&'a [u8], Fault> {
        let index = index.iter().rev().fold(0, |index, byte| index << 8 | usize::from(*byte));
        let at = index.checked_sub(self.first).map(|i| i * self.entry_bytes);
        at.and_then(|at| self.entries.get(at..at + self.entry_bytes))
            .ok_or_else(|| Fault::Damaged(format!("index {index} lies outside the palette")))
    }
}

/// The texels of the file in stored order.
struct Stored<'a> {
    rest: &'a [u8],
    bytes: usize,
    packet: Packet<'a>,
}

/// The remainder of a packet (type 9 to 11).
enum Packet<'a> {
    Literal(usize),
    Run(usize, &'a [u8]),
}

impl<'a> Stored<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        if let Packet::Literal(0) | Packet::Run(0, _) = self.packet {
            let (head, rest) = self.rest.split_first()?;
            self.rest = rest;
            let count = usize::from(head & 0x7f) + 1;
            self.packet =
                if head & 0x80 == 0 { Packet::Literal(count) } else { Packet::Run(count, self.take()?) };
        }
        match &mut self.packet {
            Packet::Literal(left) => {
                *left -= 1;
                self.take()
            }
            Packet::Run(left, texel) => {
                *left -= 1;
                Some(texel)
            }
        }
    }

    fn take(&mut self) -> Option<&'a [u8]> {
        let (texel, rest) = self.rest.split_at_checked(self.bytes)?;
        self.rest = rest;
        Some(texel)
    }
}

/// Expands a colour to channels. Blue is first in the file; two bytes for three channels are five
/// bits of each.
fn expand(color: &[u8], texel: &mut [u8]) {
    match (color, &mut *texel) {
        ([low, high], [r, g, b]) => {
            let bits = u16::from_le_bytes([*low, *high]);
            let eight = |shift: u16| (((bits >> shift & 31) * 255 + 15) / 31) as u8;
            (*r, *g, *b) = (eight(10), eight(5), eight(0));
        }
        _ => {
            texel.copy_from_slice(color);
            if texel.len() > 2 {
                texel.swap(0, 2);
            }
        }
    }
}

fn ends_early() -> Fault {
    Fault::Damaged("the file ends early".into())
}
