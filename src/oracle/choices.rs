//! What a sample chooses beside its place in the pixel, each by a pair of dimensions of the same pattern:
//! 0 place in the pixel, 1 lens, 2 time (its first dimension), 3 + 2d light and 4 + 2d lobe of the hit after
//! d bounces. From the seventh hit on the pairs begin again, with keys of their own; so do further lights of
//! one hit. Twin of `glsl/shared/choices.glsl`.

use glam::DVec2;

use super::patterns::{Points, pair_points, sample_pair};
use super::rng::{mix_bits, pcg3d};
use super::strata::UNIT;

pub const PAIR_LENS: u32 = 1;
pub const PAIR_TIME: u32 = 2;
pub const PAIR_OF_HITS: u32 = 3;
pub const CHOICE_LIGHT: u32 = 0;
pub const CHOICE_LOBE: u32 = 1;
const CHOICES: u32 = 2;
const HITS_APART: u32 = 6;

/// A sample and its pixel's points of pair 0.
#[derive(Clone, Copy, Debug)]
pub struct Choices {
    pub points: Points,
    pub s: u32,
}

pub fn chosen(points: &Points, s: u32) -> DVec2 {
    let [x, y] = sample_pair(points, s);
    DVec2::new(f64::from(x), f64::from(y)) * UNIT
}

/// A choice of the hit after `depth` bounces, for the light `again`. Without a pattern it is the middle.
pub fn chosen_at_hit(choices: Option<Choices>, depth: u32, choice: u32, again: u32) -> DVec2 {
    let Some(Choices { mut points, s }) = choices else { return DVec2::splat(0.5) };
    let round = depth / HITS_APART;
    let salt = again * 16 + round;
    if salt != 0 {
        let [x, y, _] = pcg3d([points.key[0], points.key[1], !salt]);
        points.key = [mix_bits(x), mix_bits(y)];
    }
    let pair = PAIR_OF_HITS + CHOICES * (depth - round * HITS_APART) + choice;
    chosen(&pair_points(&points, pair), s)
}
