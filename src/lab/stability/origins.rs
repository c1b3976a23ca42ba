//! Rays that leave a surface: counts self-intersections (acne) and missed surfaces (leaks) over all
//! pixels whose result is known without a reference picture. Scales range from 1e-6 to 1e6, with
//! eyes far from the scene.

use glam::DVec3;

use super::case::{Bench, Case, Point};
use super::coordinates::CENTER;
use super::scenes::{on_device, packed};
use super::view::View;
use crate::core::error::Result;

const SIDE: u32 = 128;

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, reason, run| Case {
        group: "origins",
        name,
        parameter,
        unit: "wrong pixels",
        bound: 0.0,
        reason,
        run,
    };
    vec![
        case("lit-ball", "radius, seen from 3 radii away", LIT, lit_by_scale),
        case("lit-ball-far", "distance over radius", LIT, lit_by_distance),
        case("mirror-ball", "radius, seen from 3 radii away", MIRROR, mirror_by_scale),
        case("mirror-ball-far", "distance over radius", MIRROR, mirror_by_distance),
        case("closed-box", "side of a box with a light outside", CLOSED, closed_box),
        case("glass-ball", "radius, seen from 3 radii away", GLASS, glass),
    ]
}

const LIT: &str = "a ball alone casts no shadow on the side that faces the light";
const MIRROR: &str = "what a ball alone mirrors is the background";
const CLOSED: &str = "into a box of six walls no light comes";
const GLASS: &str = "rays through glass of index 1 go straight on";

fn ball(view: &View, material: &str, radius: f64) -> String {
    let background = CENTER.replace("[0.0, 0.0, 0.0]", "[0.25, 0.5, 0.75]");
    format!(
        "{}{background}[[material]]\nname = \"m\"\n{material}\n[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = {radius:?}\nmaterial = \"m\"\n",
        view.text()
    )
}

/// Returns a view in which the ball fills the picture.
fn facing(distance: f64, radius: f64) -> View {
    let eye = distance * DVec3::new(0.48, -0.6, 0.64);
    let fov = 2.0 * (1.1 * (radius / distance).asin().tan()).atan();
    View::new(eye, DVec3::ZERO, DVec3::new(0.1, 1.0, 0.2), fov.to_degrees(), SIDE)
}

/// Counts the pixels for which `wrong` is true, given their centre and colour.
fn counted(
    bench: &Bench<'_>,
    parameter: f64,
    view: &View,
    text: &str,
    wrong: impl Fn(DVec3, [f32; 3]) -> bool,
) -> Result<Point> {
    let film = on_device(bench, &packed(text, vec![], None)?)?;
    let mut places = view.pixels().filter(|(i, _, middle)| wrong(view.direction(*middle), film.pixels[*i]));
    let first = places.next().map(|(_, [x, y], _)| format!("first at pixel ({x}, {y})"));
    let count = places.count() + usize::from(first.is_some());
    Ok(Point::worst(parameter, [(count as f64, first.unwrap_or_default())]))
}

/// Returns the normal of the ball around the origin at the ray's hit, and its distance from the
/// silhouette relative to the radius.
fn normal_of(view: &View, direction: DVec3, radius: f64) -> Option<(DVec3, f64)> {
    let distance = view.eye.length();
    let ahead = -view.eye / distance;
    let unit = direction.normalize();
    let aside = unit - unit.dot(ahead) * ahead;
    let sine = aside.length();
    let nearest = distance / radius * sine;
    (nearest < 1.0).then(|| {
        let angle = nearest.asin() - sine.asin();
        let normal = -angle.cos() * ahead + angle.sin() * aside / sine.max(1e-300);
        (normal, 1.0 - nearest)
    })
}

