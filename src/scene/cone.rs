//! Adapts a scene to cone tracing, which needs a footprint, and filters that average over it. Input: any scene. Output:
//! the scene that is traced, and a note on the settings that were chosen.

use super::model::{Algorithm, AlphaMode, Footprint, Light, Scene, Sides};
use crate::texture::sampler_spec::{Filter, Method, MipMode, SamplerSpec};

/// Default of the sampler's limit: footprints more elongated than this are blurred.
const ANISOTROPY: u32 = 64;

/// Forces the footprint of cones.
pub fn adapt_footprint(scene: &mut Scene) {
    if scene.sampling.algorithm == Algorithm::Cone {
        scene.sampling.footprint = Footprint::Cone;
    }
}

/// Forces the footprint of cones, and replaces minification filters that do not depend on a footprint in every sampler
/// that names none. Returns a note on the choice.
pub fn adapt_for_cone(scene: &mut Scene) -> Option<&'static str> {
    adapt_footprint(scene);
    let chosen = scene.sampling.algorithm == Algorithm::Cone
        && scene.samplers.iter_mut().map(adapt_sampler).fold(false, |any, one| any | one);
    chosen.then_some(
        "algorithm = \"cone\" averages over footprints: samplers without a filter for that read blended levels, \
         of method \"shader\" along the footprint's longer axis (min = \"anisotropic\", mip = \"linear\")",
    )
}

/// Returns the scene with a single value for each random dimension: a pinhole, everything at the middle of the
/// shutter's time, lights at their centres, sharp reflections.
pub fn freeze_time(scene: &Scene) -> Scene {
    let mut settled = scene.clone();
    let [opens, closes] = scene.camera.shutter;
    let time = 0.5 * (opens + closes);
    let camera = &mut settled.camera;
    let [eye, look_at] = camera.motion;
    (camera.eye, camera.look_at) = (camera.eye + time * eye, camera.look_at + time * look_at);
    (camera.lens, camera.motion) = (None, Default::default());
    settled.shapes.iter_mut().for_each(|shape| shape.freeze(time));
    for light in &mut settled.lights {
        *light = match *light {
            Light::Sphere { position, intensity, .. } => Light::Point { position, intensity },
            Light::Rectangle { position, edge_u, edge_v, radiance } => {
                Light::Point { position, intensity: radiance * edge_u.cross(edge_v).length() }
            }
            Light::Sun { direction, irradiance, .. } => Light::Directional { direction, irradiance },
            other => other,
        };
    }
    settled.lights.retain(|light| !matches!(light, Light::Environment));
    settled.materials.iter_mut().filter(|m| m.model.is_specular()).for_each(|m| m.roughness = 0.0);
    settled.materials.iter_mut().for_each(|m| (m.alpha, m.sides) = (AlphaMode::Opaque, Sides::Both));
    settled
}

/// Replaces a minification filter that does not depend on a footprint, unless the sampler names levels of its own.
pub(super) fn adapt_sampler(sampler: &mut SamplerSpec) -> bool {
    if sampler.needs_footprint() || sampler.min.only_minifies() {
        return false;
    }
    sampler.mip = MipMode::Linear;
    // Texture units differ in how they follow a footprint.
    if sampler.method == Method::Hardware {
        sampler.min = Filter::Linear;
    } else {
        sampler.min = Filter::Anisotropic;
        if sampler.max_anisotropy == SamplerSpec::default().max_anisotropy {
            sampler.max_anisotropy = ANISOTROPY;
        }
    }
    true
}
