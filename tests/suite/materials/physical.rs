//! Model `metallic-roughness` and light of the environment: white surfaces return all light, facets have the values worked
//! out by hand, a sky lights a plane by its closed form, and importance finds what is small and bright.

use std::f64::consts::PI;

use glam::{DVec3, Vec4};
use moire::internal::core::film::Film;
use moire::internal::oracle::environment::{sampled_sky, sky_density};
use moire::internal::pack::PackedScene;
use moire::internal::texture::data::TextureData;

use super::{floats, scene};
use crate::stage;

/// A plane across the z axis, seen by parallel rays at an angle from that axis.
pub fn plane(degrees: f64, samples: u32, material: &str, rest: &str) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    format!(
        "camera = {{ eye = [{sin}, 0, {cos}], look_at = [0, 0, 0], orthographic_height = 0.01 }}\n\
         image = {{ width = 4, height = 4 }}\n\
         sampling = {{ pattern = 'sobol-owen', spp = {samples} }}\n\
         [[material]]\nname = 'm'\n{material}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n{rest}"
    )
}

pub fn mean(film: &Film) -> DVec3 {
    let sum: DVec3 = film.pixels.iter().map(|p| DVec3::from_array(p.map(f64::from))).sum();
    sum / film.pixels.len() as f64
}

pub fn both(packed: &PackedScene) -> [DVec3; 2] {
    [stage::render(packed), stage::render_on_oracle(packed)].map(|film| mean(&film))
}

pub const WHITE_SKY: &str = "[background]\ncolor = [1, 1, 1]\n[[light]]\nkind = 'environment'\n";

#[test]
fn a_white_furnace_stays_white_within_one_percent() {
    for metallic in [0.0, 0.5, 1.0] {
        for roughness in [0.0, 0.2, 0.6, 1.0] {
            for degrees in [0.0, 50.0, 80.0] {
                let material =
                    format!("model = 'metallic-roughness'\nmetallic = {metallic}\nroughness = {roughness}");
                let packed = scene(&plane(degrees, 256, &material, WHITE_SKY), Vec::new());
                let seen = mean(&stage::render(&packed));
                let error = (seen - 1.0).abs().max_element();
                assert!(error < 0.01, "metallic {metallic}, roughness {roughness}, {degrees}°: {seen}");
            }
        }
    }
}

#[test]
fn the_oracles_furnace_is_white_too_and_grey_surfaces_are_darker() {
    let white = "model = 'metallic-roughness'\nroughness = 0.7";
    let packed = scene(&plane(40.0, 256, white, WHITE_SKY), Vec::new());
    let seen = mean(&stage::render_on_oracle(&packed));
    assert!((seen - 1.0).abs().max_element() < 0.01, "{seen}");
    let grey = "model = 'metallic-roughness'\nroughness = 0.7\nmetallic = 1\ncolor = [0.5, 0.5, 0.5]";
    let seen = both(&scene(&plane(40.0, 256, grey, WHITE_SKY), Vec::new()));
    for seen in seen {
        assert!(seen.x > 0.4 && seen.x < 0.55, "{seen}");
    }
}

/// Without specular weight nothing but the body is left, however grazing.
#[test]
fn a_surface_of_no_specular_weight_is_lambert() {
    let sun = "[[light]]\nkind = 'directional'\ndirection = [-8, 0, 1]\nirradiance = [3, 3, 3]";
    let color = "color = [0.8, 0.4, 0.2]";
    let packed = |model: &str, weight: f64| {
        let mut packed = scene(&plane(80.0, 1, &format!("model = '{model}'\n{color}"), sun), Vec::new());
        let material = &mut packed.records.materials[0];
        (material.edge, material.specular) = (weight as f32, material.specular * weight as f32);
        packed
    };
    for (found, wanted) in
        both(&packed("metallic-roughness", 0.0)).into_iter().zip(both(&packed("lambert", 1.0)))
    {
        assert!((found - wanted).abs().max_element() < 1e-5, "{found}, lambert {wanted}");
    }
    let [whole, _] = both(&packed("metallic-roughness", 1.0));
    let [half, _] = both(&packed("metallic-roughness", 0.5));
    let [none, _] = both(&packed("metallic-roughness", 0.0));
    assert!(whole.x > half.x + 0.05 && half.x > none.x + 0.05, "{whole}, {half}, {none}");
}

