//! Stored texels to the numbers that are averaged, and back. Those numbers are f32, linear in light
//! and in coverage: colours times alpha, and alpha; so a mean of them is a mean of what is seen.
//! Integers that are not sRGB keep their codes as units, so that grey and opaque texels come back
//! exactly.

use rayon::prelude::*;

use crate::color::{linear_to_srgb, srgb_to_linear, srgb8_table};
use crate::texture::data::{ColorSpace, Component, TexelFormat, TextureData};

/// Added to alpha as the weight of a colour: nothing beside any alpha that can be seen, and the same
/// for all where alpha is 0. A power of two, so that it goes in and out without rounding.
pub(super) const UNSEEN: f32 = 1.0 / (1u32 << 30) as f32;
/// Steps of the table behind [`Encoder8`].
const STEPS: usize = 4096;

pub(super) struct Codec {
    format: TexelFormat,
    srgb: bool,
    encoder: Encoder8,
    /// Linear light of 16-bit codes, where they are sRGB.
    table16: Vec<f32>,
    /// What each channel is clamped to.
    range: [[f32; 2]; 4],
}

impl Codec {
    /// `clamped`: nothing that is encoded leaves the range of this texture.
    pub fn new(texture: &TextureData, clamped: bool) -> Codec {
        let srgb = texture.color_space == ColorSpace::Srgb;
        let wide = srgb && texture.format.component() == Component::Unorm16;
        let table16 = if wide {
            (0..=u16::MAX).map(|c| srgb_to_linear(f64::from(c) / 65_535.0) as f32).collect()
        } else {
            Vec::new()
        };
        let everything = [[f32::NEG_INFINITY, f32::INFINITY]; 4];
        let mut codec =
            Codec { format: texture.format, srgb, encoder: Encoder8::new(), table16, range: everything };
        if clamped {
            codec.range = codec.range_of(texture);
        }
        codec
    }

    pub fn channels(&self) -> usize {
        self.format.channels()
    }

    pub fn decode(&self, texels: &[u8], out: &mut [f32]) {
        match self.channels() {
            1 => self.decode_channels::<1>(texels, out),
            2 => self.decode_channels::<2>(texels, out),
            _ => self.decode_channels::<4>(texels, out),
        }
    }

    fn decode_channels<const C: usize>(&self, texels: &[u8], out: &mut [f32]) {
        let out = out.as_chunks_mut::<C>().0;
        let table8 = srgb8_table();
        let wide = |code: [u8; 2]| u16::from_ne_bytes(code);
        match (self.format.component(), self.srgb) {
            (Component::Unorm8, false) => {
                weigh::<1, C>(texels, out, |[c]| f32::from(c), |[a]| f32::from(a) / 255.0);
            }
            (Component::Unorm8, true) => {
                weigh::<1, C>(texels, out, |[c]| table8[usize::from(c)], |[a]| f32::from(a) / 255.0);
            }
            (Component::Unorm16, false) => {
                weigh::<2, C>(texels, out, |c| f32::from(wide(c)), |a| f32::from(wide(a)) / 65_535.0);
            }
            (Component::Unorm16, true) => {
                let color = |c| self.table16[usize::from(wide(c))];
                weigh::<2, C>(texels, out, color, |a| f32::from(wide(a)) / 65_535.0);
            }
            (Component::Float32, _) => {
                weigh::<4, C>(texels, out, f32::from_ne_bytes, f32::from_ne_bytes);
            }
        }
    }

    /// Rows of `width` texels, side by side on all cores.
    pub fn encode(&self, values: &[f32], width: usize) -> Vec<u8> {
        let bytes_per_texel = self.format.bytes_per_texel();
        let mut texels = vec![0; values.len() / self.channels() * bytes_per_texel];
        let rows = texels.par_chunks_mut(width * bytes_per_texel);
        let rows = rows.zip(values.par_chunks(width * self.channels())).with_min_len(1 + 2048 / width);
        rows.for_each(|(row, values)| match self.channels() {
            1 => self.encode_channels::<1>(values, row),
            2 => self.encode_channels::<2>(values, row),
            _ => self.encode_channels::<4>(values, row),
        });
        texels
    }

    fn encode_channels<const C: usize>(&self, values: &[f32], texels: &mut [u8]) {
        let values = values.as_chunks::<C>().0;
        let range = &self.range;
        let unit8 = |v: f32| [(v * 255.0 + 0.5) as u8];
        let unit16 = |v: f32| ((v * 65_535.0 + 0.5) as u16).to_ne_bytes();
        match (self.format.component(), self.srgb) {
            (Component::Unorm8, false) => {
                unweigh::<1, C>(values, texels, range, |v| [(v + 0.5) as u8], unit8)
            }
            (Component::Unorm8, true) => {
                unweigh::<1, C>(values, texels, range, |v| [self.encoder.code(v)], unit8);
            }
            (Component::Unorm16, false) => {
                unweigh::<2, C>(values, texels, range, |v| ((v + 0.5) as u16).to_ne_bytes(), unit16);
            }
            (Component::Unorm16, true) => {
                let color = |v: f32| ((linear_to_srgb(f64::from(v)) * 65_535.0 + 0.5) as u16).to_ne_bytes();
                unweigh::<2, C>(values, texels, range, color, unit16);
            }
            (Component::Float32, _) => {
                unweigh::<4, C>(values, texels, range, f32::to_ne_bytes, f32::to_ne_bytes)
            }
        }
    }

