//! Sampled images in two and three dimensions and cubes. Creates an optimally tiled image with a
//! view from size, format and levels; `upload` fills it.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::convert;
use super::device::Core;
use super::image_check::{Texels, check};
use super::result::WithOperation;
use crate::core::error::Result;
use crate::core::named::named_enum;

named_enum! {
    /// Channels and component type; unsigned normalized unless float.
    pub enum ImageFormat {
        R8 = "r8",
        Rg8 = "rg8",
        Rgba8 = "rgba8",
        Rgba8Srgb = "rgba8-srgb",
        R16 = "r16",
        Rg16 = "rg16",
        Rgba16 = "rgba16",
        R32f = "r32f",
        Rg32f = "rg32f",
        Rgba32f = "rgba32f",
    }
}

impl ImageFormat {
    pub const fn texel_bytes(self) -> usize {
        match self {
            ImageFormat::R8 => 1,
            ImageFormat::Rg8 | ImageFormat::R16 => 2,
            ImageFormat::Rgba8 | ImageFormat::Rgba8Srgb | ImageFormat::Rg16 | ImageFormat::R32f => 4,
            ImageFormat::Rgba16 | ImageFormat::Rg32f => 8,
            ImageFormat::Rgba32f => 16,
        }
    }
}

named_enum! {
    /// The component mapping with which shaders read the stored channels, by `texture` and by
    /// `texelFetch`. It applies to border colours only where the driver defines that
    /// (VK_EXT_border_color_swizzle): do not rely on border colours with a mapping other than
    /// `Rgba`.
    pub enum Swizzle {
        Rgba = "rgba",
        /// (r, r, r, 1)
        Grey = "grey",
        /// (r, r, r, g)
        GreyAlpha = "grey-alpha",
    }
}

named_enum! {
    pub enum ImageShape {
        /// `sampler2D`
        Flat = "2d",
        /// `sampler3D`
        Volume = "3d",
        /// `samplerCube`, which Vulkan filters across edges and corners
        Cube = "cube",
    }
}

#[derive(Clone, Copy, Debug)]
pub struct ImageDesc<'a> {
    pub name: &'a str,
    pub shape: ImageShape,
    pub width: u32,
    pub height: u32,
    /// Slices of a volume, 6 for a cube, otherwise 1.
    pub depth: u32,
    pub format: ImageFormat,
    pub swizzle: Swizzle,
    /// Tightly packed rows of each mip level, slices or faces one after the other, the full size
    /// first; each next level is half as wide, high and (for a volume) deep, rounded down, at least
    /// 1.
    pub levels: &'a [&'a [u8]],
}

/// A sampled image. Clones share the same Vulkan object.
#[derive(Clone)]
pub struct Image(Arc<RawImage>);

struct RawImage {
    core: Arc<Core>,
    /// Name, size and format for messages: `texture `ground` 1024×1024 rgba8`.
    label: String,
    extent: Extent,
    levels: u32,
    format: ImageFormat,
    handle: vk::Image,
    view: vk::ImageView,
    allocation: Option<Allocation>,
}

impl Image {
    /// Creates an image whose content is undefined until it is uploaded.
    pub(super) fn new(core: &Arc<Core>, desc: &ImageDesc<'_>, texels: &Texels<'_>) -> Result<Image> {
        let extent = Extent { shape: desc.shape, width: desc.width, height: desc.height, depth: desc.depth };
        let label = format!("texture `{}` {extent} {}", desc.name, desc.format);
        check(core, desc, texels, extent, &label)?;
        let mut raw = RawImage {
            core: Arc::clone(core),
            label,
            extent,
            levels: texels.levels() as u32,
            format: desc.format,
            handle: vk::Image::null(),
            view: vk::ImageView::null(),
            allocation: None,
        };
        raw.create_image()?;
        raw.create_view(desc.swizzle)?;
        Ok(Image(Arc::new(raw)))
    }

    pub(super) fn extent(&self) -> Extent {
        self.0.extent
    }

    pub fn levels(&self) -> u32 {
        self.0.levels
    }

    pub fn format(&self) -> ImageFormat {
        self.0.format
    }

