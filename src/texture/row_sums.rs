//! Sums along the rows of flat textures, at every level of a box pyramid: what integrals over polygons are
//! read from. Values are linear light in fixed point of 16 bits over the texture's own range; sums keep
//! the low 32 bits, so that differences over up to 2^15 texels are exact.

use super::data::{ColorSpace, Component, MipKernel, TexelFormat, TextureData};
use super::mips;

/// Steps of the fixed point over the range of values.
const STEPS: f64 = 65_535.0;

/// As a device reads it, if it begins at word `start`: the number of channels (1 or 3), the number of levels,
/// the least value and a step (f32 bits), the first word of each level. A level has rows of `width + 1`
/// sums, from 0 to that of the whole row.
pub fn table(texture: &TextureData, start: usize) -> Vec<u32> {
    let channels = if texture.format.channels() < 3 { 1 } else { 3 };
    let top = linear_colors(texture, channels);
    let mut levels = mips::pyramid(&top, MipKernel::Box);
    levels.insert(0, top);
    let floats = |level: &TextureData| bytemuck::pod_collect_to_vec::<u8, f32>(&level.texels);
    let all = floats(&levels[0]);
    let colors = || all.iter().enumerate().filter(|(i, _)| channels == 1 || i % 4 < 3).map(|(_, v)| *v);
    let least = colors().fold(f32::INFINITY, f32::min);
    let most = colors().fold(f32::NEG_INFINITY, f32::max);
    let step = ((f64::from(most) - f64::from(least)) / STEPS) as f32;
    let code = |v: f32| {
        if step > 0.0 {
            ((f64::from(v) - f64::from(least)) / f64::from(step)).round().clamp(0.0, 2.0 * STEPS) as u32
        } else {
            0
        }
    };
    let mut words = vec![channels as u32, levels.len() as u32, least.to_bits(), step.to_bits()];
    let head = words.len() + levels.len();
    let mut end = start + head;
    for level in &levels {
        words.push(end as u32);
        end += (level.width as usize + 1) * level.height as usize * channels;
    }
    words.reserve_exact(end - start - head);
    for level in &levels {
        let stride = level.format.channels();
        for row in floats(level).chunks_exact(level.width as usize * stride) {
            let mut sums = [0u32; 3];
            words.extend(&sums[..channels]);
            for texel in row.chunks_exact(stride) {
                for (sum, &v) in sums[..channels].iter_mut().zip(texel) {
                    *sum = sum.wrapping_add(code(v));
                }
                words.extend(&sums[..channels]);
            }
        }
    }
    words
}

/// The texture as opaque linear floats.
fn linear_colors(texture: &TextureData, channels: usize) -> TextureData {
    let format = TexelFormat::new(if channels == 1 { 1 } else { 4 }, Component::Float32);
    let texel = |x, y| {
        (0..format.channels()).map(move |c| if c < 3 { texture.linear_value(x, y, c) as f32 } else { 1.0 })
    };
    let row = |y| (0..texture.width).flat_map(move |x| texel(x, y));
    let floats: Vec<f32> = (0..texture.height).flat_map(row).collect();
    TextureData {
        name: texture.name.clone(),
        format,
        color_space: ColorSpace::Linear,
        texels: bytemuck::cast_slice(&floats).to_vec(),
        ..*texture
    }
}
