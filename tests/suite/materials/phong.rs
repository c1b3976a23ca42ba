//! The highlight of `phong`: its lobe by hand, never more light out than in, and a lit plane.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use moire::internal::oracle::bsdf::phong::phong_lobe;

use super::scene;
use crate::stage;

#[test]
fn the_lobe_worked_out_by_hand() {
    // (n + 2) / 2 at its centre, cosⁿ beside it, 0 behind; of directions of any length.
    assert_eq!(phong_lobe(DVec3::Z * 3.0, DVec3::Z * 0.1, 6.0), 4.0);
    let side = DVec3::new(1.0, 0.0, 1.0);
    assert!((phong_lobe(DVec3::Z, side, 2.0) - 0.5 * 2.0).abs() < 1e-12); // cos² 45° = 1/2
    assert!((phong_lobe(DVec3::Z, side, 4.0) - 0.25 * 3.0).abs() < 1e-12);
    assert_eq!(phong_lobe(DVec3::Z, DVec3::X, 4.0), 0.0);
    assert_eq!(phong_lobe(DVec3::Z, -DVec3::Z, 4.0), 0.0);
}

/// ∫ lobe / π · cos θ dω over the hemisphere: 1 if the mirror direction is the normal (the norm of Lafortune & Willems
/// 1994), and less at an angle, where a part of the lobe is below the surface.
#[test]
fn no_more_light_leaves_than_arrives() {
    const STEPS: u32 = 400;
    for exponent in [1.0, 5.0, 32.0, 200.0] {
        for degrees in [0.0f64, 30.0, 60.0, 85.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let mirror = DVec3::new(sin, 0.0, cos);
            let mut sum = 0.0;
            for i in 0..STEPS * STEPS {
                // Equal shares of the solid angle times the cosine.
                let squared = (f64::from(i % STEPS) + 0.5) / f64::from(STEPS);
                let turn = TAU * (f64::from(i / STEPS) + 0.5) / f64::from(STEPS);
                let way = DVec3::new(
                    squared.sqrt() * turn.cos(),
                    squared.sqrt() * turn.sin(),
                    (1.0 - squared).sqrt(),
                );
                sum += phong_lobe(mirror, way, exponent);
            }
            let share = sum / f64::from(STEPS * STEPS);
            // Of the midpoint rule: the second derivative of (1 - x)^(n / 2) over 24 steps squared.
            let error = 1e-4 + (exponent / f64::from(STEPS)).powi(2) / 90.0;
            assert!(share < 1.0 + error, "{exponent} at {degrees}°: {share}");
            if degrees == 0.0 {
                assert!((share - 1.0).abs() < error, "{exponent}: {share}");
            }
        }
    }
}

#[test]
fn a_plane_lit_from_the_side_has_the_value_worked_out_by_hand() {
    // Seen straight from above; the light 30° off the normal; E = 2, so E cos θ = √3.
    let text = "camera = { eye = [0, 0, 3], look_at = [0, 0, 0], orthographic_height = 0.1 }
        image = { width = 2, height = 2 }
        sampling = { pattern = 'center' }
        [[material]]\nname = 'm'\nmodel = 'phong'\ncolor = [0.5, 0.25, 0]\nspecular = [0.1, 0.2, 0.4]\nexponent = 4
        [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'
        [[light]]\nkind = 'directional'\ndirection = [0.5, 0, 0.8660254037844386]\nirradiance = [2, 2, 2]";
    let packed = scene(&text.replace("\n        ", "\n"), Vec::new());
    let irradiance = 3f64.sqrt() / PI;
    let lobe = (0.75f64).powi(2) * 3.0; // cos⁴ 30° = 9/16, (4 + 2) / 2
    let right = [0.5 + 0.1 * lobe, 0.25 + 0.2 * lobe, 0.4 * lobe].map(|x| x * irradiance);
    for film in [stage::render(&packed), stage::render_on_oracle(&packed)] {
        for (value, right) in film.pixels[0].iter().zip(right) {
            assert!((f64::from(*value) - right).abs() < 1e-5, "{:?}, by hand {right}", film.pixels[0]);
        }
    }
}