/// Light and eye at 60° on the two sides of the normal: the half vector is the normal, so that D = 1 / (π α²),
/// V = 1 / (4 cos √(cos² + α² sin²)) and Schlick's term is (1 - cos)^5.
#[test]
fn a_highlight_has_the_value_worked_out_by_hand() {
    let light =
        "[[light]]\nkind = 'directional'\ndirection = [-1.7320508075688772, 0, 1]\nirradiance = [1, 1, 1]";
    let (cos, alpha): (f64, f64) = (0.5, 0.25);
    let masked = 0.25 / (cos * (cos * cos + alpha * alpha * 0.75).sqrt());
    let lobe = masked / (PI * alpha * alpha);
    let color = DVec3::new(0.9, 0.5, 0.1);
    let fresnel = color + (1.0 - color) * (1.0f64 - cos).powi(5);
    let material = "model = 'metallic-roughness'\nmetallic = 1\nroughness = 0.5\ncolor = [0.9, 0.5, 0.1]";
    let packed = scene(&plane(60.0, 1, material, light), Vec::new());
    let [device, oracle] = both(&packed);
    // What comes back between facets is the difference: at most the light that a first bounce loses, a few percent.
    let plain = lobe * fresnel * cos;
    for seen in [device, oracle] {
        let gain = seen / plain;
        assert!(gain.min_element() >= 1.0 && gain.max_element() < 1.2, "{seen} over {plain}");
        // The gain is 1 + color · lost, the same `lost` for all channels (but for the little of Schlick's term).
        let lost = (gain - 1.0) / color;
        assert!((lost.x - lost.y).abs() < 2e-3 * (1.0 + lost.x), "{lost}");
    }
    assert!((device - oracle).abs().max_element() < 1e-5 * oracle.max_element(), "{device} {oracle}");
}

/// A sky of `width` × `height` texels read without blending.
fn under_sky(
    width: u32,
    height: u32,
    texel: impl Fn(u32, u32) -> [f32; 4],
    samples: u32,
    more: &str,
) -> PackedScene {
    let text = plane(30.0, samples, "sampler = 's'\ncolor = [0.5, 0.25, 1]", "")
        + "[[texture]]\nname = 't'\nfile = 'sky.exr'\n[[sampler]]\nname = 's'\nfilter = 'nearest'\n\
           [background]\nenvironment = 't'\nsampler = 's'\n"
        + more
        + "[[light]]\nkind = 'environment'\n";
    scene(&text, vec![sky(width, height, texel)])
}

