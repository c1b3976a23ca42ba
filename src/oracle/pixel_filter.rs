//! Importance sampling of the pixel filter: maps a sample in the unit square to its position around the
//! pixel, and to the filter's sign there. Twin of `glsl/shared/pixel_filter.glsl`.

use glam::DVec2;

use super::strata::UNIT;
use crate::pack::PackedScene;
use crate::scene::model::PixelFilterKind;
use crate::schema::layout::{Header, PIXEL_FILTER_CELLS};

#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// From the pixel's corner, in pixels.
    pub inside: DVec2,
    pub sign: f64,
}

const MIDDLE: u32 = 1 << 23;
const WHOLE: u32 = 1 << 24;

/// Returns the distance from the centre beyond which `rest` of 2²⁴ samples lie, in radii.
pub fn distance_in_radii(scene: &PackedScene, rest: u32) -> f64 {
    let v = (f64::from(rest) * UNIT).sqrt();
    if scene.header.pixel_filter == PixelFilterKind::Tent {
        return 1.0 - v;
    }
    let at = v * f64::from(PIXEL_FILTER_CELLS);
    let cell = (at as usize).min(PIXEL_FILTER_CELLS as usize - 1);
    let [near, far] = [0, 1].map(|i| f64::from(scene.pixel_filter[cell + i]));
    near + (at - cell as f64) * (far - near)
}

/// Returns the distance of the centre of a position's step from the centre of all, of 2²⁴.
pub fn from_middle(position: u32) -> u32 {
    (2 * position + 1).abs_diff(WHOLE)
}

pub fn filtered_position(scene: &PackedScene, position: u32) -> f64 {
    let radius = f64::from(scene.header.filter_radius);
    if scene.header.pixel_filter == PixelFilterKind::Box {
        return 0.5 + (f64::from(position) * UNIT - 0.5) * 2.0 * radius;
    }
    let offset = distance_in_radii(scene, WHOLE - from_middle(position)) * radius;
    if position < MIDDLE { 0.5 - offset } else { 0.5 + offset }
}

pub fn filter_sign(header: &Header, position: [u32; 2]) -> f64 {
    let [x, y] = position.map(|p| from_middle(p) >= header.first_negative_step);
    if x == y { 1.0 } else { -1.0 }
}

pub fn filtered_place(scene: &PackedScene, position: [u32; 2]) -> Place {
    let inside = DVec2::from_array(position.map(|p| filtered_position(scene, p)));
    Place { inside, sign: filter_sign(&scene.header, position) }
}

/// Returns the width in pixels of the box that has the filter's variance.
pub fn filter_width(header: &Header) -> f64 {
    f64::from(header.filter_width)
}
