//! (texture, sampler, coordinate, footprint) → linear RGBA in f64, from the packed bytes. Twin of
//! `glsl/shared/filter/sample_texture.glsl`.

use glam::DVec4;

use super::anisotropic::{anisotropic_place, anisotropic_probes};
use super::ewa::{ellipse, ellipse_level, widened_minor};
use super::levels::Reader;
use super::stochastic::{look_up_dice, stochastic_level};
use super::summed_area::summed_area;
use crate::oracle::footprint::is_filtered;
use crate::oracle::footprint_axes::{FootprintEllipse, in_texture, kind_of, texel_spread};
use crate::oracle::mapping::Coordinate;
use crate::oracle::procedural::procedural_color;
use crate::oracle::texture::{add_weighted, level_at};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Filter, MipMode};

/// Returns the level that the footprint needs, whichever there are. A look-up is at least as wide as the minor axis, even
/// if there are more along the major axis than needed.
pub fn needed_level(spread: &FootprintEllipse, probes: f64) -> f64 {
    let least = if probes > 1.0 { spread.minor } else { 0.0 };
    0.5 * (spread.major / (probes * probes)).max(least).log2()
}

/// Returns the level that the sampler reads for a footprint; between two levels if it blends them.
pub fn read_level(image: &Texture, how: &Sampler, spread: &FootprintEllipse) -> f64 {
    let magnified = spread.major <= 1.0;
    let mode = if magnified { how.mag_filter } else { how.min_filter };
    let last = image.levels - 1;
    if mode == Filter::Ewa {
        return ellipse_level(widened_minor(how, spread), last).into();
    }
    let probes = if mode == Filter::Anisotropic { anisotropic_probes(how, spread) } else { 1.0 };
    let level = if magnified || mode == Filter::SummedArea {
        0.0
    } else {
        needed_level(spread, probes).clamp(0.0, last.into())
    };
    match how.mip_mode {
        MipMode::None => 0.0,
        MipMode::Nearest => (level + 0.5).ceil() - 1.0,
        MipMode::Linear => level,
    }
}

/// Samples a texture. Without a footprint in the scene every look-up magnifies.
pub fn sample_texture(
    scene: &PackedScene,
    image: &Texture,
    how: &Sampler,
    place: &Coordinate,
    random: [u32; 2],
) -> DVec4 {
    if kind_of(image) == TextureKind::Procedural {
        let [x, y] = place.change;
        return procedural_color(&scene.records.procedurals[image.procedural as usize], place.at, x, y)
            .extend(1.0);
    }
    let reader = Reader { scene, image, how };
    let mut dice = look_up_dice(random);
    let (c, face) = in_texture(image, place);
    let mag = how.mag_filter;
    if !is_filtered(&scene.header) {
        return reader.level(mag, &level_at(scene, image, 0), c.at, face, dice);
    }
    let spread = texel_spread(image, &c);
    let magnified = spread.major <= 1.0;
    let mode = if magnified { mag } else { how.min_filter };
    if mode == Filter::Ewa {
        return ellipse(&reader, &c, &spread);
    }
    if mode == Filter::SummedArea {
        return summed_area(scene, image, how, &c);
    }
    let last = image.levels - 1;
    let mut probes = 1.0;
    if mode == Filter::Anisotropic {
        probes = anisotropic_probes(how, &spread);
    }
    let level = if magnified { 0.0 } else { needed_level(&spread, probes).clamp(0.0, last.into()) };
    let (low, mut rest) = match how.mip_mode {
        MipMode::None => (0.0, 0.0),
        MipMode::Nearest => ((level + 0.5).ceil() - 1.0, 0.0),
        MipMode::Linear => (level.floor(), level - level.floor()),
    };
    let mut low = low as u32;
    if mode == Filter::Stochastic {
        low = stochastic_level(low, rest, &mut dice);
        rest = 0.0;
    }
    // A fraction `rest` of the `probes` reads the next level; the probe at the boundary reads both.
    let share = rest * probes;
    let mut sum = DVec4::ZERO;
    for probe in 0..probes as u32 {
        let (mut at, mut at_face) = (c.at, face);
        if mode == Filter::Anisotropic {
            (at, at_face) = anisotropic_place(image, &c, &spread, [probe, probes as u32], face);
        }
        let upper = (share - f64::from(probe)).clamp(0.0, 1.0);
        for (index, weight) in [((low + 1).min(last), upper), (low, 1.0 - upper)] {
            if weight > 0.0 {
                let value = reader.level(mode, &level_at(scene, image, index), at, at_face, dice);
                sum = add_weighted(weight / probes, value, sum);
            }
        }
    }
    sum
}
