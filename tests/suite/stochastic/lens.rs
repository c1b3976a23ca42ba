//! The thin lens: points in focus, the circle of confusion elsewhere, and the gain by sample
//! patterns.

use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::oracle::backend::render as on_oracle;
use moire::internal::scene::model::{Lens, Scene};
use moire::internal::scene::parse;

use super::{assert_patterns_gain, packed, parsed};
use crate::stage::render;

pub const VIEW: &str = "
[camera]
eye = [0, 0, 5]
look_at = [0, 0, 1]
vertical_fov = 40
[image]
width = 64
height = 64
[sampling]
pattern = 'sobol-owen'
spp = 16
[[material]]
name = 'white'
model = 'unlit'
";

fn with_lens(text: &str, radius: f64, focus_distance: f64) -> Scene {
    let mut scene = parsed(&format!("{VIEW}{text}"));
    scene.camera.lens = Some(Lens { radius, focus_distance });
    scene
}

#[test]
fn what_lies_in_the_plane_of_focus_looks_as_through_a_pinhole() {
    let card = "[[triangle]]\nvertices = [[-1.2, -0.7, 2], [1, -0.4, 2], [-0.3, 1, 2]]\nmaterial = 'white'\n";
    let sharp = with_lens(card, 0.4, 3.0);
    let pinhole = Scene {
        camera: moire::internal::scene::model::Camera { lens: None, ..sharp.camera },
        ..sharp.clone()
    };
    let [a, b] = [&sharp, &pinhole].map(|s| on_oracle(&packed(s), &NoProgress).unwrap());
    assert_eq!(a, b, "in focus");
    let [a, b] = [&sharp, &pinhole].map(|s| render(&packed(s)));
    let apart = a.pixels.iter().zip(&b.pixels).filter(|(p, q)| p != q).count();
    assert!(apart <= 2, "{apart} pixels differ on the device: rounding at an edge");
    let blurred = on_oracle(&packed(&with_lens(card, 0.4, 2.0)), &NoProgress).unwrap();
    assert!(moire::internal::lab::metrics::compare(&blurred, &b).unwrap().rmse > 0.05, "out of focus");
}

/// Variance of the light's place in the picture along x and y, in pixels squared.
pub fn spread(film: &Film) -> [f64; 2] {
    let (mut sum, mut first, mut second) = (0.0, [0.0; 2], [0.0; 2]);
    for (i, pixel) in film.pixels.iter().enumerate() {
        let light = f64::from(pixel[0]);
        let at = [i as u32 % film.width, i as u32 / film.width].map(|x| f64::from(x) + 0.5);
        sum += light;
        for axis in 0..2 {
            first[axis] += light * at[axis];
            second[axis] += light * at[axis] * at[axis];
        }
    }
    [0, 1].map(|axis| second[axis] / sum - (first[axis] / sum).powi(2))
}

/// The circle of confusion of a lens of radius R is, at distance 1, 2 R abs(1/focus - 1/distance) wide. A
/// uniform disc of radius r has variance r²/4 along each axis, to which that of the target itself and of a
/// pixel, 1/12, add.
#[test]
fn a_point_out_of_focus_becomes_the_circle_of_confusion() {
    let ball = "[[sphere]]\ncenter = [0, 0, 1]\nradius = 0.02\nmaterial = 'white'\n";
    let pixel = 2.0 * 20f64.to_radians().tan() / 64.0;
    for (radius, focus) in [(0.3, 2.0), (0.25, 100.0), (0.5, 4.8)] {
        let mut scene = with_lens(ball, radius, focus);
        scene.sampling.spp = 4096;
        let blur = radius * (1.0f64 / focus - 0.25).abs() / pixel;
        let own = 0.02 / 4.0 / pixel;
        let expected = (blur * blur + own * own) / 4.0 + 1.0 / 12.0;
        for found in spread(&render(&packed(&scene))) {
            assert!((found / expected - 1.0).abs() < 0.06, "R {radius}, focus {focus}: {found}, {expected}");
        }
    }
}

#[test]
fn blur_is_sampled_better_by_patterns_than_by_chance() {
    let cards = "[[plane]]\norigin = [0.1, 0, -3]\ntangent = [0.9, 0.3, 0]\nbitangent = [-0.3, 0.9, 0]
half_extent = 1\nmaterial = 'white'\n";
    let mut scene = with_lens(cards, 0.5, 3.0);
    (scene.width, scene.height) = (24, 24);
    assert_patterns_gain("lens", &scene, 0.35);
}

#[test]
fn default_focus_is_what_is_looked_at() {
    let text = VIEW.replace("vertical_fov = 40", "vertical_fov = 40\nlens_radius = 0.25");
    assert_eq!(parsed(&text).camera.lens, Some(Lens { radius: 0.25, focus_distance: 4.0 }));
    let text = VIEW.replace("vertical_fov = 40", "vertical_fov = 40\nlens_radius = 0\nfocus_distance = 2");
    assert_eq!(parsed(&text).camera.lens, None);
}

#[test]
fn lenses_that_make_no_sense_are_refused_by_line_and_key() {
    for (from, to, words) in [
        (
            "vertical_fov = 40",
            "vertical_fov = 40\nlens_radius = -1",
            ["toml:6", "camera.lens_radius", "not negative"],
        ),
        (
            "vertical_fov = 40",
            "vertical_fov = 40\nfocus_distance = 0",
            ["toml:6", "camera.focus_distance", "above 0"],
        ),
        (
            "vertical_fov = 40",
            "orthographic_height = 4\nlens_radius = 0.1",
            ["toml:6", "camera.lens_radius", "parallel rays"],
        ),
    ] {
        let told = parse("a.toml".as_ref(), &VIEW.replace(from, to)).unwrap_err().to_string();
        words.iter().for_each(|word| assert!(told.contains(word), "{word} is not in: {told}"));
    }
}
