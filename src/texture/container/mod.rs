//! Files that hold more than one array of texels: DDS and KTX2, with cubes, volumes, mip levels, and formats of devices.
//! Takes what a header says and the stored bytes of each level; returns the levels decoded, the first as the picture. No
//! more is allocated than the stored bytes can fill.

mod basis;
mod blocks;
pub(super) mod dds;
mod dds_legacy;
mod fields;
mod inflate;
pub(super) mod ktx2;
mod ktx2_header;
mod normal;
mod pixel_format;

use std::borrow::Cow;
use std::path::Path;

use super::data::{ColorSpace, Dimension, TexelFormat};
use super::read_file::{FileFacts, Picture, Texels, check_memory, check_volume, zero_size};
use crate::core::error::Result;
use fields::{Channels, Fields};
use pixel_format::{Layout, PixelFormat};

/// The most levels that a texture can have.
const MAX_LEVELS: u32 = 32;

/// What a file says of its texels, with their stored bytes.
struct Stored<'a> {
    /// The format of the file.
    kind: &'static str,
    dimension: Dimension,
    /// Width, height, and slices or faces of level 0.
    size: [u32; 3],
    format: PixelFormat,
    color_space: Option<ColorSpace>,
    levels: Vec<Level<'a>>,
    notes: Vec<String>,
}

/// The bytes of a level: of a cube one part a face, otherwise one.
type Level<'a> = Vec<Cow<'a, [u8]>>;

impl Stored<'_> {
    /// Decodes all levels.
    fn picture(self, path: &Path) -> Result<Picture> {
        let format = self.format.layout.texel_format();
        check_volume(path, self.size, format.bytes_per_texel())?;
        let mut levels = Vec::with_capacity(self.levels.len());
        for (index, level) in self.levels.into_iter().enumerate() {
            let size = level_size(self.dimension, self.size, index as u32);
            levels.push(self.format.layout.decode(&level, size, path)?);
        }
        let facts = FileFacts {
            dimension: self.dimension,
            depth: self.size[2],
            levels: Vec::new(),
            color_space: self.color_space,
            profile: None,
            encoding: Some(format!("{}, {}", self.kind, self.format.name)),
        };
        of_levels(levels, facts, self.notes, path)
    }
}

/// Returns the picture of all levels, the first of which is that of the picture.
fn of_levels(levels: Vec<Texels>, facts: FileFacts, notes: Vec<String>, path: &Path) -> Result<Picture> {
    let mut levels = levels.into_iter();
    let Some(first) = levels.next() else { return Err(zero_size(path)) };
    Ok(Picture { facts: FileFacts { levels: levels.collect(), ..facts }, ..Picture::noted(first, notes) })
}

/// Returns width, height, and slices or faces of a level.
fn level_size(dimension: Dimension, [width, height, depth]: [u32; 3], level: u32) -> [u32; 3] {
    let half = |n: u32| n.checked_shr(level).unwrap_or(0).max(1);
    [half(width), half(height), if dimension == Dimension::Three { half(depth) } else { depth }]
}

/// Returns how many levels a texture of this size can have at most.
fn max_levels(dimension: Dimension, [width, height, depth]: [u32; 3]) -> u32 {
    let depth = if dimension == Dimension::Three { depth } else { 1 };
    u32::BITS - width.max(height).max(depth).leading_zeros()
}

impl Layout {
    /// Returns the format of decoded texels.
    fn texel_format(self) -> TexelFormat {
        match self {
            Layout::Blocks(block) => block.texel_format(),
            Layout::Fields(fields) => fields.texel_format(),
            Layout::SharedExponent => TexelFormat::RgbaFloat,
        }
    }

    /// Returns the channels that the file holds; alpha alone is that of white.
    fn channels(self) -> usize {
        match self {
            Layout::Blocks(block) => block.channels(),
            Layout::Fields(Fields { channels: Channels::Alpha, .. }) => 2,
            Layout::Fields(Fields { channels, .. }) => channels.count(),
            Layout::SharedExponent => 3,
        }
    }

    /// Returns the stored bytes of slices of this size.
    fn bytes(self, [width, height, depth]: [u32; 3]) -> u64 {
        let blocks = |n: u32| u64::from(n).div_ceil(blocks::SIDE as u64);
        let bytes = match self {
            Layout::Blocks(block) => blocks(width) * blocks(height) * block.bytes() as u64,
            Layout::Fields(Fields { bytes, .. }) => u64::from(width) * u64::from(height) * u64::from(bytes),
            Layout::SharedExponent => u64::from(width) * u64::from(height) * 4,
        };
        bytes.saturating_mul(depth.into())
    }

    /// Decodes a level of this size, whose parts together have all its bytes.
    fn decode(
        self,
        parts: &[Cow<'_, [u8]>],
        [width, height, depth]: [u32; 3],
        path: &Path,
    ) -> Result<Texels> {
        let format = self.texel_format();
        let slice_bytes = width as usize * height as usize * format.bytes_per_texel();
        check_memory(path, slice_bytes * depth as usize)?;
        let mut bytes = vec![0; slice_bytes * depth as usize];
        let stored = self.bytes([width, height, 1]) as usize;
        let slices = parts.iter().flat_map(|part| part.chunks_exact(stored));
        for (stored, texels) in slices.zip(bytes.chunks_exact_mut(slice_bytes)) {
            match self {
                Layout::Blocks(block) => block.decode(stored, width as usize, texels),
                Layout::Fields(fields) => fields.decode(stored, texels),
                Layout::SharedExponent => fields::decode_shared_exponent(stored, texels),
            }
        }
        Ok(Texels { width, height, format, file_channels: self.channels(), bytes })
    }
}
