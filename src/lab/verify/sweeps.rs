//! Look-ups over footprints, the same in every run: places of every kind of texture, levels of detail from
//! magnification to beyond the last one, among them whole ones, halves and what lies just beside them;
//! long footprints in all directions; and textures whose levels are told apart by their colour.

use glam::{DVec2, DVec3};

use super::queries::{Dice, coordinates};
use super::variants::Variant;
use crate::lab::probe::LookUp;
use crate::pack::PackedScene;
use crate::texture::data::{Component, Dimension};

/// Places a variant; each is read at a level of its own.
const RANDOM: usize = 40;

/// Where a variant is looked up: u, v, w, or a direction.
fn places(dice: &mut Dice, variant: &Variant) -> Vec<[f32; 3]> {
    let [width, height, depth] = variant.size;
    let flat = coordinates(dice, [width, height], RANDOM, false);
    let third = coordinates(dice, [depth, 1], RANDOM, false);
    match variant.dimension {
        Dimension::One => flat.iter().map(|&[u, _]| [u, 0.5, 0.0]).collect(),
        Dimension::Two => flat.iter().map(|&[u, v]| [u, v, 0.0]).collect(),
        Dimension::Three => {
            flat.iter().map(|&[u, v]| [u, v, third[dice.bits() as usize % third.len()][0]]).collect()
        }
        Dimension::Cube => (0..3 * RANDOM).map(|i| direction(dice, i)).collect(),
    }
}

/// All over the cube; two of three close to an edge, half of these to a corner.
fn direction(dice: &mut Dice, i: usize) -> [f32; 3] {
    let mut d = [0; 3].map(|_| dice.between(-1.0, 1.0));
    let near = |dice: &mut Dice| {
        let side = if dice.bits() >> 32 & 1 == 0 { 1.0 } else { -1.0 };
        side * dice.between(0.9, 1.0)
    };
    let axis = dice.bits() as usize % 3;
    d[axis] = d[axis].signum();
    for k in 1..=i % 3 {
        d[(axis + k) % 3] = near(dice);
    }
    let length = dice.between(0.1, 10.0);
    d.map(|x| (x * length) as f32)
}

/// A level of detail: whole ones and halves, just beside them, and any.
fn level(dice: &mut Dice, i: usize, last: u32) -> f64 {
    let whole = f64::from(dice.bits() as u32 % (last + 2));
    match i % 6 {
        0 => whole + 0.5 + dice.between(-0.2, 0.2),
        1 => whole + dice.between(-0.2, 0.2),
        2 => whole + 0.25 * f64::from(dice.bits() as u32 % 4),
        3 => dice.between(-3.0, 0.0),
        _ => dice.between(0.0, f64::from(last) + 1.0),
    }
}

/// A look-up of the variant at a place, over changes that are there `x` and `y` in texels.
fn over(base: &LookUp, variant: &Variant, at: [f32; 3], x: DVec2, y: DVec2) -> LookUp {
    let [width, height, depth] = variant.size.map(f64::from);
    let change = |c: DVec2| match variant.dimension {
        Dimension::Cube => across(DVec3::from_array(at.map(f64::from)), c / (0.5 * width)),
        Dimension::Three => DVec3::new(c.x / width, 0.0, c.y / depth),
        Dimension::One => DVec3::new(c.x / width, 0.0, 0.0),
        Dimension::Two => (c / DVec2::new(width, height)).extend(0.0),
    };
    let four = |v: DVec3| v.as_vec3().extend(0.0).to_array();
    LookUp { uv: [at[0], at[1], at[2], 0.0], dx: four(change(x)), dy: four(change(y)), ..*base }
}

/// A change of a direction that moves the place on its face by these parts of half an edge.
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

/// Round footprints and shorter ones, of every level.
pub fn level_sweep(dice: &mut Dice, variant: &Variant, base: &LookUp) -> Vec<LookUp> {
    let last = last_level(variant);
    let places = places(dice, variant);
    let query = |(i, at)| {
        let length = level(dice, i, last).exp2();
        let turn = dice.between(0.0, std::f64::consts::TAU);
        // One dimension has no second direction, and so no other way to be this long.
        let major = if variant.dimension == Dimension::One { DVec2::X } else { DVec2::from_angle(turn) };
        let minor = major.perp() * dice.unit();
        over(base, variant, at, major * length, minor * length)
    };
    places.into_iter().enumerate().map(query).collect()
}

/// Angles of long footprints, in quarters of a right angle: half of all look-ups along an axis.
const ANGLES: [f64; 8] = [0.0, 4.0, 0.0, 4.0, 1.0, 2.0, 3.0, 5.5];

/// Footprints from round to four times as long as the sampler follows, at many angles.
pub fn long_footprints(dice: &mut Dice, variant: &Variant, base: &LookUp) -> Vec<LookUp> {
    let last = f64::from(last_level(variant));
    let most = f64::from(variant.spec.max_anisotropy);
    let query = |i: usize| {
        let length = dice.between(0.0, last).exp2();
        let ratio = (dice.unit() * (4.0 * most).log2()).exp2();
        let angle = ANGLES[i % ANGLES.len()] * std::f64::consts::FRAC_PI_8;
        let major = match ANGLES[i % ANGLES.len()] {
            0.0 => DVec2::X,
            4.0 => DVec2::Y,
            _ => DVec2::from_angle(angle),
        };
        let [x, y] = [major * length, major.perp() * (length / ratio)];
        let at = [dice.unit() as f32, dice.unit() as f32, 0.0];
        if (i / ANGLES.len()).is_multiple_of(2) {
            over(base, variant, at, x, y)
        } else {
            over(base, variant, at, y, x)
        }
    };
    (0..32 * ANGLES.len()).map(query).collect()
}

/// Levels of detail from 0 to 1 of a texture of 2 × 2 texels.
pub fn level_ramp(base: &LookUp, steps: u32) -> impl Iterator<Item = LookUp> {
    let base = *base;
    (0..=steps).map(move |k| {
        let length = (0.5 * (f64::from(k) / f64::from(steps)).exp2()) as f32;
        LookUp { dx: [length, 0.0, 0.0, 0.0], dy: [0.0, length, 0.0, 0.0], ..base }
    })
}

/// Gives every level one colour in all its channels: level / last.
pub fn paint_levels(scene: &mut PackedScene, texture: usize) {
    let record = scene.textures[texture];
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
