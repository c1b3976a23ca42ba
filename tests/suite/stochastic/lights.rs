//! Area lights: irradiance against closed forms, the width of penumbrae, and the gain by sample
//! patterns.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::scene::model::{Light, Pattern, Scene};
use moire::internal::scene::parse;

use super::{assert_patterns_gain, packed, parsed, sampled};
use crate::stage::render;

/// A white floor at the height 0 seen from straight above: over a square of `side` around the origin, by rays
/// that start at the height `from`.
fn floor(side: f64, from: f64, pixels: u32, rest: &str) -> Scene {
    parsed(&format!(
        "[camera]\neye = [0, 0, {from}]\nlook_at = [0, 0, 0]\northographic_height = {side}
[image]\nwidth = {pixels}\nheight = {pixels}\n[sampling]\npattern = 'sobol-owen'\nspp = 1024
[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\n{rest}"
    ))
}

fn mean(film: &Film) -> f64 {
    film.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / film.pixels.len() as f64
}

/// The irradiance over pi of the floor's middle, by 16 pixels of 1024 samples.
fn lit(light: Light) -> f64 {
    let mut scene = floor(1e-4, 0.1, 4, "");
    scene.lights = vec![light];
    let alone = mean(&render(&packed(&scene)));
    // With a shape that occludes nothing, shadow rays are cast.
    scene.shapes.spheres = vec![parsed_sphere()];
    let shaded = mean(&render(&packed(&scene)));
    assert!((shaded / alone - 1.0).abs() < 1e-5, "{light:?}: {alone} alone, {shaded} with a far shape");
    alone
}

fn parsed_sphere() -> moire::internal::scene::model::Sphere {
    parsed(&format!("{}[[sphere]]\ncenter = [0, 0, -9]\nradius = 1\n", super::lens::VIEW)).shapes.spheres[0]
}

fn assert_near(found: f64, expected: f64, share: f64, what: &str) {
    assert!((found / expected - 1.0).abs() <= share, "{what}: {found}, expected {expected}");
}

const POWER: DVec3 = DVec3::splat(10.0);

/// A sphere wholly above the horizon lights like a point in its middle, however near (Lambert: E = pi L sin² of
/// its half angle, times the cosine).
#[test]
fn a_sphere_above_the_horizon_lights_like_a_point() {
    for (position, radius) in [
        (DVec3::new(0.0, 0.0, 3.0), 0.01),
        (DVec3::new(0.0, 0.0, 2.0), 1.0),
        (DVec3::new(1.5, -1.0, 2.0), 1.9),
        (DVec3::new(40.0, 0.0, 9.0), 5.0),
    ] {
        let expected = POWER.x * position.z / position.length().powi(3) / PI;
        let found = lit(Light::Sphere { position, radius, intensity: POWER });
        assert_near(found, expected, 2e-3, &format!("sphere of radius {radius} at {position}"));
    }
}

/// Radiance 1 from directions within `half` of `axis`, times the cosine, above the horizon.
fn irradiance_of_a_cone(axis: DVec3, half: f64) -> f64 {
    const STEPS: u32 = 1000;
    let (side, up) = axis.any_orthonormal_pair();
    let height = 1.0 - half.cos();
    let mut sum = 0.0;
    for i in 0..STEPS * STEPS {
        let fall = height * (f64::from(i % STEPS) + 0.5) / f64::from(STEPS);
        let (sin, cos) = (TAU * (f64::from(i / STEPS) + 0.5) / f64::from(STEPS)).sin_cos();
        let w = axis * (1.0 - fall) + (side * cos + up * sin) * (fall * (2.0 - fall)).sqrt();
        sum += w.z.max(0.0);
    }
    sum / f64::from(STEPS * STEPS) * TAU * height
}

#[test]
fn only_what_lies_above_the_horizon_counts() {
    for (position, radius) in [(DVec3::new(2.0, 0.0, 0.5), 1.0), (DVec3::new(1.0, 1.0, -0.3), 0.8)] {
        let half = (radius / position.length()).asin();
        let radiance = POWER.x / (PI * radius * radius);
        let expected = radiance * irradiance_of_a_cone(position.normalize(), half) / PI;
        let found = lit(Light::Sphere { position, radius, intensity: POWER });
        assert_near(found, expected, 5e-3, &format!("sphere of radius {radius} at {position}"));
    }
    let direction = DVec3::new(1.0, 0.0, 0.1).normalize();
    let whole = irradiance_of_a_cone(DVec3::Z, 30f64.to_radians());
    let expected = POWER.x * irradiance_of_a_cone(direction, 30f64.to_radians()) / whole / PI;
    assert_near(lit(Light::Sun { direction, angle: 60.0, irradiance: POWER }), expected, 5e-3, "low sun");
}

#[test]
fn a_floor_within_a_ball_of_light_is_lit_by_half_the_sphere() {
    let radius = 2.0;
    let found = lit(Light::Sphere { position: DVec3::new(0.0, 0.5, 0.7), radius, intensity: POWER });
    // E = pi L.
    assert_near(found, POWER.x / (PI * radius * radius), 5e-3, "within");
}

#[test]
fn a_sun_lights_like_a_directional_light() {
    for angle in [0.53, 20.0, 90.0] {
        let direction = DVec3::new(0.3, -0.2, 1.0);
        let found = lit(Light::Sun { direction, angle, irradiance: POWER });
        assert_near(found, POWER.x * direction.normalize().z / PI, 2e-3, &format!("{angle} degrees"));
    }
}

/// Lambert's formula: E = L/2 times the sum over the sides of the angle that each is seen under, times the
/// cosine between the floor's normal and the plane through the side and the point.
fn lambert(polygon: &[DVec3]) -> f64 {
    let side = |i: usize| {
        let (a, b) = (polygon[i].normalize(), polygon[(i + 1) % polygon.len()].normalize());
        a.angle_between(b) * a.cross(b).normalize().z
    };
    0.5 * (0..polygon.len()).map(side).sum::<f64>().abs()
}

fn corners(position: DVec3, u: DVec3, v: DVec3) -> [DVec3; 4] {
    [-u - v, u - v, u + v, v - u].map(|half| position + 0.5 * half)
}

#[test]
fn a_rectangle_follows_lamberts_polygon_formula() {
    let radiance = POWER;
    for (position, edge_u, edge_v) in [
        (DVec3::new(0.0, 0.0, 1.0), DVec3::Y, DVec3::X),
        (DVec3::new(1.0, 0.5, 2.0), DVec3::new(0.0, 3.0, 0.0), DVec3::new(1.0, 0.0, -0.5)),
        (DVec3::new(-4.0, 0.0, 1.5), DVec3::Y * 2.0, DVec3::Z),
    ] {
        let expected = lambert(&corners(position, edge_u, edge_v)) * radiance.x / PI;
        let found = lit(Light::Rectangle { position, edge_u, edge_v, radiance });
        assert_near(found, expected, 4e-3, &format!("rectangle at {position}"));
        // Its back is dark.
        assert_eq!(lit_or_dark(Light::Rectangle { position, edge_u: edge_v, edge_v: edge_u, radiance }), 0.0);
    }
    // Through the floor: the part above it counts.
    let (position, edge_u, edge_v) = (DVec3::new(-3.0, 0.0, 0.5), DVec3::Y * 2.0, DVec3::Z * 2.0);
    let above = corners(DVec3::new(-3.0, 0.0, 0.75), edge_u, DVec3::Z * 1.5);
    let found = lit(Light::Rectangle { position, edge_u, edge_v, radiance });
    assert_near(found, lambert(&above) * radiance.x / PI, 1e-2, "half under the floor");
}

/// Lambert's formula for the middle of a square ceiling, from next to it to where it is sampled by its area: 1/1024 of
/// a solid angle is at 32 times its side. Every pixel is near, not only their mean.
#[test]
fn a_rectangle_is_as_bright_as_lambert_says_near_and_far() {
    for height in [1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0, 4.0, 16.0, 31.9, 32.1, 64.0] {
        for (x, y) in [(0.0, 0.0), (0.3, 0.45), (0.499, -0.499)] {
            let position = DVec3::new(x, y, height);
            let [edge_u, edge_v] = [DVec3::Y, DVec3::X];
            let expected = lambert(&corners(position, edge_u, edge_v)) / PI;
            let mut scene = floor(1e-6, 1e-3, 4, "");
            scene.lights = vec![Light::Rectangle { position, edge_u, edge_v, radiance: DVec3::ONE }];
            let film = render(&packed(&scene));
            for pixel in &film.pixels {
                // 1024 Sobol points; f32 at most 2e-4.
                assert_near(pixel[0].into(), expected, 5e-3, &format!("one pixel at {position}"));
            }
            assert_near(mean(&film), expected, 1e-3, &format!("at {position}"));
        }
    }
}

/// Standing on the floor, and wholly beside it: the point looks along it.
#[test]
fn a_grazing_rectangle_is_as_bright_as_lambert_says() {
    for away in [1e-3, 0.01, 0.1, 1.0] {
        let position = DVec3::new(-away, 0.2, 0.5);
        let [edge_u, edge_v] = [DVec3::Y, DVec3::Z];
        let expected = lambert(&corners(position, edge_u, edge_v)) / PI;
        let found = lit(Light::Rectangle { position, edge_u, edge_v, radiance: DVec3::ONE });
        assert_near(found, expected, 2e-3, &format!("a wall {away} away"));
    }
    // A ceiling that begins `aside` of the point, at 1/20 of that.
    for aside in [0.1, 1.0] {
        let position = DVec3::new(aside + 0.5, 0.1, aside / 20.0);
        let [edge_u, edge_v] = [DVec3::Y, DVec3::X];
        let expected = lambert(&corners(position, edge_u, edge_v)) / PI;
        let found = lit(Light::Rectangle { position, edge_u, edge_v, radiance: DVec3::ONE });
        assert_near(found, expected, 1e-2, &format!("a ceiling {aside} aside"));
    }
}

/// Rectangles with oblique edges have no solid-angle parametrisation: they are sampled by area.
#[test]
fn a_slanted_light_follows_lamberts_polygon_formula() {
    let [edge_u, edge_v] = [DVec3::new(0.3, 1.0, 0.0), DVec3::X];
    let position = DVec3::new(0.2, 0.1, 1.0);
    let expected = lambert(&corners(position, edge_u, edge_v)) / PI;
    let found = lit(Light::Rectangle { position, edge_u, edge_v, radiance: DVec3::ONE });
    assert_near(found, expected, 4e-3, "slanted");
}

fn lit_or_dark(light: Light) -> f64 {
    let mut scene = floor(1e-4, 0.1, 4, "");
    scene.lights = vec![light];
    mean(&render(&packed(&scene)))
}

/// A strip of light of width s at the height H over a half plane at h: on the ground the shadow's edge is
/// s h / (H - h) wide, and within it the light grows as the share of the strip that is seen.
#[test]
fn penumbrae_are_as_wide_as_geometry_says() {
    let (width, height, blocker) = (0.6, 12.0, 3.0);
    let rest = format!(
        "[[triangle]]\nvertices = [[0, -900, {blocker}], [0, 900, {blocker}], [-900, 0, {blocker}]]
[[light]]\nkind = 'rectangle'\nposition = [0, 0, {height}]\nedge_u = [0, 0.01, 0]\nedge_v = [{width}, 0, 0]\nradiance = [1e4, 1e4, 1e4]"
    );
    let scene = floor(0.5, 1.0, 32, &rest);
    let film = render(&packed(&scene));
    let row = &film.pixels[16 * 32..17 * 32];
    let open = f64::from(row[31][0]);
    let edge = width * blocker / (height - blocker); // 0.2 of 0.5
    for (i, pixel) in row.iter().enumerate() {
        let x = (i as f64 + 0.5) / 32.0 * 0.5 - 0.25;
        let expected = (x / edge + 0.5).clamp(0.0, 1.0);
        let found = f64::from(pixel[0]) / open;
        // Pixels at the two ends of the penumbra are averages over its kink.
        assert!((found - expected).abs() < 0.02, "at {x}: {found}, expected {expected}");
    }
}

#[test]
fn penumbrae_are_sampled_better_by_patterns_than_by_chance() {
    let blocker = "[[sphere]]\ncenter = [0.1, 0, 2]\nradius = 0.5\n";
    for (light, share) in [
        ("kind = 'sphere'\nposition = [0, 0.3, 5]\nradius = 1\nintensity = [20, 20, 20]", 0.3),
        (
            "kind = 'rectangle'\nposition = [0, 0.3, 5]\nedge_u = [0, 2, 0]\nedge_v = [1.5, 0, 0]\nintensity = [20, 20, 20]",
            0.3,
        ),
        ("kind = 'directional'\ndirection = [0.2, 0, 1]\nangle = 25\nirradiance = [2, 2, 2]", 0.3),
    ] {
        let scene = floor(2.0, 1.0, 24, &format!("{blocker}[[light]]\n{light}"));
        assert_patterns_gain(light, &scene, share);
    }
}

/// Two lights of one hit are sampled independently, and bounces beyond the last pair too.
#[test]
fn two_lights_choose_apart() {
    let light = "[[light]]\nkind = 'sphere'\nposition = [0, 0.3, 5]\nradius = 1\nintensity = [20, 20, 20]\n";
    let blocker = "[[sphere]]\ncenter = [0.1, 0, 2]\nradius = 0.5\n";
    let one = floor(2.0, 1.0, 24, &format!("{blocker}{light}"));
    let two = floor(2.0, 1.0, 24, &format!("{blocker}{light}{light}"));
    let exact = |scene: &Scene| sampled(scene, Pattern::SobolOwen, 8192, 9);
    let noise = |scene: &Scene| super::variance(scene, Pattern::SobolOwen, 16, &exact(scene));
    // With twice the light: four times the variance if both had the same sample, twice if they are independent.
    let ratio = noise(&two) / noise(&one);
    assert!((1.6..2.6).contains(&ratio), "{ratio}");
}

#[test]
fn without_an_extent_lights_are_points_and_directions() {
    let head = super::lens::VIEW;
    let pairs = [
        (
            "kind = 'sphere'\nposition = [0, 1, 2]\nradius = 0\nintensity = [1, 2, 3]",
            "kind = 'point'\nposition = [0, 1, 2]\nintensity = [1, 2, 3]",
        ),
        (
            "kind = 'directional'\ndirection = [0, 1, 2]\nangle = 0\nirradiance = [1, 2, 3]",
            "kind = 'directional'\ndirection = [0, 1, 2]\nirradiance = [1, 2, 3]",
        ),
    ];
    for (small, none) in pairs {
        let of = |light: &str| {
            let scene = parse("a.toml".as_ref(), &format!("{head}[[light]]\n{light}\n")).unwrap();
            packed(&scene).records.lights
        };
        assert_eq!(of(small), of(none));
    }
}

#[test]
fn lights_that_make_no_sense_are_refused_by_line_and_key() {
    for (light, words) in [
        (
            "kind = 'sphere'\nposition = [0, 1, 2]\nradius = -1\nintensity = [1, 2, 3]",
            ["light.radius", "not negative"],
        ),
        ("kind = 'sphere'\nposition = [0, 1, 2]\nintensity = [1, 2, 3]", ["light.radius", "missing"]),
        (
            "kind = 'directional'\ndirection = [0, 1, 2]\nangle = 181\nirradiance = [1, 2, 3]",
            ["light.angle", "180"],
        ),
        (
            "kind = 'rectangle'\nposition = [0, 1, 2]\nedge_u = [1, 0, 0]\nedge_v = [2, 0, 0]\nradiance = [1, 1, 1]",
            ["light.edge_v", "parallel"],
        ),
        (
            "kind = 'rectangle'\nposition = [0, 1, 2]\nedge_u = [1, 0, 0]\nedge_v = [0, 2, 0]",
            ["light.radiance", "intensity"],
        ),
        (
            "kind = 'rectangle'\nposition = [0, 1, 2]\nedge_u = [1, 0, 0]\nedge_v = [0, 2, 0]\nradiance = [1, 1, 1]\nintensity = [1, 1, 1]",
            ["light.intensity", "keep one"],
        ),
        (
            "kind = 'point'\nposition = [0, 1, 2]\nradius = 1\nintensity = [1, 2, 3]",
            ["radius", "kind \"point\""],
        ),
    ] {
        let text = format!("{}[[light]]\n{light}\n", super::lens::VIEW);
        let told = parse("a.toml".as_ref(), &text).unwrap_err().to_string();
        assert!(told.starts_with("a.toml:"), "{told}");
        words.iter().for_each(|word| assert!(told.contains(word), "{word} is not in: {told}"));
    }
}
