//! The filters and levels with which a lookup may be read. The level of detail, within its declared
//! precision, selects magnification or minification, the levels, and the weight between two (Vulkan
//! 1.3, "Scale Factor Operation, Level-of-Detail Operation and Image Level(s) Selection").

use glam::DVec3;

use crate::oracle::footprint_axes::texel_spread;
use crate::oracle::mapping::Coordinate;
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Filter, Method, MipMode};

/// The rounding error of levels that the shader computes in f32.
const ROUNDING: f64 = 1e-5;

/// One filter at one level, or a blend of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    pub filter: Filter,
    pub levels: [u32; 2],
    /// The smallest and largest weight of the second level.
    pub share: [f64; 2],
}

impl Reading {
    pub fn at(filter: Filter, level: u32) -> Reading {
        Reading { filter, levels: [level; 2], share: [0.0; 2] }
    }

    pub fn is_mixed(&self) -> bool {
        self.share[1] > 0.0
    }
}

/// Returns the range of the level of detail at a coordinate, before it is clamped to existing
/// levels. The shader computes it from the footprint's major axis; with anisotropic filtering the
/// device computes it itself.
pub fn levels_of_detail(image: &Texture, how: &Sampler, c: &Coordinate, precision: f64) -> [f64; 2] {
    let anisotropic = how.min_filter == Filter::Anisotropic;
    if how.method == Method::Hardware && anisotropic {
        let [low, high] = anisotropic_levels(image, how, c);
        return [low - precision, high + precision];
    }
    let major = texel_spread(image, c).major;
    let level = 0.5 * major.log2();
    // Magnification is passed to the device as level 0, which has no rounding error.
    if level < -ROUNDING { [level; 2] } else { [level - ROUNDING - precision, level + ROUNDING + precision] }
}

/// Returns the range of the level of detail of an anisotropic lookup. The number of samples along
/// the major axis, up to the sampler's limit, is implementation-dependent, and so is the scale
/// factor of a footprint that is not along an axis: between the largest component of its change and
/// the sum of all.
fn anisotropic_levels(image: &Texture, how: &Sampler, c: &Coordinate) -> [f64; 2] {
    let size = DVec3::new(f64::from(image.size.x), f64::from(image.size.y), 0.0);
    let changes = c.change.map(|d| (d * size).abs());
    let [least, most] = [changes.map(DVec3::max_element), changes.map(DVec3::element_sum)];
    let minor = least[0].min(least[1]);
    let narrowest = minor.max(least[0].max(least[1]) / f64::from(how.max_anisotropy));
    [narrowest.log2(), most[0].max(most[1]).log2()]
}

/// Returns the possible readings for a level of detail in [from, to] of a texture with `levels`
/// levels.
pub fn readings(how: &Sampler, levels: u32, [from, to]: [f64; 2]) -> Vec<Reading> {
    let (mag, min) = (how.mag_filter, how.min_filter);
    let last = levels - 1;
    let mut all = Vec::new();
    if from <= 0.0 {
        all.push(Reading::at(mag, 0));
    }
    if to <= 0.0 {
        return all;
    }
    let [from, to] = [from, to].map(|level| level.clamp(0.0, f64::from(last)));
    match how.mip_mode {
        MipMode::None => all.push(Reading::at(min, 0)),
        MipMode::Nearest => {
            let nearest = (from + 0.5).ceil() as u32 - 1..=(to + 0.5).floor() as u32;
            all.extend(nearest.map(|level| Reading::at(min, level.min(last))));
        }
        MipMode::Linear => all.extend((from.floor() as u32..=to.floor() as u32).map(|level| {
            let share = [from, to].map(|end| (end - f64::from(level)).clamp(0.0, 1.0));
            Reading { filter: min, levels: [level, (level + 1).min(last)], share }
        })),
    }
    all
}
