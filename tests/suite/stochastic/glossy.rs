//! Glossy mirrors and glass: microfacet normals follow the visible GGX distribution, the reflected
//! energy agrees with theory, and roughness 0 is the perfect mirror.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use moire::internal::core::film::Film;
use moire::internal::lab::metrics::compare;
use moire::internal::oracle::bsdf::facets::{smith, smith_g2_over_g1, visible_normal, widened_differential};
use moire::internal::oracle::bsdf::mirror::mirrored;
use moire::internal::oracle::footprint::RayDifferential;
use moire::internal::scene::model::{Pattern, Scene};
use moire::internal::scene::parse;

use super::lens::VIEW;
use super::{assert_patterns_gain, packed, parsed};
use crate::stage::{assert_same_bits, render, render_on_oracle};

const STEPS: u32 = 700;

fn grid() -> impl Iterator<Item = DVec2> {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
    (0..STEPS * STEPS).map(move |i| DVec2::new(at(i % STEPS), at(i / STEPS)))
}

/// The hemisphere by solid angle, at the middle of its equal parts.
fn hemisphere() -> impl Iterator<Item = DVec3> {
    // Steps in 1 - cos grow towards the horizon: lobes of smooth surfaces are narrow.
    grid().map(|p| {
        let sine = (1.0 - p.x * p.x).max(0.0).sqrt();
        DVec3::new(sine * (TAU * p.y).cos(), sine * (TAU * p.y).sin(), p.x)
    })
}

fn ggx(h: DVec3, alpha: f64) -> f64 {
    let squared = alpha * alpha;
    squared / (PI * (h.z * h.z * (squared - 1.0) + 1.0).powi(2))
}

