//! Filter `anisotropic`: look-ups along the major axis of the footprint, as wide as the minor one (McCormack et al.
//! 1999, as texture units do). Twin of `glsl/shared/filter/anisotropic.glsl`.

use glam::DVec3;

use super::cube::refaced;
use crate::oracle::footprint_axes::{FootprintEllipse, kind_of};
use crate::oracle::mapping::Coordinate;
use crate::pack::TextureKind;
use crate::schema::layout::{Sampler, Texture};

pub fn anisotropic_probes(how: &Sampler, spread: &FootprintEllipse) -> f64 {
    let most = f64::from(how.max_anisotropy);
    let ratio = spread.major / spread.minor.max(1e-30);
    (ratio.min(most * most).sqrt() - 1e-3).ceil().max(1.0)
}

/// Returns the position of a probe, and its face; probes are ordered from both ends inwards.
pub fn anisotropic_place(
    image: &Texture,
    c: &Coordinate,
    spread: &FootprintEllipse,
    [probe, probes]: [u32; 2],
    face: u32,
) -> (DVec3, u32) {
    let order = if probe & 1 != 0 { probes - 1 - probe / 2 } else { probe / 2 };
    let way = (f64::from(order) + 0.5) / f64::from(probes) - 0.5;
    let at = c.at + way * (spread.along.x * c.change[0] + spread.along.y * c.change[1]);
    if kind_of(image) == TextureKind::Cube { refaced(at, face) } else { (at, face) }
}
