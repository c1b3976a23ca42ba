//! The error of cones in random scenes, and the cases that must be correct: two shapes that share a
//! cone, and no visibility through a third.

use glam::{DVec2, DVec3};
use moire::internal::core::film::Film;
use moire::internal::lab::metrics::compare;
use moire::internal::oracle::camera::camera_ray;
use moire::internal::oracle::cone::{Cone, cone_of};
use moire::internal::oracle::footprint::camera_differential;
use moire::internal::oracle::fragments::{collect_fragments, composite};
use moire::internal::oracle::geometry::rays::{FAR, nearest_hit};
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::{Algorithm, Scene};

use super::scenes::{scene, text};
use super::{FEW, color, film, kind_of, many, with};
use crate::stage::packed;

/// Without the checker, whose mean over a cone's footprint is a separate matter.
pub fn plain(seed: u64, side: u32) -> Scene {
    let mut scene = scene(&text(kind_of(seed), seed, side));
    scene.materials.iter_mut().for_each(|m| m.texture = None);
    scene.sampling.spp = 1024;
    scene
}

/// RMSE, and the worst pixel's largest channel.
fn error(scene: &Scene) -> [f64; 2] {
    let [cones, truth]: [Film; 2] = [Algorithm::Cone, Algorithm::Samples].map(|a| film(scene, a));
    let off = |(p, q): (&[f32; 3], &[f32; 3])| (color(*p) - color(*q)).abs().max_element();
    let worst = cones.pixels.iter().zip(&truth.pixels).map(off).fold(0.0, f64::max);
    [compare(&cones, &truth).unwrap().rmse, worst]
}

/// As in docs/guide/learn/11-cones.md.
const WORST_RMSE: f64 = 0.02;
const WORST_PIXEL: f64 = 0.4;

#[test]
fn cones_err_as_documented() {
    let errors: Vec<[f64; 2]> = (0..FEW / 2).map(|seed| error(&plain(seed, 32))).collect();
    assert!(errors.iter().all(|e| e[0] < WORST_RMSE && e[1] < WORST_PIXEL), "{errors:?}");
}

/// Prints the figures of docs/guide/learn/11-cones.md: medians and worst of both errors, by kind, lit or not.
#[test]
#[ignore = "minutes"]
fn figures_for_the_docs() {
    let mut all = Vec::new();
    for seed in many() {
        let scene = plain(seed, 64);
        let lit = !scene.lights.is_empty();
        all.push((kind_of(seed), lit, error(&scene)));
    }
    for kind in super::Kind::ALL {
        for lit in [false, true] {
            let of = all.iter().filter(|e| (e.0, e.1) == (kind, lit));
            let mut errors: Vec<[f64; 2]> = of.map(|e| e.2).collect();
            let mut column = |c: usize| {
                errors.sort_by(|a, b| a[c].total_cmp(&b[c]));
                [errors.len() / 2, errors.len() * 9 / 10, errors.len() - 1].map(|k| errors[k][c])
            };
            println!("{kind:?}, lit {lit}: RMSE {:.4?}, worst pixel {:.3?}", column(0), column(1));
        }
    }
    assert!(all.iter().all(|e| e.2[0] < WORST_RMSE && e.2[1] < WORST_PIXEL));
}

const RINGS: u32 = 24;

/// Returns the coverage by rays through points all over the disc, by shape; last that of the background.
fn by_rays(scene: &PackedScene, cone: &Cone, shapes: usize) -> Vec<f64> {
    let mut shares = vec![0.0; shapes + 1];
    let around = 3 * RINGS;
    for (ring, k) in (0..RINGS).flat_map(|ring| (0..around).map(move |k| (ring, k))) {
        let radius = ((f64::from(ring) + 0.5) / f64::from(RINGS)).sqrt();
        let angle = std::f64::consts::TAU * (f64::from(k) + 0.37 * f64::from(ring)) / f64::from(around);
        let hit = nearest_hit(
            scene,
            &cone.ray_at(radius * DVec2::from_angle(angle)),
            moire::internal::schema::layout::NO_SHAPE,
        );
        shares[(hit.shape as usize).min(shapes)] += 1.0 / f64::from(RINGS * around);
    }
    shares
}

/// Tolerance of the coverages of one and of two fragments; and, smaller, of the last one, the background's,
/// if some shape covers the whole cone.
fn shares_off(scene: &Scene) -> [f64; 3] {
    let packed = packed(with(scene.clone(), Algorithm::Cone), None);
    let header = &packed.header;
    let shapes = scene.shapes.planes.len() + scene.shapes.triangles.len();
    let mut off = [0.0f64; 3];
    for place in (0..scene.width * scene.height).map(|i| [i % scene.width, i / scene.width]) {
        let ray = camera_ray(header, place, DVec2::splat(0.5));
        let beam = camera_differential(header, &ray);
        let cone = cone_of(ray, beam.width, beam.spread, header.step_x);
        let mut pieces = collect_fragments(&packed, &cone, moire::internal::schema::layout::NO_SHAPE, FAR);
        let rest = composite(&mut pieces, &packed, &cone).share;
        if pieces.list.iter().any(|p| p.area >= 1.0) {
            off[2] = off[2].max(rest);
        }
        if !(1..=2).contains(&pieces.list.len()) {
            continue;
        }
        let mut wanted = by_rays(&packed, &cone, shapes);
        let mut worst = (wanted[shapes] - rest).abs();
        for piece in &pieces.list {
            worst = worst.max((std::mem::take(&mut wanted[piece.shape as usize]) - piece.seen).abs());
        }
        let count = pieces.list.len() - 1;
        off[count] = off[count].max(worst).max(wanted[..shapes].iter().sum());
    }
    off
}

/// Also if the centroid of a fragment is in front of another fragment that is hidden by it entirely.
#[test]
fn two_shapes_in_a_cone_are_exact_and_hide_what_is_behind_them() {
    for seed in (0..FEW).chain([41, 39]) {
        let [one, two, through] = shares_off(&plain(seed, 32));
        // An edge across 24 rings of 72 rays: half a ring's width of 1/48 over 4 rings.
        assert!(one < 0.01 && two < 0.01, "seed {seed}: {one}, {two}");
        assert!(through < 1e-4, "seed {seed}: {through} of the background through what covers all");
    }
}

/// Three planes, each of which covers all of the pixel in which they meet.
#[test]
fn nothing_shines_through_where_three_planes_meet() {
    let room = "
[[plane]]\norigin = [0.01, 0, 0]\ntangent = [1, 0.9, 0.4]\nbitangent = [0, 1, -0.3]\nmaterial = 'white'
[[plane]]\norigin = [0, 0.012, 0]\ntangent = [1, -0.7, 0.1]\nbitangent = [0.2, 1, 0.5]\nmaterial = 'white'
[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0.1, -0.6]\nbitangent = [0, 1, 0.1]\nmaterial = 'white'
[[material]]\nname = 'white'\nmodel = 'unlit'
[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\nvertical_fov = 40
[image]\nwidth = 16\nheight = 16
[background]\ncolor = [9, 0, 0]\n";
    let scene = scene(room);
    for pixel in &film(&scene, Algorithm::Cone).pixels {
        assert!((color(*pixel) - DVec3::ONE).abs().max_element() < 1e-3, "{pixel:?}"); // shares below 1e-5 of 9
    }
}
