//! The axes of a footprint in texels, from the changes of texture coordinates. Twin of
//! `glsl/shared/footprint_axes.glsl`.

use glam::{DVec2, DVec3};

use super::mapping::{Coordinate, along_cube_face, face_uv_change, on_cube_face, within_face};
use crate::pack::TextureKind;
use crate::schema::layout::Texture;

/// The footprint in texels of level 0.
#[derive(Clone, Copy, Debug)]
pub struct FootprintEllipse {
    /// Squares of its axes: the singular values of its Jacobian.
    pub major: f64,
    pub minor: f64,
    /// The unit vector of coefficients with which the two changes combine to the major axis.
    pub along: DVec2,
}

/// The largest change, in tiles, which also replaces NaN and infinity.
pub const WIDEST_CHANGE: f64 = 1e9;

pub fn bounded_change(d: DVec3) -> DVec3 {
    DVec3::from_array(d.to_array().map(|x| if x.abs() <= WIDEST_CHANGE { x } else { WIDEST_CHANGE }))
}

pub fn kind_of(image: &Texture) -> TextureKind {
    image.kind
}

/// Converts a direction to a position on its face of the cube; 2D and 3D coordinates are unchanged. Changes
/// become finite.
pub fn in_texture(image: &Texture, c: &Coordinate) -> (Coordinate, u32) {
    if kind_of(image) != TextureKind::Cube {
        return (Coordinate { at: c.at, change: c.change.map(bounded_change) }, 0);
    }
    let (stm, face) = on_cube_face(c.at);
    let on_face = |d| face_uv_change(stm, along_cube_face(d, face)).extend(0.0);
    let change = c.change.map(|d| bounded_change(on_face(d)));
    (Coordinate { at: within_face(stm).extend(0.0), change }, face)
}

pub fn texel_spread(image: &Texture, c: &Coordinate) -> FootprintEllipse {
    let depth = if kind_of(image) == TextureKind::Volume { image.size.z } else { 0 };
    let size = DVec3::new(image.size.x.into(), image.size.y.into(), depth.into());
    let [x, y] = c.change.map(|d| d * size);
    let (xx, yy, xy) = (x.dot(x), y.dot(y), x.dot(y));
    let half_difference = 0.5 * (xx - yy);
    let radius = half_difference.hypot(xy);
    let major = 0.5 * (xx + yy) + radius;
    let minor = (xx * (yy / major) - xy * (xy / major)).max(0.0);
    let along = if half_difference >= 0.0 {
        DVec2::new(half_difference + radius, xy)
    } else {
        DVec2::new(xy, radius - half_difference)
    };
    FootprintEllipse {
        major,
        minor: if minor >= 0.0 { minor } else { 0.0 },
        along: along.try_normalize().unwrap_or(DVec2::X),
    }
}
