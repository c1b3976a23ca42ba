//! Summed-area tables (Crow 1984): for every channel of a 2D texture, the sums over all rectangles
//! that begin at texel (0, 0). Values are linear light in 24-bit fixed point over the texture's own
//! range and sums have 64 bits: they never overflow, and their differences are exact.

use super::data::TextureData;
use super::fixed_point::FixedPoint;

/// Steps of the fixed point over the range of values.
const STEPS: u32 = 16_777_215;

/// Returns the number of words of a texture's table.
pub fn words(texture: &TextureData) -> usize {
    3 + texture.format.channels() * (texture.width as usize + 1) * (texture.height as usize + 1) * 2
}

/// Returns the device table: smallest value and step (f32 bits), number of channels, then for each
/// channel `height + 1` rows of `width + 1` sums, low word first.
pub fn table(texture: &TextureData) -> Vec<u32> {
    let channels = texture.format.channels();
    let (width, height) = (texture.width as usize, texture.height as usize);
    let value = |x: usize, y: usize, c: usize| texture.linear_value(x as u32, y as u32, c);
    let texels = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let values = || texels().flat_map(|(x, y)| (0..channels).map(move |c| value(x, y, c)));
    let fixed = FixedPoint::over(values(), STEPS);
    let head = [fixed.least.to_bits(), fixed.step.to_bits(), channels as u32];
    let mut words = Vec::with_capacity(self::words(texture));
    words.extend(head);
    for c in 0..channels {
        let mut above = vec![0u64; width + 1];
        for y in 0..=height {
            let mut row = 0u64;
            for (x, sum) in above.iter_mut().enumerate() {
                if x > 0 && y > 0 {
                    row += u64::from(fixed.code(value(x - 1, y - 1, c)));
                    *sum += row;
                }
                words.extend([*sum as u32, (*sum >> 32) as u32]);
            }
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::{ColorSpace, Dimension, TexelFormat};

    #[test]
    fn the_last_sum_is_the_sum_of_all() {
        let texture = TextureData {
            name: "t".into(),
            dimension: Dimension::Two,
            width: 3,
            height: 2,
            depth: 1,
            format: TexelFormat::Grey8,
            color_space: ColorSpace::Linear,
            file_channels: 1,
            texels: vec![0, 51, 102, 153, 204, 255],
            stored_levels: Vec::new(),
        };
        let words = table(&texture);
        assert_eq!([words.len(), super::words(&texture)], [3 + 4 * 3 * 2; 2]);
        let (least, step) = (f32::from_bits(words[0]), f32::from_bits(words[1]));
        let sum = |x: usize, y: usize| {
            let at = 3 + 2 * (y * 4 + x);
            (u64::from(words[at]) | u64::from(words[at + 1]) << 32) as f64 * f64::from(step)
                + f64::from(least)
        };
        for (x, y, expected) in [(0, 0, 0.0), (3, 0, 0.0), (0, 2, 0.0), (2, 1, 0.2), (1, 2, 0.6), (3, 2, 3.0)]
        {
            assert!((sum(x, y) - expected).abs() < 1e-6, "{x} {y}: {}", sum(x, y)); // six roundings to 2⁻²⁵
        }
    }
}
