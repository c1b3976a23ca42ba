//! A part of a texture around what a pixel reads of it, as a picture in which the pixel's whole footprint can be drawn. Input:
//! a look-up. Output: texels of one level, or means of them where the part is large, as PNG, and the footprint and the
//! samples in their coordinates.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::means::{Means, Part};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::oracle::address::addressed_texel;
use crate::oracle::procedural::procedural_color;
use crate::oracle::quantities::LookUp;
use crate::oracle::texture::{Level, fetch_texel, flat_place, level_at};
use crate::output::{self, Format};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Procedural, Sampler};
use crate::texture::sampler_spec::TexelCenter;

/// Texels along a side, at least and at most.
const SIDES: [f64; 2] = [8.0, 64.0];
/// The window's side over that of the footprint's box, and texels beside it.
const MARGIN: f64 = 1.5;
const BESIDE: f64 = 4.0;
/// Parts of textures whose means are kept.
const MAX_MEANS: usize = 8;
/// Pixels along a side of a window of a procedural texture, and its least side in units of the texture.
const PIXELS: u32 = 96;
const LEAST_UNITS: f64 = 3.0;
/// Coordinates beyond this are too coarse for a window.
const FARTHEST: f64 = 1e12;

/// A footprint: its centre, the two changes over the pixel, and where samples read.
struct Footprint {
    centre: DVec2,
    axes: [DVec2; 2],
    samples: Vec<DVec2>,
}

impl Footprint {
    /// Returns the longer side of the box around it.
    fn reach(&self) -> f64 {
        let [a, b] = self.axes.map(DVec2::abs);
        (a + b).max_element()
    }

    /// Returns the side of the window that it needs.
    fn needed(&self) -> f64 {
        MARGIN * self.reach() + BESIDE
    }

    fn is_drawable(&self) -> bool {
        self.centre.abs().max_element() < FARTHEST && self.axes.iter().all(|axis| axis.is_finite())
    }

    /// Returns a description in a picture whose corner is `corner` and whose pixels are `unit` wide.
    fn described(&self, corner: DVec2, unit: f64, side: u32, png: &str) -> Value {
        let place = |at: DVec2| (at - corner) / unit;
        let is_inside = |at: &DVec2| at.cmpge(DVec2::ZERO).all() && at.max_element() <= f64::from(side);
        let samples: Vec<[f64; 2]> =
            self.samples.iter().map(|at| place(*at)).filter(is_inside).map(|at| at.to_array()).collect();
        json!({
            "png": png,
            "side": side,
            "level": null,
            "centre": place(self.centre).to_array(),
            "axes": self.axes.map(|axis| (axis / unit).to_array()),
            "samples": samples,
        })
    }
}

