// The first two dimensions of the Sobol sequence, a (0,2)-sequence in base 2, with Owen's scrambling by a
// hash: Burley 2020, "Practical Hash-based Owen Scrambling". Numbers are stored with their bits reversed, the
// first fractional digit lowest, so that the first dimension is the index itself. Blue-noise: pixels along a
// shuffled Morton curve take consecutive blocks of one sequence (Ahmed & Wonka 2020, "Screen-Space Blue-Noise
// Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels").
#ifndef SOBOL_GLSL
#define SOBOL_GLSL

#include "rng.glsl"

// Flips each bit by a hash of the bits below it: Laine & Karras 2011 in the variant of Vegdahl 2021,
// "Building a Better LK Hash".
uint laine_karras(uint x, uint seed) {
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return x;
}

// Returns the second dimension: bit j is the sum over bits k of C(k, j) mod 2, which is 1 where k has all
// bits of j (Lucas): a sum over supersets, one bit of the positions at a time.
uint second_dimension(uint index) {
    index ^= (index >> 1u) & 0x55555555u;
    index ^= (index >> 2u) & 0x33333333u;
    index ^= (index >> 4u) & 0x0F0F0F0Fu;
    index ^= (index >> 8u) & 0x00FF00FFu;
    return index ^ (index >> 16u);
}

uvec2 sobol_owen(uint index, uvec2 key) {
    return uvec2(bitfieldReverse(laine_karras(index, key.x)),
                 bitfieldReverse(laine_karras(second_dimension(index), key.y))) >> 8u;
}

// Permutes the indices such that aligned blocks of 2^k stay aligned blocks.
uint shuffled_index(uint index, uint seed) {
    return bitfieldReverse(laine_karras(bitfieldReverse(index), seed));
}

uint spread_bits(uint x) {
    x = (x | (x << 8u)) & 0x00FF00FFu;
    x = (x | (x << 4u)) & 0x0F0F0F0Fu;
    x = (x | (x << 2u)) & 0x33333333u;
    return (x | (x << 1u)) & 0x55555555u;
}

// Returns the position of a pixel along the Morton curve; coordinates below 2^16.
uint morton(uvec2 pixel) {
    return spread_bits(pixel.x) | (spread_bits(pixel.y) << 1u);
}

// Applies one of the 24 permutations of four quarters, chosen by `bits`; all of them are affine over bits.
uint shuffled_quarter(uint quarter, uint bits) {
    uint choice = ((bits >> 16u) * 6u) >> 16u;
    uint first = choice % 3u;
    uint second = (first + 1u + choice / 3u) % 3u;
    return (bits & 3u) ^ ((quarter & 1u) * (first + 1u)) ^ ((quarter >> 1u) * (second + 1u));
}

// Returns the position along the curve after shuffling the quarters of each square, from the largest square
// of 2^levels pixels per side to the smallest.
uint shuffled_place(uint place, uint levels, uint seed) {
    uint shuffled = 0u;
    uint square = 1u; // identifies each square of each level
    for (uint level = levels; level > 0u; level--) {
        uint quarter = (place >> (2u * level - 2u)) & 3u;
        shuffled = (shuffled << 2u) | shuffled_quarter(quarter, mix_bits(square ^ seed));
        square = (square << 2u) | quarter;
    }
    return shuffled;
}

#endif
