//! One scene, translated by up to 1e7 units and scaled by 1e-6 to 1e6, with everything that a
//! picture can contain: textures, a mirror, shadows, spheres, triangles. A position of 1e7 has a
//! resolution of 2^-30 in f64, a millionth of a pixel here, so that the picture is unchanged.

use glam::DVec3;

use super::case::{Bench, Case, Point};
use super::scenes::{hashed_unit, on_device, packed, texture};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::texture::data::{Dimension, TextureData};

const SIDE: u32 = 96;
/// The fraction of pixels that may differ: 18 of them.
const BOUND: f64 = 2e-3;
const REASON: &str = "what the device sees is relative to the eye and of f64 origin: 1e7 units cost 2^-30 of one, 1e-6 of a \
                      pixel, and a scale costs nothing. 16 samples on an outline or the line of a shadow may fall to \
                      the other side";

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, run| Case {
        group: "transforms",
        name,
        parameter,
        unit: "of all pixels",
        bound: BOUND,
        reason: REASON,
        run,
    };
    vec![
        case("moved", "units by which the scene is moved", moved),
        case("scaled", "factor by which the scene is scaled", scaled),
        case("near-zero", "factor, with the eye in a corner of the scene", scaled_from_within),
    ]
}

struct Placed {
    scale: f64,
    shift: DVec3,
    eye: DVec3,
}

impl Placed {
    fn at(&self, x: f64, y: f64, z: f64) -> String {
        let p = self.scale * DVec3::new(x, y, z) + self.shift;
        format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z)
    }

    fn text(&self) -> String {
        let s = self.scale;
        let tiles = 0.7 / s;
        let power = 30.0 * s * s;
        let eye = self.at(self.eye.x, self.eye.y, self.eye.z);
        format!(
            "[camera]\neye = {eye}\nlook_at = {}\nvertical_fov = 50.0\nup = [0.0, 1.0, 0.0]\n\
             [image]\nwidth = {SIDE}\nheight = {SIDE}\n[sampling]\nspp = 16\n[background]\ncolor = [0.3, 0.5, 0.8]\n\
             [[texture]]\nname = \"t\"\nfile = \"t.exr\"\n[[sampler]]\nname = \"s\"\n\
             [[material]]\nname = \"floor\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = {{ kind = \"surface\", scale = [{tiles:?}, {tiles:?}] }}\n\
             [[material]]\nname = \"wall\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = {{ kind = \"surface\", scale = [3.0, 5.0] }}\n\
             [[material]]\nname = \"mirror\"\nmodel = \"mirror\"\ncolor = [0.9, 0.8, 0.7]\n\
             [[plane]]\norigin = {}\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 0.0, 1.0]\nmaterial = \"floor\"\n\
             [[sphere]]\ncenter = {}\nradius = {:?}\nmaterial = \"mirror\"\n\
             [[sphere]]\ncenter = {}\nradius = {:?}\nmaterial = \"wall\"\n\
             [[triangle]]\nvertices = [{}, {}, {}]\nmaterial = \"wall\"\n\
             [[light]]\nkind = \"point\"\nposition = {}\nintensity = [{power:?}, {power:?}, {power:?}]\n",
            self.at(0.1, 0.4, -0.2),
            self.at(0.0, 0.0, 0.0),
            self.at(-0.7, 0.6, 0.1),
            0.6 * s,
            self.at(0.6, 0.35, 0.5),
            0.35 * s,
            self.at(-1.5, 0.0, -1.5),
            self.at(2.0, 0.0, -1.2),
            self.at(0.2, 1.9, -1.4),
            self.at(1.3, 2.2, 1.6),
        )
    }
}

/// Returns noise so smooth that no texel edge matters.
fn noise() -> TextureData {
    texture(Dimension::Two, [16, 16, 1], |i| (0.2 + 0.7 * hashed_unit(i, 3)) as f32)
}

fn picture(bench: &Bench<'_>, placed: &Placed) -> Result<Film> {
    on_device(bench, &packed(&placed.text(), vec![noise()], None)?)
}

fn differ(parameter: f64, one: &Film, other: &Film) -> Point {
    let mut worst = (0.0, String::new());
    let mut count = 0.0;
    for (i, (a, b)) in one.pixels.iter().zip(&other.pixels).enumerate() {
        let change = |(a, b): (&f32, &f32)| f64::from((a - b).abs());
        let error = a
            .iter()
            .zip(b)
            .map(change)
            .fold(0.0, |most: f64, e| if e.is_nan() { f64::INFINITY } else { most.max(e) });
        if error > 1.0 / 255.0 {
            count += 1.0;
        }
        if error > worst.0 {
            worst = (error, format!("by {error:.1e} at pixel ({}, {})", i as u32 % SIDE, i as u32 / SIDE));
        }
    }
    Point::worst(parameter, [(count / one.pixels.len() as f64, worst.1)])
}

const OUTSIDE: DVec3 = DVec3::new(1.7, 1.4, 3.1);
const WITHIN: DVec3 = DVec3::new(0.02, 0.05, 1.1);

fn moved(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let place =
        |distance: f64| Placed { scale: 1.0, shift: distance * DVec3::new(1.0, -0.7, 0.4), eye: OUTSIDE };
    let here = picture(bench, &place(0.0))?;
    (0..=7).map(|k| 10f64.powi(k)).map(|d| Ok(differ(d, &here, &picture(bench, &place(d))?))).collect()
}

fn scaled(bench: &Bench<'_>) -> Result<Vec<Point>> {
    by_scale(bench, OUTSIDE)
}

fn scaled_from_within(bench: &Bench<'_>) -> Result<Vec<Point>> {
    by_scale(bench, WITHIN)
}

fn by_scale(bench: &Bench<'_>, eye: DVec3) -> Result<Vec<Point>> {
    let place = |scale: f64| Placed { scale, shift: DVec3::ZERO, eye };
    let here = picture(bench, &place(1.0))?;
    let others = (-6..=6).filter(|k| *k != 0).map(|k| 10f64.powi(k));
    others.map(|s| Ok(differ(s, &here, &picture(bench, &place(s))?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_that_moves_by_more_than_a_step_of_8_bits_is_counted() {
        let mut film = Film::new(SIDE, SIDE, 1);
        let black = film.clone();
        assert_eq!(differ(1.0, &black, &film).error, 0.0);
        film.pixels[SIDE as usize + 2] = [0.0, 0.1, 0.0];
        film.pixels[3] = [0.003; 3];
        let found = differ(1.0, &black, &film);
        assert_eq!(found.error, 1.0 / f64::from(SIDE * SIDE));
        assert!(found.place.contains("(2, 1)"), "{}", found.place);
        film.pixels[5] = [f32::NAN; 3];
        assert_eq!(differ(1.0, &black, &film).error, 2.0 / f64::from(SIDE * SIDE));
    }
}
