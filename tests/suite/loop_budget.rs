//! Scenes with long loops: Mesa's CPU driver ends all loops of a thread after 65 535 iterations, so
//! that threads take fewer samples at once.

use std::fmt::Write;
use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::gpu::DeviceKind;
use moire::internal::pack::PackedScene;
use moire::internal::render::{self, Tuning};
use moire::internal::scene::model::{
    Algorithm, Footprint, Model, Pattern, PixelFilter, PixelFilterKind, Scene, Triangle,
};
use moire::internal::scene::parse;
use moire::internal::texture::sampler_spec::{Filter, MipMode};

use tempfile::tempdir;

use crate::lookup::bench::Rng;
use crate::stage::{
    device, packed, render, render_on_oracle, render_with, scene, small, sums_apart, unequal_batches,
};

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
    assert_alike(&render(&packed), &render_on_oracle(&packed), bound, what);
}

fn assert_alike(film: &Film, exact: &Film, bound: f64, what: &str) {
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

/// A floor, a wall and a ball that are seen from the front only, and a ring of lights above them. Nothing reflects, so that
/// paths go on through backs alone, of which there are three.
fn under_many_lights(count: usize) -> Scene {
    let mut text = "camera = { eye = [0, 2, 6], look_at = [0, 1, 0], vertical_fov = 50 }\n\
                    image = { width = 16, height = 12 }\nsampling = { spp = 4, max_depth = 64 }\n\
                    [[material]]\nname = 'm'\nsides = 'front'\n\
                    [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, -1]\nmaterial = 'm'\n\
                    [[plane]]\norigin = [0, 0, -2]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n\
                    [[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nmaterial = 'm'\n"
        .to_owned();
    for i in 0..count {
        let (sin, cos) = (i as f64 * std::f64::consts::TAU / count as f64).sin_cos();
        let intensity = 40.0 / count as f64;
        text += &format!(
            "[[light]]\nkind = 'point'\nposition = [{}, 3, {}]\nintensity = [{intensity}, {intensity}, {intensity}]\n",
            3.0 * cos,
            3.0 * sin
        );
    }
    parse(Path::new("lights.toml"), &text).unwrap()
}

#[test]
fn hundreds_of_lights_over_surfaces_without_backs() {
    let of = |count| render_on_oracle(&packed(under_many_lights(count), None)).pixels[100][0];
    assert!(of(500) > 0.1, "they light what is seen");
    // An edge between f32 and f64 moves one sample of 4 and one light of 500.
    assert_as_the_oracle(under_many_lights(500), 2e-3, "500 lights");
}

/// Renders with all samples of a pixel at once, however long that takes; returns the number of submissions, too.
fn render_at_once(scene: &PackedScene) -> (Film, u32) {
    let tuning = Tuning { samples_at_once: Some(scene.samples), ..Tuning::default() };
    let (film, report) = render_with(scene, false, &tuning);
    (film, report.slices)
}

/// Asserts that a device that ends loops takes what is left in further submissions, and that nothing is lost.
fn assert_taken_in_parts(packed: &PackedScene, expected: &Film, bound: f64, what: &str) {
    let (film, slices) = render_at_once(packed);
    assert!(device().info().kind != DeviceKind::Cpu || slices > 4, "{what}: no loop was ended");
    assert_alike(&film, expected, bound, what);
}

#[test]
fn samples_whose_loops_the_device_ends_are_taken_in_parts() {
    let mut scene = crowd(300);
    (scene.width, scene.height) = (16, 12);
    scene.sampling.spp = 256;
    for filter in [PixelFilterKind::Box, PixelFilterKind::Mitchell] {
        scene.pixel_filter = PixelFilter::new(filter, None);
        let packed = packed(scene.clone(), None);
        assert_taken_in_parts(&packed, &render_on_oracle(&packed), 2e-3, &format!("{filter:?}"));
    }
}

#[test]
fn samples_of_meshes_whose_loops_the_device_ends_are_taken_in_parts() {
    let mut scene = scene("meshes");
    (scene.width, scene.height) = (16, 12);
    scene.sampling.spp = 1024;
    let all_by_trees = packed(scene.clone(), None);
    assert_taken_in_parts(&all_by_trees, &render(&all_by_trees), 1e-6, "all rays by trees");
    scene.lights.clear();
    scene.sampling.footprint = Footprint::None;
    scene.sampling.spp = 1 << 16;
    for material in &mut scene.materials {
        material.model = Model::Unlit;
    }
    let in_passes = packed(scene, None);
    assert_taken_in_parts(&in_passes, &render(&in_passes), 1e-5, "passes");
}

/// One sample tests 2000 triangles for a camera ray and as many for each shadow ray.
#[test]
fn batches_whose_loops_the_device_ends_are_taken_in_parts() {
    let mut scene = crowd(2000);
    (scene.width, scene.height) = (16, 12);
    scene.sampling.spp = 128;
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.algorithm = Algorithm::Adaptive;
    let packed = packed(scene, None);
    let batches = unequal_batches(&packed);
    let few = sums_apart(&packed, &batches, &Tuning { samples_at_once: Some(1), ..Tuning::default() });
    let many = sums_apart(&packed, &batches, &Tuning { samples_at_once: Some(128), ..Tuning::default() });
    for (i, (a, b)) in few.iter().zip(&many).enumerate() {
        let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off <= 1e-4, "{:?}: {a:?}, {b:?}", batches[i]);
    }
}

/// A heap of 30 000 large triangles through each of which most light passes: one sample of eight neighbouring pixels turns too
/// often, that of one pixel does not.
#[test]
fn a_sample_that_is_too_long_beside_others_is_taken_alone() {
    let mut rng = Rng::new(1);
    let mut model = String::new();
    for i in 0..30_000 {
        let middle: [f64; 3] = std::array::from_fn(|_| rng.between(-1.0, 1.0));
        for _ in 0..3 {
            let [x, y, z] = middle.map(|m| m + rng.between(-0.3, 0.3));
            writeln!(model, "v {x:.4} {y:.4} {z:.4}").unwrap();
        }
        writeln!(model, "f {} {} {}", 3 * i + 1, 3 * i + 2, 3 * i + 3).unwrap();
    }
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("heap.obj"), model).unwrap();
    let text = "camera = { eye = [0.3, 0.2, 4.0], look_at = [0, 0, -1], vertical_fov = 40 }\n\
                image = { width = 16, height = 12 }\nsampling = { spp = 1 }\n\
                [background]\ncolor = [0.2, 0.3, 0.5]\n\
                [[material]]\nname = 'm'\nmodel = 'unlit'\ncolor = [0.5, 0.2, 0.1]\nalpha = 'blend'\nopacity = 0.01\n\
                [[mesh]]\nfile = 'heap.obj'\nmaterial = 'm'\n";
    let scene = parse(&folder.path().join("heap.toml"), text).unwrap();
    assert_as_the_oracle(scene, 2e-3, "a heap");
}

#[test]
fn a_sample_that_alone_is_too_long_is_an_error() {
    let scene = packed(crowd(65_000), None);
    let told = render::render(&device(), scene, false, &Tuning::default(), &NoProgress);
    if device().info().kind == DeviceKind::Cpu {
        let message = told.unwrap_err().to_string();
        assert!(message.contains("65535 iterations"), "{message}");
    } else {
        told.unwrap();
    }
}
