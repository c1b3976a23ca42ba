//! Warnings about a scene: settings that are valid but have no effect, or an unexpected one, in this scene or on this
//! device.

use glam::DVec3;

use super::model::{Algorithm, Footprint, Light, Material, PixelFilter, Scene};
use crate::texture::sampler_spec::{Method, MipMode, SamplerSpec};

/// Returns the warnings of a scene, whose unused samplers have been removed.
pub fn of_scene(scene: &Scene) -> Vec<String> {
    let algorithm = scene.sampling.algorithm;
    let mut told = match algorithm {
        // It goes without a footprint by itself, as a prefilter's bias would stay.
        Algorithm::Auto => Vec::new(),
        _ => without_effect(scene.sampling.footprint, &scene.samplers),
    };
    told.extend(without_light(scene));
    told.extend(scene.notes.iter().cloned());
    match scene.dropped_triangles {
        0 => {}
        1 => told.push(format!("a triangle ({}) has no area and was left out", scene.first_dropped)),
        count => told.push(format!(
            "{count} triangles have no area and were left out, the first in {}",
            scene.first_dropped
        )),
    }
    if let Some(address) = scene.background.environment.and_then(|e| e.idle_address) {
        told.push(format!(
            "an equirectangular environment goes on over its poles: address \"{address}\" of its sampler has no effect \
             on v; write address = [\"repeat\", \"clamp-to-edge\"]"
        ));
    }
    if algorithm == Algorithm::Beam && scene.lets_rays_pass() {
        told.push("beams end at the first surface: where some material has alpha or one side every pixel takes samples".into());
    } else if algorithm == Algorithm::Beam && !scene.supports_beams() {
        told.push(
            "one beam a pixel takes all rays of a square alike, from one place at one time: with another pixel \
             filter than \"box\", a lens or motion every pixel takes samples"
                .into(),
        );
    }
    if algorithm == Algorithm::Cone && scene.leaves_more_to_chance() {
        told.push(
            "cones choose nothing by chance: no lens, everything as in the middle of the shutter's time, lights as \
             points at their middles, sharp reflections"
                .into(),
        );
    }
    if algorithm == Algorithm::Cone && scene.reflects_or_lets_pass() {
        told.push(
            "cones see no alpha, both sides of every surface, no light of the environment on surfaces, and no \
             reflections on model \"metallic-roughness\""
                .into(),
        );
    }
    if algorithm == Algorithm::Cone && scene.pixel_filter != PixelFilter::default() {
        told.push("a cone stands for its pixel's own square: pixel_filter has no effect".into());
    }
    told
}

fn without_effect(footprint: Footprint, samplers: &[SamplerSpec]) -> Vec<String> {
    if footprint != Footprint::None {
        return Vec::new();
    }
    let asked: Vec<String> = samplers.iter().flat_map(idle_settings).collect();
    let mut distinct: Vec<&str> = Vec::new();
    asked.iter().for_each(|s| {
        if !distinct.contains(&s.as_str()) {
            distinct.push(s)
        }
    });
    if distinct.is_empty() {
        return Vec::new();
    }
    vec![format!(
        "footprint = \"none\" makes every look-up a magnification: {} has no effect; \
         set footprint = \"cone\" under [sampling], or --footprint cone",
        distinct.join(", ")
    )]
}

/// Warns about materials that reflect the light of lights in a scene without any.
fn without_light(scene: &Scene) -> Option<String> {
    if scene.lights.iter().any(shines) {
        return None;
    }
    let waits = |m: &&Material| m.model.is_lit() && m.color.max_element() > 0.0;
    let dark: Vec<String> = scene
        .materials
        .iter()
        .filter(waits)
        .map(|m| format!("\"{}\" (model \"{}\")", m.name, m.model))
        .collect();
    if dark.is_empty() {
        return None;
    }
    let (plural, verb) = if dark.len() == 1 { ("", "is") } else { ("s", "are") };
    let reason = match (scene.lights.is_empty(), scene.background.environment) {
        (false, _) => "all lights have zero power",
        (true, Some(_)) => {
            "the scene has no [[light]], and its environment is seen but lights nothing (kind = \"environment\" is a light)"
        }
        (true, None) => "the scene has no [[light]]",
    };
    let names = dark.join(", ");
    Some(format!(
        "nothing lights material{plural} {names}, which {verb} black: {reason}; add a [[light]], or set \
         model = \"unlit\" to show the colour itself"
    ))
}

fn shines(light: &Light) -> bool {
    let power = match *light {
        Light::Point { intensity, .. } | Light::Sphere { intensity, .. } => intensity,
        Light::Directional { irradiance, .. } | Light::Sun { irradiance, .. } => irradiance,
        Light::Rectangle { radiance, .. } => radiance,
        Light::Spot { intensity, .. } => intensity,
        Light::Environment => DVec3::ONE,
    };
    power.max_element() > 0.0
}

/// Returns the settings that only apply to minification.
fn idle_settings(spec: &SamplerSpec) -> Vec<String> {
    let mut idle = Vec::new();
    if spec.min != spec.mag {
        idle.push(format!("min = \"{}\"", spec.min));
    }
    if spec.mip != MipMode::None {
        idle.push(format!("mip = \"{}\"", spec.mip));
    }
    idle
}

/// Returns true if the device's own samplers filter anisotropically in this scene.
pub fn samples_anisotropically(scene: &Scene) -> bool {
    scene.sampling.footprint != Footprint::None && scene.samplers.iter().any(follows_footprints)
}

fn follows_footprints(spec: &SamplerSpec) -> bool {
    spec.method == Method::Hardware && spec.follows_axis()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::sampler_spec::Filter;

    #[test]
    fn filters_without_a_footprint_are_told() {
        let plain = SamplerSpec::default();
        let mipped = SamplerSpec { mip: MipMode::Linear, ..plain };
        let long = SamplerSpec { min: Filter::Ewa, ..mipped };
        assert!(without_effect(Footprint::None, &[plain]).is_empty());
        assert!(without_effect(Footprint::Cone, &[mipped, long]).is_empty());
        let told = without_effect(Footprint::None, &[mipped, long, mipped]);
        assert_eq!(told.len(), 1);
        assert_eq!(told[0].matches("mip = \"linear\"").count(), 1, "{}", told[0]);
        assert!(told[0].contains("min = \"ewa\"") && told[0].contains("--footprint cone"), "{}", told[0]);
    }

    #[test]
    fn only_the_devices_own_samplers_follow_footprints() {
        let shader = SamplerSpec { min: Filter::Anisotropic, ..SamplerSpec::default() };
        assert!(!follows_footprints(&shader));
        assert!(follows_footprints(&SamplerSpec { method: Method::Hardware, ..shader }));
        assert!(!follows_footprints(&SamplerSpec { method: Method::Hardware, ..SamplerSpec::default() }));
    }
}
