//! The box mip chain of a texture with NaN or infinite texels: a coarser texel is the mean over the
//! texels it covers that are finite in every channel, or NaN if none is. A non-finite texel
//! therefore stays local and does not reach the last level, which distant footprints read.

use super::mip_chain;
use crate::texture::data::{MipKernel, TextureData};

/// Returns levels 1 to the last of a float texture.
pub fn mip_chain_of_finite(texture: &TextureData) -> Vec<TextureData> {
    let channels = texture.format.channels();
    let present = |x, y| (0..channels).all(|c| texture.value(x, y, c).is_finite());
    // Non-finite texels count as 0; the share is the finite fraction of a mean.
    let filled = texture
        .with_floats(channels, |x, y, c| if present(x, y) { texture.value(x, y, c) as f32 } else { 0.0 });
    let shares = texture.with_floats(1, |x, y, _| if present(x, y) { 1.0 } else { 0.0 });
    let levels = mip_chain(&filled, MipKernel::Box).into_iter().zip(mip_chain(&shares, MipKernel::Box));
    levels.map(|(level, share)| mean_of_present(&level, &share)).collect()
}

fn mean_of_present(level: &TextureData, share: &TextureData) -> TextureData {
    let channels = level.format.channels();
    level.with_floats(channels, |x, y, c| {
        let share = share.value(x, y, 0);
        if share == 0.0 { f32::NAN } else { (level.value(x, y, c) / share) as f32 }
    })
}
