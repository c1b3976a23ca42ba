//! Uploads the texels of all textures to one texel buffer, or to several if the device's are too short. Levels that the
//! host left out do not cross the bus: they are generated on the device and copied into place.

use std::ops::Range;

use super::mip_chain::{MipGenerator, MipSource, sizes};
use crate::core::error::{Error, Result};
use crate::gpu::{Buffer, BufferUse, Gpu};
use crate::pack::PackedScene;

/// Largest number of buffers that hold the texels (`READ_BLOCK` in `texel_buffer.glsl`).
const MAX_BLOCKS: u64 = 16;

/// The texels on the device.
pub struct TexelBuffer {
    /// Blocks of 2^`block_log2` words each; the last one holds the rest.
    pub blocks: Vec<Buffer>,
    /// 0 if there is one block of any length.
    pub block_log2: u32,
}

impl TexelBuffer {
    /// Uploads the first `bytes` of the scene's texels to buffers of at most `most_words`.
    pub fn upload(
        gpu: &Gpu,
        packed: &PackedScene,
        bytes: usize,
        most_words: u64,
        generator: &mut MipGenerator<'_>,
    ) -> Result<TexelBuffer> {
        let texels = &packed.texels[..bytes];
        let texel_buffer = TexelBuffer::new(gpu, packed, bytes as u64, most_words)?;
        let mut written = 0;
        for &texture in &packed.device_levels {
            let record = &packed.records.textures[texture];
            let start = record.first_word as usize * 4;
            if start >= bytes {
                continue;
            }
            texel_buffer.write(gpu, written, &texels[written..start])?;
            let mip_chain = generator.make(&MipSource {
                name: &packed.texture_names[texture],
                format: record.format,
                space: record.color_space,
                sizes: &sizes(packed, texture),
                texels: packed.level_texels(texture, 0),
            })?;
            texel_buffer.copy(gpu, &mip_chain.buffer, start)?;
            written = start + mip_chain.buffer.bytes() as usize;
        }
        texel_buffer.write(gpu, written, &texels[written..])?;
        Ok(texel_buffer)
    }

    /// Uploads the texels with their neighbours, to one buffer.
    pub fn upload_quads(gpu: &Gpu, packed: &PackedScene) -> Result<TexelBuffer> {
        let quads = packed.texel_quads();
        let usage = if quads.wide { BufferUse::TexelUint4 } else { BufferUse::TexelUint };
        let buffer =
            gpu.upload_buffer("texels with neighbours", usage, bytemuck::cast_slice(&quads.words))?;
        Ok(TexelBuffer { blocks: vec![buffer], block_log2: 0 })
    }

    fn new(gpu: &Gpu, packed: &PackedScene, bytes: u64, most_words: u64) -> Result<TexelBuffer> {
        let Some((count, block_log2)) = blocks(bytes / 4, most_words) else {
            return Err(Error::with_help(
                format!(
                    "{} together take {} MiB, and on device \"{}\" {MAX_BLOCKS} texel buffers hold {} MiB",
                    named(packed),
                    bytes >> 20,
                    gpu.info().name,
                    (MAX_BLOCKS << most_words.max(1).ilog2()) >> 18
                ),
                "use smaller or fewer textures, fewer bits a texel, or a device with longer texel buffers \
                 (`moire devices --json`: max_texel_buffer_elements)",
            ));
        };
        let block_bytes = 4 << block_log2;
        let block = |index: u64| {
            let name = if count == 1 { "texels".into() } else { format!("texels {} of {count}", index + 1) };
            let rest = bytes - if count == 1 { 0 } else { index * block_bytes };
            // A binding must not be empty.
            let bytes = if count == 1 { rest.max(4) } else { rest.min(block_bytes) };
            gpu.buffer(&name, bytes, BufferUse::TexelUint)
        };
        Ok(TexelBuffer { blocks: (0..count).map(block).collect::<Result<_>>()?, block_log2 })
    }

    /// Replaces the bytes from `start` on.
    fn write(&self, gpu: &Gpu, start: usize, bytes: &[u8]) -> Result<()> {
        self.parts(start, bytes.len())
            .try_for_each(|part| gpu.write_buffer(&self.blocks[part.block], part.at, &bytes[part.range]))
    }

    /// Copies a whole buffer to byte `start`.
    fn copy(&self, gpu: &Gpu, from: &Buffer, start: usize) -> Result<()> {
        self.parts(start, from.bytes() as usize).try_for_each(|part| {
            let (first, length) = (part.range.start as u64, part.range.len() as u64);
            gpu.copy_buffer(from, first, &self.blocks[part.block], part.at, length)
        })
    }

