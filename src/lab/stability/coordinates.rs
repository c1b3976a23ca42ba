//! Texture coordinates of many tiles: planes and triangles whose pictures are 1 to 1e9 tiles from
//! the texture's origin, through the eye position, offset, scale or the vertices' own uv. Each
//! pixel reads a texture of ramps, so that its colour encodes the sampled coordinate; the reference
//! is that coordinate in f64.

use glam::{DVec2, DVec3};

use super::case::{Bench, Case, Point};
use super::scenes::{on_device, packed};
use super::view::{Reading, View, on_plane};
use crate::core::error::Result;

const BOUND: f64 = 1.0 / 256.0;
const REASON: &str = "whole tiles leave in f64, on the host what is constant and on the device what varies: 2^-52 of \
                      1e9 tiles of 1024 texels is 2e-4 of a texel, and the rest is below one tile in f32, 6e-5";
const SIDE: u32 = 48;

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, run| Case {
        group: "coordinates",
        name,
        parameter,
        unit: "texels",
        bound: BOUND,
        reason: REASON,
        run,
    };
    vec![
        case("eye", "tiles from the texture's origin to the eye", eye),
        case("offset", "tiles of offset", offset),
        case("scale", "tiles a unit", scale),
        case("triangle", "tiles between vertices", triangle),
        case("planar", "tiles a unit", planar),
        case("collinear-axes", "radians between the plane's axes", collinear),
    ]
}

/// Returns powers of ten from 10^first to 10^last, times a number with many digits.
pub fn decades(first: i32, last: i32) -> impl Iterator<Item = f64> {
    (first..=last).map(|k| 1.234_567_891 * 10f64.powi(k))
}

/// The expected coordinate of a pixel, as a function of its centre.
type Answer<'a> = &'a dyn Fn(DVec2) -> Option<DVec2>;

/// Returns the largest error over all four readings.
fn swept(
    bench: &Bench<'_>,
    parameter: f64,
    view: &View,
    mapping: &str,
    shape: &str,
    answer: Answer<'_>,
) -> Result<Point> {
    let mut errors = Vec::new();
    for reading in Reading::ALL {
        let text = view.text() + CENTER + &reading.text(mapping) + shape;
        let film = on_device(bench, &packed(&text, vec![reading.ramps()], None)?)?;
        for (i, [x, y], middle) in view.pixels() {
            let Some(uv) = answer(middle) else { continue };
            if let Some(error) = reading.texels_off(film.pixels[i], uv) {
                errors.push((error, format!("pixel ({x}, {y}), {}", reading.name())));
            }
        }
    }
    Ok(Point::worst(parameter, errors))
}

pub const CENTER: &str = "[sampling]\npattern = \"center\"\n[background]\ncolor = [0.0, 0.0, 0.0]\n";
const GROUND: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Z];

fn ground_text(material: &str) -> String {
    format!(
        "[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 0.0, 1.0]\nmaterial = \"{material}\"\n"
    )
}

/// Returns a view down on the ground near a position.
fn above(position: DVec3) -> View {
    let eye = position + DVec3::new(0.3, 1.7, 0.2);
    View::new(eye, position + DVec3::new(0.4, 0.0, -0.3), DVec3::Y, 40.0, SIDE)
}

/// Adds the constant and the varying part of a coordinate in tiles, which are kept separate because
/// their sum would lose digits that the scene has.
fn sum(constant: DVec2, varies: DVec2) -> DVec2 {
    let even = |x: f64| x - 2.0 * (0.5 * x).floor();
    DVec2::new(even(constant.x), even(constant.y)) + varies
}

fn eye(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |tiles: f64| {
        let view = above(DVec3::new(tiles, 0.0, -0.7 * tiles));
        let answer = |middle: DVec2| {
            let [constant, varies] = on_plane(view.eye, view.direction(middle), GROUND)?;
            Some(sum(constant, varies))
        };
        swept(bench, tiles, &view, "kind = \"surface\"", &ground_text("m"), &answer)
    };
    decades(0, 9).map(run).collect()
}

