//! Mip levels of a texture, filtered in linear light. Computes all levels from level 0 in its own
//! format, each half as long on every axis, rounded down, at least 1 (Vulkan 1.3, "Image Mip Level
//! Sizing"). Faces of a cube are filtered separately, slices of a volume along the third axis too.
//!
//! - `box`: a texel is the mean over exactly the area that it covers, border texels weighted by the
//!   covered fraction; the mean of every level therefore equals that of level 0. As long as lengths
//!   halve without remainder, each level is computed from the previous one; from the first odd
//!   length on, every level is computed from that one.
//! - `kaiser`: sinc(x) · I₀(β √(1 − (x/w)²)) / I₀(β) with w = 3 texels of the new level and β = 4,
//!   each level from the previous one, the texture extended by its border texels. Negative lobes
//!   overshoot at edges: every level is clamped to the range of level 0.
//!
//! Intermediate levels stay in unrounded f32, so that a stored level is off by one rounding only,
//! whatever its number: half a step of its format, with halves rounded up. Channels are averaged
//! independently, including alpha: no material interprets it as coverage, so a colour counts
//! whatever its alpha.

mod codec;
mod halve;
mod nonfinite;
mod resample;

use rayon::prelude::*;

use super::data::{Dimension, MipKernel, TextureData};
use codec::Codec;
pub use codec::srgb_midpoints;
use halve::halve;
pub use nonfinite::mip_chain_of_finite;
use resample::{AxisWeights, resample};

/// Returns levels 1 to the last, or none for a texture of one texel; of stored levels those that there are.
pub fn mip_chain(texture: &TextureData, kernel: MipKernel) -> Vec<TextureData> {
    let codec = Codec::new(texture, kernel == MipKernel::Kaiser);
    let stored =
        Level { size: size(texture, 0), rows: Rows::Stored { texels: &texture.texels, codec: &codec } };
    match kernel {
        MipKernel::Box | MipKernel::Auto => box_levels(texture, &codec, stored),
        MipKernel::Kaiser => kaiser_levels(texture, &codec, stored),
        MipKernel::Stored => texture.stored_levels.clone(),
    }
}

/// Returns the number of levels including level 0.
pub fn level_count(texture: &TextureData) -> u32 {
    let depth = if texture.dimension == Dimension::Three { texture.depth } else { 1 };
    let longest = texture.width.max(texture.height).max(depth);
    u32::BITS - longest.leading_zeros()
}

/// Returns width, height, and depth or faces of a level.
pub fn level_size(texture: &TextureData, level: u32) -> [u32; 3] {
    let half = |n: u32| n.checked_shr(level).unwrap_or(0).max(1);
    let depth = if texture.dimension == Dimension::Three { half(texture.depth) } else { texture.depth };
    [half(texture.width), half(texture.height), depth]
}

/// Returns true if every length of every level equals that of the previous level or is exactly half
/// of it.
pub fn halves_throughout(texture: &TextureData) -> bool {
    (1..level_count(texture)).all(|level| halves(size(texture, level - 1), size(texture, level)))
}

/// Returns levels 1 to the last with all texels 0.
pub fn zeroed_levels(texture: &TextureData) -> Vec<TextureData> {
    let level = |level| {
        let [width, height, depth] = level_size(texture, level);
        let count = width as usize * height as usize * depth as usize;
        let texels = vec![0; count * texture.format.bytes_per_texel()];
        TextureData {
            name: texture.name.clone(),
            width,
            height,
            depth,
            texels,
            stored_levels: Vec::new(),
            ..*texture
        }
    };
    (1..level_count(texture)).map(level).collect()
}

fn size(texture: &TextureData, level: u32) -> [usize; 3] {
    level_size(texture, level).map(|n| n as usize)
}

fn box_levels(texture: &TextureData, codec: &Codec, stored: Level<'_>) -> Vec<TextureData> {
    let mut levels = Vec::new();
    let mut above = stored;
    for level in 1..level_count(texture) {
        let to = size(texture, level);
        if !halves(above.size, to) {
            let rest: Vec<u32> = (level..level_count(texture)).collect();
            let direct = rest.par_iter().map(|&level| {
                let to = size(texture, level);
                let axes = [0, 1, 2].map(|a| AxisWeights::covered(above.size[a], to[a]));
                stored_level(texture, codec, to, &resample(&above, &axes, codec.channels()))
            });
            levels.extend(direct.collect::<Vec<_>>());
            break;
        }
        let values = halve(&above, to, codec.channels());
        levels.push(stored_level(texture, codec, to, &values));
        above = Level { size: to, rows: Rows::Working(values) };
    }
    levels
}

fn kaiser_levels(texture: &TextureData, codec: &Codec, stored: Level<'_>) -> Vec<TextureData> {
    let mut levels = Vec::new();
    let mut above = stored;
    for level in 1..level_count(texture) {
        let to = size(texture, level);
        let axes = [0, 1, 2].map(|a| AxisWeights::windowed_sinc(above.size[a], to[a]));
        let values = resample(&above, &axes, codec.channels());
        levels.push(stored_level(texture, codec, to, &values));
        above = Level { size: to, rows: Rows::Working(values) };
    }
    levels
}

/// Returns true if each texel of the new level covers one or two whole texels along every axis.
fn halves(from: [usize; 3], to: [usize; 3]) -> bool {
    from.iter().zip(to).all(|(&from, to)| from == to || from == 2 * to)
}

fn stored_level(texture: &TextureData, codec: &Codec, size: [usize; 3], values: &[f32]) -> TextureData {
    let [width, height, depth] = size.map(|n| n as u32);
    let texels = codec.encode(values, size[0]);
    TextureData {
        name: texture.name.clone(),
        width,
        height,
        depth,
        texels,
        stored_levels: Vec::new(),
        ..*texture
    }
}

/// The source level from which the next one is computed.
struct Level<'a> {
    size: [usize; 3],
    rows: Rows<'a>,
}

enum Rows<'a> {
    /// Stored texels, decoded row by row: level 0 is never expanded to floats as a whole.
    Stored { texels: &'a [u8], codec: &'a Codec },
    /// Decoded values in the codec's units, rows one after the other.
    Working(Vec<f32>),
}

impl Level<'_> {
    /// Returns row `index`, counted through all slices; `scratch` receives it if it must be
    /// decoded.
    fn row<'s>(&'s self, index: usize, scratch: &'s mut Vec<f32>) -> &'s [f32] {
        match &self.rows {
            Rows::Working(values) => {
                let length = values.len() / (self.size[1] * self.size[2]);
                &values[index * length..(index + 1) * length]
            }
            Rows::Stored { texels, codec } => {
                scratch.resize(self.size[0] * codec.channels(), 0.0);
                let bytes = texels.len() / (self.size[1] * self.size[2]);
                codec.decode(&texels[index * bytes..(index + 1) * bytes], scratch);
                scratch
            }
        }
    }
}
