//! Decides where the levels of a texture are generated: on the host when it is packed, or on a device from
//! level 0; and by whom on the host. Input: a texture and the caller's choice. Output: true if the levels are left to the
//! device.

use crate::scene::model::{Footprint, Scene};
use crate::texture::data::{MipKernel, TextureData};
use crate::texture::mips;
use crate::texture::sampler_spec::SamplerSpec;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MipPlacement {
    #[default]
    Host,
    /// The levels that a device can generate: box mip chains whose lengths halve without remainder to the
    /// last level; for textures of at least `least_texels`, through buffers of at most `most_bytes`.
    Device { least_texels: u64, most_bytes: u64 },
}

impl MipPlacement {
    /// All levels that a device can generate.
    pub const DEVICE: MipPlacement = MipPlacement::Device { least_texels: 0, most_bytes: u64::MAX };

    pub(super) fn leaves(self, texture: &TextureData, kernel: MipKernel) -> bool {
        let MipPlacement::Device { least_texels, most_bytes } = self else { return false };
        let sizes = (0..mips::level_count(texture)).map(|level| mips::level_size(texture, level));
        let texels: Vec<u64> = sizes.map(|size| size.map(u64::from).iter().product()).collect();
        // With four channels, which some images need: all codes, and the values of two levels.
        let codes = texels.iter().sum::<u64>() * 4 * texture.format.component().bytes() as u64;
        let numbers = texels.iter().skip(1).take(2).sum::<u64>() * 4 * size_of::<f32>() as u64;
        kernel == MipKernel::Box
            && texels.len() > 1
            && texels[0] >= least_texels
            && codes.max(numbers) <= most_bytes
            && mips::halves_throughout(texture)
    }
}

/// Who makes levels of textures on the host: anew, or by finding those that were made before.
pub trait LevelMaker {
    /// Returns levels 1 to the last of a texture of the scene.
    fn levels(&mut self, index: usize, texture: &TextureData, kernel: MipKernel) -> Vec<TextureData>;
}

/// Makes all of them.
pub(super) struct Anew;

impl LevelMaker for Anew {
    fn levels(&mut self, _: usize, texture: &TextureData, kernel: MipKernel) -> Vec<TextureData> {
        mips::mip_chain(texture, kernel)
    }
}

/// Returns true if some texture of the scene is read at levels other than 0.
pub fn reads_levels(scene: &Scene) -> bool {
    super::header::footprint(scene) != Footprint::None && scene.samplers.iter().any(SamplerSpec::reads_levels)
}
