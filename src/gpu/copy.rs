//! Copies on the device: bytes of one buffer into another, or into all levels of an image.

use ash::vk;

use super::buffer::Buffer;
use super::command::Commands;
use super::image::Image;
use super::upload::{Transition, transition};
use crate::core::error::{Error, Result};

pub(super) fn to_buffer(
    commands: &mut Commands,
    from: &Buffer,
    start: u64,
    to: &Buffer,
    at: u64,
    bytes: u64,
) -> Result<()> {
    from.check_range(start, bytes as usize)?;
    to.check_range(at, bytes as usize)?;
    if bytes == 0 || from.handle() == to.handle() {
        let reason = if bytes == 0 { "no bytes" } else { "onto itself" };
        return Err(Error::new(format!("copying buffer `{}` to `{}`: {reason}", from.name(), to.name())));
    }
    let region = vk::BufferCopy { src_offset: start, dst_offset: at, size: bytes };
    commands.run(to.name(), |device, commands| {
        // SAFETY: both ranges were checked and lie in different buffers.
        unsafe { device.cmd_copy_buffer(commands, from.handle(), to.handle(), &[region]) };
    })?;
    Ok(())
}

/// Fills all levels of an image. Ranges and alignment were checked when the image was created.
pub(super) fn to_image(commands: &mut Commands, image: &Image, from: &Buffer, starts: &[u64]) -> Result<()> {
    let regions: Vec<vk::BufferImageCopy> =
        (0..).zip(starts).map(|(level, &start)| region(image, level, start)).collect();
    commands.run(image.label(), |device, commands| {
        transition(device, commands, image, Transition::ToTransfer);
        // SAFETY: the regions lie in the buffer and are whole levels of the image, which are in the
        // layout for transfers.
        unsafe {
            let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            device.cmd_copy_buffer_to_image(commands, from.handle(), image.handle(), layout, &regions);
        }
        transition(device, commands, image, Transition::ToShader);
    })?;
    Ok(())
}

/// Returns the region of a whole level with all its slices or faces, tightly packed.
fn region(image: &Image, level: u32, start: u64) -> vk::BufferImageCopy {
    let size = image.extent().at_level(level);
    let depth = size.depth / size.layers();
    vk::BufferImageCopy::default()
        .buffer_offset(start)
        .image_subresource(
            vk::ImageSubresourceLayers::default()
                .aspect_mask(vk::ImageAspectFlags::COLOR)
                .mip_level(level)
                .layer_count(size.layers()),
        )
        .image_extent(vk::Extent3D { width: size.width, height: size.height, depth })
}
