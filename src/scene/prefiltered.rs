//! Scenes that show the same by averages over footprints, which err by a bias in place of noise: what a render for a time
//! may choose instead of samples. Input: a scene without a footprint. Output: scenes of one sample, or one cone, a pixel.

use super::cone::{adapt_footprint, adapt_for_cone, adapt_sampler};
use super::limits::check_filters;
use super::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Scene};

/// Returns the scene with one sample in the centre of each pixel, whose look-ups are averages; `None` if it has nothing
/// to average, or a sampler that cannot.
pub fn by_one_sample(scene: &Scene) -> Option<Scene> {
    if !scene.has_square_pixels() {
        return None;
    }
    let mut one = with_algorithm(scene, Algorithm::Adaptive)?;
    one.sampling.footprint = Footprint::Cone;
    one.samplers.iter_mut().for_each(|sampler| {
        adapt_sampler(sampler);
    });
    check_filters(&one).ok().map(|()| one)
}

/// Returns the scene with one cone a pixel; `None` if cones lack something of the scene.
pub fn by_one_cone(scene: &Scene) -> Option<Scene> {
    let is_box = scene.pixel_filter.kind == PixelFilterKind::Box;
    if !is_box || scene.leaves_more_to_chance() || scene.reflects_or_lets_pass() {
        return None;
    }
    let mut one = with_algorithm(scene, Algorithm::Cone)?;
    adapt_footprint(&mut one);
    adapt_for_cone(&mut one);
    check_filters(&one).ok().map(|()| one)
}

fn with_algorithm(scene: &Scene, algorithm: Algorithm) -> Option<Scene> {
    if scene.textures.is_empty() {
        return None;
    }
    let mut one = scene.clone();
    one.sampling.algorithm = algorithm;
    (one.sampling.pattern, one.sampling.spp, one.sampling.shared) = (Pattern::Center, 1, false);
    Some(one)
}
