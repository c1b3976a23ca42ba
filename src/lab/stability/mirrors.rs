//! Two facing mirrors and the radiance after k bounces, which is the product of the mirrors'
//! colours and the radiance that the unfolded, straight ray meets. For a ray that rises by the
//! height of k bounces, measures the relative error of that product, and of a ramp that encodes
//! where the ray arrives.

use super::case::{Bench, Case, Point};
use super::scenes::{on_device, packed, texture};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::texture::data::{Dimension, TextureData};

const GROUP: &str = "mirrors";
const BOUNCES: [u32; 14] = [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 63, 64];
/// The reflectance of the two mirrors in red, green and blue.
const COLOURS: [[f32; 3]; 2] = [[0.9, 0.99, 1.0], [0.5, 0.98, 1.0]];
const SEEN: [f32; 3] = [0.7, 1.0, 300.0];

pub fn cases() -> Vec<Case> {
    let case = |name, bound, reason, run| Case {
        group: GROUP,
        name,
        parameter: "bounces",
        unit: "of the radiance",
        bound,
        reason,
        run,
    };
    vec![
        case(
            "throughput",
            4e-6,
            "65 products in f32, each off by half an ulp of 6e-8; no light where a path has one bounce too few",
            throughput,
        ),
        case(
            "place",
            2e-3,
            "each of 64 bounces starts 2^-18 of the largest coordinate off the mirror, 4e-6 of the way, and the ramp \
             rises by 2 over the way",
            place,
        ),
    ]
}

/// Returns mirrors one unit apart with the eye half way between them, and a ceiling one unit above,
/// which the ray reaches after a horizontal distance of k + 1/5 units.
fn scene(bounces: u32, max_depth: u32, ceiling: &str) -> String {
    let rise = 1.0 / direction(bounces);
    let mirror = |i: usize| {
        let (name, [r, g, b], z) = (["a", "b"][i], COLOURS[i], [0.0, 1.0][i]);
        format!(
            "[[material]]\nname = \"{name}\"\nmodel = \"mirror\"\ncolor = [{r}, {g}, {b}]\n\
             [[plane]]\norigin = [0.0, 0.0, {z:.1}]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 1.0, 0.0]\n\
             material = \"{name}\"\n"
        )
    };
    format!(
        "[camera]\neye = [0.0, 0.0, 0.5]\nlook_at = [0.0, {rise:?}, -0.5]\nvertical_fov = 1.0\n\
         [image]\nwidth = 1\nheight = 1\n[sampling]\npattern = \"center\"\nspp = 1\nmax_depth = {max_depth}\n{}{}\
         [[material]]\nname = \"ceiling\"\nmodel = \"unlit\"\n{ceiling}\n\
         [[plane]]\norigin = [0.0, 1.0, 0.0]\ntangent = [0.0, 0.0, 1.0]\nbitangent = [1.0, 0.0, 0.0]\n\
         material = \"ceiling\"\n",
        mirror(0),
        mirror(1)
    )
}

fn direction(bounces: u32) -> f64 {
    f64::from(bounces) + 0.2
}

/// Returns the radiance of a source of 1 after the given number of bounces, the first at the first
/// mirror.
fn product(bounces: u32) -> [f64; 3] {
    std::array::from_fn(|c| (0..bounces as usize).map(|i| f64::from(COLOURS[i % 2][c])).product())
}

fn throughput(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let point = |&bounces: &u32| {
        let look = |depth| {
            let text = scene(bounces, depth, &format!("color = {SEEN:?}"));
            on_device(bench, &packed(&text, Vec::new(), None)?)
        };
        let full =
            relative(&look(bounces)?, std::array::from_fn(|c| product(bounces)[c] * f64::from(SEEN[c])));
        let mut errors = vec![(full, "at the ceiling".to_string())];
        if bounces > 0 {
            let dark = look(bounces - 1)?.pixels == [[0.0; 3]];
            errors.push((if dark { 0.0 } else { f64::INFINITY }, "one bounce too few".into()));
        }
        Ok(Point::worst(f64::from(bounces), errors))
    };
    BOUNCES.iter().map(point).collect()
}

/// Returns a ramp: 1 at a quarter of the distance between the mirrors, 2 at three quarters.
fn ramp() -> TextureData {
    texture(Dimension::Two, [2, 1, 1], |i| if i < 4 { 1.0 } else { 2.0 })
}

fn place(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let sampler = "[[texture]]\nname = \"t\"\nfile = \"t.exr\"\n[[sampler]]\nname = \"s\"\naddress = \"clamp-to-edge\"\n";
    let point = |&bounces: &u32| {
        let text = scene(bounces, bounces, "texture = \"t\"\nsampler = \"s\"") + sampler;
        let film = on_device(bench, &packed(&text, vec![ramp()], None)?)?;
        // 0.5 - (k + 0.2), folded into the distance between the mirrors.
        let at = if bounces % 2 == 0 { 0.3 } else { 0.7 };
        let seen = 1.0 + 2.0 * (at - 0.25);
        let error = relative(&film, product(bounces).map(|p| p * seen));
        Ok(Point::worst(f64::from(bounces), [(error, "at the ceiling".to_string())]))
    };
    BOUNCES.iter().map(point).collect()
}

fn relative(film: &Film, exact: [f64; 3]) -> f64 {
    let pairs = film.pixels.iter().flatten().zip(exact);
    let errors = pairs.map(|(found, exact)| (f64::from(*found) - exact).abs() / exact);
    errors.fold(0.0, |worst, e| if e.is_nan() { f64::INFINITY } else { worst.max(e) })
}
