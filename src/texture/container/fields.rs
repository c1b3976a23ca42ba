//! Texels that are numbers in a word of one to sixteen bytes. Takes the bits of each channel and stored texels; returns
//! texels in a format of textures. Channels are kept as stored, but for two of integers, which are the x and y of normals.

use super::normal;
use crate::texture::data::{Component, TexelFormat};
use crate::texture::scalar::{NumberKind, Scalar};

/// The meaning of a texel's numbers, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::texture) enum Channels {
    Grey,
    GreyAlpha,
    /// Alpha alone, of white.
    Alpha,
    RedGreen,
    Rgb,
    Rgba,
}

impl Channels {
    /// Returns how many numbers a stored texel has.
    pub const fn count(self) -> usize {
        match self {
            Channels::Grey | Channels::Alpha => 1,
            Channels::GreyAlpha | Channels::RedGreen => 2,
            Channels::Rgb => 3,
            Channels::Rgba => 4,
        }
    }
}

/// The place of each number in a texel's word, which is little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::texture) struct Fields {
    /// The bytes of a texel.
    pub bytes: u8,
    pub kind: NumberKind,
    pub channels: Channels,
    pub shifts: [u8; 4],
    pub bits: [u8; 4],
}

impl Fields {
    /// Returns numbers of one length, one after the other.
    pub const fn even(bits: u8, kind: NumberKind, channels: Channels) -> Fields {
        Fields::packed(kind, channels, [0, bits, 2 * bits, 3 * bits], [bits; 4])
    }

    /// Returns numbers from these bits on, of these lengths, in as few bytes as hold them.
    pub const fn packed(kind: NumberKind, channels: Channels, shifts: [u8; 4], bits: [u8; 4]) -> Fields {
        let (mut end, mut i) = (0, 0);
        while i < channels.count() {
            if shifts[i] + bits[i] > end {
                end = shifts[i] + bits[i];
            }
            i += 1;
        }
        Fields { bytes: end.div_ceil(8), kind, channels, shifts, bits }
    }

    /// Returns the format of decoded texels.
    pub fn texel_format(&self) -> TexelFormat {
        let longest = self.bits[..self.channels.count()].iter().copied().max().unwrap_or(8);
        let component = match (self.kind, self.channels) {
            (NumberKind::Signed, Channels::RedGreen) => Component::Unorm16,
            (kind, _) => Scalar { bits: longest.into(), kind }.component(),
        };
        let channels = match self.channels {
            Channels::Grey => 1,
            Channels::GreyAlpha | Channels::Alpha => 2,
            Channels::RedGreen | Channels::Rgb | Channels::Rgba => 4,
        };
        TexelFormat::new(channels, component)
    }

    /// Decodes a row.
    pub fn decode(&self, stored: &[u8], texels: &mut [u8]) {
        let format = self.texel_format();
        let (component, size) = (format.component(), format.component().bytes());
        let texels = texels.chunks_exact_mut(format.bytes_per_texel());
        for (stored, texel) in stored.chunks_exact(self.bytes.into()).zip(texels) {
            let rgba = self.values(stored);
            let values: &[f64] = match self.channels {
                Channels::Alpha => &[1.0, rgba[0]],
                _ => &rgba[..format.channels()],
            };
            let numbers = texel.chunks_exact_mut(size);
            numbers.zip(values).for_each(|(number, value)| component.store(*value, number));
        }
    }

    /// Returns the numbers of a texel, with 0 for a missing colour and 1 for a missing alpha.
    fn values(&self, stored: &[u8]) -> [f64; 4] {
        let mut word = [0; 16];
        word[..stored.len()].copy_from_slice(stored);
        let word = u128::from_le_bytes(word);
        let mut values = [0.0, 0.0, 0.0, 1.0];
        for (i, value) in values.iter_mut().enumerate().take(self.channels.count()) {
            *value = self.number(word >> self.shifts[i], self.bits[i]);
        }
        match (self.channels, self.kind) {
            (Channels::RedGreen, NumberKind::Unsigned) => normal::with_z([values[0], values[1]]),
            (Channels::RedGreen, NumberKind::Signed) => {
                normal::with_z([values[0], values[1]].map(normal::unsigned))
            }
            _ => values,
        }
    }

