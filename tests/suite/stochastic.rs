//! Sample dimensions beyond the pixel position: points on the lens and on lights, times, lobes.
//! Tests the mappings, the pictures against theory, and the gain by sample patterns in each.

mod fresnel;
mod glossy;
mod lens;
mod lights;
mod motion;
mod rectangles;
mod warps;

use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::compare;
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::model::{Pattern, Scene};
use moire::internal::scene::parse;
use moire::internal::scene::prune::prune;

use crate::stage::render;

fn parsed(text: &str) -> Scene {
    let mut scene = parse(Path::new("stochastic.toml"), text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    prune(&mut scene);
    scene
}

/// A scene without textures.
fn packed(scene: &Scene) -> PackedScene {
    pack::pack(scene, Vec::new(), None).unwrap()
}

fn sampled(scene: &Scene, pattern: Pattern, spp: u32, seed: u32) -> Film {
    let mut scene = scene.clone();
    (scene.sampling.pattern, scene.sampling.spp, scene.sampling.seed) = (pattern, spp, seed);
    render(&packed(&scene))
}

/// Returns the mean over seeds of the squared error against many samples.
fn variance(scene: &Scene, pattern: Pattern, spp: u32, exact: &Film) -> f64 {
    let of_seed = |seed| compare(&sampled(scene, pattern, spp, seed), exact).unwrap().rmse.powi(2);
    (1..=4).map(of_seed).sum::<f64>() / 4.0
}

/// At 64 samples per pixel the patterns have less than `share` of the variance of random points.
fn assert_patterns_gain(what: &str, scene: &Scene, share: f64) {
    let exact = sampled(scene, Pattern::SobolOwen, 8192, 99);
    let random = variance(scene, Pattern::Random, 64, &exact);
    for pattern in [Pattern::Stratified, Pattern::SobolOwen] {
        let left = variance(scene, pattern, 64, &exact) / random;
        assert!(left < share, "{what}: {pattern} leaves {left:.3} of the variance, {share} allowed");
        assert!(left > 1e-4, "{what}: nothing was left to chance");
    }
}
