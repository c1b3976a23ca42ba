//! Who makes the levels of a texture: the host when it packs, or a device when it is given level 0. In go
//! a texture and the caller's choice, out comes whether the texture's levels are left to the device.

use crate::scene::model::{Footprint, Scene};
use crate::texture::data::{MipKernel, TextureData};
use crate::texture::mips;
use crate::texture::sampler_spec::SamplerSpec;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MipPlacement {
    #[default]
    Host,
    /// Those that a device can make: box mip chains whose lengths halve without remainder to the last level;
    /// of textures with at least so many texels, through buffers of at most so many bytes.
    Device { least_texels: u64, most_bytes: u64 },
}

impl MipPlacement {
    /// Every one that a device can make.
    pub const DEVICE: MipPlacement = MipPlacement::Device { least_texels: 0, most_bytes: u64::MAX };

    pub(super) fn leaves(self, texture: &TextureData, kernel: MipKernel) -> bool {
        let MipPlacement::Device { least_texels, most_bytes } = self else { return false };
        let sizes = (0..mips::level_count(texture)).map(|level| mips::level_size(texture, level));
        let texels: Vec<u64> = sizes.map(|size| size.map(u64::from).iter().product()).collect();
        // With four channels, which some images need: all codes, and the numbers of two levels.
        let codes = texels.iter().sum::<u64>() * 4 * texture.format.component().bytes() as u64;
        let numbers = texels.iter().skip(1).take(2).sum::<u64>() * 4 * size_of::<f32>() as u64;
        kernel == MipKernel::Box
            && texels.len() > 1
            && texels[0] >= least_texels
            && codes.max(numbers) <= most_bytes
            && mips::halves_throughout(texture)
    }
}

/// Whether some texture of the scene is read at other levels than 0.
pub fn reads_levels(scene: &Scene) -> bool {
    super::header::footprint(scene) != Footprint::None && scene.samplers.iter().any(SamplerSpec::reads_levels)
}
