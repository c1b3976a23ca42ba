//! Lookups over footprints, equal in every run: coordinates of every kind of texture, levels of
//! detail from magnification to beyond the last one, among them integers, halves and their
//! neighbours; long footprints in all directions; and textures whose levels are distinguished by
//! colour.

use glam::{DVec2, DVec3};

use super::queries::{Rng, coordinates};
use super::variants::Variant;
use crate::lab::probe::LookupQuery;
use crate::pack::PackedScene;
use crate::texture::data::{Component, Dimension};

/// The number of coordinates per variant; each is read at its own level.
const RANDOM: usize = 40;

/// Returns the coordinates of a variant: u, v, w, or a direction.
fn places(rng: &mut Rng, variant: &Variant) -> Vec<[f32; 3]> {
    let [width, height, depth] = variant.size;
    let flat = coordinates(rng, [width, height], RANDOM, false);
    let third = coordinates(rng, [depth, 1], RANDOM, false);
    match variant.dimension {
        Dimension::One => flat.iter().map(|&[u, _]| [u, 0.5, 0.0]).collect(),
        Dimension::Two => flat.iter().map(|&[u, v]| [u, v, 0.0]).collect(),
        Dimension::Three => {
            flat.iter().map(|&[u, v]| [u, v, third[rng.bits() as usize % third.len()][0]]).collect()
        }
        Dimension::Cube => (0..3 * RANDOM).map(|i| direction(rng, i)).collect(),
    }
}

/// Returns directions all over the cube; two of three close to an edge, half of these close to a
/// corner.
fn direction(rng: &mut Rng, i: usize) -> [f32; 3] {
    let mut d = [0; 3].map(|_| rng.between(-1.0, 1.0));
    let near = |rng: &mut Rng| {
        let side = if rng.bits() >> 32 & 1 == 0 { 1.0 } else { -1.0 };
        side * rng.between(0.9, 1.0)
    };
    let axis = rng.bits() as usize % 3;
    d[axis] = d[axis].signum();
    for k in 1..=i % 3 {
        d[(axis + k) % 3] = near(rng);
    }
    let length = rng.between(0.1, 10.0);
    d.map(|x| (x * length) as f32)
}

/// Returns a level of detail: integers and halves, their neighbours, and random ones.
fn level(rng: &mut Rng, i: usize, last: u32) -> f64 {
    let whole = f64::from(rng.bits() as u32 % (last + 2));
    match i % 6 {
        0 => whole + 0.5 + rng.between(-0.2, 0.2),
        1 => whole + rng.between(-0.2, 0.2),
        2 => whole + 0.25 * f64::from(rng.bits() as u32 % 4),
        3 => rng.between(-3.0, 0.0),
        _ => rng.between(0.0, f64::from(last) + 1.0),
    }
}

/// Returns a lookup of the variant at a coordinate, over differentials of `x` and `y` in texels.
fn over(base: &LookupQuery, variant: &Variant, at: [f32; 3], x: DVec2, y: DVec2) -> LookupQuery {
    let [width, height, depth] = variant.size.map(f64::from);
    let change = |c: DVec2| match variant.dimension {
        Dimension::Cube => across(DVec3::from_array(at.map(f64::from)), c / (0.5 * width)),
        Dimension::Three => DVec3::new(c.x / width, 0.0, c.y / depth),
        Dimension::One => DVec3::new(c.x / width, 0.0, 0.0),
        Dimension::Two => (c / DVec2::new(width, height)).extend(0.0),
    };
    let four = |v: DVec3| v.as_vec3().extend(0.0).to_array();
    LookupQuery { uv: [at[0], at[1], at[2], 0.0], dx: four(change(x)), dy: four(change(y)), ..*base }
}

/// Returns the change of a direction that moves the coordinate on its face by these fractions of
/// half an edge.
fn across(d: DVec3, c: DVec2) -> DVec3 {
    let a = d.abs();
    let length = a.max_element();
    match () {
        () if a.z == length => DVec3::new(c.x, c.y, 0.0) * length,
        () if a.y == length => DVec3::new(c.x, 0.0, c.y) * length,
        () => DVec3::new(0.0, c.x, c.y) * length,
    }
}

