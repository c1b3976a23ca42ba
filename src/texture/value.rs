//! One texel as numbers in f64: stored value, linear light, and the four channels that a lookup
//! returns. Tests compare packed and uploaded texels with these values.

use rayon::prelude::*;

use super::data::{ColorSpace, Component, TexelFormat, TextureData};
use crate::core::color::srgb_to_linear;

impl TextureData {
    /// Returns the stored value of one of the format's own channels: integers scaled to [0, 1] by
    /// 2ⁿ − 1 (Vulkan 1.3, 3.10.1), floats unchanged.
    ///
    /// Rows are counted through all slices and faces: row y of slice z is `y + height · z`.
    ///
    /// Panics if the texel or the channel does not exist.
    pub fn value(&self, x: u32, y: u32, channel: usize) -> f64 {
        assert!(x < self.width && y < self.height * self.depth && channel < self.format.channels());
        let texel = y as usize * self.width as usize + x as usize;
        let index = texel * self.format.channels() + channel;
        let bytes = &self.texels;
        match self.format.component() {
            Component::Unorm8 => f64::from(bytes[index]) / 255.0,
            Component::Unorm16 => {
                let at = index * 2;
                f64::from(u16::from_ne_bytes([bytes[at], bytes[at + 1]])) / 65_535.0
            }
            Component::Float32 => {
                let at = index * 4;
                let value = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
                f64::from(f32::from_ne_bytes(value))
            }
        }
    }

    /// Returns all values of a row, as [`value`](Self::value) does each.
    ///
    /// Panics if there is no such row.
    pub fn row_values(&self, y: usize) -> Vec<f64> {
        let length = self.width as usize * self.format.bytes_per_texel();
        let row = &self.texels[y * length..][..length];
        match self.format.component() {
            Component::Unorm8 => row.iter().map(|byte| f64::from(*byte) / 255.0).collect(),
            Component::Unorm16 => {
                row.as_chunks().0.iter().map(|two| f64::from(u16::from_ne_bytes(*two)) / 65_535.0).collect()
            }
            Component::Float32 => {
                row.as_chunks().0.iter().map(|four| f64::from(f32::from_ne_bytes(*four))).collect()
            }
        }
    }

    /// Like [`value`](Self::value), with sRGB decoded. Alpha is never sRGB-encoded.
    pub fn linear_value(&self, x: u32, y: u32, channel: usize) -> f64 {
        let stored = self.value(x, y, channel);
        let is_alpha = self.format.channels() > 1 && channel + 1 == self.format.channels();
        if self.color_space == ColorSpace::Srgb && !is_alpha { srgb_to_linear(stored) } else { stored }
    }

    /// Returns the number of texels with a channel that is NaN or infinite, in all stored levels.
    pub fn nonfinite_texels(&self) -> u64 {
        let of_levels: u64 = self.stored_levels.iter().map(TextureData::nonfinite_texels).sum();
        of_levels + self.nonfinite_texels_of_first()
    }

    fn nonfinite_texels_of_first(&self) -> u64 {
        if self.format.component() != Component::Float32 {
            return 0;
        }
        let row = self.width as usize * self.format.bytes_per_texel();
        let finite = |bytes: &[u8; 4]| f32::from_ne_bytes(*bytes).is_finite();
        let bad = |texel: &&[[u8; 4]]| !texel.iter().all(finite);
        let in_row = |row: &[u8]| row.as_chunks().0.chunks_exact(self.format.channels()).filter(bad).count();
        self.texels.par_chunks(row).map(|row| in_row(row) as u64).sum()
    }

    /// Returns a texture of this one's size in linear floats, computed by column, row (as in
    /// [`value`](Self::value)) and channel.
    pub fn with_floats(&self, channels: usize, value: impl Fn(u32, u32, usize) -> f32) -> TextureData {
        self.with_any_floats(channels, &value)
    }

    /// Returns [`Self::with_floats`], compiled once for all functions.
    fn with_any_floats(&self, channels: usize, value: &dyn Fn(u32, u32, usize) -> f32) -> TextureData {
        let rows = (0..self.height * self.depth).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let floats: Vec<f32> = rows
            .flat_map(|(x, y)| (0..channels).map(move |c| (x, y, c)))
            .map(|(x, y, c)| value(x, y, c))
            .collect();
        TextureData {
            name: self.name.clone(),
            format: TexelFormat::new(channels, Component::Float32),
            color_space: ColorSpace::Linear,
            texels: bytemuck::cast_slice(&floats).to_vec(),
            stored_levels: Vec::new(),
            ..*self
        }
    }

    /// Returns the result of a lookup of this texel: grey is replicated, missing alpha is 1.
    pub fn linear_rgba(&self, x: u32, y: u32) -> [f64; 4] {
        let value = |channel| self.linear_value(x, y, channel);
        match self.format.channels() {
            1 => [value(0), value(0), value(0), 1.0],
            2 => [value(0), value(0), value(0), value(1)],
            _ => [value(0), value(1), value(2), value(3)],
        }
    }
}