fn offset(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |tiles: f64| {
        let view = above(DVec3::ZERO);
        let offset = DVec2::new(tiles, -0.3 * tiles);
        let answer = |middle: DVec2| {
            let [constant, varies] = on_plane(view.eye, view.direction(middle), GROUND)?;
            Some(sum(offset, constant + varies))
        };
        let mapping = format!("kind = \"surface\", offset = [{:?}, {:?}]", offset.x, offset.y);
        swept(bench, tiles, &view, &mapping, &ground_text("m"), &answer)
    };
    decades(0, 9).map(run).collect()
}

fn scale(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |tiles: f64| {
        let view = above(DVec3::ZERO);
        let scale = DVec2::new(tiles, 0.9 * tiles);
        let answer = |middle: DVec2| {
            let [constant, varies] = on_plane(view.eye, view.direction(middle), GROUND)?;
            Some(scale * (constant + varies))
        };
        let mapping = format!("kind = \"surface\", scale = [{:?}, {:?}]", scale.x, scale.y);
        swept(bench, tiles, &view, &mapping, &ground_text("m"), &answer)
    };
    decades(-6, 9).map(run).collect()
}

fn planar(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |tiles: f64| {
        let view = above(DVec3::ZERO);
        // The ground's own x, and the height above the offset, which is 0.
        let answer = |middle: DVec2| {
            let [constant, varies] = on_plane(view.eye, view.direction(middle), GROUND)?;
            let position = constant + varies;
            Some(DVec2::new(tiles * position.x, 0.25))
        };
        let mapping = format!("kind = \"planar\", scale = [{tiles:?}, 1.0], offset = [0.0, 0.25]");
        swept(bench, tiles, &view, &mapping, &ground_text("m"), &answer)
    };
    decades(-6, 9).map(run).collect()
}

fn triangle(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |tiles: f64| {
        let view = above(DVec3::ZERO);
        let [a, b, c] = [DVec3::new(-9.0, 0.0, 7.0), DVec3::new(11.0, 0.0, 8.0), DVec3::new(1.0, 0.0, -17.0)];
        let uv = |x: f64, z: f64| DVec2::new(tiles * (0.1 * x + 0.02 * z), tiles * (0.07 * z - 0.01 * x));
        let uvs = [a, b, c].map(|v| uv(v.x, v.z));
        let answer = |middle: DVec2| {
            let [constant, varies] = on_plane(view.eye, view.direction(middle), [a, b - a, c - a])?;
            let w = constant + varies;
            let inside = w.x > 1e-3 && w.y > 1e-3 && w.x + w.y < 0.999;
            inside.then(|| uvs[0] + w.x * (uvs[1] - uvs[0]) + w.y * (uvs[2] - uvs[0]))
        };
        let list = |v: [f64; 2]| format!("[{:?}, {:?}]", v[0], v[1]);
        let shape = format!(
            "[[triangle]]\nvertices = [[-9.0, 0.0, 7.0], [11.0, 0.0, 8.0], [1.0, 0.0, -17.0]]\nuvs = [{}, {}, {}]\nmaterial = \"m\"\n",
            list(uvs[0].to_array()),
            list(uvs[1].to_array()),
            list(uvs[2].to_array())
        );
        swept(bench, tiles, &view, "kind = \"surface\"", &shape, &answer)
    };
    decades(0, 9).map(run).collect()
}

/// Sweeps axes that are neither of unit length nor orthogonal.
fn collinear(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |k: i32| {
        let angle = 10f64.powi(-k);
        let view = above(DVec3::ZERO);
        let bitangent = DVec3::new(2.0 * angle.cos(), 0.0, 2.0 * angle.sin());
        let answer = |middle: DVec2| {
            let [constant, varies] =
                on_plane(view.eye, view.direction(middle), [DVec3::ZERO, DVec3::X, bitangent])?;
            Some(constant + varies)
        };
        let shape = format!(
            "[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [{:?}, 0.0, {:?}]\nmaterial = \"m\"\n",
            bitangent.x, bitangent.z
        );
        swept(bench, angle, &view, "kind = \"surface\"", &shape, &answer)
    };
    (0..=8).map(run).collect()
}