    fn number(&self, word: u128, bits: u8) -> f64 {
        let code = (word & ((1 << bits) - 1)) as u64;
        // Floats of 11 and 10 bits are halves without a sign and the last bits.
        let (code, bits) = match (self.kind, bits) {
            (NumberKind::Float, 10..=15) => (code << (15 - bits), 16),
            _ => (code, bits.into()),
        };
        let scalar = Scalar { bits, kind: self.kind };
        scalar.fraction(scalar.number(code))
    }
}

/// Decodes a row of texels of three mantissas of 9 bits, without a leading one, and an exponent of 5 (Vulkan 1.3,
/// "Shared Exponent Format") to four floats.
pub(super) fn decode_shared_exponent(stored: &[u8], texels: &mut [u8]) {
    let stored = stored.as_chunks::<4>().0.iter();
    for (stored, texel) in stored.zip(texels.as_chunks_mut::<16>().0) {
        let word = u32::from_le_bytes(*stored);
        let scale = 2f32.powi((word >> 27) as i32 - 15 - 9);
        let value = |shift: u32| (word >> shift & 0x1ff) as f32 * scale;
        let rgba = [value(0), value(9), value(18), 1.0];
        texel.copy_from_slice(bytemuck::bytes_of(&rgba));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use NumberKind::{Float, Signed, Unsigned};

    fn decoded(fields: Fields, stored: &[u8]) -> Vec<u8> {
        let mut texels = vec![0; fields.texel_format().bytes_per_texel()];
        fields.decode(stored, &mut texels);
        texels
    }

    fn floats(bytes: &[u8]) -> Vec<f32> {
        bytes.as_chunks::<4>().0.iter().map(|b| f32::from_ne_bytes(*b)).collect()
    }

    #[test]
    fn packed_integers_keep_their_fractions() {
        let bgr565 = Fields::packed(Unsigned, Channels::Rgb, [11, 5, 0, 0], [5, 6, 5, 0]);
        assert_eq!(decoded(bgr565, &[0x1f, 0xf8]), [255, 0, 255, 255]);
        let ten = Fields::packed(Unsigned, Channels::Rgba, [0, 10, 20, 30], [10, 10, 10, 2]);
        let word = 1023u32 | 341 << 10 | 1 << 30;
        let codes = [65_535u16, 21_845, 0, 21_845].map(u16::to_ne_bytes).concat();
        assert_eq!(decoded(ten, &word.to_le_bytes()), codes);
        assert_eq!(decoded(Fields::even(8, Unsigned, Channels::Alpha), &[7]), [255, 7]);
    }

    #[test]
    fn small_and_signed_numbers_become_floats() {
        let small = Fields::packed(Float, Channels::Rgb, [0, 11, 22, 0], [11, 11, 10, 0]);
        // 1 is exponent 15, mantissa 0; 3 is 1.5 · 2.
        let word = 15u32 << 6 | (16 << 6 | 32) << 11 | (14 << 5) << 22;
        assert_eq!(floats(&decoded(small, &word.to_le_bytes())), [1.0, 3.0, 0.5, 1.0]);
        assert_eq!(floats(&decoded(Fields::even(8, Signed, Channels::Grey), &[0x81])), [-1.0]);
        let mut texel = [0; 16];
        decode_shared_exponent(&(256u32 | 1 << 9 | 16 << 27).to_le_bytes(), &mut texel);
        assert_eq!(floats(&texel), [1.0, 1.0 / 256.0, 0.0, 1.0]);
    }

    #[test]
    fn two_integers_are_the_x_and_y_of_a_normal() {
        assert_eq!(decoded(Fields::even(8, Unsigned, Channels::RedGreen), &[255, 128])[..2], [255, 128]);
        let tilted = decoded(Fields::even(8, Signed, Channels::RedGreen), &[0, 0]);
        let codes: Vec<u16> = tilted.as_chunks::<2>().0.iter().map(|c| u16::from_ne_bytes(*c)).collect();
        assert_eq!(codes, [32_768, 32_768, 65_535, 65_535]);
    }
}
