//! A part of a texture around what a pixel reads of it, as a picture in which the pixel's footprint can be drawn. Input:
//! a look-up. Output: texels of one level as PNG, and the footprint in their coordinates.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DVec2, DVec3, DVec4};
use serde_json::{Value, json};

use crate::core::error::Result;
use crate::core::film::Film;
use crate::oracle::procedural::procedural_color;
use crate::oracle::quantities::LookUp;
use crate::oracle::texture::{Level, addresses, fetch_or_border, fetch_texel, flat_texel, level_at};
use crate::output::{self, Format};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::Procedural;
use crate::texture::sampler_spec::TexelCenter;

/// Texels along a side, at least and at most.
const SIDES: [f64; 2] = [8.0, 64.0];
/// The window's side over that of the footprint's box.
const MARGIN: f64 = 2.0;
/// Pixels along a side of a window of a procedural texture, and its least side in units of the texture.
const PIXELS: u32 = 96;
const LEAST_UNITS: f64 = 3.0;
/// Coordinates beyond this are too coarse for a window.
const FARTHEST: f64 = 1e12;

/// A footprint: its centre and the two changes over the pixel.
struct Footprint {
    centre: DVec2,
    axes: [DVec2; 2],
}

impl Footprint {
    /// Returns the longer side of the box around it.
    fn reach(&self) -> f64 {
        let [a, b] = self.axes.map(DVec2::abs);
        (a + b).max_element()
    }

    fn is_drawable(&self) -> bool {
        self.centre.abs().max_element() < FARTHEST && self.axes.iter().all(|axis| axis.is_finite())
    }

    /// Returns a description in a picture whose corner is `corner` and whose pixels are `unit` wide.
    fn described(&self, corner: DVec2, unit: f64, side: u32, level: Option<u32>, png: &str) -> Value {
        json!({
            "png": png,
            "side": side,
            "level": level,
            "centre": ((self.centre - corner) / unit).to_array(),
            "axes": self.axes.map(|axis| (axis / unit).to_array()),
        })
    }
}

/// Returns the window of a look-up of texels; none where its coordinates are too large.
pub fn of_texels(scene: &PackedScene, look_up: &LookUp<'_>) -> Result<Option<Value>> {
    let LookUp { image, how, coordinate, face, .. } = *look_up;
    let footprint = |level: &Level| {
        let size = DVec2::new(level.size[0] as f64, level.size[1] as f64);
        let offset = if how.texel_center == TexelCenter::Integer { 0.5 } else { 0.0 };
        Footprint {
            centre: coordinate.at.truncate() * size + offset,
            axes: coordinate.change.map(|change| change.truncate() * size),
        }
    };
    let mut index = (look_up.level().round() as u32).min(image.levels - 1);
    while MARGIN * footprint(&level_at(scene, image, index)).reach() > SIDES[1] && index + 1 < image.levels {
        index += 1;
    }
    let level = level_at(scene, image, index);
    let seen = footprint(&level);
    if !seen.is_drawable() {
        return Ok(None);
    }
    let side = (MARGIN * seen.reach() + 4.0).clamp(SIDES[0], SIDES[1]).ceil() as u32;
    let corner = (seen.centre - 0.5 * f64::from(side)).round();
    let depth = level.size[2];
    let slice = (coordinate.at.z * depth as f64).floor().clamp(-FARTHEST, FARTHEST) as i64;
    let texel = |x: i64, y: i64| -> DVec4 {
        let inside = |at: i64, size: i64| at.clamp(0, size - 1);
        match image.kind {
            TextureKind::Cube => {
                let at = [inside(x, level.size[0]), inside(y, level.size[1]), i64::from(face)];
                fetch_texel(scene, image, &level, at)
            }
            TextureKind::Volume => {
                fetch_or_border(scene, image, how, &level, [x, y, slice], addresses(how).len())
            }
            TextureKind::Flat | TextureKind::Procedural => flat_texel(scene, image, how, &level, [x, y]),
        }
    };
    let (left, top) = (corner.x as i64, corner.y as i64);
    let png = png(side, |x, y| texel(left + i64::from(x), top + i64::from(y)).truncate())?;
    Ok(Some(seen.described(corner, 1.0, side, Some(index), &png)))
}

/// Returns the window of a procedural texture: its plane of constant w.
pub fn of_procedural(procedural: &Procedural, at: DVec3, change: [DVec3; 2]) -> Result<Option<Value>> {
    let seen = Footprint { centre: at.truncate(), axes: change.map(DVec3::truncate) };
    if !seen.is_drawable() {
        return Ok(None);
    }
    let side = (MARGIN * seen.reach()).max(LEAST_UNITS);
    let unit = side / f64::from(PIXELS);
    let corner = seen.centre - 0.5 * side;
    let png = png(PIXELS, |x, y| {
        let place = corner + unit * (DVec2::new(x.into(), y.into()) + 0.5);
        procedural_color(procedural, place.extend(at.z), DVec3::X * unit, DVec3::Y * unit)
    })?;
    Ok(Some(seen.described(corner, unit, PIXELS, None, &png)))
}

/// Returns a square picture as PNG in base64.
fn png(side: u32, color: impl Fn(u32, u32) -> DVec3) -> Result<String> {
    let mut film = Film::new(side, side, 1);
    let places = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
    for (pixel, (x, y)) in film.pixels.iter_mut().zip(places) {
        *pixel = color(x, y).as_vec3().to_array();
    }
    Ok(STANDARD.encode(output::to_bytes(&film, Format::Png)?))
}