    /// Smallest and largest value of each channel, colours not weighted.
    fn range_of(&self, texture: &TextureData) -> [[f32; 2]; 4] {
        let row = texture.width as usize * self.format.bytes_per_texel();
        let channels = self.channels();
        let nothing = || [[f32::INFINITY, f32::NEG_INFINITY]; 4];
        let of_row = |texels: &[u8]| {
            let mut values = vec![0.0; texture.width as usize * channels];
            self.decode(texels, &mut values);
            let mut range = nothing();
            for texel in values.chunks_exact(channels) {
                let weight = if channels == 1 { 1.0 } else { weight(texel[channels - 1]) };
                for (c, value) in texel.iter().enumerate() {
                    let value = if c + 1 == channels && channels > 1 { *value } else { value / weight };
                    range[c] = [range[c][0].min(value), range[c][1].max(value)];
                }
            }
            range
        };
        let wider = |a: [[f32; 2]; 4], b: [[f32; 2]; 4]| {
            std::array::from_fn(|c| [a[c][0].min(b[c][0]), a[c][1].max(b[c][1])])
        };
        texture.texels.par_chunks(row).map(of_row).reduce(nothing, wider)
    }
}

fn weight(alpha: f32) -> f32 {
    alpha.max(0.0) + UNSEEN
}

/// Texels of `C` channels of `N` bytes: the last of several is alpha.
#[inline(always)]
fn weigh<const N: usize, const C: usize>(
    texels: &[u8],
    out: &mut [[f32; C]],
    color: impl Fn([u8; N]) -> f32,
    alpha: impl Fn([u8; N]) -> f32,
) {
    let texels = texels.as_chunks::<N>().0.as_chunks::<C>().0;
    for (texel, out) in texels.iter().zip(out) {
        if C == 1 {
            out[0] = color(texel[0]);
            continue;
        }
        let a = alpha(texel[C - 1]);
        let weight = weight(a);
        for c in 0..C - 1 {
            out[c] = color(texel[c]) * weight;
        }
        out[C - 1] = a;
    }
}

#[inline(always)]
fn unweigh<const N: usize, const C: usize>(
    values: &[[f32; C]],
    texels: &mut [u8],
    range: &[[f32; 2]; 4],
    color: impl Fn(f32) -> [u8; N],
    alpha: impl Fn(f32) -> [u8; N],
) {
    let texels = texels.as_chunks_mut::<N>().0.as_chunks_mut::<C>().0;
    let clamped = |value: f32, c: usize| value.max(range[c][0]).min(range[c][1]);
    for (value, texel) in values.iter().zip(texels) {
        if C == 1 {
            texel[0] = color(clamped(value[0], 0));
            continue;
        }
        let a = value[C - 1];
        let weight = weight(a);
        for c in 0..C - 1 {
            texel[c] = color(clamped(value[c] / weight, c));
        }
        texel[C - 1] = alpha(clamped(a, C - 1));
    }
}

/// Linear light from which on the code after is nearer; none after the last.
pub fn srgb8_middles() -> [f32; 256] {
    let middle = |code: usize| srgb_to_linear((code as f64 + 0.5) / 255.0) as f32;
    std::array::from_fn(|code| if code < 255 { middle(code) } else { f32::INFINITY })
}

/// Linear light to the nearest 8-bit sRGB code, without a power: a table says which code the light
/// has at least, and the middles between codes say the rest.
struct Encoder8 {
    /// Codes at the beginning of each step.
    least: Vec<u8>,
    middles: [f32; 256],
}

impl Encoder8 {
    fn new() -> Encoder8 {
        let middles = srgb8_middles();
        let below = |light: f32| middles.iter().filter(|&&m| m <= light).count() as u8;
        let least = (0..=STEPS).map(|step| below(step as f32 / STEPS as f32)).collect();
        Encoder8 { least, middles }
    }

    fn code(&self, light: f32) -> u8 {
        let step = (light * STEPS as f32) as usize;
        let mut code = self.least[step.min(STEPS)];
        while light >= self.middles[usize::from(code)] {
            code += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_encoding_is_the_nearest_code() {
        let encoder = Encoder8::new();
        for i in 0..=100_000u32 {
            let light = i as f32 / 100_000.0;
            let exact = linear_to_srgb(f64::from(light)) * 255.0;
            let code = f64::from(encoder.code(light));
            // 2e-5 of a step: the standard's two pieces do not meet exactly.
            assert!((code - exact).abs() <= 0.5 + 2e-5, "{light}: {code}, not {exact}");
        }
        assert_eq!((encoder.code(-1.0), encoder.code(2.0), encoder.code(f32::NAN)), (0, 255, 0));
        assert!((0..=255u8).all(|c| encoder.code(srgb8_table()[usize::from(c)]) == c));
    }
}
