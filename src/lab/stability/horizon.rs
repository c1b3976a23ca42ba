//! Rays at grazing incidence on a plane: a camera 1e-4 to 1e6 above it with the horizon in its
//! picture, and cameras whose whole view is within a small angle of parallel. Towards the horizon
//! texels become smaller than pixels: the error of a lookup is then in fractions of a pixel.

use glam::{DVec2, DVec3};

use super::case::{Bench, Case, Point};
use super::coordinates::{CENTER, decades};
use super::scenes::{on_device, packed};
use super::view::{Reading, View, on_plane};
use crate::core::error::Result;

const BOUND: f64 = 1.0 / 256.0;
const SIDE: u32 = 96;

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, unit, reason, run| Case {
        group: "horizon",
        name,
        parameter,
        unit,
        bound: BOUND,
        reason,
        run,
    };
    let height = "height of the eye over the plane";
    let either = "texels or pixels, whichever are larger";
    vec![
        case("height", height, either, IN_PIXELS, by_height),
        case("height-in-f64", height, "texels", IN_TEXELS, by_height_in_double),
        case("grazing", "radians between rays and plane", either, IN_PIXELS, grazing),
    ]
}

const IN_PIXELS: &str = "a direction in f32 is off by 2^-23, which in a picture of up to 1e4 pixels is less than 1/256 of \
                         one; scenes whose texels would move by more are computed in f64";
const IN_TEXELS: &str = "in f64 the distance along a ray is off by 2^-50 over the sine of its angle with the plane, so that \
                         even a pixel below the horizon no look-up moves by 1/256 of a texel";

/// The ground with one unit per tile around the origin.
const GROUND: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Z];

fn seen(bench: &Bench<'_>, parameter: f64, view: &View, scale: f64, double: bool) -> Result<Point> {
    let mut errors = Vec::new();
    let coordinate = |place: DVec2| {
        let [constant, varies] = on_plane(view.eye, view.direction(place), GROUND)?;
        Some(scale * (constant + varies))
    };
    for reading in Reading::ALL {
        let mapping = format!("kind = \"surface\", scale = [{scale:?}, {scale:?}]");
        let precision = if double { "double" } else { "auto" };
        let text = view.text()
            + &CENTER.replace("[background]", &format!("precision = \"{precision}\"\n[background]"))
            + &reading.text(&mapping)
            + "[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 0.0, 1.0]\nmaterial = \"m\"\n";
        let film = on_device(bench, &packed(&text, vec![reading.ramps()], None)?)?;
        for (i, [x, y], middle) in view.pixels() {
            let Some(uv) = coordinate(middle) else { continue };
            let Some(texels) = reading.texels_off(film.pixels[i], uv) else { continue };
            let pixel = if double { 1.0 } else { pixel_in_texels(&coordinate, middle, uv, reading.size) };
            errors.push((texels / pixel.max(1.0), format!("pixel ({x}, {y}), {}", reading.name())));
        }
    }
    Ok(Point::worst(parameter, errors))
}

/// Returns the largest extent of a pixel in texels, from positions near its centre.
fn pixel_in_texels(
    coordinate: &dyn Fn(DVec2) -> Option<DVec2>,
    middle: DVec2,
    uv: DVec2,
    size: [u32; 2],
) -> f64 {
    const STEP: f64 = 1.0 / 64.0;
    let size = DVec2::new(f64::from(size[0]), f64::from(size[1]));
    let span = |step: DVec2| match coordinate(middle + step) {
        Some(other) => ((other - uv) * size).length() / STEP,
        None => f64::INFINITY,
    };
    span(DVec2::new(STEP, 0.0)).max(span(DVec2::new(0.0, STEP)))
}

fn with_horizon(height: f64) -> View {
    let eye = DVec3::new(0.31, height, -0.17);
    View::new(eye, eye + DVec3::new(0.9, -0.2, 0.4) * height, DVec3::Y, 50.0, SIDE)
}

fn by_height(bench: &Bench<'_>) -> Result<Vec<Point>> {
    decades(-4, 6).map(|height| seen(bench, height, &with_horizon(height), 1.0, false)).collect()
}

fn by_height_in_double(bench: &Bench<'_>) -> Result<Vec<Point>> {
    decades(-4, 6).map(|height| seen(bench, height, &with_horizon(height), 1.0, true)).collect()
}

/// Sweeps the grazing angle of the whole picture; a tile is as long as the visible part.
fn grazing(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |k: i32| {
        let angle = 10f64.powi(-k);
        let eye = DVec3::new(0.0, 1.0, 0.0);
        let view =
            View::new(eye, DVec3::new(1.0 / angle, 0.0, 0.1 / angle), DVec3::Y, angle.to_degrees(), SIDE);
        seen(bench, angle, &view, angle, false)
    };
    (1..=7).map(run).collect()
}
