//! Decides whether the levels of a texture are those that its file stores. Input: the scene, a texture, and its texels.
//! Output: how its levels are made, or an error where the file has no levels or the samplers disagree.

use super::texture_readers::readers;
use crate::core::error::{Error, Result};
use crate::scene::model::Scene;
use crate::texture::data::{Dimension, MipKernel, TextureData};
use crate::texture::sampler_spec::SamplerSpec;

/// Returns how the levels of a texture that is read at levels are made.
pub(super) fn kernel(scene: &Scene, index: usize, texture: &TextureData) -> Result<MipKernel> {
    let own = match scene.textures.get(index).map_or(MipKernel::Box, |t| t.mip_kernel) {
        MipKernel::Auto if texture.stored_levels.is_empty() => MipKernel::Box,
        MipKernel::Auto => MipKernel::Stored,
        stated => stated,
    };
    let named = scene.textures.get(index).map_or(texture.name.as_str(), |t| t.name.as_str());
    let mut asking =
        readers(scene, index).filter(|s| s.reads_levels()).map(|s: &SamplerSpec| s.stored_levels);
    let first = asking.next().unwrap_or(false);
    let is_stored = own == MipKernel::Stored;
    if !is_stored && asking.any(|asks| asks != first) {
        return Err(Error::with_help(
            format!(
                "texture \"{named}\": one sampler that reads it has mip = \"stored\", and another makes its levels anew"
            ),
            "set mip_filter = \"stored\" in the texture, or name a second texture of the same file",
        ));
    }
    if !is_stored && !first {
        return Ok(own);
    }
    let longest = texture.width.max(texture.height);
    let longest = if texture.dimension == Dimension::Three { longest.max(texture.depth) } else { longest };
    if texture.stored_levels.is_empty() && longest > 1 {
        let asked = if is_stored { "mip_filter" } else { "mip" };
        return Err(Error::with_help(
            format!(
                "texture \"{named}\": {asked} = \"stored\" asks for the mip levels of its file, which stores none"
            ),
            "export it as DDS or KTX2 with mip levels, or let them be made: mip = \"linear\", mip_filter = \"box\"",
        ));
    }
    Ok(MipKernel::Stored)
}
