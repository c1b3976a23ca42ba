//! The formats of texels in DDS and KTX2 files. Holds one table of their names, their numbers in DXGI and in Vulkan, and
//! their layouts; a number that is in no row is a format that is not read.

use super::blocks::Block;
use super::fields::{Channels, Fields};
use crate::texture::scalar::NumberKind::{self, Float, Signed, Unsigned};

/// A format of texels in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::texture) struct PixelFormat {
    /// The name in DXGI, or in Vulkan where DXGI has none; both say the same of the order of bytes.
    pub name: &'static str,
    pub layout: Layout,
    /// True if the format itself says that colours are sRGB codes.
    pub is_srgb: bool,
}

/// How texels are stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::texture) enum Layout {
    /// Blocks of 4 × 4 texels.
    Blocks(Block),
    /// One texel after the other, each of several numbers.
    Fields(Fields),
    /// Three numbers of 9 bits with one exponent of 5.
    SharedExponent,
}

/// A row of the table; 0 stands for a number that the other list does not have.
struct Row {
    dxgi: u32,
    vulkan: u32,
    format: PixelFormat,
}

const fn row(dxgi: u32, vulkan: u32, name: &'static str, layout: Layout) -> Row {
    Row { dxgi, vulkan, format: PixelFormat { name, layout, is_srgb: false } }
}

const fn srgb(dxgi: u32, vulkan: u32, name: &'static str, layout: Layout) -> Row {
    Row { dxgi, vulkan, format: PixelFormat { name, layout, is_srgb: true } }
}

/// Numbers of equal length in the order of channels.
const fn even(bits: u8, kind: NumberKind, channels: Channels) -> Layout {
    Layout::Fields(Fields::even(bits, kind, channels))
}

/// Numbers from these bits on, of these lengths.
const fn packed(kind: NumberKind, channels: Channels, shifts: [u8; 4], bits: [u8; 4]) -> Layout {
    Layout::Fields(Fields::packed(kind, channels, shifts, bits))
}

const fn blocks(block: Block) -> Layout {
    Layout::Blocks(block)
}

use Channels::{Alpha, Grey, RedGreen, Rgb, Rgba};

const BGRA: Layout = packed(Unsigned, Rgba, [16, 8, 0, 24], [8; 4]);
const BGR: Layout = packed(Unsigned, Rgb, [16, 8, 0, 0], [8, 8, 8, 0]);
const BGRX: Layout =
    Layout::Fields(Fields { bytes: 4, ..Fields::packed(Unsigned, Rgb, [16, 8, 0, 0], [8, 8, 8, 0]) });

