//! Rough mirrors under an environment that is a light: a small bright sun is found by few samples, and the mean is that of
//! rays alone; of other models, what they see by way of a mirror counts whole.

use std::f64::consts::PI;

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::pack::PackedScene;

use super::physical::{both, mean, plane};
use super::{floats, scene};
use crate::stage;

/// The texel of 64 × 32 that shines, and the middle of it.
const SUN: (u32, u32) = (2, 14);
const RADIANCE: f64 = 1000.0;

fn sun(x: u32, y: u32) -> [f32; 4] {
    let shines = (x, y) == SUN;
    if shines { [RADIANCE as f32, RADIANCE as f32, RADIANCE as f32, 1.0] } else { [0.0; 4] }
}

/// A mirror across the z axis that is seen at 30°.
fn mirror(keys: &str, samples: u32, rest: &str) -> PackedScene {
    let material = format!("model = 'mirror'\nsampler = 's'\ncolor = [0.5, 0.25, 1]\n{keys}");
    let sky = "[[texture]]\nname = 't'\nfile = 'sky.exr'\n[[sampler]]\nname = 's'\nfilter = 'nearest'\n\
               [background]\nenvironment = 't'\nsampler = 's'\n";
    let text = plane(30.0, samples, &material, &format!("{sky}{rest}"));
    scene(&text, vec![floats(64, 32, sun)])
}

const LIGHT: &str = "[[light]]\nkind = 'environment'\n";

/// Standard deviation of the pixels over `expected`.
fn deviation(film: &Film, expected: f64) -> f64 {
    let squares = film.pixels.iter().map(|p| (f64::from(p[2]) / expected - 1.0).powi(2));
    (squares.sum::<f64>() / film.pixels.len() as f64).sqrt()
}

/// The integral over the texel of radiance times D V cos, without Fresnel: D V as `metallic-roughness` has them.
fn by_quadrature(roughness: f64) -> f64 {
    let alpha = roughness * roughness;
    let view = DVec3::new(0.5, 0.0, 0.75f64.sqrt());
    let smith = |cosine: f64| (cosine * cosine + alpha * alpha * (1.0 - cosine * cosine)).sqrt();
    let steps = 256;
    let mut sum = 0.0;
    for i in 0..steps * steps {
        let part = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
        let turn = 2.0 * PI * ((f64::from(SUN.0) + part(i % steps)) / 64.0 - 0.5);
        let polar = PI * (f64::from(SUN.1) + part(i / steps)) / 32.0;
        let (sin, cos) = polar.sin_cos();
        let light = DVec3::new(sin * turn.sin(), cos, -sin * turn.cos());
        let half = (view + light).normalize();
        let (seen, lit) = (view.z, light.z);
        let density =
            (alpha / (half.cross(DVec3::Z).length_squared() + (alpha * half.z).powi(2))).powi(2) / PI;
        let masked = 0.5 / (lit * smith(seen) + seen * smith(lit));
        sum += density * masked * lit * sin;
    }
    RADIANCE * sum * (2.0 * PI / 64.0) * (PI / 32.0) / f64::from(steps * steps)
}

#[test]
fn a_small_sun_in_a_rough_mirror_has_the_value_of_the_integral_and_little_noise() {
    for roughness in [0.2, 0.5, 1.0] {
        let expected = by_quadrature(roughness);
        let packed = mirror(&format!("roughness = {roughness}"), 1024, LIGHT);
        for film in [stage::render(&packed), stage::render_on_oracle(&packed)] {
            let seen = mean(&film) / DVec3::new(0.5, 0.25, 1.0) / expected;
            // 16384 samples, each of which deviates by about 1.5 of the mean: 2.5 standard deviations.
            assert!((seen - 1.0).abs().max_element() < 0.03, "roughness {roughness}: {seen} of {expected}");
            let deviates = deviation(&film, expected);
            assert!(deviates < 0.08, "roughness {roughness}: a pixel of 1024 samples deviates by {deviates}");
        }
    }
}

