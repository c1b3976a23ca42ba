//! Jittered strata whose rows and columns are permuted. `permute` returns the position of entry i in
//! permutation p of the numbers below `length`: Kensler 2013, "Correlated Multi-Jittered Sampling", with its
//! last offset limited to 24 bits, as i + p beyond 2^32 would map two entries to one position. Patterns:
//! multi-jittered (ibid., any number of samples) and n-rooks (Shirley 1991). Twin of
//! `glsl/shared/permute.glsl`.

use super::rng::sample_bits;
use super::strata::fine_position;

pub fn permute(mut i: u32, length: u32, p: u32) -> u32 {
    // All bits of length - 1 and below.
    let mask = length.next_power_of_two() - 1;
    // Entries beyond the length are mapped again until they are below it (cycle walking).
    loop {
        i ^= p;
        i = i.wrapping_mul(0xE170_893D);
        i ^= p >> 16;
        i ^= (i & mask) >> 4;
        i ^= p >> 8;
        i = i.wrapping_mul(0x0929_EB3F);
        i ^= p >> 23;
        i ^= (i & mask) >> 1;
        i = i.wrapping_mul(1 | (p >> 27));
        i = i.wrapping_mul(0x6935_FA69);
        i ^= (i & mask) >> 11;
        i = i.wrapping_mul(0x74DC_B303);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0x9E50_1CC3);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0xC860_A3DF);
        i &= mask;
        i ^= i >> 5;
        if i < length {
            return (i + (p >> 8)) % length;
        }
    }
}

/// Returns a sample of columns × rows cells with one sample each, of which all samples have one in each of
/// `count` rows and at most one in each of columns × rows columns: the order of the rows within a cell is the
/// same for all columns.
pub fn multi_jittered(s: u32, columns: u32, count: u32, key: [u32; 2]) -> [u32; 2] {
    let rows = count.div_ceil(columns);
    let column = permute(s % columns, columns, key[0]);
    let column_in_cell = permute(s / columns, rows, key[1]);
    let jitter = sample_bits(key, s).map(|bits| bits >> 8);
    [
        fine_position(column * rows + column_in_cell, jitter[0], columns * rows),
        fine_position(s, jitter[1], count),
    ]
}

/// Returns one sample in each of `count` rows and of `count` columns.
pub fn n_rooks(s: u32, count: u32, key: [u32; 2]) -> [u32; 2] {
    let jitter = sample_bits(key, s).map(|bits| bits >> 8);
    [fine_position(permute(s, count, key[0]), jitter[0], count), fine_position(s, jitter[1], count)]
}
