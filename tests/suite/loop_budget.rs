//! Scenes with long loops: Mesa's CPU driver ends all loops of a thread after 65 535 iterations, so
//! that threads take fewer samples at once.

use moire::internal::core::progress::NoProgress;
use moire::internal::gpu::DeviceKind;
use moire::internal::render::{self, Tuning};
use moire::internal::scene::model::{Footprint, Scene, Triangle};
use moire::internal::texture::sampler_spec::{Filter, MipMode};

use crate::lookup::bench::Rng;
use crate::stage::{device, packed, render, render_on_oracle, scene, small};

/// This number of small triangles in front of the lecture's scene.
fn crowd(count: usize) -> Scene {
    let mut scene = small("lecture", 32, 4);
    scene.shapes.spheres.clear();
    scene.shapes.planes.clear();
    scene.lights.truncate(1);
    let mut rng = Rng::new(7);
    let first = scene.shapes.triangles[0];
    let moved = |_| {
        let by = glam::DVec3::new(rng.between(-1.0, 1.0), rng.between(-0.5, 1.0), rng.between(-1.0, 1.0));
        Triangle { vertices: first.vertices.map(|v| 0.2 * v + by), ..first }
    };
    scene.shapes.triangles = (0..count).map(moved).collect();
    scene
}

fn assert_as_the_oracle(scene: Scene, bound: f64, what: &str) {
    let packed = packed(scene, None);
    let (film, exact) = (render(&packed), render_on_oracle(&packed));
    let pairs = film.pixels.iter().flatten().zip(exact.pixels.iter().flatten());
    let square = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>();
    let rmse = (square / (3 * film.pixels.len()) as f64).sqrt();
    assert!(rmse < bound, "{what}: RMSE {rmse:e}");
}

#[test]
fn hundreds_of_triangles_at_hundreds_of_samples() {
    let mut scene = crowd(300);
    (scene.width, scene.height) = (16, 12);
    scene.sampling.spp = 256;
    // An edge between f32 and f64 moves a sample of 256 in few pixels.
    assert_as_the_oracle(scene, 2e-3, "300 triangles with shadows");
}

#[test]
fn ellipses_up_to_the_horizon_at_hundreds_of_samples() {
    let mut scene = scene("horizon");
    scene.sampling.spp = 256;
    scene.sampling.footprint = Footprint::Cone;
    for sampler in &mut scene.samplers {
        (sampler.min, sampler.mip) = (Filter::Ewa, MipMode::Linear);
    }
    (scene.width, scene.height) = (64, 48);
    assert_as_the_oracle(scene, 2e-3, "the horizon's ellipses");
}

#[test]
fn a_sample_that_alone_is_too_long_is_refused() {
    let scene = packed(crowd(65_000), None);
    let told = render::render(&device(), scene, false, &Tuning::default(), &NoProgress);
    if device().info().kind == DeviceKind::Cpu {
        let message = told.unwrap_err().to_string();
        assert!(message.contains("65535 iterations"), "{message}");
    } else {
        told.unwrap();
    }
}
