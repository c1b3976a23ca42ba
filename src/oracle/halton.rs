//! The Halton sequence with Owen's nested scrambling: pair k has the bases `PRIMES[2k]` and `PRIMES[2k + 1]`.
//! Base 2 is that of `sobol`. In other bases digit d becomes slope · d + shift mod base, with a hashed slope
//! and shift for each interval of the preceding digits: affine maps permute pairs of digits uniformly, on
//! which alone the variance depends (Owen 2003, "Variance with Alternative Scramblings of Digital Nets").
//! Twin of `glsl/shared/halton.glsl`.

use super::sobol::laine_karras;

pub const PRIMES: [u32; 32] = [
    2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53, 59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103,
    107, 109, 113, 127, 131,
];

fn high_product(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

/// Returns the scrambled radical inverse of `index` in this base. `stream` is the scrambled position within
/// the interval, as 24 bits, if all further digits are zero: its first digit in this base is the shift, the
/// remainder the fraction within that digit's interval. Any other digit begins a new stream. `path`
/// identifies the interval. Widths and positions are in units of 1 / `total`, the largest power of the base
/// below 2^30, so that intervals end exactly.
pub fn scrambled_inverse(mut index: u32, base: u32, seed: u32) -> u32 {
    let total = base.pow(((1u32 << 30) - 1).ilog(base));
    let mut path = seed;
    let mut stream = path >> 8;
    let mut width = total;
    let mut place = 0;
    while index != 0 {
        let digit = index % base;
        index /= base;
        let slope = 1 + (((stream & 0xFFFF) * (base - 1)) >> 16);
        let digits = stream * base;
        width /= base;
        place += (slope * digit + (digits >> 24)) % base * width;
        path = path.wrapping_add(digit).wrapping_mul(0x9E37_79B1);
        path ^= path >> 15;
        stream = if digit == 0 { digits & 0xFF_FFFF } else { path >> 8 };
    }
    place += high_product(stream << 8, width);
    ((u64::from(place) << 24) / u64::from(total)) as u32
}

pub fn halton(s: u32, pair: u32, key: [u32; 2]) -> [u32; 2] {
    if pair == 0 {
        return [laine_karras(s, key[0]).reverse_bits() >> 8, scrambled_inverse(s, 3, key[1])];
    }
    let [first, second] = [PRIMES[2 * pair as usize], PRIMES[2 * pair as usize + 1]];
    [scrambled_inverse(s, first, key[0]), scrambled_inverse(s, second, key[1])]
}
