//! Model `oren-nayar`: a white surface returns all light whatever its roughness, no other returns more than arrives,
//! the two directions may change places, and without roughness it is Lambert's.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use moire::internal::oracle::bsdf::oren_nayar::{fujii_share, oren_nayar_lobes, scattered_albedo};

use super::scene;
use crate::stage;

fn seen_at(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(-sin, 0.0, -cos)
}

/// Returns the share of uniform light from the hemisphere that is reflected to the eye.
fn furnace(direction: DVec3, albedo: f64, roughness: f64) -> f64 {
    const STEPS: u32 = 300;
    let second = scattered_albedo(DVec3::splat(albedo), roughness).x;
    let of = |i: u32| {
        // The cosine is the cube of what is stepped through: a direction along the surface is lit from there most.
        let step = (f64::from(i % STEPS) + 0.5) / f64::from(STEPS);
        let turn = TAU * (f64::from(i / STEPS) + 0.5) / f64::from(STEPS);
        let cosine = step.powi(3);
        let out = (1.0 - cosine * cosine).sqrt();
        let way = DVec3::new(out * turn.cos(), out * turn.sin(), cosine);
        let [first, more] = oren_nayar_lobes(DVec3::Z, direction, way, roughness);
        // Solid angle times the cosine over pi, for a step.
        6.0 * step.powi(5) * (albedo * first + second * more)
    };
    (0..STEPS * STEPS).map(of).sum::<f64>() / f64::from(STEPS * STEPS)
}

#[test]
fn a_white_furnace_stays_white() {
    for roughness in [0.0, 0.1, 0.5, 1.0] {
        for degrees in [0.0, 30.0, 60.0, 85.0, 89.9] {
            let white = furnace(seen_at(degrees), 1.0, roughness);
            assert!((white - 1.0).abs() < 2e-4, "{roughness} at {degrees}°: {white}");
            let grey = furnace(seen_at(degrees), 0.5, roughness);
            assert!(grey < 0.5 + 2e-4, "{roughness} at {degrees}°: {grey}");
        }
    }
}

/// The share that single scattering returns, at the two ends: G = 0 straight above and π/2 - 2/3 along the surface.
#[test]
fn the_share_of_a_direction_worked_out_by_hand() {
    assert!(fujii_share(1.0).abs() < 1e-15);
    assert!((fujii_share(0.0) - (0.5 - 2.0 / (3.0 * PI))).abs() < 1e-15);
    // 60°: sin = √3/2; G = √3/2 (π/3 - √3/4) + 2/3 (√3 (1 - 3√3/8) - √3/2).
    let root = 3f64.sqrt();
    let g = root / 2.0 * (PI / 3.0 - root / 4.0) + 2.0 / 3.0 * (root * (1.0 - 3.0 * root / 8.0) - root / 2.0);
    assert!((fujii_share(0.5) - g / PI).abs() < 1e-15);
}

#[test]
fn directions_may_change_places_and_no_roughness_is_lambert() {
    let ways = [DVec3::new(0.3, 0.1, 0.9), DVec3::new(-0.8, 0.2, 0.4), DVec3::new(0.0, 0.99, 0.05)];
    for a in ways {
        for b in ways {
            let [there, back] = [(a, b), (b, a)].map(|(a, b)| oren_nayar_lobes(DVec3::Z, -a, b * 2.0, 0.7));
            assert!((there[0] - back[0]).abs() < 1e-12 && (there[1] - back[1]).abs() < 1e-12, "{a} {b}");
            assert_eq!(oren_nayar_lobes(DVec3::Z, -a, b, 0.0), [1.0, 0.0]);
        }
    }
}

/// Seen and lit from the same side at 60° a surface of roughness 1 is brighter than Lambert's, by hand: s/t = 3/4 / 1/2.
#[test]
fn a_plane_lit_from_behind_the_eye_has_the_value_worked_out_by_hand() {
    let text =
        "camera = { eye = [1.7320508075688772, 0, 1], look_at = [0, 0, 0], orthographic_height = 0.01 }
        image = { width = 2, height = 2 }
        sampling = { pattern = 'center' }
        [[material]]\nname = 'm'\nmodel = 'oren-nayar'\ncolor = [0.5, 0.25, 1]\nroughness = 1
        [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'
        [[light]]\nkind = 'directional'\ndirection = [1.7320508075688772, 0, 1]\nirradiance = [2, 2, 2]";
    let a = 1.0 / (1.5 - 2.0 / (3.0 * PI));
    let [c1, c2] = [0.5 - 2.0 / (3.0 * PI), 2.0 / 3.0 - 28.0 / (15.0 * PI)];
    let more = a * (c1 - fujii_share(0.5)).powi(2) / (c1 - c2);
    let mean = (1.0 + c2) * a;
    let packed = scene(&text.replace("\n        ", "\n"), Vec::new());
    for film in [stage::render(&packed), stage::render_on_oracle(&packed)] {
        for (seen, albedo) in film.pixels[0].iter().zip([0.5, 0.25, 1.0]) {
            let scattered = albedo * albedo * mean / (1.0 - albedo * (1.0 - mean));
            let expected = (albedo * a * (1.0 + 1.5) + scattered * more) / PI;
            assert!((f64::from(*seen) - expected).abs() < 2e-6, "{seen}, by hand {expected}");
        }
    }
}
