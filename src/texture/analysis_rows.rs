//! The values of a texture on which its analysis works: rows of stored values, of lookup results
//! and of perceptually mapped values, whose steps are spaced about evenly to the eye; the pairs
//! across a seam; the sizes of the steps along single lines.

use super::analysis_steps::Pairs;
use super::data::{ColorSpace, Component, TextureData};
use crate::core::color::srgb_to_linear;

/// The number of lines in which a period is searched, and the texels in all of them together.
const LINES: (usize, usize) = (16, 64);
const PERIOD_TEXELS: usize = 64 * 4096;
/// The number of values from which the median is taken.
const MEDIAN_SAMPLES: usize = 1 << 16;

/// The texels of a texture row by row, without channels that the file does not have.
pub struct Rows<'a> {
    texture: &'a TextureData,
    /// Linear light of every stored integer; empty if stored values are linear.
    table: Vec<f64>,
    /// The median |v| of float values.
    median: Option<f64>,
}

impl Rows<'_> {
    pub fn new(texture: &TextureData) -> Rows<'_> {
        Rows { texture, table: linear_table(texture), median: median(texture) }
    }

    /// Maps a stored value to the scale on which steps are compared.
    fn map_value(&self, value: f64) -> f64 {
        self.median.map_or(value, |median| (value / median).asinh())
    }

    pub fn map_row(&self, row: &[f64]) -> Vec<f64> {
        row.iter().map(|&value| self.map_value(value)).collect()
    }

    /// Returns texel `i` of line `line`; along u a line is a row.
    fn texel(&self, i: usize, line: usize, along_u: bool, channel: usize) -> f64 {
        let (x, y) = if along_u { (i, line) } else { (line, i) };
        self.texture.value(x as u32, y as u32, channel)
    }

    /// Returns the pairs across the seam of an axis of `length` texels and `lines` lines.
    pub fn seam(&self, length: usize, lines: usize, along_u: bool) -> Pairs {
        let mut pairs = Pairs::default();
        for line in 0..lines {
            for channel in 0..self.texture.file_channels {
                let [last, first] = [length - 1, 0].map(|i| self.texel(i, line, along_u, channel));
                pairs.stored.push(first - last);
                pairs.mapped.push(self.map_value(first) - self.map_value(last));
            }
        }
        pairs
    }

    /// Returns the sizes of the steps along lines spread over the texture, the seam's last.
    pub fn lines(&self, length: usize, lines: usize, along_u: bool) -> Vec<Vec<f32>> {
        let wanted = (PERIOD_TEXELS / length).clamp(LINES.0, LINES.1).min(lines);
        let count = self.texture.file_channels;
        let value =
            |i: usize, line: usize, c: usize| self.map_value(self.texel(i % length, line, along_u, c));
        let step = |i: usize, line: usize| {
            let sizes = (0..count).map(|c| (value(i + 1, line, c) - value(i, line, c)).abs());
            sizes.filter(|size| size.is_finite()).sum::<f64>() as f32
        };
        let of_line = |k: usize| (0..length).map(|i| step(i, k * lines / wanted)).collect();
        (0..wanted).map(of_line).collect()
    }

    /// Returns by how much roundings of integer texels change the difference of two steps of a line.
    pub fn grain(&self) -> f32 {
        let codes = self.texture.format.component().codes();
        // Each step is off by a code at most, in each channel.
        if codes > 0 { 2.0 * self.texture.file_channels as f32 / (codes - 1) as f32 } else { 0.0 }
    }

    pub fn stored(&self, y: usize) -> Vec<f64> {
        let (count, channels) = (self.texture.file_channels, self.texture.format.channels());
        let mut row = self.texture.row_values(y);
        if count < channels {
            let texels = row.len() / channels;
            (0..texels * count).for_each(|i| row[i] = row[i / count * channels + i % count]);
            row.truncate(texels * count);
        }
        row
    }

    /// Converts a stored value to the one that a lookup returns. Alpha is never sRGB-encoded.
    pub fn lookup_value(&self, stored: f64, channel: usize) -> f64 {
        let is_alpha =
            self.texture.file_channels.is_multiple_of(2) && channel + 1 == self.texture.file_channels;
        if self.table.is_empty() || is_alpha {
            return stored;
        }
        self.table[(stored * (self.table.len() - 1) as f64).round() as usize]
    }
}

fn linear_table(texture: &TextureData) -> Vec<f64> {
    let largest = match (texture.color_space, texture.format.component()) {
        (ColorSpace::Linear, _) | (_, Component::Float32) => return Vec::new(),
        (ColorSpace::Srgb, Component::Unorm8) => u8::MAX.into(),
        (ColorSpace::Srgb, Component::Unorm16) => u16::MAX,
    };
    (0..=largest).map(|i| srgb_to_linear(f64::from(i) / f64::from(largest))).collect()
}

/// Returns the median |v| over the finite values of a float texture that are not 0, or `None` for
/// integers.
fn median(texture: &TextureData) -> Option<f64> {
    if texture.format.component() != Component::Float32 {
        return None;
    }
    let count = texture.file_channels;
    let values = texture.width as usize * texture.height as usize * count;
    let value = |i: usize| {
        let texel = i / count;
        let (x, y) = (texel % texture.width as usize, texel / texture.width as usize);
        texture.value(x as u32, y as u32, i % count).abs()
    };
    // An odd stride visits every column of a texture whose width is a power of two.
    let spread = (0..values).step_by(values.div_ceil(MEDIAN_SAMPLES) | 1).map(value);
    let mut sizes: Vec<f64> = spread.filter(|v| *v > 0.0 && v.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied()
}