#[test]
fn rays_alone_have_the_same_mean_and_far_more_noise() {
    let keys = "roughness = 0.5";
    let alone = stage::render(&mirror(keys, 65_536, ""));
    let light = stage::render(&mirror(keys, 256, LIGHT));
    let [alone_mean, light_mean] = [&alone, &light].map(|film| mean(film).z);
    // A million samples of rays alone; both deviate by less than 1 in 200.
    assert!((alone_mean / light_mean - 1.0).abs() < 0.01, "{alone_mean} {light_mean}");
    let expected = by_quadrature(0.5);
    let noise = [mirror(keys, 64, ""), mirror(keys, 64, LIGHT)]
        .map(|packed| deviation(&stage::render(&packed), expected));
    assert!(noise[0] > 5.0 * noise[1], "{noise:?}");
}

/// Whatever is sampled, a white sky leaves what facets do not hold back, and the balance is one: rays alone see as much.
#[test]
fn a_white_sky_is_not_counted_twice() {
    for roughness in [0.3, 0.8] {
        let material = format!("model = 'mirror'\nroughness = {roughness}");
        let sky = "[background]\ncolor = [1, 1, 1]\n";
        let of =
            |light: &str| both(&scene(&plane(60.0, 1024, &material, &format!("{sky}{light}")), Vec::new()));
        for (light, alone) in of(LIGHT).into_iter().zip(of("")) {
            assert!(
                (light - alone).abs().max_element() < 3e-3,
                "roughness {roughness}: {light}, alone {alone}"
            );
            assert!(alone.x > 0.5 && alone.x < 1.0, "{alone}");
        }
    }
}

/// Lights other than the environment are not seen in mirrors, and the last bounce stays black.
#[test]
fn rough_mirrors_reflect_no_other_light_and_end_as_they_did() {
    let others = "[[light]]\nkind = 'directional'\ndirection = [-1, 0, 1]\nirradiance = [9, 9, 9]\n\
                  [[light]]\nkind = 'point'\nposition = [-1, 0, 1]\nintensity = [9, 9, 9]\n";
    let [plain, more] =
        ["", others].map(|more| both(&mirror("roughness = 0.5", 64, &format!("{more}{LIGHT}"))));
    for (plain, more) in plain.into_iter().zip(more) {
        assert!((plain / more - 1.0).abs().max_element() < 0.1, "{plain} {more}");
    }
    let text = plane(
        30.0,
        16,
        "model = 'mirror'\nroughness = 0.5",
        &format!("[background]\ncolor = [1, 1, 1]\n{LIGHT}"),
    );
    let text = text.replace("spp = 16", "spp = 16, max_depth = 0");
    assert_eq!(both(&scene(&text, Vec::new())), [DVec3::ZERO; 2]);
}

/// White metal beside a smooth mirror, all under a white sky: a white furnace. The mirror's ray is sampled by itself, so
/// that the sky by way of it counts whole.
#[test]
fn the_sky_by_way_of_a_mirror_counts_whole() {
    for second in ["model = 'mirror'", "model = 'dielectric'"] {
        let rest = format!(
            "[[material]]\nname = 'other'\n{second}\n[[plane]]\norigin = [0.5, 0, 0]\ntangent = [0, 1, 0]\n\
             bitangent = [0, 0, 1]\nmaterial = 'other'\n[background]\ncolor = [1, 1, 1]\n{LIGHT}"
        );
        let metal = "model = 'metallic-roughness'\nmetallic = 1\nroughness = 0.6";
        for seen in both(&scene(&plane(0.0, 256, metal, &rest), Vec::new())) {
            assert!((seen - 1.0).abs().max_element() < 0.01, "{second}: {seen}");
        }
    }
}

#[test]
fn only_rough_mirrors_under_a_sky_have_the_code() {
    let left_out = |packed: &PackedScene| packed.header.environment_rows == 0;
    assert!(!left_out(&mirror("roughness = 0.5", 1, LIGHT)));
    assert!(left_out(&mirror("roughness = 0.5", 1, "")));
    assert!(left_out(&mirror("", 1, LIGHT)));
}