/// Returns the window of a look-up of texels, which holds the whole footprint; none where its coordinates are too large.
/// `samples`: places in the texture at which the pixel's samples read it. Means are made where they are needed, and kept.
pub fn of_texels(
    scene: &PackedScene,
    look_up: &LookUp<'_>,
    samples: &[DVec2],
    kept: &mut Vec<(Part, Means)>,
) -> Result<Option<Value>> {
    let LookUp { texture, image, how, coordinate, face, .. } = *look_up;
    let offset = DVec2::splat(if how.texel_center == TexelCenter::Integer { 0.5 } else { 0.0 });
    let in_level = |[width, height]: [i64; 2], offset: DVec2| {
        let size = DVec2::new(width as f64, height as f64);
        let centre = coordinate.at.truncate() * size + offset;
        let axes = coordinate.change.map(|change| change.truncate() * size);
        Footprint { centre, axes, samples: samples.iter().map(|at| *at * size + offset).collect() }
    };
    let fits = |seen: &Footprint| seen.needed() <= SIDES[1];
    let read = (look_up.level().round() as u32).min(image.levels - 1);
    let flat = |level: &Level| [level.size[0], level.size[1]];
    let level_of = |index: u32| level_at(scene, image, index);
    // Levels that the texture has are at hand.
    let index = (read..image.levels).find(|index| fits(&in_level(flat(&level_of(*index)), offset)));
    let index = index.unwrap_or(image.levels - 1);
    let level = level_of(index);
    let size = flat(&level);
    let in_means = |shown: [i64; 2]| {
        let part = [0, 1].map(|axis| shown[axis] as f64 / size[axis] as f64);
        in_level(shown, offset * DVec2::from(part))
    };
    let seen = in_means(size);
    if !seen.is_drawable() {
        return Ok(None);
    }
    let slice = match image.kind {
        TextureKind::Cube => Some(i64::from(face)),
        TextureKind::Volume => {
            let depth = level.size[2];
            let at = (coordinate.at.z * depth as f64).floor().clamp(-FARTHEST, FARTHEST) as i64;
            addressed_texel(how.address_w, at, depth)
        }
        TextureKind::Flat | TextureKind::Procedural => Some(0),
    };
    let texel = |slice: i64, [x, y]: [i64; 2]| fetch_texel(scene, image, &level, [x, y, slice]).truncate();
    let grid = match slice {
        Some(slice) if !fits(&seen) => {
            let part = Part { texture, level: index, slice };
            let means = means(kept, part, || Means::new(size, &|at| texel(slice, at)));
            means.grids.iter().find(|grid| fits(&in_means(grid.size))).or(means.grids.last())
        }
        _ => None,
    };
    let shown = grid.map_or(size, |grid| grid.size);
    let seen = in_means(shown);
    // Beyond many tiles, each pixel is one mean of the whole texture.
    let unit = (seen.needed() / SIDES[1]).max(1.0);
    let side = seen.needed().clamp(SIDES[0], SIDES[1]).ceil();
    let mut corner = seen.centre - 0.5 * side * unit;
    if unit == 1.0 {
        corner = corner.round();
    }
    let color = |x: u32, y: u32| {
        let at = (corner + unit * (DVec2::new(x.into(), y.into()) + 0.5)).floor();
        let place = placed(image.kind, how, shown, [at.x as i64, at.y as i64]);
        match (place, slice, grid) {
            (Some(place), Some(_), Some(grid)) => grid.at(place),
            (Some(place), Some(slice), None) => texel(slice, place),
            _ => how.border.as_dvec4().truncate(),
        }
    };
    let picture = png(side as u32, color)?;
    let mut told = seen.described(corner, unit, side as u32, &picture);
    told["level"] = index.into();
    told["read"] = read.into();
    let box_of = |axis: usize| size[axis] as f64 / shown[axis] as f64;
    told["mean"] = grid.map(|_| [box_of(0), box_of(1)]).into();
    Ok(Some(told))
}

/// Returns which texel is at a column and row of a picture of that size.
fn placed(kind: TextureKind, how: &Sampler, size: [i64; 2], [x, y]: [i64; 2]) -> Option<[i64; 2]> {
    match kind {
        TextureKind::Cube => Some([x.clamp(0, size[0] - 1), y.clamp(0, size[1] - 1)]),
        TextureKind::Volume => {
            Some([addressed_texel(how.address_u, x, size[0])?, addressed_texel(how.address_v, y, size[1])?])
        }
        TextureKind::Flat | TextureKind::Procedural => flat_place(how, size, [x, y]),
    }
}

/// Returns the means of a part, made at its first use.
fn means(kept: &mut Vec<(Part, Means)>, part: Part, make: impl FnOnce() -> Means) -> &Means {
    let at = match kept.iter().position(|(own, _)| *own == part) {
        Some(at) => at,
        None => {
            kept.truncate(MAX_MEANS - 1);
            kept.insert(0, (part, make()));
            0
        }
    };
    &kept[at].1
}

/// Returns the window of a procedural texture: its plane of constant w.
pub fn of_procedural(
    procedural: &Procedural,
    at: DVec3,
    change: [DVec3; 2],
    samples: Vec<DVec2>,
) -> Result<Option<Value>> {
    let seen = Footprint { centre: at.truncate(), axes: change.map(DVec3::truncate), samples };
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
    Ok(Some(seen.described(corner, unit, PIXELS, &png)))
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