fn sky(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> TextureData {
    floats(width, height, texel)
}

/// The plane faces +z. A sky that is bright above the horizon (+y) fills half of what it sees.
#[test]
fn a_half_bright_sky_lights_a_wall_by_half_whatever_its_turn() {
    let upper = |_, y: u32| if y < 8 { [2.0, 2.0, 2.0, 1.0] } else { [0.0, 0.0, 0.0, 1.0] };
    for more in ["", "rotate = 70\n", "mirror = true\n"] {
        for seen in both(&under_sky(32, 16, upper, 256, more)) {
            let error = (seen / DVec3::new(0.5, 0.25, 1.0) - 1.0).abs().max_element();
            assert!(error < 0.01, "{more:?}: {seen}");
        }
    }
}

/// Azimuth: the middle of the picture looks along -z, so that its outer quarters are the half about +z, which alone lights
/// the plane; +x is right of the middle.
#[test]
fn the_sky_lights_from_where_it_is_seen() {
    let behind = |x: u32, _| if (8..24).contains(&x) { [1.0, 1.0, 1.0, 1.0] } else { [0.0; 4] };
    for seen in both(&under_sky(32, 16, behind, 64, "")) {
        assert!(seen.max_element() < 1e-9, "{seen}");
    }
    for seen in both(&under_sky(32, 16, behind, 256, "rotate = 180\n")) {
        let error = (seen / DVec3::new(0.5, 0.25, 1.0) - 1.0).abs().max_element();
        assert!(error < 0.01, "{seen}");
    }
}

/// One texel of 64 × 32 near +z: solid angle times cosine times its radiance over π. Without importance one of a thousand
/// samples would find it.
#[test]
fn a_small_bright_spot_is_found_by_few_samples() {
    let spot = |x, y| if (x, y) == (2, 15) { [1000.0, 1000.0, 1000.0, 1.0] } else { [0.0; 4] };
    // Azimuth from the picture's middle, which is -z; polar angles from +y.
    let turn = |x: f64| 2.0 * PI * (x / 64.0 - 0.5);
    let [from, to] = [15.0, 16.0].map(|y: f64| PI * y / 32.0);
    // The integral of cos = sin θ · -cos(turn) over the texel.
    let polar = 0.5 * ((to - from) - (to.sin() * to.cos() - from.sin() * from.cos()));
    let around = -(turn(3.0).sin() - turn(2.0).sin());
    let expected = 1000.0 * polar * around / PI;
    for film in
        [stage::render, stage::render_on_oracle].map(|render| render(&under_sky(64, 32, spot, 64, "")))
    {
        let seen = mean(&film).z;
        assert!((seen / expected - 1.0).abs() < 0.02, "{seen}, by hand {expected}");
        let deviation = film.pixels.iter().map(|p| (f64::from(p[2]) / expected - 1.0).powi(2)).sum::<f64>();
        let deviation = (deviation / film.pixels.len() as f64).sqrt();
        assert!(deviation < 0.2, "a pixel of 64 samples deviates by {deviation}");
    }
}

#[test]
fn densities_of_the_sky_sum_to_1_and_are_those_of_its_samples() {
    let texel = |x: u32, y: u32| [1.0 + x as f32, 1.0 + (x * y % 7) as f32, 0.5, 1.0];
    let packed = under_sky(48, 24, texel, 1, "rotate = 33\n");
    let side = 240;
    let mut sum = 0.0;
    for i in 0..side * side {
        let [u, v] = [i % side, i / side].map(|k| (f64::from(k) + 0.5) / f64::from(side));
        let (sin, cos) = (2.0 * PI * u).sin_cos();
        let height = 1.0 - 2.0 * v;
        let across = (1.0 - height * height).sqrt();
        sum += 4.0 * PI * sky_density(&packed, DVec3::new(across * cos, height, across * sin));
    }
    let sum = sum / f64::from(side * side);
    assert!((sum - 1.0).abs() < 2e-3, "{sum}");
    for i in 0..200 {
        let square = glam::DVec2::new(f64::from(i * 37 % 200) + 0.3, f64::from(i) + 0.6) / 200.0;
        let sample = sampled_sky(&packed, square);
        assert!((sample.way.length() - 1.0).abs() < 1e-9);
        let again = sky_density(&packed, sample.way);
        assert!((again / sample.density - 1.0).abs() < 1e-9, "{square}: {again} {}", sample.density);
    }
    let black = under_sky(8, 4, |_, _| [0.0; 4], 4, "");
    assert!(both(&black).iter().all(|seen| *seen == DVec3::ZERO));
    assert!(black.records.environment_parts.iter().all(|part| part.values.cmpge(Vec4::ZERO).all()));
}

/// All models under a white sky, with occlusion: a map of 0 keeps diffuse light away, half of its strength half of it.
#[test]
fn other_models_reflect_a_white_sky_and_occlusion_is_of_the_sky_alone() {
    for model in ["lambert", "oren-nayar"] {
        let material = format!("model = '{model}'\ncolor = [0.5, 0.5, 0.5]");
        let seen = both(&scene(&plane(30.0, 256, &material, WHITE_SKY), Vec::new()));
        for seen in seen {
            assert!((seen.x - 0.5).abs() < 5e-3, "{model}: {seen}");
        }
    }
    let map = "sampler = 's'\ncolor = [0.5, 0.5, 0.5]\nocclusion_map = 't'\n";
    let rest = "[[texture]]\nname = 't'\nfile = 't.exr'\n[[sampler]]\nname = 's'\n";
    let light = "[[light]]\nkind = 'directional'\ndirection = [0, 0, 1]\nirradiance = [3, 3, 3]\n";
    for (strength, lights, expected) in
        [(1.0, WHITE_SKY, 0.0), (0.5, WHITE_SKY, 0.25), (1.0, light, 0.5 * 3.0 / PI)]
    {
        let material = format!("{map}occlusion_strength = {strength}");
        let text = plane(30.0, 64, &material, &format!("{rest}{lights}"));
        for seen in both(&scene(&text, vec![floats(1, 1, |_, _| [0.0, 1.0, 1.0, 1.0])])) {
            assert!((seen.x - expected).abs() < 5e-3, "{strength}: {seen}, not {expected}");
        }
    }
}

#[test]
fn maps_multiply_roughness_by_green_and_metal_by_blue() {
    let light = "[[light]]\nkind = 'directional'\ndirection = [-1, 0, 1]\nirradiance = [1, 1, 1]\n";
    let maps = "[[texture]]\nname = 't'\nfile = 't.exr'\n[[sampler]]\nname = 's'\n";
    let mapped =
        "model = 'metallic-roughness'\ncolor = [0.9, 0.5, 0.1]\nsampler = 's'\nmetallic_roughness_map = 't'";
    let plain = "model = 'metallic-roughness'\ncolor = [0.9, 0.5, 0.1]\nmetallic = 0.25\nroughness = 0.5";
    let text = plane(45.0, 1, mapped, &format!("{maps}{light}"));
    let texture = floats(1, 1, |_, _| [0.3, 0.5, 0.25, 1.0]);
    let shown = both(&scene(&text, vec![texture]));
    let wanted = both(&scene(&plane(45.0, 1, plain, light), Vec::new()));
    for (shown, wanted) in shown.iter().zip(wanted) {
        assert!((*shown - wanted).abs().max_element() < 1e-6, "{shown} {wanted}");
    }
}
