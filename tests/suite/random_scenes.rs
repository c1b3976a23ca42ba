//! Random scenes of polygons by beams and by cones, on the device and in float64, against the path tracer in
//! float64, which shares none of their code.

mod beams;
mod causes;
mod cones;
mod scenes;
mod truth;

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::scene::model::{Algorithm, Footprint, Scene};

use crate::stage::{packed, render};
use scenes::Kind;

/// Scenes that every run tries, two of each kind; and those of the long run.
const FEW: u64 = 12;
const MANY: u64 = 252;

/// Seeds of the long run: `MOIRE_SEEDS=FROM..TO`, else all.
fn many() -> std::ops::Range<u64> {
    let Ok(seeds) = std::env::var("MOIRE_SEEDS") else { return 0..MANY };
    let ends = seeds.split_once("..").and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    ends.unwrap_or_else(|| panic!("MOIRE_SEEDS={seeds}: FROM..TO wanted"))
}

fn kind_of(seed: u64) -> Kind {
    Kind::ALL[(seed % 6) as usize]
}

fn with(mut scene: Scene, algorithm: Algorithm) -> Scene {
    scene.sampling.algorithm = algorithm;
    scene.sampling.footprint = Footprint::None;
    scene
}

fn film(scene: &Scene, algorithm: Algorithm) -> Film {
    render(&packed(with(scene.clone(), algorithm), None))
}

fn color(pixel: [f32; 3]) -> DVec3 {
    DVec3::from_array(pixel.map(f64::from))
}
