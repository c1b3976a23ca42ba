//! The highlight of `phong` under an environment that is a light: its integral, whether the sky is a point or all around, and
//! little noise in both cases.

use std::f64::consts::PI;

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::pack::PackedScene;

use super::physical::{both, mean, plane};
use super::{floats, scene};
use crate::stage;

const LIGHT: &str = "[[light]]\nkind = 'environment'\n";

/// A black surface with a highlight, seen head-on.
fn highlight(exponent: f64, samples: u32, sky: &str, texels: &[[f32; 4]]) -> PackedScene {
    let material = format!(
        "model = 'phong'\nsampler = 's'\ncolor = [0, 0, 0]\nspecular = [1, 0.5, 0.25]\nexponent = {exponent}"
    );
    let textures = match texels {
        [] => Vec::new(),
        _ => vec![floats(texels.len() as u32 / 8, 8, |x, y| {
            texels[(y * texels.len() as u32 / 8 + x) as usize]
        })],
    };
    scene(
        &plane(
            0.0,
            samples,
            &material,
            &format!("[[sampler]]\nname = 's'\nfilter = 'nearest'\n{sky}{LIGHT}"),
        ),
        textures,
    )
}

fn deviation(film: &Film, expected: f64) -> f64 {
    let squares = film.pixels.iter().map(|p| (f64::from(p[0]) / expected - 1.0).powi(2));
    (squares.sum::<f64>() / film.pixels.len() as f64).sqrt()
}

/// Head-on the angle to the mirrored ray is that to the normal: (n + 2)/2π ∫ cosⁿ⁺¹ = 1.
#[test]
fn a_white_sky_in_a_highlight_is_its_colour_however_sharp() {
    for exponent in [1.0, 32.0, 1e4] {
        let packed = highlight(exponent, 64, "[background]\ncolor = [1, 1, 1]\n", &[]);
        for film in [stage::render(&packed), stage::render_on_oracle(&packed)] {
            let seen = mean(&film) / DVec3::new(1.0, 0.5, 0.25);
            assert!((seen - 1.0).abs().max_element() < 0.01, "exponent {exponent}: {seen}");
            // Directions of the sky alone would find a lobe of 1e4 in one of 5000 samples.
            let deviates = deviation(&film, 1.0);
            assert!(deviates < 0.1, "exponent {exponent}: a pixel of 64 samples deviates by {deviates}");
        }
    }
}

/// The texel of 16 × 8 beside +z and above the horizon, by quadrature.
#[test]
fn a_sun_in_a_highlight_has_the_value_of_the_integral() {
    let mut texels = [[0.0; 4]; 128];
    texels[3 * 16] = [100.0, 100.0, 100.0, 1.0];
    let sky = "[[texture]]\nname = 't'\nfile = 'sky.exr'\n[background]\nenvironment = 't'\nsampler = 's'\n";
    for exponent in [4.0, 200.0] {
        let steps = 512;
        let mut sum = 0.0;
        for i in 0..steps * steps {
            let part = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
            let turn = 2.0 * PI * (part(i % steps) / 16.0 - 0.5);
            let (sin, _) = (PI * (3.0 + part(i / steps)) / 8.0).sin_cos();
            let cosine = -sin * turn.cos();
            sum += cosine.powf(exponent + 1.0) * sin;
        }
        let area = 2.0 * PI / 16.0 * PI / 8.0 / f64::from(steps * steps);
        let expected = 100.0 * (exponent + 2.0) / (2.0 * PI) * sum * area;
        for seen in both(&highlight(exponent, 4096, sky, &texels)) {
            // 65536 samples.
            assert!(
                (seen.x / expected - 1.0).abs() < 0.01,
                "exponent {exponent}: {}, not {expected}",
                seen.x
            );
        }
    }
}

/// What holds back the sky's diffuse light does not hold back the highlight, whichever way a sample goes.
#[test]
fn occlusion_leaves_the_highlight() {
    let of = |map: &str, textures| {
        let material = format!(
            "model = 'phong'\nsampler = 's'\ncolor = [0.5, 0.5, 0.5]\nspecular = [0.25, 0.25, 0.25]{map}"
        );
        let rest = format!(
            "[[sampler]]\nname = 's'\n{}[background]\ncolor = [1, 1, 1]\n{LIGHT}",
            if map.is_empty() { "" } else { "[[texture]]\nname = 't'\nfile = 't.exr'\n" }
        );
        both(&scene(&plane(0.0, 256, &material, &rest), textures))
    };
    let open = of("", Vec::new());
    let closed = of("\nocclusion_map = 't'", vec![floats(1, 1, |_, _| [0.0, 1.0, 1.0, 1.0])]);
    for (open, closed) in open.into_iter().zip(closed) {
        assert!((open.x - 0.75).abs() < 0.01 && (closed.x - 0.25).abs() < 0.01, "{open} {closed}");
    }
}
