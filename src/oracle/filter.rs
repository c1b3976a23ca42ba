//! (texture, sampler, coordinate, footprint) → linear RGBA in f64, from the packed bytes. Twin of
//! `glsl/shared/filter.glsl`.

use glam::{DVec3, DVec4};

use super::ellipse::ellipse;
use super::footprint::is_filtered;
use super::footprint_axes::{in_texture, kind_of, texel_spread};
use super::levels::{Reader, refaced};
use super::mapping::Coordinate;
use super::procedural::procedural_color;
use super::rng::pcg3d;
use super::summed_area::summed_area;
use super::texture::{add_weighted, level_at};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Filter, MipMode};

/// Three numbers in [0, 1) from a sample's random bits.
pub fn look_up_dice(random: [u32; 2]) -> DVec3 {
    let bits = pcg3d([random[0], random[1], 0x7E41]);
    DVec3::from_array(bits.map(|b| f64::from(b >> 8) / 16_777_216.0))
}

/// Without a footprint in the scene all is magnification.
pub fn sample_texture(
    scene: &PackedScene,
    image: &Texture,
    how: &Sampler,
    place: &Coordinate,
    random: [u32; 2],
) -> DVec4 {
    if kind_of(image) == TextureKind::Procedural {
        let [x, y] = place.change;
        return procedural_color(&scene.procedurals[image.place[0] as usize], place.at, x, y).extend(1.0);
    }
    let reader = Reader { scene, image, how };
    let mut dice = look_up_dice(random);
    let (c, face) = in_texture(image, place);
    let mag = Filter::ALL[how.modes[2] as usize];
    if !is_filtered(&scene.header) {
        return reader.level(mag, &level_at(scene, image, 0), c.at, face, dice);
    }
    let spread = texel_spread(image, &c);
    let magnified = spread.major <= 1.0;
    let mode = if magnified { mag } else { Filter::ALL[how.link[1] as usize] };
    if mode == Filter::Ewa {
        return ellipse(&reader, &c, &spread);
    }
    if mode == Filter::SummedArea {
        return summed_area(scene, image, how, &c);
    }
    let last = image.link[1] - 1;
    let mut probes = 1.0;
    if mode == Filter::Anisotropic {
        let most = f64::from(how.link[3]);
        let ratio = spread.major / spread.minor.max(1e-30);
        probes = (ratio.min(most * most).sqrt() - 1e-3).ceil().max(1.0);
    }
    let level = if magnified {
        0.0
    } else {
        // A look-up is as wide as the minor axis, though more of them than needed lie along the major one.
        let least = if probes > 1.0 { spread.minor } else { 0.0 };
        (0.5 * (spread.major / (probes * probes)).max(least).log2()).clamp(0.0, last.into())
    };
    let (low, mut rest) = match MipMode::ALL[how.link[2] as usize] {
        MipMode::None => (0.0, 0.0),
        MipMode::Nearest => ((level + 0.5).ceil() - 1.0, 0.0),
        MipMode::Linear => (level.floor(), level - level.floor()),
    };
    let mut low = low as u32;
    if mode == Filter::Stochastic {
        low += u32::from(dice.z < rest);
        rest = 0.0;
        dice.z = (dice.z * 4096.0).fract();
    }
    // Of `probes` a share `rest` reads the next level, the one between reads both.
    let share = rest * probes;
    let mut sum = DVec4::ZERO;
    for probe in 0..probes as u32 {
        let probes_less_one = probes as u32 - 1;
        // From both ends inwards.
        let order = if probe & 1 != 0 { probes_less_one - probe / 2 } else { probe / 2 };
        let way = (f64::from(order) + 0.5) / probes - 0.5;
        let mut at = c.at;
        let mut at_face = face;
        if mode == Filter::Anisotropic {
            at += way * (spread.along.x * c.change[0] + spread.along.y * c.change[1]);
            if kind_of(image) == TextureKind::Cube {
                (at, at_face) = refaced(at, face);
            }
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
