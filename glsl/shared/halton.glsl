// Halton's sequence with Owen's nested scrambling: pair k has the bases PRIMES[2k] and PRIMES[2k + 1].
// Base 2 is that of sobol.glsl. In other bases digit d becomes slope · d + shift mod base, with a hashed slope
// and shift for each interval of the digits before it: affine maps permute pairs of digits evenly, which
// is all that the variance depends on (Owen 2003, "Variance with Alternative Scramblings of Digital Nets").
#ifndef HALTON_GLSL
#define HALTON_GLSL

#include "rng.glsl"
#include "sobol.glsl"

const uint PRIMES[32] = uint[32](2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u, 23u, 29u, 31u, 37u, 41u, 43u, 47u, 53u,
                                 59u, 61u, 67u, 71u, 73u, 79u, 83u, 89u, 97u, 101u, 103u, 107u, 109u, 113u,
                                 127u, 131u);

uint high_product(uint a, uint b) {
    uint high, low;
    umulExtended(a, b, high, low);
    return high;
}

// `stream` is the scrambled place within the interval as 24 bits of it, if all further digits are
// zeros: its first digit in this base is the shift, what remains the fraction within that digit's interval.
// Any other digit begins a new stream. `path` tells intervals apart. Widths and places are in units of 2^-32.
uint scrambled_inverse(uint index, uint base, uint seed) {
    uint path = mix_bits(seed);
    uint stream = path >> 8u;
    uint width = 0xFFFFFFFFu;
    uint place = 0u;
    while (index != 0u) {
        uint digit = index % base;
        index /= base;
        uint slope = 1u + (((stream & 0xFFFFu) * (base - 1u)) >> 16u);
        uint digits = stream * base;
        width /= base;
        place += ((slope * digit + (digits >> 24u)) % base) * width;
        path = (path + digit) * 0x9E3779B1u;
        path ^= path >> 15u;
        stream = digit == 0u ? digits & 0xFFFFFFu : path >> 8u;
    }
    return place + high_product(stream << 8u, width);
}

uvec2 halton(uint s, uint pair, uvec2 key) {
    if (pair == 0u) return uvec2(bitfieldReverse(laine_karras(s, key.x)), scrambled_inverse(s, 3u, key.y)) >> 8u;
    return uvec2(scrambled_inverse(s, PRIMES[2u * pair], key.x),
                 scrambled_inverse(s, PRIMES[2u * pair + 1u], key.y)) >> 8u;
}

#endif
