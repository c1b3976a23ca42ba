// The sample dimensions, each by a pair of dimensions of the same pattern:
//     0 position in the pixel   1 lens   2 time (its first dimension)
//     3 + 2d light, 4 + 2d lobe of the hit after d bounces
// For glass 3 + 2d chooses between reflection and refraction (its first dimension). Further lights of one hit
// shift the pair of the first. Twin: src/oracle/sample_dimensions.rs.
#ifndef SAMPLE_DIMENSIONS_GLSL
#define SAMPLE_DIMENSIONS_GLSL

#include "patterns.glsl"

const bool LENS = HAS(SAMPLE_DIMENSIONS, DIMENSION_LENS);
const bool TIMED = HAS(SAMPLE_DIMENSIONS, DIMENSION_TIME);
const bool AREA_LIGHTS = HAS(SAMPLE_DIMENSIONS, DIMENSION_LIGHT);
const bool GLOSSY = HAS(SAMPLE_DIMENSIONS, DIMENSION_LOBE);
const bool FRESNEL = HAS(SAMPLE_DIMENSIONS, DIMENSION_FRESNEL);

// Positions as integers in [0, 2^24).
struct SampleDimensions {
    uvec2 place;
    uvec2 lens;
    uvec2 time;
    uvec2 light;
    uvec2 lobe;
    uint fresnel;
};

const SampleDimensions NO_CHOICES = SampleDimensions(uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u), 0u);

float unit_line(uint position) {
    return float(position) * (1.0 / 16777216.0);
}

vec2 unit_square(uvec2 position) {
    return vec2(position) * (1.0 / 16777216.0);
}

// Returns the positions shifted by an amount that depends on `salt`; 0 leaves them unchanged. The result is
// uncorrelated with them on average, and equally uniform. Nets in base 2 stay nets under exclusive or; strata
// wrap around the square.
uvec2 apart(const Points points, uvec2 position, uint salt) {
    if (salt == 0u || MODE_IS(PATTERNS, PATTERN_CENTER, points.pattern) || MODE_IS(PATTERNS, PATTERN_GRID, points.pattern)) {
        return position;
    }
    uvec3 bits = pcg3d(uvec3(points.key, ~salt));
    uvec2 by = uvec2(mix_bits(bits.x), mix_bits(bits.y)) >> 8u;
    bool net = MODE_IS(PATTERNS, PATTERN_SOBOL_OWEN, points.pattern) || MODE_IS(PATTERNS, PATTERN_BLUE_NOISE, points.pattern);
    return net ? position ^ by : (position + by) & 0xFFFFFFu;
}

// Returns all dimensions of sample s for the hit after `depth` bounces; at the start of its path also the
// position in the pixel and the camera's dimensions. One loop, so that the patterns' code exists once.
SampleDimensions choose(const Header header, const Points points, uint s, uint depth, bool starts) {
    SampleDimensions dimensions = NO_CHOICES;
    uint wanted = (SAMPLE_DIMENSIONS & header.sample_dimensions) << 1u;
    wanted = starts ? wanted | 1u : wanted & (0xFFFFFFFFu << (1u + DIMENSION_LIGHT));
    while (wanted != 0u) {
        uint i = uint(findLSB(wanted));
        wanted &= wanted - 1u;
        bool of_hit = i > DIMENSION_LIGHT;
        bool fresnel = FRESNEL && i == 1u + DIMENSION_FRESNEL;
        uint first = fresnel ? 1u + DIMENSION_LIGHT : i;
        Points drawn = pair_points(points, of_hit ? first + 2u * depth : first);
        uvec2 position = sample_pair(drawn, s, fresnel);
        dimensions.place = i == 0u ? position : dimensions.place;
        dimensions.lens = i == 1u + DIMENSION_LENS ? position : dimensions.lens;
        dimensions.time = i == 1u + DIMENSION_TIME ? position : dimensions.time;
        dimensions.light = i == 1u + DIMENSION_LIGHT ? position : dimensions.light;
        dimensions.lobe = i == 1u + DIMENSION_LOBE ? position : dimensions.lobe;
        dimensions.fresnel = fresnel ? position.x : dimensions.fresnel;
    }
    return dimensions;
}

// Returns the hit's sample on the light `i`.
vec2 chosen_light(const Points points, const SampleDimensions dimensions, uint i) {
    return unit_square(apart(points, dimensions.light, 16u * i));
}

#endif