fn lit(bench: &Bench<'_>, parameter: f64, distance: f64, radius: f64) -> Result<Point> {
    let view = facing(distance, radius);
    let light = DVec3::new(-0.36, 0.48, 0.8);
    let text = ball(&view, "model = \"lambert\"", radius)
        + "[[light]]\nkind = \"directional\"\ndirection = [-0.36, 0.48, 0.8]\nirradiance = [3.0, 3.0, 3.0]\n";
    counted(bench, parameter, &view, &text, |direction, found| {
        // Closer to the silhouette or to the shadow's edge either result is correct.
        let sure = normal_of(&view, direction, radius).filter(|(_, inside)| *inside > 1e-2);
        sure.is_some_and(|(normal, _)| {
            normal.dot(light) > 1e-2 && found.iter().any(|x| x.is_nan() || *x <= 0.0)
        })
    })
}

fn mirror(bench: &Bench<'_>, parameter: f64, distance: f64, radius: f64) -> Result<Point> {
    let view = facing(distance, radius);
    let text = ball(&view, "model = \"mirror\"\ncolor = [1.0, 1.0, 1.0]", radius);
    counted(bench, parameter, &view, &text, |_, found| found != [0.25, 0.5, 0.75])
}

fn scales() -> impl Iterator<Item = f64> {
    (-6..=6).map(|k| 10f64.powi(k))
}

fn distances() -> impl Iterator<Item = f64> {
    (0..=8).map(|k| 3.0 * 10f64.powi(k))
}

fn lit_by_scale(bench: &Bench<'_>) -> Result<Vec<Point>> {
    scales().map(|s| lit(bench, s, 3.0 * s, s)).collect()
}

fn lit_by_distance(bench: &Bench<'_>) -> Result<Vec<Point>> {
    distances().map(|d| lit(bench, d, d, 1.0)).collect()
}

fn mirror_by_scale(bench: &Bench<'_>) -> Result<Vec<Point>> {
    scales().map(|s| mirror(bench, s, 3.0 * s, s)).collect()
}

fn mirror_by_distance(bench: &Bench<'_>) -> Result<Vec<Point>> {
    distances().map(|d| mirror(bench, d, d, 1.0)).collect()
}

fn glass(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |s: f64| {
        let view = facing(3.0 * s, s);
        let text = ball(&view, "model = \"dielectric\"\nior = 1.0", s);
        counted(bench, s, &view, &text, |_, found| found != [0.25, 0.5, 0.75])
    };
    scales().map(run).collect()
}

/// Sweeps twelve triangles around the eye, with lights on all sides of them.
fn closed_box(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |s: f64| {
        let eye = s * DVec3::new(0.31, -0.17, 0.23);
        let view = View::new(eye, s * DVec3::new(1.0, 0.9, 1.1), DVec3::Y, 120.0, SIDE);
        let corner = |bits: u32| {
            let side = |bit: u32| if bits >> bit & 1 == 0 { -s } else { s };
            format!("[{:?}, {:?}, {:?}]", side(0), side(1), side(2))
        };
        let mut text = view.text() + CENTER + "[[material]]\nname = \"m\"\n";
        for [a, b, c, d] in
            [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
        {
            for [p, q, r] in [[a, b, c], [a, c, d]] {
                text += &format!(
                    "[[triangle]]\nvertices = [{}, {}, {}]\nmaterial = \"m\"\n",
                    corner(p),
                    corner(q),
                    corner(r)
                );
            }
        }
        for axis in [[1.5, 1.2, 1.4], [-1.3, -1.6, -1.1], [0.0, 3.0, 0.1], [2.5, 0.2, -0.3]] {
            let [x, y, z] = axis.map(|x: f64| x * s);
            let power = 10.0 * s * s;
            text += &format!(
                "[[light]]\nkind = \"point\"\nposition = [{x:?}, {y:?}, {z:?}]\nintensity = [{power:?}, {power:?}, {power:?}]\n"
            );
        }
        counted(bench, s, &view, &text, |_, found| found != [0.0; 3])
    };
    scales().map(run).collect()
}
