//! Shapes behind a mirror do not appear in its reflection, neither as a shape nor as a hole.

use std::path::Path;

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::scene::model::{Scene, Triangle};
use moire::internal::scene::parse;

use super::{beams, with_beams};
use crate::stage::render_on_oracle;

/// A mirror that shows a green wall, before a blue sky, and a red triangle.
fn mirror(corners: [DVec3; 3], tilt: f64) -> Scene {
    let text = format!(
        "[camera]\neye = [0, 0, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 50\n[image]\nwidth = 64\nheight = 64
[background]\ncolor = [0, 0, 1]\n[[material]]\nname = 'mirror'\nmodel = 'mirror'
[[material]]\nname = 'green'\nmodel = 'unlit'\ncolor = [0, 1, 0]
[[material]]\nname = 'red'\nmodel = 'unlit'\ncolor = [1, 0, 0]
[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, {tilt}]\nhalf_extent = 1\nmaterial = 'mirror'
[[plane]]\norigin = [0, 0, 6]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'green'
[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nmaterial = 'red'\n"
    );
    let mut scene = parse(Path::new("mirror.toml"), &text).unwrap();
    scene.shapes.triangles = vec![Triangle { vertices: corners, ..scene.shapes.triangles[0] }];
    scene
}

fn by_device_and_oracle(scene: Scene) -> [Film; 2] {
    let scene = with_beams(scene);
    let (film, sampled) = beams(&scene);
    assert_eq!(sampled, 0);
    [film, render_on_oracle(&scene)]
}

#[test]
fn a_triangle_behind_a_mirror_makes_no_hole_in_its_reflection() {
    let behind = [DVec3::new(0.1, -0.5, -0.1), DVec3::new(0.7, -0.3, -0.4), DVec3::new(0.3, 0.6, -0.2)];
    for film in by_device_and_oracle(mirror(behind, 0.0)) {
        assert_eq!(film.pixels[20 * 64 + 39], [0.0, 1.0, 0.0]);
        // The whole mirror: half as wide as 3 tan 25°, in rows and columns about the centre.
        for (x, y) in (10..54).flat_map(|x| (10..54).map(move |y| (x, y))) {
            assert_eq!(film.pixels[y * 64 + x], [0.0, 1.0, 0.0], "({x}, {y})");
        }
    }
}

/// If two shapes are coplanar the first is visible, and no ray that leaves it meets the other.
#[test]
fn what_lies_in_the_mirror_is_not_in_its_reflection() {
    for tilt in [0.0, 0.123] {
        let on_mirror = |x: f64, y: f64| DVec3::new(x, y, tilt * y);
        let within = [on_mirror(0.1, -0.5), on_mirror(0.7, -0.3), on_mirror(0.3, 0.6)];
        for film in by_device_and_oracle(mirror(within, tilt)) {
            assert!(film.pixels.iter().all(|p| p[0] == 0.0), "tilt {tilt}: red");
        }
    }
}

/// Its protruding part, upside down.
#[test]
fn what_reaches_through_a_mirror_is_mirrored_from_there() {
    let through = [DVec3::new(-0.3, -0.5, -0.4), DVec3::new(-0.3, 0.5, -0.4), DVec3::new(-0.3, 0.0, 0.4)];
    let half = DVec3::new(-0.3, 0.0, 0.0);
    let before = [half + 0.25 * DVec3::NEG_Y, half + 0.25 * DVec3::Y, through[2]];
    let films = [through, before].map(|corners| by_device_and_oracle(mirror(corners, 0.0)));
    for (a, b) in films[0].iter().zip(&films[1]) {
        let red = |film: &Film| film.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>();
        assert!(red(a) > 5.0 && (red(a) - red(b)).abs() < 1e-3, "{} and {}", red(a), red(b)); // 64² × f32
    }
}
