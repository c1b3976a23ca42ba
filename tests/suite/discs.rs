//! Discs: their area, their texture coordinates from the formulas of the scene format, and pictures by beams against
//! pictures by samples.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use glam::{DVec2, DVec3};
use moire::internal::core::film::Film;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::rays::{hit_surface, nearest_hit};
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::{Algorithm, Disc, Scene};
use moire::internal::scene::parse;
use moire::internal::schema::layout::NO_SHAPE;

use crate::lookup::bench::{Rng, Vectors};
use crate::stage::{packed, render};

/// Seen along -z from (0, 0, 4), without perspective: 2 units are `side` pixels.
fn parallel(side: u32, shapes: &str) -> Scene {
    let text = format!(
        "[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\northographic_height = 2\n[image]\nwidth = {side}\n\
         height = {side}\n[sampling]\npattern = 'stratified'\nspp = 256\n[[material]]\nname = 'white'\n\
         model = 'unlit'\n{shapes}"
    );
    parse(Path::new("test.toml"), &text).unwrap()
}

fn light(film: &Film) -> f64 {
    film.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / film.pixels.len() as f64
}

/// π r² cos of the angle between normal and view, of a picture of 4 square units, however the disc is turned.
#[test]
fn a_disc_covers_the_area_of_its_ellipse() {
    for (normal, cosine) in
        [("[0, 0, 1]", 1.0), ("[0, 0, -5]", 1.0), ("[0, 3, 4]", 0.8), ("[-4, 0, -3]", 0.6)]
    {
        let disc = format!(
            "[[disc]]\ncenter = [0.05, 0.1, 0.3]\nnormal = {normal}\nradius = 0.7\nmaterial = 'white'\n"
        );
        let area = PI * 0.49 * cosine / 4.0;
        for (algorithm, bound) in
            [(Algorithm::Samples, 2e-4), (Algorithm::Beam, 2e-4), (Algorithm::Cone, 3e-3)]
        {
            let mut scene = parallel(48, &disc);
            scene.sampling.algorithm = algorithm;
            let found = light(&render(&packed(scene, None)));
            assert!((found - area).abs() < bound, "{normal} by {algorithm}: {found}, not {area}");
        }
    }
}

fn disc_scene(disc: &Disc, uv: &str) -> PackedScene {
    let three = |v: DVec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let text = format!(
        "[[disc]]\ncenter = {}\nnormal = {}\nradius = {:?}\nuv = '{uv}'\nmaterial = 'white'\n",
        three(disc.center),
        three(disc.normal),
        disc.radius
    );
    let mut scene = parallel(1, &text);
    scene.sampling.precision = moire::internal::scene::model::Precision::Double;
    packed(scene, None)
}

/// (x, y)/2r + ½ and (φ/2π, distance/r) of points that are given by angle and distance in the documented frame; and
/// their gradients from differences of neighbouring points.
#[test]
fn texture_coordinates_follow_their_formulas_and_gradients_their_differences() {
    let mut rng = Rng::new(31);
    for _ in 0..300 {
        let (normal, center) = (rng.direction(), rng.vector(1.5));
        let disc = Disc::new(center, normal, rng.between(0.2, 3.0));
        let [x, y] = disc.axes();
        assert!((x.cross(y) - normal).length() < 1e-12, "not right-handed: {normal}");
        assert!(x.dot(y).abs() < 1e-12 && (x.length() - 1.0).abs() < 1e-12, "no frame: {normal}");
        let (angle, part) = (rng.unit(), rng.between(0.05, 0.95));
        let unit = DVec2::from_angle(TAU * angle) * part;
        let point = center + disc.radius * (unit.x * x + unit.y * y);
        let scenes = ["planar", "polar"].map(|uv| disc_scene(&disc, uv));
        for (scene, expected) in scenes.iter().zip([0.5 * unit + 0.5, DVec2::new(angle, part)]) {
            let at = |place: DVec3| {
                let from = place + 2.0 * normal - DVec3::new(0.0, 0.0, 4.0);
                let ray = Ray { origin: from, direction: -normal, time: 0.0 };
                let hit = nearest_hit(scene, &ray, NO_SHAPE);
                assert_ne!(hit.shape, NO_SHAPE, "the ray misses its point");
                hit_surface(scene, &ray, &hit)
            };
            let surface = at(point);
            assert!((surface.own_uv - expected).abs().max_element() < 1e-9, "{} {expected}", surface.own_uv);
            let step = 1e-6 * disc.radius;
            for way in [x, y] {
                let change = (at(point + step * way).own_uv - at(point - step * way).own_uv) / (2.0 * step);
                let told = DVec2::new(surface.own_gradients[0].dot(way), surface.own_gradients[1].dot(way));
                // Over the seam the angle jumps by a whole turn.
                let seam = 2.0 * step * told.x.abs() + 1e-9;
                if expected.x.min(1.0 - expected.x) > seam {
                    assert!((change - told).length() < 1e-4 * (1.0 + told.length()), "{change} {told}");
                }
            }
        }
    }
}

