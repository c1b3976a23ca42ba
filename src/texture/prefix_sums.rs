//! Prefix sums along the rows of 2D textures at every level of a box mip chain, from which
//! integrals over polygons are evaluated. Values are linear light in 16-bit fixed point over the
//! texture's own range; sums keep the low 32 bits, so that differences over up to 2^15 texels are
//! exact.

use super::data::{MipKernel, TextureData};
use super::fixed_point::FixedPoint;
use super::mips;

/// Steps of the fixed point over the range of values.
const STEPS: u32 = 65_535;
/// Words before those with the start of each level.
const HEAD: u64 = 4;

/// Returns the number of words of a texture's table.
pub fn words(texture: &TextureData) -> u64 {
    let channels = if texture.format.channels() < 3 { 1 } else { 3 };
    let levels = (0..mips::level_count(texture)).map(|level| {
        let [width, height, _] = mips::level_size(texture, level).map(u64::from);
        1 + (width + 1) * height * channels
    });
    HEAD + levels.sum::<u64>()
}

/// Returns the device table of a texture that begins at word `start`: number of channels (1 or 3),
/// number of levels, smallest value and step (f32 bits), first word of each level. A level has rows
/// of `width + 1` sums, from 0 to the sum of the whole row.
pub fn table(texture: &TextureData, start: usize) -> Vec<u32> {
    let channels = if texture.format.channels() < 3 { 1 } else { 3 };
    let opaque = |x, y, c| if c < 3 { texture.linear_value(x, y, c) as f32 } else { 1.0 };
    let top = texture.with_floats(if channels == 1 { 1 } else { 4 }, opaque);
    let mut levels = mips::mip_chain(&top, MipKernel::Box);
    levels.insert(0, top);
    let floats = |level: &TextureData| bytemuck::pod_collect_to_vec::<u8, f32>(&level.texels);
    let texels = floats(&levels[0]);
    let colors = texels.iter().enumerate().filter(|(i, _)| channels == 1 || i % 4 < 3);
    let fixed = FixedPoint::over(colors.map(|(_, v)| f64::from(*v)), STEPS);
    let mut words = vec![channels as u32, levels.len() as u32, fixed.least.to_bits(), fixed.step.to_bits()];
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
                    *sum = sum.wrapping_add(fixed.code(v.into()));
                }
                words.extend(&sums[..channels]);
            }
        }
    }
    words
}
