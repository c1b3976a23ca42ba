//! Cones at the limits of their geometry: inside spheres, along planes, among shapes smaller than
//! the cone, in shadows.

use moire::internal::core::film::Film;

use super::{central, exact_film, film, parallel, with_samples};

fn mean(film: &Film) -> f64 {
    film.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / film.pixels.len() as f64
}

#[test]
fn from_within_a_ball_there_is_nothing_else() {
    for material in ["white", "mirror"] {
        let ball = format!("[[sphere]]\ncenter = [0, 0.2, 4]\nradius = 3\nmaterial = '{material}'\n");
        let wanted = if material == "white" { 1.0 } else { 0.0 };
        for pixel in film(central(24, &ball)).pixels {
            assert_eq!(pixel, [wanted; 3], "{material}");
        }
    }
}

#[test]
fn a_plane_through_the_eye_is_no_wider_than_a_line() {
    for (origin, far) in [(0.0, 0.0), (1e-6, 0.0), (-1e-3, 0.0)] {
        let plane = format!(
            "[[plane]]\norigin = [0, {origin}, {far}]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'white'\n"
        );
        let found = film(parallel(31, &plane));
        assert!(found.pixels.iter().flatten().all(|v| v.is_finite() && *v <= 1.0));
        let covered = mean(&found);
        assert!(covered < 1.1 / 31.0, "at {origin}: {covered}");
    }
}

/// Random balls of a tenth of a pixel, mostly one or none per cone: their brightness is their area.
#[test]
fn balls_smaller_than_cones_add_up_to_their_area() {
    let mut rng = crate::lookup::bench::Rng::new(21);
    let (side, radius) = (32u32, 0.1 * 2.0 / 32.0);
    let mut text = String::new();
    let count = 1500;
    for _ in 0..count {
        let [x, y] = [(); 2].map(|()| rng.between(-0.95, 0.95));
        let z = rng.between(-1.0, 1.0);
        text += &format!("[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = {radius}\nmaterial = 'white'\n");
    }
    let wanted = f64::from(count) * std::f64::consts::PI * radius * radius / 4.0;
    let found = mean(&film(parallel(side, &text)));
    // Some hide others, in proportion to their own coverage.
    assert!((found / wanted - 1.0).abs() < 0.03, "{found} for {wanted}");
}

#[test]
fn a_tiny_ball_never_pops() {
    let radius = 0.15 * 2.0 / 16.0;
    let wanted = std::f64::consts::PI * radius * radius / 4.0;
    for i in 0..60 {
        let (x, y) = (0.0043 * f64::from(i) - 0.1, 0.0071 * f64::from(i) - 0.2);
        let ball = format!("[[sphere]]\ncenter = [{x}, {y}, 0]\nradius = {radius}\nmaterial = 'white'\n");
        let found = mean(&exact_film(parallel(16, &ball)));
        assert!((found / wanted - 1.0).abs() < 1e-3, "at ({x}, {y}): {found} for {wanted}");
    }
}

/// More shapes in a pixel than a cone keeps: the others have the same brightness.
#[test]
fn a_crowd_of_balls_is_as_bright_as_samples_say() {
    let mut rng = crate::lookup::bench::Rng::new(4);
    let mut text = String::from("[background]\ncolor = [0.2, 0.2, 0.2]\n");
    for _ in 0..2000 {
        let [x, y, z] = [(); 3].map(|()| rng.between(-1.0, 1.0));
        text += &format!("[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = 0.02\nmaterial = 'white'\n");
    }
    let scene = parallel(8, &text);
    let (found, truth) = (mean(&film(scene.clone())), mean(&film(with_samples(scene, 1024))));
    assert!((found / truth - 1.0).abs() < 0.03, "{found}, {truth} by samples");
}

#[test]
fn the_edge_of_a_shadow_is_a_share() {
    let text = "
[[material]]\nname = 'grey'
[[plane]]\norigin = [0, 0, -1]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'grey'
[[triangle]]\nvertices = [[0.1, -3, 0], [0.9, 0, 0.1], [0.4, 3, 0]]\nmaterial = 'grey'
[[sphere]]\ncenter = [-0.5, 0, -0.2]\nradius = 0.3\nmaterial = 'grey'
[[light]]\nkind = 'point'\nposition = [-0.2, 0.3, 3]\nintensity = [40, 40, 40]
[[light]]\nkind = 'directional'\ndirection = [0.3, 0.2, 1]\nirradiance = [1, 1, 1]\n";
    let scene = central(48, text);
    let truth = film(with_samples(scene.clone(), 1024));
    let found = film(scene.clone());
    let worst = found.pixels.iter().zip(&truth.pixels).map(|(p, q)| (p[0] - q[0]).abs()).fold(0.0, f32::max);
    let brightest = truth.pixels.iter().map(|p| p[0]).fold(0.0, f32::max);
    let one = super::rmse(&film(with_samples(scene, 1)), &truth);
    let all = super::rmse(&found, &truth);
    assert!(
        worst < 0.15 * brightest && all < 0.2 * one,
        "worst {worst} of {brightest}, RMSE {all:e}, one sample {one:e}"
    );
}
