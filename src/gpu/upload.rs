//! Host to device: in go bytes or texels, out come filled buffers and images, ready for shaders.
//! Everything goes through the staging buffer, chunk by chunk; small mip levels share a chunk.

use ash::vk;

use super::buffer::Buffer;
use super::command::Commands;
use super::image::{Extent, Image, ImageShape};
use super::staging::{CHUNK, Staging};
use crate::core::error::Result;

/// Copies in a chunk start at multiples of this: the largest texel (Vulkan 1.2, "Copying Data
/// Between Buffers and Images": a multiple of the texel size, and of 4).
const ALIGNMENT: usize = 16;

pub(super) fn to_buffer(
    staging: &mut Staging,
    commands: &mut Commands,
    buffer: &Buffer,
    offset: u64,
    data: &[u8],
) -> Result<()> {
    buffer.check_range(offset, data.len())?;
    let mut dst_offset = offset;
    for chunk in data.chunks(CHUNK) {
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

/// The levels' sizes were checked when the image was created.
pub(super) fn to_image(
    staging: &mut Staging,
    commands: &mut Commands,
    image: &Image,
    levels: &[&[u8]],
) -> Result<()> {
    let texel_bytes = image.format().texel_bytes();
    let extent = image.extent();
    let chunks = plan(extent, image.levels(), texel_bytes, CHUNK);
    for (index, pieces) in chunks.iter().enumerate() {
        let bytes = pieces.last().map_or(0, Piece::end);
        let source = staging.get(bytes)?;
        let mapped = source.mapped()?;
        for piece in pieces {
            let from = piece.from();
            mapped[piece.at..piece.end()]
                .copy_from_slice(&levels[piece.level as usize][from..from + piece.bytes()]);
        }
        let source = source.handle();
        let regions: Vec<vk::BufferImageCopy> =
            pieces.iter().map(|piece| piece.region(extent.shape)).collect();
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
    // SAFETY: the command buffer is recording; old layouts are what earlier commands left.
    unsafe {
        let flags = vk::DependencyFlags::empty();
        device.cmd_pipeline_barrier(commands, from_stage, to_stage, flags, &[], &[], &[barrier]);
    }
}

/// Whole rows of one slice or face of a level, at byte `at` of a chunk.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    level: u32,
    slice: u32,
    row: u32,
    rows: u32,
    /// Of the level.
    width: u32,
    height: u32,
    row_bytes: usize,
    at: usize,
}

impl Piece {
    fn bytes(&self) -> usize {
        self.rows as usize * self.row_bytes
    }

    fn end(&self) -> usize {
        self.at + self.bytes()
    }

    /// Where in the level's texels it begins.
    fn from(&self) -> usize {
        (self.slice as usize * self.height as usize + self.row as usize) * self.row_bytes
    }

    fn region(&self, shape: ImageShape) -> vk::BufferImageCopy {
        let (layer, z) = if shape == ImageShape::Cube { (self.slice, 0) } else { (0, self.slice) };
        vk::BufferImageCopy::default()
            .buffer_offset(self.at as u64)
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

/// Cuts all levels into chunks of at most `capacity` bytes; a row is never cut.
fn plan(extent: Extent, levels: u32, texel_bytes: usize, capacity: usize) -> Vec<Vec<Piece>> {
    let mut chunks = vec![Vec::new()];
    let mut at = 0;
    let sizes = (0..levels).map(|level| (level, extent.at_level(level)));
    let slices = sizes.flat_map(|(level, size)| (0..size.depth).map(move |slice| (level, slice, size)));
    for (level, slice, Extent { width, height, .. }) in slices {
        let row_bytes = width as usize * texel_bytes;
        let mut row = 0;
        while row < height {
            let room = (capacity.saturating_sub(at) / row_bytes) as u32;
            if room == 0 && at > 0 {
                chunks.push(Vec::new());
                at = 0;
                continue;
            }
            let rows = room.clamp(1, height - row);
            let piece = Piece { level, slice, row, rows, width, height, row_bytes, at };
            at = piece.end().next_multiple_of(ALIGNMENT);
            row += rows;
            if let Some(chunk) = chunks.last_mut() {
                chunk.push(piece);
            }
        }
    }
    chunks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every row of every slice of every level once, inside the capacity, aligned, without overlap.
    fn check(extent: Extent, levels: u32, texel_bytes: usize, capacity: usize) -> usize {
        let chunks = plan(extent, levels, texel_bytes, capacity);
        let mut next = (0, 0, 0);
        for pieces in &chunks {
            let mut free = 0;
            for piece in pieces {
                assert_eq!((piece.level, piece.slice, piece.row), next, "rows in order");
                assert!(
                    piece.at >= free && piece.at % ALIGNMENT == 0,
                    "{piece:?} overlaps or is not aligned"
                );
                assert!(piece.end() <= capacity, "{piece:?} is outside of {capacity}");
                free = piece.end();
                let size = extent.at_level(piece.level);
                let row = piece.row + piece.rows;
                next = match (row == size.height, piece.slice + 1 == size.depth) {
                    (false, _) => (piece.level, piece.slice, row),
                    (true, false) => (piece.level, piece.slice + 1, 0),
                    (true, true) => (piece.level + 1, 0, 0),
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
        assert_eq!(check(flat(64, 64), 7, 4, CHUNK), 1);
        assert_eq!(check(flat(5, 3), 3, 1, CHUNK), 1);
        assert_eq!(
            check(Extent { shape: ImageShape::Volume, width: 5, height: 3, depth: 9 }, 4, 1, CHUNK),
            1
        );
        assert_eq!(check(Extent { shape: ImageShape::Cube, width: 8, height: 8, depth: 6 }, 4, 4, CHUNK), 1);
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
