//! Layers with known answers, on the oracle: planes and floors in closed form, spheres, numbers, edges.

use std::f64::consts::PI;

use glam::{DMat2, DVec2, DVec3};
use moire::internal::core::layer::Layer;
use moire::internal::render::layers::Aov;
use moire::internal::scene::model::{Algorithm, Pattern};
use moire::internal::texture::sampler_spec::{Filter, MipMode};

use super::{DOWN, TEXELS, layer, with_scene};
use crate::support::told;

const FLOOR: &str = r#"
[camera]
eye = [0.0, 1.0, 0.0]
look_at = [0.0, 1.0, -1.0]
vertical_fov = 90.0
[image]
width = 8
height = 8
[[texture]]
name = "t"
file = "t.png"
[[material]]
name = "m"
model = "unlit"
texture = "t"
[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 0.0, 1.0]
material = "m"
"#;

const BALL: &str = r#"
[camera]
eye = [0.0, 0.0, 5.0]
look_at = [0.0, 0.0, 0.0]
orthographic_height = 4.0
[image]
width = 16
height = 16
[[texture]]
name = "t"
file = "t.png"
[[material]]
name = "plain"
model = "unlit"
[[material]]
name = "m"
model = "unlit"
texture = "t"
[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 1.5
material = "m"
[[sphere]]
center = [1.75, 1.75, 0.0]
radius = 0.2
material = "plain"
"#;

fn near(found: f32, wanted: f64, what: &str) {
    assert!(
        (f64::from(found) - wanted).abs() <= 2e-6 * wanted.abs().max(1.0),
        "{what}: {found}, not {wanted}"
    );
}

fn all(layer: &Layer, channel: usize, wanted: f64) {
    assert!(layer.present.iter().all(|present| *present), "{}: missing", layer.name);
    layer.channels[channel].values.iter().for_each(|value| near(*value, wanted, layer.name));
}

#[test]
fn a_plane_seen_straight_has_the_texels_that_its_scale_says() {
    with_scene(DOWN, |scene| {
        let texels = layer(&scene, Aov::Texels);
        all(&texels, 0, 4.0);
        all(&texels, 1, 2.0);
        all(&layer(&scene, Aov::Magnification), 0, -2.0);
        all(&layer(&scene, Aov::Anisotropy), 0, 2.0);
    });
}

#[test]
fn a_magnified_plane_has_positive_magnification_and_level_0() {
    let text = DOWN.replace("scale = [0.5, 0.25]", "scale = [0.03125, 0.03125]");
    with_scene(&text, |scene| {
        all(&layer(&scene, Aov::Texels), 0, 0.25);
        all(&layer(&scene, Aov::Magnification), 0, 2.0);
        all(&layer(&scene, Aov::Level), 0, 0.0);
    });
}

#[test]
fn the_level_is_that_of_the_scenes_own_sampler() {
    with_scene(DOWN, |scene| {
        let level = |min: Filter, mip: MipMode| {
            let mut scene = scene.clone();
            (scene.samplers[0].mag, scene.samplers[0].min) = (Filter::Linear, min);
            scene.samplers[0].mip = mip;
            layer(&scene, Aov::Level)
        };
        all(&level(Filter::Linear, MipMode::Linear), 0, 2.0);
        all(&level(Filter::Linear, MipMode::None), 0, 0.0);
        // Two look-ups along the longer axis are each as wide as the shorter one.
        all(&level(Filter::Anisotropic, MipMode::Linear), 0, 1.0);
        all(&level(Filter::Ewa, MipMode::Linear), 0, 1.0);
        all(&level(Filter::SummedArea, MipMode::None), 0, 0.0);
    });
    let between = DOWN.replace("scale = [0.5, 0.25]", "scale = [0.375, 0.25]");
    with_scene(&between, |mut scene| {
        all(&layer(&scene, Aov::Level), 0, 3f64.log2());
        scene.samplers[0].mip = MipMode::Nearest;
        all(&layer(&scene, Aov::Level), 0, 2.0);
    });
}

#[test]
fn a_floor_in_perspective_has_the_texels_and_depths_of_the_formula() {
    with_scene(FLOOR, |scene| {
        let (texels, depth) = (layer(&scene, Aov::Texels), layer(&scene, Aov::Depth));
        for [x, y] in [[0, 4], [3, 5], [7, 6], [2, 7]] {
            let i = y * 8 + x;
            let [sx, sy] = [(x as f64 + 0.5) / 4.0 - 1.0, 1.0 - (y as f64 + 0.5) / 4.0];
            let t = -1.0 / sy;
            near(depth.channels[0].values[i], t, "depth");
            // A pixel is a quarter of the picture's half height: changes of (x, z) by columns and rows.
            let by_row = 0.25 / (sy * sy);
            let changes = DMat2::from_cols(DVec2::new(0.25 * t, 0.0), DVec2::new(-by_row * sx, by_row))
                * f64::from(TEXELS);
            let squares = changes.transpose() * changes;
            let (middle, half) =
                ((squares.x_axis.x + squares.y_axis.y) / 2.0, (squares.x_axis.x - squares.y_axis.y) / 2.0);
            let radius = half.hypot(squares.x_axis.y);
            near(texels.channels[0].values[i], (middle + radius).sqrt(), "longer axis");
            near(
                texels.channels[1].values[i],
                changes.determinant().abs() / (middle + radius).sqrt(),
                "shorter axis",
            );
        }
        assert!(!texels.present[0] && !depth.present[0], "the sky has texels");
        assert_eq!([texels.channels[0].values[0], depth.channels[0].values[0]], [0.0; 2]);
    });
}

#[test]
fn depth_normal_and_place_of_a_sphere_are_those_of_the_formula() {
    with_scene(BALL, |scene| {
        let [depth, normal, uv] = [Aov::Depth, Aov::Normal, Aov::Uv].map(|aov| layer(&scene, aov));
        let mut seen = 0;
        for y in 0..16 {
            for x in 0..16 {
                let at = DVec2::new((x as f64 + 0.5) / 4.0 - 2.0, 2.0 - (y as f64 + 0.5) / 4.0);
                let i = y * 16 + x;
                if at.length() >= 1.5 {
                    assert!(!uv.present[i], "({x}, {y})");
                    continue;
                }
                seen += 1;
                let n = DVec3::new(at.x, at.y, (2.25 - at.length_squared()).sqrt()) / 1.5;
                near(depth.channels[0].values[i], 5.0 - 1.5 * n.z, "depth");
                (0..3).for_each(|c| near(normal.channels[c].values[i], n[c], "normal"));
                near(uv.channels[0].values[i], n.y.acos() / PI, "u");
                near(uv.channels[1].values[i], n.z.atan2(n.x).rem_euclid(2.0 * PI) / (2.0 * PI), "v");
            }
        }
        assert!(seen > 80, "{seen}");
    });
}

#[test]
fn shapes_and_materials_are_numbered_from_1_and_the_background_is_0() {
    with_scene(BALL, |scene| {
        let [instance, material, texels] =
            [Aov::Instance, Aov::Material, Aov::Texels].map(|aov| layer(&scene, aov));
        // The middle, the small ball in the corner, and the sky.
        for (i, [shape, of]) in [(8 * 16 + 8, [1.0, 2.0]), (16 + 14, [2.0, 1.0]), (0, [0.0, 0.0])] {
            assert_eq!(
                [instance.channels[0].values[i], material.channels[0].values[i]],
                [shape, of],
                "pixel {i}"
            );
            assert_eq!(instance.present[i], shape > 0.0);
            assert_eq!(texels.present[i], shape == 1.0, "only one of them has a texture");
        }
    });
}

#[test]
fn pixels_at_an_edge_see_two_surfaces() {
    // The plane's edges cut the middle of pixels in x, and go along pixels in z.
    let text = DOWN
        .replace("origin = [0.0, 0.0, 0.0]", "origin = [0.0625, 0.0, 0.0]\nhalf_extent = 0.5")
        .replace("height = 16\n", "height = 16\n[sampling]\nspp = 16\n");
    with_scene(&text, |scene| {
        let surfaces = layer(&scene, Aov::Surfaces);
        for (i, &count) in surfaces.channels[0].values.iter().enumerate() {
            let [x, y] = [i % 16, i / 16];
            let edge = (4..12).contains(&y) && (x == 4 || x == 12);
            assert_eq!(count, if edge { 2.0 } else { 1.0 }, "({x}, {y})");
        }
    });
}

#[test]
fn one_sample_at_the_centre_still_looks_for_surfaces() {
    let text = DOWN
        .replace("origin = [0.0, 0.0, 0.0]", "origin = [0.0625, 0.0, 0.0]\nhalf_extent = 0.5")
        .replace("height = 16\n", "height = 16\n[sampling]\npattern = \"center\"\n");
    with_scene(&text, |scene| assert_eq!(layer(&scene, Aov::Surfaces).channels[0].values[8 * 16 + 4], 2.0));
}

#[test]
fn albedo_is_the_colour_without_light() {
    let text = DOWN
        .replace("model = \"unlit\"\ntexture = \"t\"", "model = \"lambert\"\ncolor = [0.5, 0.25, 0.75]")
        + "[background]\ncolor = [9.0, 9.0, 9.0]\n";
    with_scene(&text, |scene| {
        let albedo = layer(&scene, Aov::Albedo);
        (0..3).for_each(|c| all(&albedo, c, [0.5, 0.25, 0.75][c]));
    });
}

#[test]
fn samples_and_errors_are_the_same_everywhere_or_those_of_adaptive_sampling() {
    with_scene(FLOOR, |mut scene| {
        all(&layer(&scene, Aov::Samples), 0, 16.0);
        let error = layer(&scene, Aov::Error).channels.remove(0).values;
        assert!(error[63] > 0.0 && error[63] < 0.5, "{}", error[63]);
        assert_eq!(error[0], 0.0, "the sky has no noise");
        scene.sampling.algorithm = Algorithm::Adaptive;
        scene.sampling.pattern = Pattern::SobolOwen;
        let samples = layer(&scene, Aov::Samples).channels.remove(0).values;
        let mean = samples.iter().sum::<f32>() / 64.0;
        assert!((12.0..=20.0).contains(&mean), "{mean}");
        let range = samples.iter().fold([f32::MAX, 0.0], |[low, high], n| [low.min(*n), high.max(*n)]);
        assert!(range[0] < range[1], "all pixels have {} samples", range[0]);
        let error = layer(&scene, Aov::Error).channels.remove(0).values;
        assert!(error.iter().all(|e| e.is_finite()) && error.iter().any(|e| *e > 0.0), "{error:?}");
    });
}

#[test]
fn errors_of_pictures_without_chance_are_refused() {
    with_scene(FLOOR, |mut scene| {
        for (algorithm, pattern, name) in
            [(Algorithm::Samples, Pattern::Grid, "grid"), (Algorithm::Cone, Pattern::Random, "cone")]
        {
            (scene.sampling.algorithm, scene.sampling.pattern) = (algorithm, pattern);
            let why = told(Aov::Error.check(&scene));
            assert!(why.contains(name) && why.contains("--pattern sobol-owen"), "{why}");
        }
    });
}
