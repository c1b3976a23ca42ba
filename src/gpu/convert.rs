//! Conversions from this crate's types to Vulkan's enums and back. No other file pairs the two.

use ash::vk;

use super::buffer::BufferUse;
use super::descriptor::BindingKind;
use super::image::{ImageFormat, ImageShape, Swizzle};
use super::info::DeviceKind;
use crate::texture::sampler_spec::{Address, Filter, MipMode};

pub(super) fn kind(kind: vk::PhysicalDeviceType) -> DeviceKind {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
        vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
        vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
        vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
        _ => DeviceKind::Other,
    }
}

pub(super) fn format(format: ImageFormat) -> vk::Format {
    match format {
        ImageFormat::R8 => vk::Format::R8_UNORM,
        ImageFormat::Rg8 => vk::Format::R8G8_UNORM,
        ImageFormat::Rgba8 => vk::Format::R8G8B8A8_UNORM,
        ImageFormat::Rgba8Srgb => vk::Format::R8G8B8A8_SRGB,
        ImageFormat::R16 => vk::Format::R16_UNORM,
        ImageFormat::Rg16 => vk::Format::R16G16_UNORM,
        ImageFormat::Rgba16 => vk::Format::R16G16B16A16_UNORM,
        ImageFormat::R32f => vk::Format::R32_SFLOAT,
        ImageFormat::Rg32f => vk::Format::R32G32_SFLOAT,
        ImageFormat::Rgba32f => vk::Format::R32G32B32A32_SFLOAT,
    }
}

/// Returns image type, view type and create flags. A cube is a 2D image of six layers.
pub(super) fn shape(shape: ImageShape) -> (vk::ImageType, vk::ImageViewType, vk::ImageCreateFlags) {
    let none = vk::ImageCreateFlags::empty();
    match shape {
        ImageShape::Flat => (vk::ImageType::TYPE_2D, vk::ImageViewType::TYPE_2D, none),
        ImageShape::Volume => (vk::ImageType::TYPE_3D, vk::ImageViewType::TYPE_3D, none),
        ImageShape::Cube => {
            (vk::ImageType::TYPE_2D, vk::ImageViewType::CUBE, vk::ImageCreateFlags::CUBE_COMPATIBLE)
        }
    }
}

pub(super) fn swizzle(swizzle: Swizzle) -> vk::ComponentMapping {
    use vk::ComponentSwizzle as C;
    let [r, g, b, a] = match swizzle {
        Swizzle::Rgba => [C::IDENTITY; 4],
        Swizzle::Grey => [C::R, C::R, C::R, C::ONE],
        Swizzle::GreyAlpha => [C::R, C::R, C::R, C::G],
    };
    vk::ComponentMapping { r, g, b, a }
}

pub(super) fn buffer_usage(usage: BufferUse) -> vk::BufferUsageFlags {
    match usage {
        BufferUse::Storage => vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::UNIFORM_BUFFER,
        BufferUse::TexelUint | BufferUse::TexelUint4 => vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER,
    }
}

pub(super) fn descriptor(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::TexelBuffer => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
        BindingKind::SampledImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
    }
}

pub(super) fn address(address: Address) -> vk::SamplerAddressMode {
    match address {
        Address::Repeat => vk::SamplerAddressMode::REPEAT,
        Address::MirroredRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
        Address::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        Address::ClampToBorder => vk::SamplerAddressMode::CLAMP_TO_BORDER,
        Address::MirrorClampToEdge => vk::SamplerAddressMode::MIRROR_CLAMP_TO_EDGE,
    }
}

pub(super) fn filter(filter: Filter) -> vk::Filter {
    match filter {
        Filter::Nearest => vk::Filter::NEAREST,
        // Anisotropy is a sampler state beside the filter; the remaining filters were refused
        // earlier.
        _ => vk::Filter::LINEAR,
    }
}

/// Returns mip mode and largest level of detail. Without mips the level is clamped to 1/4, not to
/// 0: it still rounds to level 0, and the minification filter stays reachable (Vulkan 1.2,
/// `VkSamplerCreateInfo`, "Mapping of OpenGL to Vulkan filter modes").
pub(super) fn mip(mip: MipMode) -> (vk::SamplerMipmapMode, f32) {
    match mip {
        MipMode::None => (vk::SamplerMipmapMode::NEAREST, 0.25),
        MipMode::Nearest => (vk::SamplerMipmapMode::NEAREST, vk::LOD_CLAMP_NONE),
        MipMode::Linear => (vk::SamplerMipmapMode::LINEAR, vk::LOD_CLAMP_NONE),
    }
}

/// Returns a custom border colour unless the colour equals one of the three standard ones exactly.
pub(super) fn border_color(color: [f32; 4]) -> vk::BorderColor {
    match color {
        [0.0, 0.0, 0.0, 0.0] => vk::BorderColor::FLOAT_TRANSPARENT_BLACK,
        [0.0, 0.0, 0.0, 1.0] => vk::BorderColor::FLOAT_OPAQUE_BLACK,
        [1.0, 1.0, 1.0, 1.0] => vk::BorderColor::FLOAT_OPAQUE_WHITE,
        _ => vk::BorderColor::FLOAT_CUSTOM_EXT,
    }
}