#[test]
fn a_disc_facing_z_or_y_has_the_documented_axes() {
    let axes = |normal: DVec3| Disc::new(DVec3::ZERO, normal, 1.0).axes();
    assert_eq!(axes(DVec3::Z), [DVec3::X, DVec3::Y]);
    assert_eq!(axes(DVec3::Y), [DVec3::X, -DVec3::Z]);
    assert_eq!(axes(7.0 * DVec3::Z), [DVec3::X, DVec3::Y]);
}

/// At the centre of polar coordinates, far away, huge, tiny and edge-on: every pixel is a number, and light comes from
/// the disc alone.
#[test]
fn extreme_discs_are_finite_and_within_their_colour() {
    let sizes = [(0.0, 1e-20), (0.0, 1e-6), (0.0, 1.0), (-1e6, 1e6), (-1e12, 1e12), (0.0, 1e25)];
    let normals = ["[0, 0, 1]", "[1, 0, 0]", "[1, 1e-9, 1e-7]"];
    // Each normal with two sizes, apart from the one that all algorithms see from the front.
    for (i, (depth, radius)) in sizes.into_iter().enumerate() {
        for normal in if i == 2 { &normals[..] } else { &normals[i % 3..=i % 3] } {
            for algorithm in [Algorithm::Samples, Algorithm::Cone, Algorithm::Beam] {
                let text = format!(
                    "[[texture]]\nname = 't'\nprocedural = 'checker'\n[[material]]\nname = 'm'\nmodel = 'unlit'\n\
                     texture = 't'\n[[disc]]\ncenter = [0, 0, {depth:?}]\nnormal = {normal}\nradius = {radius:?}\n\
                     uv = 'polar'\nmaterial = 'm'\n"
                );
                let mut scene = parallel(9, &text);
                (scene.sampling.algorithm, scene.sampling.spp) = (algorithm, 4);
                let film = render(&packed(scene, None));
                let good = film.pixels.iter().flatten().all(|v| (0.0..=1.0).contains(v));
                assert!(good, "{algorithm}, {normal}, radius {radius:e} at {depth:e}");
            }
        }
    }
}

/// Beams know no outline of a disc: pixels that may see one, or lie in its shadow, take samples, and the others are
/// those of a scene with very many samples.
#[test]
fn beams_leave_discs_and_their_shadows_to_samples() {
    let scene = crate::stage::small("discs", 64, 64);
    let by = |algorithm: Algorithm, spp: u32| {
        let mut scene = scene.clone();
        (scene.sampling.algorithm, scene.sampling.spp) = (algorithm, spp);
        render(&packed(scene, None))
    };
    let (beams, truth) = (by(Algorithm::Beam, 256), by(Algorithm::Samples, 1024));
    let apart = moire::internal::lab::metrics::compare(&beams, &truth).unwrap().rmse;
    assert!(apart < 3e-3, "RMSE {apart:e}");
}
