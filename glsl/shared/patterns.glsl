// Sample positions as integers in [0, 2^24) on each axis, from the pixel and the sample index alone. Pair 0
// is the position in the pixel; further pairs are other dimensions of the same samples. A pixel's point set
// is set up once per pixel and pair (`pixel_points`, `pair_points`), then evaluated sample by sample.
#ifndef PATTERNS_GLSL
#define PATTERNS_GLSL

#include "halton.glsl"
#include "permute.glsl"
#include "rng.glsl"
#include "sobol.glsl"
#include "strata.glsl"

struct Points {
    uint pattern;
    uint side;  // strata per side, columns
    uint count; // number of samples, for patterns that depend on it
    uint pair;
    uvec2 key;
    uint order; // seed of the order of the samples, for further pairs
    uint place; // blue-noise: position along the Morton curve of the tile
    uint block; // blue-noise: first index of the pixel's block
};

// Returns n such that, for blue-noise, pixels in tiles of 2^n pixels per side share one sequence of 2^32
// points.
uint tile_log2(uint count) {
    return (32u - uint(findMSB(count))) >> 1u;
}

uint first_of_block(const Points points, uint seed) {
    return shuffled_place(points.place, tile_log2(points.count), seed) << uint(findMSB(points.count));
}

const uint SCRAMBLED = (1u << PATTERN_HALTON) | (1u << PATTERN_SOBOL_OWEN) | (1u << PATTERN_BLUE_NOISE);

// Mixes keys that seed scramblings, which need all bits equally random: the low ones of pcg are weak.
uvec2 pattern_key(uint pattern, uvec2 key) {
    if ((PATTERNS & SCRAMBLED) == 0u) return key;
    return HAS(SCRAMBLED, pattern) ? uvec2(mix_bits(key.x), mix_bits(key.y)) : key;
}

// Returns the point set of pair 0; `key` is the pixel's.
Points pixel_points(const Header header, uvec2 pixel, uvec2 key) {
    uint side = COUNT(STRATA_SIDE, header.strata_side);
    uint count = COUNT(SAMPLES, header.samples);
    Points points = Points(header.pattern, side, count, 0u, key, 0u, 0u, 0u);
    if (MODE_IS(PATTERNS, PATTERN_BLUE_NOISE, points.pattern)) {
        uint bits = tile_log2(count);
        points.key = pixel_key(pixel >> bits, header.seed, false);
        points.place = morton(pixel & ((1u << bits) - 1u));
        points.block = first_of_block(points, mix_bits(points.key.x ^ points.key.y));
    }
    points.key = pattern_key(points.pattern, points.key);
    return points;
}

// Returns the point set of another pair, from that of pair 0.
Points pair_points(const Points first, uint pair) {
    if (pair == 0u) return first;
    Points points = first;
    uvec3 bits = pcg3d(uvec3(first.key, pair));
    points.pair = pair;
    points.key = uvec2(mix_bits(bits.x), mix_bits(bits.y));
    points.order = mix_bits(bits.z);
    if (MODE_IS(PATTERNS, PATTERN_BLUE_NOISE, points.pattern)) {
        points.block = first_of_block(points, points.order);
        points.order ^= mix_bits(points.block);
    }
    return points;
}

// With `line` only the first number is used: n x n strata have only n different columns, so such patterns
// stratify the line itself.
uvec2 sample_point(const Points points, uint s, bool line) {
    uvec2 key = points.key;
    if (MODE_IS(PATTERNS, PATTERN_SOBOL_OWEN, points.pattern)) return sobol_owen(s, key);
    if (MODE_IS(PATTERNS, PATTERN_BLUE_NOISE, points.pattern)) return sobol_owen(points.block + s, key);
    bool is_halton = MODE_IS(PATTERNS, PATTERN_HALTON, points.pattern);
    if (is_halton && points.pair < HALTON_PAIRS) return halton(s, points.pair, key);
    if (MODE_IS(PATTERNS, PATTERN_N_ROOKS, points.pattern)) return n_rooks(s, points.count, key);
    if (MODE_IS(PATTERNS, PATTERN_MULTI_JITTERED, points.pattern)) {
        return multi_jittered(s, points.side, points.count, key);
    }
    if (is_halton || MODE_IS(PATTERNS, PATTERN_RANDOM, points.pattern)) return sample_bits(key, s) >> 8u;
    uint side = points.side;
    // The number of bits of side - 1 is ceil(log2 side).
    uint side_log2 = uint(findMSB(side - 1u) + 1);
    // The centre of a stratum is a jitter of half a stratum; `center` is a grid of one.
    uvec2 jitter = uvec2(0x800000u);
    if (MODE_IS(PATTERNS, PATTERN_STRATIFIED, points.pattern)) jitter = sample_bits(key, s) >> 8u;
    if (line && !MODE_IS(PATTERNS, PATTERN_CENTER, points.pattern)) {
        return uvec2(fine_position(s, jitter.x, points.count), 0u);
    }
    jitter >>= side_log2;
    return uvec2(stratum_position(s % side, jitter.x, side, side_log2),
                 stratum_position(s / side, jitter.y, side, side_log2));
}

bool fills_strata(uint pattern) {
    return MODE_IS(PATTERNS, PATTERN_GRID, pattern) || MODE_IS(PATTERNS, PATTERN_STRATIFIED, pattern) ||
           MODE_IS(PATTERNS, PATTERN_MULTI_JITTERED, pattern) || MODE_IS(PATTERNS, PATTERN_N_ROOKS, pattern);
}

// Returns sample s of any pair. Further pairs have an order of their own, so that the pairing of points in a
// sample is random. Halton's bases need no such order.
uvec2 sample_pair(const Points points, uint s, bool line) {
    if (points.pair == 0u) return sample_point(points, s, line);
    if (MODE_IS(PATTERNS, PATTERN_SOBOL_OWEN, points.pattern)) {
        s = shuffled_index(s, points.order);
    } else if (MODE_IS(PATTERNS, PATTERN_BLUE_NOISE, points.pattern)) {
        s = shuffled_index(s, points.order) & (points.count - 1u);
    } else if (fills_strata(points.pattern)) {
        s = permute(s, points.count, points.order);
    }
    return sample_point(points, s, line);
}

#endif
