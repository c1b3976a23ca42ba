//! Samplers with normalized coordinates. Creates the `VkSampler` of a sampler description, or
//! returns an error that names the missing device feature.

use std::sync::Arc;

use ash::vk;

use super::convert;
use super::device::Core;
use super::result::WithOperation;
use crate::core::error::{Error, Result};
use crate::texture::sampler_spec::{Address, MipMode, SamplerSpec};

/// A sampler. Clones share the same Vulkan object.
#[derive(Clone)]
pub struct Sampler(Arc<RawSampler>);

struct RawSampler {
    core: Arc<Core>,
    handle: vk::Sampler,
    linear: bool,
}

impl Sampler {
    pub(super) fn new(core: &Arc<Core>, spec: &SamplerSpec) -> Result<Sampler> {
        check(core, spec)?;
        let [u, v] = spec.address.map(convert::address);
        let (mip, max_lod) = convert::mip(spec.mip);
        let border = border_color(spec);
        let mut custom = vk::SamplerCustomBorderColorCreateInfoEXT::default()
            .custom_border_color(vk::ClearColorValue { float32: spec.border_color })
            .format(vk::Format::UNDEFINED);
        let mut info = vk::SamplerCreateInfo::default()
            .mag_filter(convert::filter(spec.mag))
            .min_filter(convert::filter(spec.min))
            .mipmap_mode(mip)
            .address_mode_u(u)
            .address_mode_v(v)
            .address_mode_w(convert::address(spec.address_w))
            .min_lod(spec.min_lod)
            .max_lod(max_lod.max(spec.min_lod))
            .anisotropy_enable(anisotropic(spec))
            .max_anisotropy((spec.max_anisotropy as f32).min(core.info.limits.max_anisotropy))
            .border_color(border);
        if border == vk::BorderColor::FLOAT_CUSTOM_EXT {
            info = info.push_next(&mut custom);
        }
        // SAFETY: features that the create info needs were checked.
        let handle = unsafe { core.device.create_sampler(&info, None) }
            .during(|| format!("creating sampler {}", spec.label()))?;
        core.set_name(handle, || format!("sampler {}", spec.label()));
        let linear = spec.blends() || spec.mip == MipMode::Linear;
        Ok(Sampler(Arc::new(RawSampler { core: Arc::clone(core), handle, linear })))
    }

    pub(super) fn core(&self) -> &Arc<Core> {
        &self.0.core
    }

    pub(super) fn handle(&self) -> vk::Sampler {
        self.0.handle
    }

    /// Returns true if the sampler filters linearly, which not every format supports.
    pub(super) fn is_linear(&self) -> bool {
        self.0.linear
    }
}

fn anisotropic(spec: &SamplerSpec) -> bool {
    spec.follows_axis()
}

/// Returns the border colour. The requested colour matters only if some axis clamps to the border.
fn border_color(spec: &SamplerSpec) -> vk::BorderColor {
    if spec.has(Address::ClampToBorder) {
        convert::border_color(spec.border_color)
    } else {
        vk::BorderColor::FLOAT_TRANSPARENT_BLACK
    }
}

fn check(core: &Core, spec: &SamplerSpec) -> Result<()> {
    let limits = &core.info.limits;
    if anisotropic(spec) && limits.max_anisotropy <= 1.0 {
        return Err(Error::with_help(
            format!("sampler {}: {} has no anisotropic filtering", spec.label(), core.info.name),
            "Use method = \"shader\", which has it on every device.",
        ));
    }
    if spec.has(Address::MirrorClampToEdge) && !limits.mirror_clamp_to_edge {
        return Err(Error::with_help(
            format!("sampler {}: {} has no mirror-clamp-to-edge", spec.label(), core.info.name),
            "Use method = \"shader\", which has every address mode on every device.",
        ));
    }
    if border_color(spec) == vk::BorderColor::FLOAT_CUSTOM_EXT && !limits.custom_border_color {
        return Err(Error::with_help(
            format!(
                "sampler {}: {} has only the border colors [0, 0, 0, 0], [0, 0, 0, 1] and [1, 1, 1, 1], not {:?}",
                spec.label(),
                core.info.name,
                spec.border_color
            ),
            "Use one of the three, or method = \"shader\", which has every border color.",
        ));
    }
    Ok(())
}

impl Drop for RawSampler {
    fn drop(&mut self) {
        // SAFETY: calls are synchronous, so the device does not use the sampler.
        self.core.release(|device| unsafe { device.destroy_sampler(self.handle, None) });
    }
}
