//! Textures with texels that are NaN or infinite and were accepted on purpose: counts them, and checks that
//! all readers confine them to the pixels that show them. Other readers are refused, with an alternative.

use super::texture_readers::readers;
use super::textures::reads;
use super::{PackedScene, TextureKind, textures};
use crate::core::counted::{counted, verb};
use crate::core::error::{Error, Result};
use crate::scene::model::Scene;
use crate::texture::data::{MipKernel, TextureData};
use crate::texture::sampler_spec::{Method, SamplerSpec};

/// Counts such texels, and refuses scenes in which they would spoil a whole texture.
pub fn admit(packed: &mut PackedScene, scene: &Scene, textures: &[TextureData]) -> Result<()> {
    packed.nonfinite_texels = textures.iter().map(TextureData::nonfinite_texels).collect();
    for (i, texture) in textures.iter().enumerate().filter(|(i, _)| packed.nonfinite_texels[*i] > 0) {
        let count = packed.nonfinite_texels[i];
        let refused = |what: &str, instead: &str| {
            let message = format!(
                "texture \"{}\": {} {} not finite, and {what}",
                texture.name,
                counted(count, "texel"),
                verb(count, "is", "are")
            );
            Err(Error::with_help(message, instead))
        };
        if packed.beams && textures::kind(texture) == TextureKind::Flat {
            return refused(
                "algorithm \"beam\" reads sums over whole rows, which one of them spoils",
                "use --algorithm samples, adaptive or cone",
            );
        }
        if reads(packed, scene, i, SamplerSpec::needs_sums) {
            return refused(
                "filter \"summed-area\" reads sums over the whole texture, which one of them spoils",
                "use filter \"ewa\" or \"anisotropic\"",
            );
        }
        if readers(scene, i).any(|s| s.method == Method::Hardware) {
            return refused(
                "method \"hardware\" leaves it to the driver what becomes of a texel that has no weight",
                "use --method shader",
            );
        }
        let kernel = scene.textures.get(i).map_or(MipKernel::Box, |t| t.mip_kernel);
        if kernel == MipKernel::Kaiser && reads(packed, scene, i, SamplerSpec::reads_levels) {
            return refused(
                "mip_filter \"kaiser\" has negative weights, which make no mean of what is left",
                "use mip_filter = \"box\", which averages over the other texels",
            );
        }
    }
    Ok(())
}

impl PackedScene {
    /// Returns true if some texel may be NaN or infinite.
    pub fn has_nonfinite(&self) -> bool {
        self.nonfinite_texels.iter().any(|&count| count > 0)
    }
}
