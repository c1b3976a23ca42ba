//! The sample dimensions, each by a pair of dimensions of the same pattern: 0 position in the pixel, 1 lens, 2 time
//! (its first dimension), 3 + 2d light and 4 + 2d lobe of the hit after d bounces; for glass 3 + 2d chooses between
//! reflection and refraction (its first dimension). Further lights of one hit shift the pair of the first. Twin of
//! `glsl/shared/sample_dimensions.glsl`.

use glam::DVec2;

use super::patterns::{Points, pair_points, sample_line, sample_pair};
use super::rng::{mix_bits, pcg3d};
use super::strata::UNIT;
use crate::pack::SampleDimension;
use crate::scene::model::Pattern;
use crate::schema::layout::Header;

/// Positions as integers in [0, 2^24).
#[derive(Clone, Copy, Debug, Default)]
pub struct SampleDimensions {
    pub place: [u32; 2],
    pub lens: [u32; 2],
    pub time: [u32; 2],
    pub light: [u32; 2],
    pub lobe: [u32; 2],
    pub fresnel: u32,
}

impl SampleDimensions {
    /// The sample of a path without a pattern: the middle in every dimension.
    pub const MIDDLE: SampleDimensions = SampleDimensions {
        place: [1 << 23; 2],
        lens: [1 << 23; 2],
        time: [1 << 23; 2],
        light: [1 << 23; 2],
        lobe: [1 << 23; 2],
        fresnel: 1 << 23,
    };
}

pub fn unit_line(position: u32) -> f64 {
    f64::from(position) * UNIT
}

pub fn unit_square(position: [u32; 2]) -> DVec2 {
    DVec2::from_array(position.map(unit_line))
}

/// Returns the positions shifted by an amount that depends on `salt`; 0 leaves them unchanged.
pub fn apart(points: &Points, position: [u32; 2], salt: u32) -> [u32; 2] {
    if salt == 0 || matches!(points.pattern, Pattern::Center | Pattern::Grid) {
        return position;
    }
    let [x, y, _] = pcg3d([points.key[0], points.key[1], !salt]).map(mix_bits);
    let net = matches!(points.pattern, Pattern::SobolOwen | Pattern::BlueNoise);
    let shifted = |position: u32, by: u32| if net { position ^ by } else { (position + by) & 0xFF_FFFF };
    [shifted(position[0], x >> 8), shifted(position[1], y >> 8)]
}

/// Returns all dimensions of sample s for the hit after `depth` bounces; at the start of its path also the position in
/// the pixel and the camera's dimensions.
pub fn choose(header: &Header, points: &Points, s: u32, depth: u32, starts: bool) -> SampleDimensions {
    let mut dimensions = SampleDimensions::default();
    if starts {
        dimensions.place = sample_pair(points, s);
    }
    for &choice in SampleDimension::ALL {
        let of_hit = choice as u32 >= SampleDimension::Light as u32;
        if header.sample_dimensions >> choice as u32 & 1 == 0 || !(of_hit || starts) {
            continue;
        }
        let first = if choice == SampleDimension::Fresnel { SampleDimension::Light } else { choice };
        let pair = 1 + first as u32 + if of_hit { 2 * depth } else { 0 };
        let drawn = pair_points(points, pair);
        let position = if choice == SampleDimension::Fresnel {
            [sample_line(&drawn, s), 0]
        } else {
            sample_pair(&drawn, s)
        };
        match choice {
            SampleDimension::Lens => dimensions.lens = position,
            SampleDimension::Time => dimensions.time = position,
            SampleDimension::Light => dimensions.light = position,
            SampleDimension::Lobe => dimensions.lobe = position,
            SampleDimension::Fresnel => dimensions.fresnel = position[0],
        }
    }
    dimensions
}

/// Returns the hit's sample on the light `i`.
pub fn chosen_light(points: Option<&Points>, dimensions: &SampleDimensions, i: u32) -> DVec2 {
    unit_square(points.map_or(dimensions.light, |points| apart(points, dimensions.light, 16 * i)))
}
