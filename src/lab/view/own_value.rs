//! What a scene itself has for an option of the page. Input: the scene and the option's name. Output: the value as text.

use super::SAMPLES;
use crate::output::DisplayTransform;
use crate::scene::model::Scene;
use crate::texture::sampler_spec::{CUBICS, SamplerSpec};

/// The key of the filter of magnification.
pub const MAG: &str = "sampler.*.filter.mag";

/// Returns the value that a scene has; none where its samplers differ, or where it has no samplers.
pub fn own_value(scene: &Scene, name: &str) -> Option<String> {
    let sampling = &scene.sampling;
    let display = DisplayTransform::default();
    Some(match name {
        "algorithm" => sampling.algorithm.name().into(),
        "pattern" => sampling.pattern.name().into(),
        "spp" => sampling.spp.max(SAMPLES).to_string(),
        "seed" => sampling.seed.to_string(),
        "shared" => sampling.shared.to_string(),
        "pixel-filter" => scene.pixel_filter.kind.name().into(),
        "pixel-filter-radius" => scene.pixel_filter.radius.to_string(),
        "footprint" => sampling.footprint.name().into(),
        "precision" => sampling.precision.name().into(),
        "size" => format!("{}x{}", scene.width, scene.height),
        "exposure" => display.exposure.to_string(),
        "white-balance" => "off".into(),
        "tone-map" => display.tone_map.name().into(),
        "gamut" => display.gamut.name().into(),
        _ => {
            let of = |sampler: &SamplerSpec| match name {
                "filter" if sampler.mag != sampler.min => format!("{}/{}", sampler.mag, sampler.min),
                "filter" => sampler.min.name().into(),
                MAG => sampler.mag.name().into(),
                "sampler.*.filter.min" => sampler.min.name().into(),
                "sampler.*.max_anisotropy" => sampler.max_anisotropy.to_string(),
                "sampler.*.cubic" => {
                    let [b, c] = sampler.cubic;
                    let named = CUBICS.iter().find(|(_, own)| *own == sampler.cubic);
                    named.map_or_else(|| format!("[{b}, {c}]"), |(name, _)| (*name).into())
                }
                "mip" if sampler.stored_levels => "stored".into(),
                "mip" => sampler.mip.name().into(),
                "method" => sampler.method.name().into(),
                "sampler.*.texel_center" => sampler.texel_center.name().into(),
                _ => {
                    let [u, v] = sampler.address;
                    if u == v { u.name().into() } else { format!("{u}/{v}") }
                }
            };
            let first = of(scene.samplers.first()?);
            scene.samplers.iter().all(|sampler| of(sampler) == first).then_some(first)?
        }
    })
}