    pub(super) fn label(&self) -> &str {
        &self.0.label
    }

    pub(super) fn core(&self) -> &Arc<Core> {
        &self.0.core
    }

    pub(super) fn handle(&self) -> vk::Image {
        self.0.handle
    }

    pub(super) fn view(&self) -> vk::ImageView {
        self.0.view
    }

    pub(super) fn all_levels(&self) -> vk::ImageSubresourceRange {
        self.0.all_levels()
    }
}

/// The shape and size of an image or of one of its levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    pub shape: ImageShape,
    pub width: u32,
    pub height: u32,
    /// The number of slices or faces.
    pub depth: u32,
}

impl Extent {
    /// Returns the size of a level: halved and rounded down, at least 1, while faces stay six
    /// (Vulkan 1.2, "Image Miplevel Sizing").
    pub(super) fn at_level(self, level: u32) -> Extent {
        let half = |size: u32| size.checked_shr(level).unwrap_or(0).max(1);
        let depth = if self.shape == ImageShape::Volume { half(self.depth) } else { self.depth };
        Extent { width: half(self.width), height: half(self.height), depth, ..self }
    }

    pub(super) fn layers(self) -> u32 {
        if self.shape == ImageShape::Cube { 6 } else { 1 }
    }

    pub(super) fn longest(self) -> u32 {
        let depth = if self.shape == ImageShape::Volume { self.depth } else { 1 };
        self.width.max(self.height).max(depth)
    }
}

impl std::fmt::Display for Extent {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}×{}", self.width, self.height)?;
        if self.depth == 1 { Ok(()) } else { write!(f, "×{}", self.depth) }
    }
}

impl RawImage {
    fn create_image(&mut self) -> Result<()> {
        let (image_type, _, flags) = convert::shape(self.extent.shape);
        let depth = self.extent.depth / self.extent.layers();
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(image_type)
            .format(convert::format(self.format))
            .extent(vk::Extent3D { width: self.extent.width, height: self.extent.height, depth })
            .mip_levels(self.levels)
            .array_layers(self.extent.layers())
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST)
            .sharing_mode(vk::SharingMode::EXCLUSIVE)
            .initial_layout(vk::ImageLayout::UNDEFINED);
        let device = &self.core.device;
        // SAFETY: size, level count and format were checked against the device.
        self.handle =
            unsafe { device.create_image(&info, None) }.during(|| format!("creating {}", self.label))?;
        self.core.set_name(self.handle, || self.label.clone());
        // SAFETY: the handle was created just now.
        let requirements = unsafe { device.get_image_memory_requirements(self.handle) };
        let memory = self.core.memory.allocate(&self.label, requirements, MemoryLocation::GpuOnly, false)?;
        let memory = self.allocation.insert(memory);
        // SAFETY: memory of the required size, type and alignment, bound once, and freed after the
        // image is destroyed.
        unsafe { device.bind_image_memory(self.handle, memory.memory(), memory.offset()) }
            .during(|| format!("binding memory to {}", self.label))
    }

    fn create_view(&mut self, swizzle: Swizzle) -> Result<()> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.handle)
            .view_type(convert::shape(self.extent.shape).1)
            .format(convert::format(self.format))
            .components(convert::swizzle(swizzle))
            .subresource_range(self.all_levels());
        // SAFETY: the image has memory, and the view has its format and levels.
        self.view = unsafe { self.core.device.create_image_view(&info, None) }
            .during(|| format!("creating the view of {}", self.label))?;
        self.core.set_name(self.view, || format!("view of {}", self.label));
        Ok(())
    }

    fn all_levels(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .level_count(self.levels)
            .layer_count(self.extent.layers())
    }
}

impl Drop for RawImage {
    fn drop(&mut self) {
        self.core.release(|device| {
            // SAFETY: calls are synchronous, so the device does not use the image; null handles
            // are allowed.
            unsafe {
                device.destroy_image_view(self.view, None);
                device.destroy_image(self.handle, None);
            }
            if let Some(allocation) = self.allocation.take() {
                self.core.memory.free(allocation);
            }
        });
    }
}