fn view(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

/// Returns the reflectance of a white surface under uniform light: D G2 / (4 cos cos') times cos' over the hemisphere.
fn albedo(v: DVec3, alpha: f64) -> f64 {
    let term = |o: DVec3| {
        let g = 2.0 * v.z * o.z / (o.z * smith(v.z, alpha) + v.z * smith(o.z, alpha));
        ggx((v + o).normalize(), alpha) * g / (4.0 * v.z)
    };
    hemisphere().map(term).sum::<f64>() * TAU / f64::from(STEPS * STEPS)
}

fn sampled_albedo(v: DVec3, alpha: f64) -> f64 {
    let term = |square: DVec2| {
        let o = mirrored(-v, visible_normal(-v, DVec3::Z, alpha, square));
        if o.z > 0.0 { smith_g2_over_g1(v.z, o.z, alpha) } else { 0.0 }
    };
    grid().map(term).sum::<f64>() / f64::from(STEPS * STEPS)
}

#[test]
fn a_white_surface_mirrors_what_the_integral_says() {
    for alpha in [0.15, 0.4, 0.7, 1.0] {
        for degrees in [0.0, 40.0, 75.0] {
            let (found, expected) = (sampled_albedo(view(degrees), alpha), albedo(view(degrees), alpha));
            assert!(
                (found - expected).abs() < 2e-3,
                "alpha {alpha}, {degrees}: {found}, integral {expected}"
            );
            assert!(found <= 1.0, "more light leaves than arrives");
        }
    }
}

/// Returns mean and second moments of visible facets: D G1 max(v·m, 0) / cos.
#[test]
fn facets_are_those_that_the_view_sees() {
    for alpha in [0.3, 0.6, 1.0] {
        for degrees in [10.0, 60.0, 85.0] {
            let v = view(degrees);
            let g1 = 2.0 * v.z / (v.z + smith(v.z, alpha));
            let moments = |m: DVec3, weight: f64| [weight, weight * m.x, weight * m.z, weight * m.y * m.y];
            let add = |a: [f64; 4], b: [f64; 4]| std::array::from_fn(|i| a[i] + b[i]);
            let expected = hemisphere()
                .map(|m| moments(m, ggx(m, alpha) * g1 * v.dot(m).max(0.0) / v.z * TAU))
                .fold([0.0; 4], add);
            let found =
                grid().map(|p| moments(visible_normal(-v, DVec3::Z, alpha, p), 1.0)).fold([0.0; 4], add);
            for (a, b) in found.iter().zip(expected) {
                let (a, b) = (a / f64::from(STEPS * STEPS), b / f64::from(STEPS * STEPS));
                assert!((a - b).abs() < 3e-3, "alpha {alpha}, {degrees}: {found:?}, {expected:?}");
            }
        }
    }
}

fn mean(film: &Film) -> f64 {
    film.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / film.pixels.len() as f64
}

/// A floor below a white sky, by parallel rays at an angle.
#[test]
fn a_rough_mirror_in_a_white_room_renders_its_albedo() {
    for (roughness, degrees) in [(0.5, 20.0), (0.8, 60.0), (1.0, 45.0)] {
        let eye = view(degrees);
        let scene = parsed(&format!(
            "[camera]\neye = [{}, 0, {}]\nlook_at = [0, 0, 0]\northographic_height = 0.1\n[image]\nwidth = 8\nheight = 8
[sampling]\npattern = 'sobol-owen'\nspp = 256\n[background]\ncolor = [1, 1, 1]
[[material]]\nname = 'm'\nmodel = 'mirror'\nroughness = {roughness}
[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n",
            eye.x, eye.z
        ));
        let expected = albedo(eye, roughness * roughness);
        for found in [mean(&render(&packed(&scene))), mean(&render_on_oracle(&packed(&scene)))] {
            assert!((found / expected - 1.0).abs() < 3e-3, "{roughness}, {degrees}: {found}, {expected}");
        }
    }
}

const ROOM: &str = "
[background]\ncolor = [0.2, 0.4, 0.9]
[[plane]]\norigin = [0, -1, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, -1]\nhalf_extent = 4\nmaterial = 'white'
[[sphere]]\ncenter = [0, 0, 1]\nradius = 0.8\nmaterial = 'ball'
";

fn room(ball: &str) -> Scene {
    parsed(&format!("{VIEW}[[material]]\nname = 'ball'\n{ball}\n{ROOM}"))
}

#[test]
fn roughness_0_is_the_perfect_mirror_bit_for_bit() {
    for model in ["mirror", "dielectric"] {
        let smooth = room(&format!("model = '{model}'"));
        let zero = room(&format!("model = '{model}'\nroughness = 0"));
        assert_eq!(packed(&smooth).records.materials, packed(&zero).records.materials);
        // Beside a rough ball that nothing here sees.
        let far = "[[material]]\nname = 'rough'\nmodel = 'mirror'\nroughness = 0.5
[[sphere]]\ncenter = [0, 0, 90]\nradius = 0.01\nmaterial = 'rough'\n";
        let beside = parsed(&format!("{VIEW}[[material]]\nname = 'ball'\nmodel = '{model}'\n{ROOM}{far}"));
        assert_same_bits(&render(&packed(&smooth)), &render(&packed(&beside)), model);
    }
}

#[test]
fn little_roughness_changes_little_and_much_blurs() {
    for model in ["mirror", "dielectric"] {
        let film = |roughness: f64| {
            let mut scene = room(&format!("model = '{model}'\nroughness = {roughness}"));
            scene.sampling.spp = 1024;
            render(&packed(&scene))
        };
        let smooth = film(0.0);
        let apart = |roughness| compare(&film(roughness), &smooth).unwrap().rmse;
        let (little, much) = (apart(0.03), apart(0.6));
        assert!(little < 0.02 && much > 2.0 * little && much > 0.02, "{model}: {little} and {much}");
    }
}

/// A lobe that is 2 alpha wide, of which a sample stands for 1 / √samples.
#[test]
fn beams_grow_by_the_samples_share_of_the_lobe() {
    let mut scene = packed(&room("model = 'mirror'\nroughness = 0.5"));
    scene.header.sample_side = 0.25;
    let beam = RayDifferential {
        direction: [DVec3::X * 0.01, DVec3::Y * -0.01],
        spread: 0.01,
        ..RayDifferential::default()
    };
    let wide = widened_differential(&scene.header, &beam, DVec3::Z * 2.0, 0.09);
    let by = 2.0 * 0.09 * 0.25 * 2.0;
    assert!((wide.spread - 0.01 - by).abs() < 1e-9);
    assert!((wide.direction[0] - DVec3::X * (0.01 + by)).length() < 1e-9, "{:?}", wide.direction);
    assert!((wide.direction[1] + DVec3::Y * (0.01 + by)).length() < 1e-9, "{:?}", wide.direction);
}

/// Twelve bounces between two mirrors: more pairs of dimensions than Halton's bases.
#[test]
fn device_and_oracle_agree_after_more_bounces_than_there_are_bases() {
    let mut scene = parsed(&format!(
        "{VIEW}[background]\ncolor = [0.1, 0.2, 0.4]
[[material]]\nname = 'near'\nmodel = 'mirror'\nroughness = 0.1\ncolor = [0.9, 0.95, 0.9]
[[plane]]\norigin = [-0.2, 0, 0]\ntangent = [0, 1, 0]\nbitangent = [0, 0, 1]\nhalf_extent = 4\nmaterial = 'near'
[[plane]]\norigin = [0.2, 0, 0]\ntangent = [0, 1, 0]\nbitangent = [0, 0, 1]\nhalf_extent = 4\nmaterial = 'near'
[[triangle]]\nvertices = [[-3, -3, -4], [3, -3, -4], [0, 3, -4]]\nmaterial = 'white'\n"
    ));
    (scene.sampling.max_depth, scene.camera.eye.x) = (12, 0.15);
    for pattern in [Pattern::SobolOwen, Pattern::Halton] {
        scene.sampling.pattern = pattern;
        let packed = packed(&scene);
        let (device, oracle) = (render(&packed), render_on_oracle(&packed));
        let apart = compare(&device, &oracle).unwrap();
        assert!(apart.rmse < 5e-3, "{pattern}: {:e}", apart.rmse);
        let mut shallow = scene.clone();
        shallow.sampling.max_depth = 7;
        let lost = compare(&device, &render(&super::packed(&shallow))).unwrap();
        assert!(
            lost.rmse > 4.0 * apart.rmse,
            "{pattern}: few paths are longer: {:e}, {:e}",
            lost.rmse,
            apart.rmse
        );
    }
}

#[test]
fn lobes_are_sampled_better_by_patterns_than_by_chance() {
    let mut scene = room("model = 'mirror'\nroughness = 0.5");
    (scene.width, scene.height) = (24, 24);
    assert_patterns_gain("glossy", &scene, 0.5);
}

#[test]
fn roughness_that_makes_no_sense_is_refused_by_line_and_key() {
    for (text, words) in [
        ("model = 'mirror'\nroughness = 1.5", ["material.roughness", "from 0 to 1"]),
        ("model = 'lambert'\nroughness = 0.5", ["material.roughness", "this one is \"lambert\""]),
    ] {
        let told =
            parse("a.toml".as_ref(), &format!("{VIEW}[[material]]\nname = 'x'\n{text}\n")).unwrap_err();
        let told = told.to_string();
        assert!(told.starts_with("a.toml:18:"), "{told}");
        words.iter().for_each(|word| assert!(told.contains(word), "{word} is not in: {told}"));
    }
}
