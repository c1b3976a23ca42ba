//! Cone tracing: the coverage of a cone, and pictures with one cone per pixel.

mod coverage;
mod extremes;
mod floors;
mod scenes;

use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::compare;
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, Scene};
use moire::internal::scene::{cone, parse};

use crate::stage::{packed, render, render_on_oracle};

/// Looking along -z from (0, 0, 4); a picture of height 2 where z = 0.
fn parallel(side: u32, text: &str) -> Scene {
    let view = format!(
        "[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\northographic_height = 2
[image]\nwidth = {side}\nheight = {side}\n[sampling]\nalgorithm = 'cone'
[[material]]\nname = 'white'\nmodel = 'unlit'\n[[material]]\nname = 'mirror'\nmodel = 'mirror'\n{text}"
    );
    parse(Path::new("cone.toml"), &view).unwrap_or_else(|e| panic!("{e}\n{view}"))
}

/// The same from a point.
fn central(side: u32, text: &str) -> Scene {
    let mut scene = parallel(side, text);
    scene.camera.projection = moire::internal::scene::model::Projection::VerticalFov(40.0);
    scene
}

fn with_cones(mut scene: Scene) -> Scene {
    scene.sampling.algorithm = Algorithm::Cone;
    cone::adapt_for_cone(&mut scene);
    scene
}

/// The scene with this number of samples per pixel (a power of two), without a footprint.
fn with_samples(mut scene: Scene, spp: u32) -> Scene {
    scene.sampling.algorithm = Algorithm::Samples;
    scene.sampling.footprint = Footprint::None;
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.spp = spp;
    scene
}

fn film(scene: Scene) -> Film {
    render(&packed(scene, None))
}

fn exact_film(scene: Scene) -> Film {
    render_on_oracle(&packed(scene, None))
}

fn rmse(a: &Film, b: &Film) -> f64 {
    compare(a, b).unwrap().rmse
}
