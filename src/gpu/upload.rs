//! Uploads bytes or texels into buffers and images and leaves them ready for shaders. Bytes of buffers
//! in memory of the host are written there; all other data goes through the staging buffer in chunks.
//! Small mip levels share a chunk.

use ash::vk;
use rayon::prelude::*;

use super::buffer::Buffer;
use super::command::Commands;
use super::image::{Extent, Image, ImageShape};
use super::staging::{STAGING_BYTES, Staging};
use crate::core::error::Result;

/// The alignment of copies within a chunk: the largest texel size (Vulkan 1.2, "Copying Data
/// Between Buffers and Images", requires a multiple of the texel size and of 4).
const ALIGNMENT: usize = 16;
/// Bytes that a thread copies at once.
const AT_ONCE: usize = 1 << 20;

pub(super) fn to_buffer(
    staging: &mut Staging,
    commands: &mut Commands,
    buffer: &Buffer,
    offset: u64,
    data: &[u8],
) -> Result<()> {
    buffer.check_range(offset, data.len())?;
    if let Some(bytes) = buffer.host_bytes(commands) {
        let target = &mut bytes[offset as usize..][..data.len()];
        let both = target.par_chunks_mut(AT_ONCE).zip(data.par_chunks(AT_ONCE));
        both.for_each(|(target, data)| target.copy_from_slice(data));
        return Ok(());
    }
    let mut dst_offset = offset;
    for chunk in data.chunks(STAGING_BYTES) {
        let source = staging.get(chunk.len())?;
        source.mapped()?[..chunk.len()].copy_from_slice(chunk);
        let source = source.handle();
        let size = chunk.len() as u64;
        let region = vk::BufferCopy { src_offset: 0, dst_offset, size };
        commands.run(buffer.name(), |device, commands| {
            // SAFETY: both ranges were checked; submissions are waited for one by one.
            unsafe { device.cmd_copy_buffer(commands, source, buffer.handle(), &[region]) };
        })?;
        dst_offset += size;
    }
    Ok(())
}

/// Uploads all levels of an image. Their sizes were checked when the image was created.
pub(super) fn to_image(
    staging: &mut Staging,
    commands: &mut Commands,
    image: &Image,
    levels: &[&[u8]],
) -> Result<()> {
    let texel_bytes = image.format().texel_bytes();
    let extent = image.extent();
    let chunks = plan(extent, image.levels(), texel_bytes, STAGING_BYTES);
    for (index, blocks) in chunks.iter().enumerate() {
        let bytes = blocks.last().map_or(0, RowBlock::end);
        let source = staging.get(bytes)?;
        let mapped = source.mapped()?;
        for block in blocks {
            let start = block.level_offset();
            mapped[block.offset..block.end()]
                .copy_from_slice(&levels[block.level as usize][start..start + block.bytes()]);
        }
        let source = source.handle();
        let regions: Vec<vk::BufferImageCopy> =
            blocks.iter().map(|block| block.region(extent.shape)).collect();
        let (first, last) = (index == 0, index + 1 == chunks.len());
        commands.run(image.label(), |device, commands| {
            if first {
                transition(device, commands, image, Transition::ToTransfer);
            }
            // SAFETY: the regions lie in the staging buffer and in the image's levels, which are
            // in the layout for transfers.
            unsafe {
                let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
                device.cmd_copy_buffer_to_image(commands, source, image.handle(), layout, &regions);
            }
            if last {
                transition(device, commands, image, Transition::ToShader);
            }
        })?;
    }
    Ok(())
}

pub(super) enum Transition {
    ToTransfer,
    ToShader,
}

pub(super) fn transition(device: &ash::Device, commands: vk::CommandBuffer, image: &Image, to: Transition) {
    use vk::{AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stage};
    let barrier = vk::ImageMemoryBarrier::default()
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image.handle())
        .subresource_range(image.all_levels());
    let (barrier, from_stage, to_stage) = match to {
        Transition::ToTransfer => (
            barrier
                .old_layout(Layout::UNDEFINED)
                .new_layout(Layout::TRANSFER_DST_OPTIMAL)
                .dst_access_mask(Access::TRANSFER_WRITE),
            Stage::TOP_OF_PIPE,
            Stage::TRANSFER,
        ),
        Transition::ToShader => (
            barrier
                .old_layout(Layout::TRANSFER_DST_OPTIMAL)
                .new_layout(Layout::SHADER_READ_ONLY_OPTIMAL)
                .src_access_mask(Access::TRANSFER_WRITE)
                .dst_access_mask(Access::SHADER_READ),
            Stage::TRANSFER,
            Stage::COMPUTE_SHADER,
        ),
    };
    // SAFETY: the command buffer is recording; the old layouts are those that earlier commands
    // left.
    unsafe {
        let flags = vk::DependencyFlags::empty();
        device.cmd_pipeline_barrier(commands, from_stage, to_stage, flags, &[], &[], &[barrier]);
    }
}

