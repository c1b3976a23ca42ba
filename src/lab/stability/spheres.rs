//! Spheres of radius 1e-4 to 1e6, seen from a distance and from close above their surface. The
//! camera looks at the centre, or along the tangent that grazes it, so that silhouette, position
//! and coordinate follow from plane trigonometry in the angle between ray and view, without any of
//! the renderer's formulas.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::case::{Bench, Case, Point};
use super::coordinates::CENTER;
use super::scenes::{on_device, packed};
use super::view::{Reading, View};
use crate::core::error::Result;

const SIDE: u32 = 64;

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, unit, bound, reason, run| Case {
        group: "spheres",
        name,
        parameter,
        unit,
        bound,
        reason,
        run,
    };
    vec![
        case("distance", "distance over radius", "pixels or texels", 1.0 / 32.0, OUTLINE, by_distance),
        case(
            "radius",
            "radius at distance 1e7 from the surface",
            "pixels or texels",
            1.0 / 32.0,
            OUTLINE,
            by_radius,
        ),
        case("horizon", "radius over the eye's height", "pixels", 1.0 / 32.0, OUTLINE, horizon),
    ]
}

const OUTLINE: &str = "f32 places outlines to 1/32 of a pixel and f64 takes over where it does not; places on the surface \
                       are then known to as much";

fn text(view: &View, center: DVec3, radius: f64, reading: &Reading) -> String {
    view.text()
        + CENTER
        + &reading.text("kind = \"surface\"")
        + &format!(
            "[[sphere]]\ncenter = [{:?}, {:?}, {:?}]\nradius = {radius:?}\nmaterial = \"m\"\n",
            center.x, center.y, center.z
        )
}

/// Returns the coordinate of a unit normal in the lecture's order u = θ/π and v = φ/2π.
fn coordinate(normal: DVec3) -> DVec2 {
    let turn = normal.z.atan2(normal.x) / (2.0 * PI);
    DVec2::new(normal.x.hypot(normal.z).atan2(normal.y) / PI, turn - turn.floor())
}

/// Measures a view towards the centre. The picture is 1.2 times as high as the sphere.
fn at_center(bench: &Bench<'_>, parameter: f64, radius: f64, distance: f64) -> Result<Point> {
    // No axis of the world is in the picture.
    let ahead = DVec3::new(0.48, -0.6, 0.64).normalize();
    let fov = 2.0 * (1.2 * (radius / distance).asin().tan()).atan();
    let center = DVec3::new(0.5, 0.25, -0.125);
    let view =
        View::new(center - distance * ahead, center, DVec3::new(0.2, 1.0, 0.1), fov.to_degrees(), SIDE);
    let reading = Reading { mirrored: false, linear: true, size: [64, 64] };
    let film =
        on_device(bench, &packed(&text(&view, center, radius, &reading), vec![reading.ramps()], None)?)?;
    let [_, _, ahead] = view.axes();
    let pixel = 2.0 * (0.5 * fov).tan() / f64::from(SIDE);
    let errors = view.pixels().filter_map(|(i, [x, y], middle)| {
        let place = format!("pixel ({x}, {y})");
        let aside = view.direction(middle) - ahead;
        let tangent = aside.length();
        // The distance of the ray from the centre, relative to the radius.
        let nearest = distance / radius * tangent / (1.0 + tangent * tangent).sqrt();
        let hit = film.pixels[i] != [0.0; 3];
        // The silhouette is at 1, and a pixel in these units is:
        let unit = pixel * distance / radius;
        if hit != (nearest < 1.0) {
            return Some(((nearest - 1.0).abs() / unit, place));
        }
        if !hit {
            return None;
        }
        // The angle between ray and normal; close to the silhouette positions on the sphere change
        // without bound.
        let normal_angle = nearest.asin() - tangent.atan();
        let normal = -normal_angle.cos() * ahead + normal_angle.sin() * aside / tangent.max(1e-300);
        let texels = reading.texels_off(film.pixels[i], coordinate(normal))?;
        let steep = 1.0 / (1.0 - nearest * nearest).sqrt();
        // Texels per pixel: along v a turn is 2π sin θ long.
        let sine = normal.x.hypot(normal.z);
        let across = 64.0 * unit * steep * (1.0 / PI).max(1.0 / (2.0 * PI * sine));
        Some((texels / across.max(1.0), place))
    });
    Ok(Point::worst(parameter, errors))
}

fn by_distance(bench: &Bench<'_>) -> Result<Vec<Point>> {
    (0..=10).map(|k| at_center(bench, 1.5 * 10f64.powi(k), 1.0, 1.5 * 10f64.powi(k))).collect()
}

fn by_radius(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |k: i32| {
        let radius = 10f64.powi(k);
        at_center(bench, radius, radius, radius + 1e7)
    };
    (-4..=6).map(run).collect()
}

/// Measures an eye one unit above a sphere that looks at its horizon: at an angle of acos(r / (r +
/// 1)) below level.
fn horizon(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |k: i32| {
        let radius = 10f64.powi(k);
        let dip = ((2.0 * radius + 1.0).sqrt() / radius).atan();
        let center = DVec3::new(0.0, -radius, 0.0);
        let eye = DVec3::new(0.0, 1.0, 0.0);
        // The picture's height is a fifth of the dip.
        let fov = 0.2 * dip;
        let view =
            View::new(eye, eye + DVec3::new(dip.cos(), -dip.sin(), 0.0), DVec3::Y, fov.to_degrees(), SIDE);
        let reading = Reading { mirrored: false, linear: true, size: [64, 64] };
        let scene = packed(&text(&view, center, radius, &reading), vec![reading.ramps()], None)?;
        let film = on_device(bench, &scene)?;
        let pixel = 2.0 * (0.5 * fov).tan() / f64::from(SIDE);
        let errors = view.pixels().filter_map(|(i, [x, y], middle)| {
            let direction = view.direction(middle);
            let below = (-direction.y).atan2(direction.x.hypot(direction.z)) - dip;
            let hit = film.pixels[i] != [0.0; 3];
            (hit != (below > 0.0)).then(|| (below.abs() / pixel, format!("pixel ({x}, {y})")))
        });
        Ok(Point::worst(radius, errors))
    };
    (0..=6).map(run).collect()
}
