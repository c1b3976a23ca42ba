//! Formats of texels in DDS files of Direct3D 9. Takes the words of a header; returns the format that its four letters,
//! its number or its bit masks name, or a refusal by that name.

use super::dds::{Refusal, Words};
use super::fields::{Channels, Fields};
use super::pixel_format::{Layout, PixelFormat};
use crate::texture::scalar::NumberKind;

/// Flags of a format.
const HAS_ALPHA: u32 = 1;
const IS_ALPHA: u32 = 2;
const HAS_LETTERS: u32 = 4;
const IS_RGB: u32 = 0x40;
const IS_LUMINANCE: u32 = 0x2_0000;

/// Four letters or a number of Direct3D 9, and the number in DXGI of the same format.
const LETTERS: &[([u8; 4], u32)] = &[
    (*b"DXT1", 71),
    (*b"DXT2", 74),
    (*b"DXT3", 74),
    (*b"DXT4", 77),
    (*b"DXT5", 77),
    (*b"ATI1", 80),
    (*b"BC4U", 80),
    (*b"BC4S", 81),
    (*b"ATI2", 83),
    (*b"BC5U", 83),
    (*b"BC5S", 84),
    (36u32.to_le_bytes(), 11),
    (110u32.to_le_bytes(), 13),
    (111u32.to_le_bytes(), 54),
    (112u32.to_le_bytes(), 34),
    (113u32.to_le_bytes(), 10),
    (114u32.to_le_bytes(), 41),
    (115u32.to_le_bytes(), 16),
    (116u32.to_le_bytes(), 2),
];

/// Returns the format, and true if its colours are multiplied by alpha.
pub(super) fn format(words: Words<'_>) -> Result<(PixelFormat, bool), Refusal> {
    let (flags, letters) = (words.get(20), words.get(21).to_le_bytes());
    if flags & HAS_LETTERS == 0 {
        return masks(flags, words).map(|format| (format, false));
    }
    let known = LETTERS.iter().find(|(known, _)| *known == letters);
    let format = known.and_then(|(_, dxgi)| PixelFormat::of_dxgi(*dxgi));
    let is_premultiplied = [*b"DXT2", *b"DXT4"].contains(&letters);
    match format {
        Some(format) => Ok((format, is_premultiplied)),
        None if letters.iter().all(u8::is_ascii_graphic) => Err(Refusal::Kind(format!(
            "of the format {}",
            letters.map(char::from).iter().collect::<String>()
        ))),
        None => Err(Refusal::Kind(format!("of Direct3D format {}", u32::from_le_bytes(letters)))),
    }
}

/// Returns the format whose channels lie where the masks say.
fn masks(flags: u32, words: Words<'_>) -> Result<PixelFormat, Refusal> {
    let bit_count = words.get(22);
    let [red, green, blue, alpha] = [23, 24, 25, 26].map(|index| words.get(index));
    let has_alpha = flags & HAS_ALPHA != 0 && alpha != 0;
    let (channels, masks) = match (flags & (IS_RGB | IS_LUMINANCE | IS_ALPHA), has_alpha) {
        (IS_RGB, true) => (Channels::Rgba, [red, green, blue, alpha]),
        (IS_RGB, false) if green == 0 && blue == 0 => (Channels::Grey, [red, 0, 0, 0]),
        (IS_RGB, false) => (Channels::Rgb, [red, green, blue, 0]),
        (IS_LUMINANCE, true) => (Channels::GreyAlpha, [red, alpha, 0, 0]),
        (IS_LUMINANCE, false) => (Channels::Grey, [red, 0, 0, 0]),
        (IS_ALPHA, _) => (Channels::Alpha, [alpha, 0, 0, 0]),
        _ => return Err(Refusal::Kind(format!("with format flags {flags:#x}"))),
    };
    let used = &masks[..channels.count()];
    let is_run = |mask: u32| mask != 0 && (mask >> mask.trailing_zeros()).wrapping_add(1).is_power_of_two();
    let fits = |mask: u32| bit_count == 32 || mask >> bit_count == 0;
    if ![8, 16, 24, 32].contains(&bit_count)
        || !used.iter().all(|&mask| (is_run(mask) || mask == u32::MAX) && fits(mask))
    {
        return Err(Refusal::Kind(format!(
            "of {bit_count} bits with masks {red:x}, {green:x}, {blue:x}, {alpha:x}"
        )));
    }
    let shifts = masks.map(|mask| if mask == 0 { 0 } else { mask.trailing_zeros() as u8 });
    let bits = masks.map(|mask| mask.count_ones() as u8);
    let fields = Fields { bytes: (bit_count / 8) as u8, kind: NumberKind::Unsigned, channels, shifts, bits };
    Ok(PixelFormat { name: name(channels), layout: Layout::Fields(fields), is_srgb: false })
}

fn name(channels: Channels) -> &'static str {
    match channels {
        Channels::Grey => "luminance",
        Channels::GreyAlpha => "luminance and alpha",
        Channels::Alpha => "alpha",
        Channels::RedGreen => "RG",
        Channels::Rgb => "RGB",
        Channels::Rgba => "RGBA",
    }
}

#[cfg(test)]
mod tests {
    use super::super::blocks::Block;
    use super::*;

    #[test]
    fn every_name_of_direct3d_9_has_a_format() {
        for (letters, dxgi) in LETTERS {
            assert!(PixelFormat::of_dxgi(*dxgi).is_some(), "{letters:?}");
        }
        assert!(matches!(
            PixelFormat::of_dxgi(71).map(|f| f.layout),
            Some(Layout::Blocks(Block::Bc1 { .. }))
        ));
    }
}
