//! Sample positions as integers in [0, 2^24) on each axis, from the pixel and the sample index alone. Pair 0 is the
//! position in the pixel; further pairs are other dimensions of the same samples. A pixel's point set is set up once
//! per pixel and pair (`pixel_points`, `pair_points`), then evaluated sample by sample. Twin of
//! `glsl/shared/patterns.glsl`.

use super::halton::{PRIMES, halton};
use super::permute::{multi_jittered, n_rooks, permute};
use super::rng::{mix_bits, pcg3d, pixel_key, sample_bits};
use super::sobol::{morton, shuffled_index, shuffled_place, sobol_owen};
use super::strata::{fine_position, stratum_position};
use crate::scene::model::Pattern;
use crate::schema::layout::Header;

/// Paths that need more pairs of bases continue with random points.
pub const HALTON_PAIRS: u32 = PRIMES.len() as u32 / 2;

#[derive(Clone, Copy, Debug)]
pub struct Points {
    pub pattern: Pattern,
    /// Strata per side, columns.
    pub side: u32,
    /// Number of samples, for patterns that depend on it.
    pub count: u32,
    pub pair: u32,
    pub key: [u32; 2],
    /// Seed of the order of the samples, for further pairs.
    pub order: u32,
    /// Blue-noise: position along the Morton curve of the tile.
    pub place: u32,
    /// Blue-noise: first index of the pixel's block.
    pub block: u32,
}

/// Returns n such that, for blue-noise, pixels in tiles of 2^n pixels per side share one sequence of 2^32 points.
pub fn tile_log2(count: u32) -> u32 {
    (32 - count.ilog2()) / 2
}

fn first_of_block(points: &Points, seed: u32) -> u32 {
    shuffled_place(points.place, tile_log2(points.count), seed) << points.count.ilog2()
}

/// Mixes keys that seed scramblings, which need all bits equally random: the low ones of pcg are weak.
fn pattern_key(pattern: Pattern, key: [u32; 2]) -> [u32; 2] {
    match pattern {
        Pattern::Halton | Pattern::SobolOwen | Pattern::BlueNoise => key.map(mix_bits),
        _ => key,
    }
}

/// Returns the point set of pair 0; `key` is the pixel's.
pub fn pixel_points(header: &Header, pixel: [u32; 2], key: [u32; 2]) -> Points {
    let Header { pattern, strata_side: side, samples: count, seed, .. } = *header;
    let mut points = Points { pattern, side, count, pair: 0, key, order: 0, place: 0, block: 0 };
    if pattern == Pattern::BlueNoise {
        let bits = tile_log2(count);
        points.key = pixel_key(pixel.map(|x| x >> bits), seed, false);
        points.place = morton(pixel.map(|x| x & ((1 << bits) - 1)));
        points.block = first_of_block(&points, mix_bits(points.key[0] ^ points.key[1]));
    }
    points.key = pattern_key(pattern, points.key);
    points
}

/// Returns the point set of another pair, from that of pair 0.
pub fn pair_points(first: &Points, pair: u32) -> Points {
    let mut points = *first;
    if pair == 0 {
        return points;
    }
    let [x, y, order] = pcg3d([first.key[0], first.key[1], pair]).map(mix_bits);
    (points.pair, points.key, points.order) = (pair, [x, y], order);
    if points.pattern == Pattern::BlueNoise {
        points.block = first_of_block(&points, order);
        points.order ^= mix_bits(points.block);
    }
    points
}

pub fn sample_point(points: &Points, s: u32) -> [u32; 2] {
    let Points { side, count, key, .. } = *points;
    // ceil(log2 side)
    let side_log2 = side.next_power_of_two().trailing_zeros();
    let jitter = match points.pattern {
        Pattern::SobolOwen => return sobol_owen(s, key),
        Pattern::BlueNoise => return sobol_owen(points.block + s, key),
        Pattern::Halton if points.pair < HALTON_PAIRS => return halton(s, points.pair, key),
        Pattern::NRooks => return n_rooks(s, count, key),
        Pattern::MultiJittered => return multi_jittered(s, side, count, key),
        Pattern::Halton | Pattern::Random => return sample_bits(key, s).map(|b| b >> 8),
        Pattern::Stratified => sample_bits(key, s).map(|b| b >> (8 + side_log2)),
        // The centre of a stratum is a jitter of half a stratum; `center` is a grid of one.
        Pattern::Center | Pattern::Grid => [1 << (23 - side_log2); 2],
    };
    [
        stratum_position(s % side, jitter[0], side, side_log2),
        stratum_position(s / side, jitter[1], side, side_log2),
    ]
}

/// Returns sample s of any pair. Further pairs have an order of their own, so that the pairing of points in a sample is
/// random. Halton's bases need no such order.
pub fn sample_pair(points: &Points, s: u32) -> [u32; 2] {
    if points.pair == 0 {
        return sample_point(points, s);
    }
    let s = match points.pattern {
        Pattern::SobolOwen => shuffled_index(s, points.order),
        Pattern::BlueNoise => shuffled_index(s, points.order) & (points.count - 1),
        Pattern::Grid | Pattern::Stratified | Pattern::MultiJittered | Pattern::NRooks => {
            permute(s, points.count, points.order)
        }
        Pattern::Center | Pattern::Random | Pattern::Halton => s,
    };
    sample_point(points, s)
}

/// Returns sample s of a pair of which only one number is used. n × n strata have only n different columns, so such
/// patterns stratify the line itself.
pub fn sample_line(points: &Points, s: u32) -> u32 {
    if !matches!(points.pattern, Pattern::Grid | Pattern::Stratified) {
        return sample_pair(points, s)[0];
    }
    let s = permute(s, points.count, points.order);
    let jitter = if points.pattern == Pattern::Grid { 1 << 23 } else { sample_bits(points.key, s)[0] >> 8 };
    fine_position(s, jitter, points.count)
}
