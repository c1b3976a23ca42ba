//! Reads DDS files (Microsoft, "Programming Guide for DDS"), of Direct3D 9 or with the header of Direct3D 10: flat
//! textures, whole cubes and volumes with their levels. Takes the bytes of a file; returns its decoded levels. Rows have
//! no padding, as in all files of today's programs.

use std::borrow::Cow;
use std::path::Path;

use super::dds_legacy;
use super::pixel_format::PixelFormat;
use super::{Level, MAX_LEVELS, Stored, level_size, max_levels};
use crate::core::error::Result;
use crate::texture::data::{ColorSpace, Dimension};
use crate::texture::decoder::Fault;
use crate::texture::read_file::{Picture, unsupported_kind};

const HEADER_BYTES: usize = 128;
const DX10_BYTES: usize = 20;

/// Flags of the header, of its capabilities and of Direct3D 10.
const HAS_DEPTH: u32 = 0x80_0000;
const IS_CUBE: u32 = 0x200;
const ALL_FACES: u32 = 0xfc00;
const IS_VOLUME: u32 = 0x20_0000;
const DX10_CUBE: u32 = 4;
const DX10_PREMULTIPLIED: u32 = 2;

pub(in crate::texture) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let header = match Header::read(file) {
        Ok(header) => header,
        Err(Refusal::Fault(fault)) => return Err(fault.in_file(path, "DDS")),
        Err(Refusal::Kind(what)) => return Err(unsupported_kind(path, &format!("a DDS file {what}"))),
    };
    let levels = header.levels(file).map_err(|fault| fault.in_file(path, "DDS"))?;
    let mut notes = Vec::new();
    if header.is_premultiplied {
        notes.push(format!("{}: its colours are multiplied by alpha, and stay so", path.display()));
    }
    let Header { dimension, size, format, .. } = header;
    let color_space = format.is_srgb.then_some(ColorSpace::Srgb);
    Stored { kind: "DDS", dimension, size, format, color_space, levels, notes }.picture(path)
}

/// Why a file is not read.
pub(super) enum Refusal {
    Fault(Fault),
    /// Something that is not read, so that "a DDS file …" is a phrase.
    Kind(String),
}

impl From<Fault> for Refusal {
    fn from(fault: Fault) -> Self {
        Refusal::Fault(fault)
    }
}

struct Header {
    dimension: Dimension,
    size: [u32; 3],
    level_count: u32,
    format: PixelFormat,
    is_premultiplied: bool,
    /// Bytes before the texels.
    start: usize,
}

/// The words of a file, the first with number 0.
#[derive(Clone, Copy)]
pub(super) struct Words<'a>(&'a [u8]);

impl Words<'_> {
    /// Returns a word, or 0 beyond the end.
    pub fn get(self, index: usize) -> u32 {
        let word = self.0.get(index * 4..).and_then(|rest| rest.first_chunk());
        word.map_or(0, |word| u32::from_le_bytes(*word))
    }
}

impl Header {
    fn read(file: &[u8]) -> std::result::Result<Header, Refusal> {
        let words = Words(file);
        if file.len() < HEADER_BYTES || words.get(1) != 124 || words.get(19) != 32 {
            return Err(Fault::Damaged("the header has not the size of one".into()).into());
        }
        let [flags, height, width, depth, levels] = [2, 3, 4, 6, 7].map(|index| words.get(index));
        let caps = words.get(28);
        let (is_volume, mut faces) = (caps & IS_VOLUME != 0 && flags & HAS_DEPTH != 0, caps & IS_CUBE != 0);
        if faces && caps & ALL_FACES != ALL_FACES {
            return Err(Refusal::Kind("of a cube that lacks faces".into()));
        }
        let mut dimension = if is_volume { Dimension::Three } else { Dimension::Two };
        let mut start = HEADER_BYTES;
        let (format, is_premultiplied) = if words.get(21) == u32::from_le_bytes(*b"DX10") {
            start += DX10_BYTES;
            let [number, axes, misc, layers, alpha] = [32, 33, 34, 35, 36].map(|index| words.get(index));
            if file.len() < start {
                return Err(Fault::Damaged("the file ends within the header".into()).into());
            }
            if layers > 1 {
                return Err(Refusal::Kind(format!("of an array of {layers} textures")));
            }
            faces = misc & DX10_CUBE != 0;
            dimension = if axes == 4 { Dimension::Three } else { Dimension::Two };
            let format = PixelFormat::of_dxgi(number);
            let format = format.ok_or_else(|| Refusal::Kind(format!("of DXGI format {number}")))?;
            (format, alpha & 7 == DX10_PREMULTIPLIED)
        } else {
            dds_legacy::format(words)?
        };
        if faces {
            dimension = Dimension::Cube;
        }
        if faces && width != height {
            return Err(Fault::Damaged(format!("a cube's faces of {width}×{height} texels")).into());
        }
        let depth = match dimension {
            Dimension::Three => depth,
            Dimension::Cube => 6,
            _ => 1,
        };
        let size = [width, height, depth];
        if size.contains(&0) {
            return Err(Fault::ZeroSize.into());
        }
        let level_count = levels.max(1);
        if level_count > max_levels(dimension, size).min(MAX_LEVELS) {
            let [width, height, _] = size;
            return Err(Fault::Damaged(format!("{level_count} levels of {width}×{height} texels")).into());
        }
        Ok(Header { dimension, size, level_count, format, is_premultiplied, start })
    }

    /// Returns the bytes of each level; a file has all levels of a face before those of the next.
    fn levels<'a>(&self, file: &'a [u8]) -> std::result::Result<Vec<Level<'a>>, Fault> {
        let mut levels: Vec<Level<'a>> = (0..self.level_count).map(|_| Vec::new()).collect();
        let mut rest = &file[self.start..];
        for _ in 0..if self.dimension == Dimension::Cube { 6 } else { 1 } {
            for (index, level) in (0..).zip(&mut levels) {
                let mut size = level_size(self.dimension, self.size, index);
                if self.dimension == Dimension::Cube {
                    size[2] = 1;
                }
                let bytes = usize::try_from(self.format.layout.bytes(size)).unwrap_or(usize::MAX);
                let Some((part, after)) = rest.split_at_checked(bytes) else {
                    return Err(Fault::Damaged(format!(
                        "level {index} takes {bytes} bytes, and {} are left",
                        rest.len()
                    )));
                };
                level.push(Cow::Borrowed(part));
                rest = after;
            }
        }
        Ok(levels)
    }
}
