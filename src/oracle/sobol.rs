//! The first two dimensions of the Sobol sequence, a (0,2)-sequence in base 2, with Owen's scrambling by a
//! hash: Burley 2020, "Practical Hash-based Owen Scrambling". Numbers are stored with their bits reversed,
//! the first fractional digit lowest, so that the first dimension is the index itself. Blue-noise: pixels
//! along a shuffled Morton curve take consecutive blocks of one sequence (Ahmed & Wonka 2020, "Screen-Space
//! Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels"). Twin of
//! `glsl/shared/sobol.glsl`.

use super::rng::mix_bits;

/// Flips each bit by a hash of the bits below it: Laine & Karras 2011 in the variant of Vegdahl 2021,
/// "Building a Better LK Hash".
pub fn laine_karras(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3D20_ADEA);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6C56);
    x ^= x.wrapping_mul(0x53A2_2864);
    x
}

/// Returns the second dimension: bit j is the sum over bits k of C(k, j) mod 2, which is 1 where k has all
/// bits of j (Lucas). The shader computes it as a sum over supersets.
pub fn second_dimension(index: u32) -> u32 {
    let bit = |j: u32| (0..32).filter(|k| index >> k & 1 == 1 && k & j == j).count() as u32 & 1;
    (0..32).map(|j| bit(j) << j).sum()
}

pub fn sobol_owen(index: u32, key: [u32; 2]) -> [u32; 2] {
    let dimensions = [laine_karras(index, key[0]), laine_karras(second_dimension(index), key[1])];
    dimensions.map(|reversed| reversed.reverse_bits() >> 8)
}

/// Permutes the indices such that aligned blocks of 2^k stay aligned blocks.
pub fn shuffled_index(index: u32, seed: u32) -> u32 {
    laine_karras(index.reverse_bits(), seed).reverse_bits()
}

fn spread_bits(x: u32) -> u32 {
    (0..16).map(|bit| (x >> bit & 1) << (2 * bit)).sum()
}

/// Returns the position of a pixel along the Morton curve; coordinates below 2^16.
pub fn morton(pixel: [u32; 2]) -> u32 {
    spread_bits(pixel[0]) | spread_bits(pixel[1]) << 1
}

/// Applies one of the 24 permutations of four quarters, chosen by `bits`; all of them are affine over bits.
pub fn shuffled_quarter(quarter: u32, bits: u32) -> u32 {
    let choice = ((bits >> 16) * 6) >> 16;
    let first = choice % 3;
    let second = (first + 1 + choice / 3) % 3;
    (bits & 3) ^ ((quarter & 1) * (first + 1)) ^ ((quarter >> 1) * (second + 1))
}

/// Returns the position along the curve after shuffling the quarters of each square, from the largest square
/// of 2^levels pixels per side to the smallest.
pub fn shuffled_place(place: u32, levels: u32, seed: u32) -> u32 {
    let mut shuffled = 0;
    let mut square: u32 = 1; // identifies each square of each level
    for level in (1..=levels).rev() {
        let quarter = (place >> (2 * level - 2)) & 3;
        shuffled = shuffled << 2 | shuffled_quarter(quarter, mix_bits(square ^ seed));
        square = square << 2 | quarter;
    }
    shuffled
}
