// Sample positions inside a pixel, as integers in [0, 2^24) on each axis. With n strata a side,
// L = ceil(log2 n) and B = 24 - L bits of jitter j, the position in stratum c is
// floor(((c << B) + j) * 2^24 / (n << B)) = floor((c * 2^24 + j * 2^L) / n), in 32-bit integers.
#ifndef STRATA_GLSL
#define STRATA_GLSL

#include "rng.glsl"

uint stratum_position(uint cell, uint jitter, uint side, uint side_log2) {
    if (side == (1u << side_log2)) return (cell << (24u - side_log2)) + jitter;
    // Long division of cell * 2^24 by side, 12 bits at a time: side <= 4096 keeps all below 2^24.
    uint high = cell << 12u;
    uint low = (high % side) << 12u;
    uint quotient = ((high / side) << 12u) + low / side;
    return quotient + (low % side + (jitter << side_log2)) / side;
}

uvec2 sample_position(uint pattern, uvec2 key, uint s, uint side, uint side_log2) {
    if (MODE_IS(PATTERNS, PATTERN_RANDOM, pattern)) return sample_bits(key, s) >> 8u;
    // The centre of a stratum is the jitter of half a stratum; `center` is a grid of one.
    uvec2 jitter = uvec2(1u << (23u - side_log2));
    if (MODE_IS(PATTERNS, PATTERN_STRATIFIED, pattern)) jitter = sample_bits(key, s) >> (8u + side_log2);
    return uvec2(stratum_position(s % side, jitter.x, side, side_log2),
                 stratum_position(s / side, jitter.y, side, side_log2));
}

#endif
