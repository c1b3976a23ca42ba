//! Sample positions inside a pixel, as integers in [0, 2^24) on each axis. With n strata a side,
//! L = ceil(log2 n) and B = 24 - L bits of jitter j, the position in stratum c is
//! floor(((c << B) + j) · 2^24 / (n << B)). Here in 64-bit integers by that formula; the shader
//! needs 32. Twin of `glsl/shared/strata.glsl`.

use super::rng::sample_bits;
use crate::scene::model::Pattern;

/// Positions are this fraction of a pixel.
pub const UNIT: f64 = 1.0 / 16_777_216.0;

pub fn stratum_position(cell: u32, jitter: u32, side: u32, side_log2: u32) -> u32 {
    let bits = 24 - side_log2;
    let place = (u64::from(cell) << bits) + u64::from(jitter);
    ((place << 24) / (u64::from(side) << bits)) as u32
}

pub fn sample_position(pattern: Pattern, key: [u32; 2], s: u32, side: u32, side_log2: u32) -> [u32; 2] {
    let jitter = match pattern {
        Pattern::Random => return sample_bits(key, s).map(|b| b >> 8),
        Pattern::Stratified => sample_bits(key, s).map(|b| b >> (8 + side_log2)),
        // The centre of a stratum is the jitter of half a stratum; `center` is a grid of one.
        Pattern::Center | Pattern::Grid => [1 << (23 - side_log2); 2],
    };
    [
        stratum_position(s % side, jitter[0], side, side_log2),
        stratum_position(s / side, jitter[1], side, side_log2),
    ]
}