const TABLE: &[Row] = &[
    row(61, 9, "R8_UNORM", even(8, Unsigned, Grey)),
    srgb(0, 15, "R8_SRGB", even(8, Unsigned, Grey)),
    row(63, 10, "R8_SNORM", even(8, Signed, Grey)),
    row(65, 0, "A8_UNORM", even(8, Unsigned, Alpha)),
    row(49, 16, "R8G8_UNORM", even(8, Unsigned, RedGreen)),
    srgb(0, 22, "R8G8_SRGB", even(8, Unsigned, RedGreen)),
    row(51, 17, "R8G8_SNORM", even(8, Signed, RedGreen)),
    row(0, 23, "R8G8B8_UNORM", even(8, Unsigned, Rgb)),
    srgb(0, 29, "R8G8B8_SRGB", even(8, Unsigned, Rgb)),
    row(0, 30, "B8G8R8_UNORM", BGR),
    srgb(0, 36, "B8G8R8_SRGB", BGR),
    row(28, 37, "R8G8B8A8_UNORM", even(8, Unsigned, Rgba)),
    srgb(29, 43, "R8G8B8A8_UNORM_SRGB", even(8, Unsigned, Rgba)),
    row(31, 38, "R8G8B8A8_SNORM", even(8, Signed, Rgba)),
    row(87, 44, "B8G8R8A8_UNORM", BGRA),
    srgb(91, 50, "B8G8R8A8_UNORM_SRGB", BGRA),
    row(88, 0, "B8G8R8X8_UNORM", BGRX),
    srgb(93, 0, "B8G8R8X8_UNORM_SRGB", BGRX),
    row(85, 4, "B5G6R5_UNORM", packed(Unsigned, Rgb, [11, 5, 0, 0], [5, 6, 5, 0])),
    row(86, 8, "B5G5R5A1_UNORM", packed(Unsigned, Rgba, [10, 5, 0, 15], [5, 5, 5, 1])),
    row(115, 1_000_340_000, "B4G4R4A4_UNORM", packed(Unsigned, Rgba, [8, 4, 0, 12], [4; 4])),
    row(24, 64, "R10G10B10A2_UNORM", packed(Unsigned, Rgba, [0, 10, 20, 30], [10, 10, 10, 2])),
    row(56, 70, "R16_UNORM", even(16, Unsigned, Grey)),
    row(58, 71, "R16_SNORM", even(16, Signed, Grey)),
    row(54, 76, "R16_FLOAT", even(16, Float, Grey)),
    row(35, 77, "R16G16_UNORM", even(16, Unsigned, RedGreen)),
    row(37, 78, "R16G16_SNORM", even(16, Signed, RedGreen)),
    row(34, 83, "R16G16_FLOAT", even(16, Float, RedGreen)),
    row(0, 84, "R16G16B16_UNORM", even(16, Unsigned, Rgb)),
    row(0, 90, "R16G16B16_FLOAT", even(16, Float, Rgb)),
    row(11, 91, "R16G16B16A16_UNORM", even(16, Unsigned, Rgba)),
    row(13, 92, "R16G16B16A16_SNORM", even(16, Signed, Rgba)),
    row(10, 97, "R16G16B16A16_FLOAT", even(16, Float, Rgba)),
    row(41, 100, "R32_FLOAT", even(32, Float, Grey)),
    row(16, 103, "R32G32_FLOAT", even(32, Float, RedGreen)),
    row(6, 106, "R32G32B32_FLOAT", even(32, Float, Rgb)),
    row(2, 109, "R32G32B32A32_FLOAT", even(32, Float, Rgba)),
    row(26, 122, "R11G11B10_FLOAT", packed(Float, Rgb, [0, 11, 22, 0], [11, 11, 10, 0])),
    row(67, 123, "R9G9B9E5_SHAREDEXP", Layout::SharedExponent),
    row(0, 131, "BC1_RGB_UNORM", blocks(Block::Bc1 { has_alpha: false })),
    srgb(0, 132, "BC1_RGB_UNORM_SRGB", blocks(Block::Bc1 { has_alpha: false })),
    row(71, 133, "BC1_UNORM", blocks(Block::Bc1 { has_alpha: true })),
    srgb(72, 134, "BC1_UNORM_SRGB", blocks(Block::Bc1 { has_alpha: true })),
    row(74, 135, "BC2_UNORM", blocks(Block::Bc2)),
    srgb(75, 136, "BC2_UNORM_SRGB", blocks(Block::Bc2)),
    row(77, 137, "BC3_UNORM", blocks(Block::Bc3)),
    srgb(78, 138, "BC3_UNORM_SRGB", blocks(Block::Bc3)),
    row(80, 139, "BC4_UNORM", blocks(Block::Bc4 { is_signed: false })),
    row(81, 140, "BC4_SNORM", blocks(Block::Bc4 { is_signed: true })),
    row(83, 141, "BC5_UNORM", blocks(Block::Bc5 { is_signed: false })),
    row(84, 142, "BC5_SNORM", blocks(Block::Bc5 { is_signed: true })),
    row(95, 143, "BC6H_UF16", blocks(Block::Bc6h { is_signed: false })),
    row(96, 144, "BC6H_SF16", blocks(Block::Bc6h { is_signed: true })),
    row(98, 145, "BC7_UNORM", blocks(Block::Bc7)),
    srgb(99, 146, "BC7_UNORM_SRGB", blocks(Block::Bc7)),
];

impl PixelFormat {
    /// Returns the format of this number in DXGI.
    pub fn of_dxgi(number: u32) -> Option<PixelFormat> {
        TABLE.iter().find(|row| row.dxgi == number && number != 0).map(|row| row.format)
    }

    /// Returns the format of this number in Vulkan.
    pub fn of_vulkan(number: u32) -> Option<PixelFormat> {
        TABLE.iter().find(|row| row.vulkan == number && number != 0).map(|row| row.format)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_stands_for_two_formats() {
        for (i, a) in TABLE.iter().enumerate() {
            for b in &TABLE[i + 1..] {
                assert!(a.dxgi != b.dxgi || a.dxgi == 0, "{} {}", a.format.name, b.format.name);
                assert!(a.vulkan != b.vulkan || a.vulkan == 0, "{} {}", a.format.name, b.format.name);
                assert_ne!(a.format.name, b.format.name);
            }
        }
    }

    #[test]
    fn names_say_whether_a_format_is_srgb() {
        assert!(TABLE.iter().all(|row| row.format.is_srgb == row.format.name.ends_with("_SRGB")));
    }
}