fn last_level(variant: &Variant) -> u32 {
    let [width, height, depth] = variant.size;
    let depth = if variant.dimension == Dimension::Three { depth } else { 1 };
    width.max(height).max(depth).ilog2()
}

/// Returns round and shorter footprints of every level.
pub fn level_sweep(rng: &mut Rng, variant: &Variant, base: &LookupQuery) -> Vec<LookupQuery> {
    let last = last_level(variant);
    let places = places(rng, variant);
    let query = |(i, at)| {
        let length = level(rng, i, last).exp2();
        let turn = rng.between(0.0, std::f64::consts::TAU);
        // A 1D texture has no second direction, and so no other footprint of this length.
        let major = if variant.dimension == Dimension::One { DVec2::X } else { DVec2::from_angle(turn) };
        let minor = major.perp() * rng.unit();
        over(base, variant, at, major * length, minor * length)
    };
    places.into_iter().enumerate().map(query).collect()
}

/// The angles of long footprints, in quarters of a right angle: half of all lookups are along an
/// axis.
const ANGLES: [f64; 8] = [0.0, 4.0, 0.0, 4.0, 1.0, 2.0, 3.0, 5.5];

/// Returns footprints from round to four times the sampler's anisotropy, at many angles.
pub fn long_footprints(rng: &mut Rng, variant: &Variant, base: &LookupQuery) -> Vec<LookupQuery> {
    let last = f64::from(last_level(variant));
    let most = f64::from(variant.spec.max_anisotropy);
    let query = |i: usize| {
        let length = rng.between(0.0, last).exp2();
        let ratio = (rng.unit() * (4.0 * most).log2()).exp2();
        let angle = ANGLES[i % ANGLES.len()] * std::f64::consts::FRAC_PI_8;
        let major = match ANGLES[i % ANGLES.len()] {
            0.0 => DVec2::X,
            4.0 => DVec2::Y,
            _ => DVec2::from_angle(angle),
        };
        let [x, y] = [major * length, major.perp() * (length / ratio)];
        let at = [rng.unit() as f32, rng.unit() as f32, 0.0];
        if (i / ANGLES.len()).is_multiple_of(2) {
            over(base, variant, at, x, y)
        } else {
            over(base, variant, at, y, x)
        }
    };
    (0..32 * ANGLES.len()).map(query).collect()
}

/// Returns levels of detail from 0 to 1 of a texture of 2 × 2 texels.
pub fn level_ramp(base: &LookupQuery, steps: u32) -> impl Iterator<Item = LookupQuery> {
    let base = *base;
    (0..=steps).map(move |k| {
        let length = (0.5 * (f64::from(k) / f64::from(steps)).exp2()) as f32;
        LookupQuery { dx: [length, 0.0, 0.0, 0.0], dy: [0.0, length, 0.0, 0.0], ..base }
    })
}

/// Gives every level one colour in all its channels: level / last.
pub fn paint_levels(scene: &mut PackedScene, texture: usize) {
    let record = scene.records.textures[texture];
    let component = record.format.component();
    let levels = record.levels;
    for level in 0..levels {
        let value = f64::from(level) / f64::from((levels - 1).max(1));
        let bytes = match component {
            Component::Unorm8 => vec![(value * 255.0).round() as u8],
            Component::Unorm16 => ((value * 65_535.0).round() as u16).to_ne_bytes().to_vec(),
            Component::Float32 => (value as f32).to_ne_bytes().to_vec(),
        };
        let length = scene.level_texels(texture, level).len();
        let start = scene.level_word(record.first_word, level) as usize * 4;
        for texel in scene.texels[start..start + length].chunks_exact_mut(bytes.len()) {
            texel.copy_from_slice(&bytes);
        }
    }
}
