//! Conversion between stored texels and the f32 values that mip filters average, which are linear
//! in light. Alpha is a channel like the others, because no material interprets it as coverage.
//! Channels that are not sRGB, alpha among them, keep their integer codes as units, so that a mean
//! of equal codes is exactly that code.

use rayon::prelude::*;

use crate::core::color::{srgb_table, srgb_to_linear};
use crate::texture::data::{ColorSpace, Component, TexelFormat, TextureData};

pub(super) struct Codec {
    format: TexelFormat,
    /// The tables of an sRGB texture's colour channels.
    srgb: Option<SrgbCodes>,
    /// The range to which each channel is clamped.
    range: [[f32; 2]; 4],
}

impl Codec {
    /// Creates the codec of a texture. With `clamped`, encoded values stay within the range of this
    /// texture.
    pub fn new(texture: &TextureData, clamped: bool) -> Codec {
        let format = texture.format;
        let codes = format.component().codes();
        let coded = texture.color_space == ColorSpace::Srgb && codes > 0;
        let srgb = coded.then(|| SrgbCodes::new(codes));
        let mut codec = Codec { format, srgb, range: [[f32::NEG_INFINITY, f32::INFINITY]; 4] };
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
        let code8 = |[code]: [u8; 1]| f32::from(code);
        let code16 = |code| f32::from(u16::from_ne_bytes(code));
        match (self.format.component(), &self.srgb) {
            (Component::Unorm8, None) => decode::<1, C>(texels, out, code8, code8),
            (Component::Unorm8, Some(srgb)) => {
                decode::<1, C>(texels, out, |[code]| srgb.light[usize::from(code)], code8);
            }
            (Component::Unorm16, None) => decode::<2, C>(texels, out, code16, code16),
            (Component::Unorm16, Some(srgb)) => {
                let light = |code| srgb.light[usize::from(u16::from_ne_bytes(code))];
                decode::<2, C>(texels, out, light, code16);
            }
            (Component::Float32, _) => decode::<4, C>(texels, out, f32::from_ne_bytes, f32::from_ne_bytes),
        }
    }

