//! Renders that share device resources are bitwise equal to independent renders.

use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::pack::pack;
use moire::internal::render::{Session, Tuning, render};
use moire::internal::scene::model::{Algorithm, Pattern, Scene};
use moire::internal::texture;

use crate::stage;
use crate::stage::device;

fn load(name: &str) -> Scene {
    let mut scene = stage::scene(name);
    (scene.width, scene.height) = (24, 18);
    moire::internal::scene::prune::prune(&mut scene);
    scene
}

fn packed(scene: &Scene) -> moire::internal::pack::PackedScene {
    pack(scene, scene.textures.iter().map(|t| texture::load::load(t).unwrap()).collect(), None).unwrap()
}

fn alone(scene: &Scene) -> Film {
    let gpu = device();
    render(&gpu, packed(scene), false, &Tuning::default(), &NoProgress).unwrap().0
}

/// Pixels left by beams take the samples of the current choice, not those for which the scene was packed.
#[test]
fn samples_beside_beams_are_those_that_are_asked_for() {
    let mut base = load("s2");
    base.sampling.algorithm = Algorithm::Beam;
    let variant = |pattern, spp| {
        let mut scene = base.clone();
        scene.sampling = moire::internal::scene::model::Sampling { pattern, spp, ..scene.sampling };
        scene
    };
    let gpu = device();
    let session = Session::open(&gpu, packed(&base), false, &Tuning::default()).unwrap();
    for scene in
        [variant(Pattern::Stratified, 1), variant(Pattern::Random, 5), variant(Pattern::Stratified, 64)]
    {
        let (film, report) = session.prepare_sampling(&scene).unwrap().render(&NoProgress).unwrap();
        assert!(report.sampled_pixels > Some(0));
        assert!(film == alone(&scene), "{:?}", scene.sampling);
    }
}

#[test]
fn renders_in_turn_equal_renders_alone() {
    for name in ["s2", "filters"] {
        let base = load(name);
        let variant = |pattern, spp, seed| {
            let mut scene = base.clone();
            scene.sampling = moire::internal::scene::model::Sampling { pattern, spp, seed, ..scene.sampling };
            scene
        };
        // More than 256 samples need the film's second half.
        let scenes = [
            variant(Pattern::Stratified, 4, 1),
            variant(Pattern::Random, 5, 7),
            variant(Pattern::Stratified, 324, 1),
        ];
        let gpu = device();
        let session = Session::open(&gpu, packed(&base), false, &Tuning::default()).unwrap();
        let prepared: Vec<_> = scenes.iter().map(|s| session.prepare_sampling(s).unwrap()).collect();
        let alone: Vec<Film> = scenes.iter().map(alone).collect();
        for round in 0..2 {
            for ((scene, expected), prepared) in scenes.iter().zip(&alone).zip(&prepared) {
                let (film, report) = prepared.render(&NoProgress).unwrap();
                assert!(film == *expected, "{name}, round {round}, {:?}", scene.sampling);
                assert!(report.seconds.render > 0.0 && report.seconds.compile > 0.0);
            }
        }
    }
}