    fn parts(&self, start: usize, length: usize) -> impl Iterator<Item = Part> {
        let block_bytes = if self.blocks.len() == 1 { usize::MAX } else { 4 << self.block_log2 };
        parts(start, length, block_bytes)
    }
}

/// Returns the number of blocks for these words and the log2 of their length; `None` if there are too many.
fn blocks(words: u64, most_words: u64) -> Option<(u64, u32)> {
    if words <= most_words {
        return Some((1, 0));
    }
    let log2 = most_words.checked_ilog2()?;
    let count = words.div_ceil(1 << log2);
    (count <= MAX_BLOCKS).then_some((count, log2))
}

/// A part of a byte range that lies in one block.
#[derive(Clone, Debug, PartialEq)]
struct Part {
    block: usize,
    /// Byte offset in the block.
    at: u64,
    range: Range<usize>,
}

/// Returns the parts of `length` bytes from byte `start` of the texel buffer.
fn parts(start: usize, length: usize, block_bytes: usize) -> impl Iterator<Item = Part> {
    let mut done = 0;
    std::iter::from_fn(move || {
        let (block, at) = ((start + done) / block_bytes, (start + done) % block_bytes);
        let range = done..length.min(done.saturating_add(block_bytes - at));
        done = range.end;
        (!range.is_empty()).then_some(Part { block, at: at as u64, range })
    })
}

/// Uploads the prefix sums of rows, which beams read.
pub fn upload_row_sums(gpu: &Gpu, packed: &PackedScene, words: &[u32]) -> Result<Buffer> {
    if !fits(gpu, words.len() as u64) {
        return Err(Error::with_help(
            format!(
                "{}: their sums along rows take {} MiB, over the {} MiB of a texel buffer on device \"{}\"",
                named(packed),
                words.len() >> 18,
                most_words(gpu) >> 18,
                gpu.info().name
            ),
            "use smaller textures, or algorithm \"adaptive\"",
        ));
    }
    gpu.upload_buffer("row sums", BufferUse::TexelUint, bytemuck::cast_slice(words))
}

/// Returns true if one texel buffer holds this many words.
pub fn fits(gpu: &Gpu, words: u64) -> bool {
    words <= most_words(gpu)
}

/// Returns the largest length of a texel buffer: the shader's index is an `int`, whatever the device allows.
pub fn most_words(gpu: &Gpu) -> u64 {
    gpu.info().limits.max_texel_buffer_elements.min(i32::MAX as u64)
}

fn named(packed: &PackedScene) -> String {
    let names: Vec<String> = packed.texture_names.iter().take(4).map(|name| format!("\"{name}\"")).collect();
    match packed.texture_names.len().saturating_sub(names.len()) {
        0 if names.len() == 1 => format!("the texels of texture {}", names.concat()),
        0 => format!("the texels of textures {}", names.join(", ")),
        more => format!("the texels of textures {} and {more} more", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_take_one_buffer_as_long_as_they_fit_and_then_powers_of_two() {
        assert_eq!(blocks(0, 100), Some((1, 0)));
        assert_eq!(blocks(100, 100), Some((1, 0)));
        assert_eq!(blocks(101, 100), Some((2, 6)), "64 words each");
        assert_eq!(blocks(16 * 64, 100), Some((16, 6)));
        assert_eq!(blocks(16 * 64 + 1, 100), None);
        assert_eq!(blocks(1, 0), None);
        // 21600 × 10800 texels of 4 bytes with their levels, on lavapipe.
        assert_eq!(blocks(21_600 * 10_800 / 3 * 4, 1 << 27), Some((3, 27)));
    }

    #[test]
    fn parts_cover_every_byte_once_and_in_order_each_in_its_block() {
        for (start, length, block) in [(0, 0, 8), (0, 8, 8), (3, 5, 8), (3, 6, 8), (8, 40, 8), (7, 30, 4)] {
            let mut next = 0;
            for part in parts(start, length, block) {
                assert_eq!(part.range.start, next);
                assert_eq!(part.block * block + part.at as usize, start + next);
                assert!(part.at as usize + part.range.len() <= block, "{part:?}");
                next = part.range.end;
            }
            assert_eq!(next, length, "{start} {length} {block}");
        }
        assert_eq!(parts(5, 7, usize::MAX).collect::<Vec<_>>(), [Part { block: 0, at: 5, range: 0..7 }]);
    }
}