    /// Encodes rows of `width` texels in parallel.
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
        let code8 = |v: f32| [(v + 0.5) as u8];
        let code16 = |v: f32| ((v + 0.5) as u16).to_ne_bytes();
        match (self.format.component(), &self.srgb) {
            (Component::Unorm8, None) => encode::<1, C>(values, texels, range, code8, code8),
            (Component::Unorm8, Some(srgb)) => {
                encode::<1, C>(values, texels, range, |v| [srgb.code(v) as u8], code8);
            }
            (Component::Unorm16, None) => encode::<2, C>(values, texels, range, code16, code16),
            (Component::Unorm16, Some(srgb)) => {
                encode::<2, C>(values, texels, range, |v| srgb.code(v).to_ne_bytes(), code16);
            }
            (Component::Float32, _) => {
                encode::<4, C>(values, texels, range, f32::to_ne_bytes, f32::to_ne_bytes);
            }
        }
    }

    /// Returns the smallest and largest value of each channel.
    fn range_of(&self, texture: &TextureData) -> [[f32; 2]; 4] {
        let row = texture.width as usize * self.format.bytes_per_texel();
        let channels = self.channels();
        let nothing = || [[f32::INFINITY, f32::NEG_INFINITY]; 4];
        let of_row = |texels: &[u8]| {
            let mut values = vec![0.0; texture.width as usize * channels];
            self.decode(texels, &mut values);
            let mut range = nothing();
            for texel in values.chunks_exact(channels) {
                for (range, value) in range.iter_mut().zip(texel) {
                    *range = [range[0].min(*value), range[1].max(*value)];
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

/// Decodes texels of `C` channels of `N` bytes; the last of several channels is alpha.
#[inline(always)]
fn decode<const N: usize, const C: usize>(
    texels: &[u8],
    out: &mut [[f32; C]],
    color: impl Fn([u8; N]) -> f32,
    alpha: impl Fn([u8; N]) -> f32,
) {
    let texels = texels.as_chunks::<N>().0.as_chunks::<C>().0;
    for (texel, out) in texels.iter().zip(out) {
        *out = std::array::from_fn(|c| if is_alpha::<C>(c) { alpha(texel[c]) } else { color(texel[c]) });
    }
}

#[inline(always)]
fn encode<const N: usize, const C: usize>(
    values: &[[f32; C]],
    texels: &mut [u8],
    range: &[[f32; 2]; 4],
    color: impl Fn(f32) -> [u8; N],
    alpha: impl Fn(f32) -> [u8; N],
) {
    let texels = texels.as_chunks_mut::<N>().0.as_chunks_mut::<C>().0;
    for (value, texel) in values.iter().zip(texels) {
        *texel = std::array::from_fn(|c| {
            let value = value[c].max(range[c][0]).min(range[c][1]);
            if is_alpha::<C>(c) { alpha(value) } else { color(value) }
        });
    }
}

const fn is_alpha<const C: usize>(channel: usize) -> bool {
    C > 1 && channel + 1 == C
}

/// Returns for each code the linear light from which the next code is nearer; there is none after
/// the last.
pub fn srgb_midpoints(codes: usize) -> Vec<f32> {
    let last = codes - 1;
    let middle = |code: usize| srgb_to_linear((code as f64 + 0.5) / last as f64) as f32;
    (0..codes).map(|code| if code < last { middle(code) } else { f32::INFINITY }).collect()
}

/// The linear light of sRGB codes, and the nearest code of a light value without a power function:
/// a table gives a lower bound of the code, and the midpoints between codes determine the rest.
struct SrgbCodes {
    light: &'static [f32],
    /// The lower bound of the code at the beginning of each step.
    least: Vec<u16>,
    middles: Vec<f32>,
}

impl SrgbCodes {
    /// Equal steps of light per code; where the codes are densest, 12.92 of them are as wide as an
    /// average one.
    const STEPS: usize = 16;

    fn new(codes: usize) -> SrgbCodes {
        let (steps, middles) = (codes * Self::STEPS, srgb_midpoints(codes));
        let mut code = 0;
        let least = (0..=steps).map(|step| {
            while step as f32 / steps as f32 >= middles[code] {
                code += 1;
            }
            code as u16
        });
        SrgbCodes { light: srgb_table(codes), least: least.collect(), middles }
    }

    fn code(&self, light: f32) -> u16 {
        let steps = self.least.len() - 1;
        let step = (light * steps as f32) as usize;
        let mut code = self.least[step.min(steps)];
        while light >= self.middles[usize::from(code)] {
            code += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::core::color::linear_to_srgb;

    #[test]
    fn table_encoding_is_the_nearest_code() {
        for codes in [256, 65_536] {
            let srgb = SrgbCodes::new(codes);
            let last = (codes - 1) as u16;
            for i in 0..=100_000u32 {
                let light = i as f32 / 100_000.0;
                let exact = linear_to_srgb(f64::from(light)) * f64::from(last);
                let code = f64::from(srgb.code(light));
                // 2e-5 of an 8-bit step, because the standard's two pieces do not meet exactly; in
                // addition midpoints are rounded to f32, by 2⁻²⁵ near 1, where a light difference
                // of 1 / 65535 is 0.44 codes.
                let tolerance = f64::from(last) * (2e-5 / 255.0 + 0.44 / f64::from(1 << 25));
                assert!((code - exact).abs() <= 0.5 + tolerance, "{light}: {code}, not {exact}");
            }
            assert_eq!((srgb.code(-1.0), srgb.code(2.0), srgb.code(f32::NAN)), (0, last, 0));
            assert!((0..=last).all(|code| srgb.code(srgb.light[usize::from(code)]) == code));
        }
    }
}