/// Whole rows of one slice or face of a level, at byte `offset` of a chunk.
#[derive(Clone, Debug, PartialEq)]
struct RowBlock {
    level: u32,
    slice: u32,
    row: u32,
    rows: u32,
    /// The width of the level.
    width: u32,
    height: u32,
    row_bytes: usize,
    offset: usize,
}

impl RowBlock {
    fn bytes(&self) -> usize {
        self.rows as usize * self.row_bytes
    }

    fn end(&self) -> usize {
        self.offset + self.bytes()
    }

    /// Returns the byte offset of the block in the level's texels.
    fn level_offset(&self) -> usize {
        (self.slice as usize * self.height as usize + self.row as usize) * self.row_bytes
    }

    fn region(&self, shape: ImageShape) -> vk::BufferImageCopy {
        let (layer, z) = if shape == ImageShape::Cube { (self.slice, 0) } else { (0, self.slice) };
        vk::BufferImageCopy::default()
            .buffer_offset(self.offset as u64)
            .image_subresource(
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .mip_level(self.level)
                    .base_array_layer(layer)
                    .layer_count(1),
            )
            .image_offset(vk::Offset3D { x: 0, y: self.row as i32, z: z as i32 })
            .image_extent(vk::Extent3D { width: self.width, height: self.rows, depth: 1 })
    }
}

/// Splits all levels into chunks of at most `capacity` bytes without splitting a row.
fn plan(extent: Extent, levels: u32, texel_bytes: usize, capacity: usize) -> Vec<Vec<RowBlock>> {
    let mut chunks = vec![Vec::new()];
    let mut offset = 0;
    let sizes = (0..levels).map(|level| (level, extent.at_level(level)));
    let slices = sizes.flat_map(|(level, size)| (0..size.depth).map(move |slice| (level, slice, size)));
    for (level, slice, Extent { width, height, .. }) in slices {
        let row_bytes = width as usize * texel_bytes;
        let mut row = 0;
        while row < height {
            let room = (capacity.saturating_sub(offset) / row_bytes) as u32;
            if room == 0 && offset > 0 {
                chunks.push(Vec::new());
                offset = 0;
                continue;
            }
            let rows = room.clamp(1, height - row);
            let block = RowBlock { level, slice, row, rows, width, height, row_bytes, offset };
            offset = block.end().next_multiple_of(ALIGNMENT);
            row += rows;
            if let Some(chunk) = chunks.last_mut() {
                chunk.push(block);
            }
        }
    }
    chunks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the plan covers every row of every slice of every level exactly once, within the
    /// capacity, aligned and without overlap.
    fn check(extent: Extent, levels: u32, texel_bytes: usize, capacity: usize) -> usize {
        let chunks = plan(extent, levels, texel_bytes, capacity);
        let mut next = (0, 0, 0);
        for blocks in &chunks {
            let mut free = 0;
            for block in blocks {
                assert_eq!((block.level, block.slice, block.row), next, "rows in order");
                assert!(
                    block.offset >= free && block.offset % ALIGNMENT == 0,
                    "{block:?} overlaps or is not aligned"
                );
                assert!(block.end() <= capacity, "{block:?} is outside of {capacity}");
                free = block.end();
                let size = extent.at_level(block.level);
                let row = block.row + block.rows;
                next = match (row == size.height, block.slice + 1 == size.depth) {
                    (false, _) => (block.level, block.slice, row),
                    (true, false) => (block.level, block.slice + 1, 0),
                    (true, true) => (block.level + 1, 0, 0),
                };
            }
        }
        assert_eq!(next, (levels, 0, 0), "all levels are covered");
        chunks.len()
    }

    fn flat(width: u32, height: u32) -> Extent {
        Extent { shape: ImageShape::Flat, width, height, depth: 1 }
    }

    #[test]
    fn a_small_image_with_all_levels_is_one_chunk() {
        assert_eq!(check(flat(64, 64), 7, 4, STAGING_BYTES), 1);
        assert_eq!(check(flat(5, 3), 3, 1, STAGING_BYTES), 1);
        assert_eq!(
            check(Extent { shape: ImageShape::Volume, width: 5, height: 3, depth: 9 }, 4, 1, STAGING_BYTES),
            1
        );
        assert_eq!(
            check(Extent { shape: ImageShape::Cube, width: 8, height: 8, depth: 6 }, 4, 4, STAGING_BYTES),
            1
        );
    }

    #[test]
    fn a_large_image_is_cut_between_rows() {
        assert_eq!(check(flat(100, 50), 1, 4, 4000), 5);
        assert!(check(flat(37, 91), 7, 16, 4096) > 1);
        assert!(check(flat(1, 1000), 10, 1, 64) > 1);
        assert!(check(Extent { shape: ImageShape::Volume, width: 33, height: 17, depth: 9 }, 6, 4, 999) > 1);
        assert!(check(Extent { shape: ImageShape::Cube, width: 33, height: 33, depth: 6 }, 6, 4, 999) > 1);
    }
}
