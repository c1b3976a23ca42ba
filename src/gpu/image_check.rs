//! The preconditions of creating an image. Checks its description and the source of its texels
//! against the device's limits; errors name the image.

use super::buffer::Buffer;
use super::device::Core;
use super::image::{Extent, ImageDesc, ImageFormat, ImageShape};
use crate::core::error::{Error, Result};

/// The source of an image's texels.
pub(super) enum Texels<'a> {
    Host(&'a [&'a [u8]]),
    /// A buffer and the byte offset of each level.
    Device(&'a Buffer, &'a [u64]),
}

impl Texels<'_> {
    pub fn levels(&self) -> usize {
        match self {
            Texels::Host(levels) => levels.len(),
            Texels::Device(_, starts) => starts.len(),
        }
    }

    /// Checks that a level has exactly the bytes of its size and, in a buffer, begins at a multiple
    /// of the texel size and of 4 (Vulkan 1.2, "Copying Data Between Buffers and Images").
    fn check(
        &self,
        level: usize,
        size: Extent,
        bytes: usize,
        format: ImageFormat,
        label: &str,
    ) -> Result<()> {
        match *self {
            Texels::Host(levels) if levels[level].len() != bytes => Err(Error::new(format!(
                "level {level} of {label} has {} bytes of texels; {size} take {bytes}",
                levels[level].len()
            ))),
            Texels::Host(_) => Ok(()),
            Texels::Device(_, starts) if starts[level] % format.texel_bytes().max(4) as u64 != 0 => {
                Err(Error::new(format!(
                    "level {level} of {label} begins at byte {}, inside a texel or word",
                    starts[level]
                )))
            }
            Texels::Device(buffer, starts) => buffer.check_range(starts[level], bytes),
        }
    }
}

pub(super) fn check(
    core: &Core,
    desc: &ImageDesc<'_>,
    texels: &Texels<'_>,
    extent: Extent,
    label: &str,
) -> Result<()> {
    if desc.width == 0 || desc.height == 0 || desc.depth == 0 {
        return Err(Error::new(format!("{label} has no texels")));
    }
    let limits = &core.info.limits;
    let (limit, fits, reason) = match desc.shape {
        ImageShape::Flat => (limits.max_image_2d, desc.depth == 1, "2D images have one slice"),
        ImageShape::Volume => (limits.max_image_3d, true, ""),
        ImageShape::Cube => {
            let square = desc.width == desc.height && desc.depth == 6;
            (limits.max_image_cube, square, "cubes have six square faces")
        }
    };
    if !fits {
        return Err(Error::new(format!("{label}: {reason}")));
    }
    if extent.longest() > limit {
        let limit_text = match desc.shape {
            ImageShape::Flat => format!("images there have at most {limit}×{limit} texels"),
            ImageShape::Volume => format!("3D images there have at most {limit}×{limit}×{limit} texels"),
            ImageShape::Cube => format!("faces of cubes there have at most {limit}×{limit} texels"),
        };
        return Err(Error::with_help(
            format!("{label} is too large for {}: {limit_text}", core.info.name),
            "Scale the texture down, use method = \"shader\" with --texels auto or buffer, or another device.",
        ));
    }
    if !core.supports(desc.format, false) {
        return Err(Error::with_help(
            format!("{label}: {} cannot sample images of this format", core.info.name),
            "Use method = \"shader\", or a texture with other channels or another component type.",
        ));
    }
    let max_levels = u32::BITS - extent.longest().leading_zeros();
    let levels = texels.levels();
    if levels == 0 || levels > max_levels as usize {
        return Err(Error::new(format!("{label} has {levels} levels; it can have 1 to {max_levels}")));
    }
    let mut total = 0;
    for level in 0..levels {
        let size = extent.at_level(level as u32);
        let count = size.width as usize * size.height as usize * size.depth as usize;
        let bytes = count * desc.format.texel_bytes();
        texels.check(level, size, bytes, desc.format, label)?;
        total += bytes as u64;
    }
    core.memory.check_heap(label, total)
}
