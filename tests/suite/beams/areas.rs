//! Areas of visible fragments: they sum to the pixel's area in any depth order, and each is
//! correct.

use glam::{DVec2, DVec3};
use moire::internal::oracle::polygon::{area, split, unit_square};
use moire::internal::scene::model::{Model, Scene, Triangle};

use super::{beams, rmse, with_beams, with_samples};
use crate::lookup::bench::Rng;
use crate::stage::{render, render_on_oracle, small};

#[test]
fn both_sides_of_a_cut_make_the_whole() {
    let mut rng = Rng::new(3);
    for _ in 0..2000 {
        let mut rest = unit_square();
        for _ in 0..6 {
            let angle = rng.between(0.0, 6.3);
            let through = DVec2::new(rng.between(0.0, 1.0), rng.between(0.0, 1.0));
            let n = DVec2::new(angle.cos(), angle.sin());
            let [inside, outside] = split(&rest, n.extend(-n.dot(through)));
            let (whole, parts) = (area(&rest), area(&inside) + area(&outside));
            assert!((whole - parts).abs() < 1e-14, "{whole} and {parts}");
            assert!(area(&inside) >= -1e-15 && area(&outside) >= -1e-15);
            rest = if area(&inside) > 0.2 { inside } else { outside };
        }
    }
}

/// Random triangles, in front of nothing; many intersect.
fn soup(count: usize, seed: u32, colors: impl Fn(usize) -> DVec3) -> Scene {
    let mut scene = small("beams", 24, 4);
    scene.shapes.planes.clear();
    scene.lights.clear();
    let mut rng = Rng::new(seed.into());
    let plain = scene.materials.iter().find(|m| m.name == "brown").unwrap().clone();
    scene.materials = (0..count)
        .map(|i| moire::internal::scene::model::Material {
            model: Model::Unlit,
            color: colors(i),
            ..plain.clone()
        })
        .collect();
    let first = scene.shapes.triangles[0];
    let mut corner = || DVec3::new(rng.between(-0.9, 0.9), rng.between(-0.4, 1.4), rng.between(-0.9, 0.9));
    scene.shapes.triangles = (0..count)
        .map(|material| Triangle { vertices: [corner(), corner(), corner()], material, ..first })
        .collect();
    // Two coplanar ones that overlap.
    let [a, b, c] = scene.shapes.triangles[0].vertices;
    scene.shapes.triangles[1].vertices = [a + 0.3 * (b - a), b + 0.4 * (c - b), c + 0.2 * (b - c)];
    scene
}

/// Everything white: any gap or overlap of areas would show.
#[test]
fn pieces_fill_the_pixel() {
    for seed in 0..12 {
        let mut scene = soup(7, seed, |_| DVec3::ONE);
        scene.background.color = DVec3::ONE;
        for pixel in render_on_oracle(&with_beams(scene)).pixels.iter().flatten() {
            // Dropped fragments: 1e-7 each.
            assert!((pixel - 1.0).abs() < 5e-6, "seed {seed}: {pixel}");
        }
    }
}

#[test]
fn the_nearest_of_triangles_in_disorder_is_seen() {
    for seed in 0..4 {
        let hue = |i: usize| DVec3::new((i % 2) as f64, (i / 2 % 2) as f64, (i / 4 % 2) as f64);
        let scene = soup(7, 40 + seed, hue);
        let beamed = with_beams(scene.clone());
        let (film, sampled) = beams(&beamed);
        assert_eq!(sampled, 0, "seed {seed}");
        let exact = rmse(&film, &render_on_oracle(&beamed));
        assert!(exact < 1e-4, "seed {seed}: device and oracle differ by {exact:e}"); // edges that meet in f32
        let apart = rmse(&film, &render(&with_samples(scene, 64 * 64)));
        // Edges at 4096 stratified samples: contrast 1, N^-0.75 = 2e-3 in pixels of edges.
        assert!(apart < 2e-3, "seed {seed}: RMSE {apart:e}");
    }
}

/// A triangle of known size before black: the sum of all coverages is its area in the picture.
#[test]
fn a_triangle_covers_its_area() {
    let mut scene = soup(2, 5, |_| DVec3::ONE);
    scene.background.color = DVec3::ZERO;
    scene.camera.projection = moire::internal::scene::model::Projection::Orthographic(4.0);
    scene.shapes.triangles.truncate(1);
    let forward = (scene.camera.look_at - scene.camera.eye).normalize();
    let [a, b, c] = scene.shapes.triangles[0].vertices;
    let pixel = 4.0 / f64::from(scene.height);
    let expected = 0.5 * (b - a).cross(c - a).dot(forward).abs() / (pixel * pixel);
    let (film, _) = beams(&with_beams(scene));
    let covered: f64 = film.pixels.iter().map(|p| f64::from(p[0])).sum();
    assert!((covered - expected).abs() < 1e-4 * expected, "{covered} pixels for {expected}"); // f32 lines
}
