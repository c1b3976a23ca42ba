// What a sample chooses beside its place in the pixel, each by a pair of dimensions of the same pattern:
//   0 place in the pixel   1 lens   2 time (its first dimension)
//   3 + 2d light, 4 + 2d lobe of the hit after d bounces; of glass 3 + 2d is whether it mirrors (its first dimension)
// From the seventh hit on the pairs begin again, shifted; further lights of one hit shift the pair of the
// first. Twin: src/oracle/choices.rs.
#ifndef CHOICES_GLSL
#define CHOICES_GLSL

#include "patterns.glsl"

const bool LENS = HAS(CHOICES, CHOICE_LENS);
const bool TIMED = HAS(CHOICES, CHOICE_TIME);
const bool AREA_LIGHTS = HAS(CHOICES, CHOICE_LIGHT);
const bool GLOSSY = HAS(CHOICES, CHOICE_LOBE);
const bool FRESNEL = HAS(CHOICES, CHOICE_FRESNEL);

const uint HITS_APART = 6u;

// Positions as integers in [0, 2^24).
struct Choices {
    uvec2 place;
    uvec2 lens;
    uvec2 time;
    uvec2 light;
    uvec2 lobe;
    uint fresnel;
};

const Choices NO_CHOICES = Choices(uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u), 0u);

float unit_line(uint position) {
    return float(position) * (1.0 / 16777216.0);
}

vec2 unit_square(uvec2 position) {
    return vec2(position) * (1.0 / 16777216.0);
}

// The same positions shifted, by another number for each `salt` but 0: without correlation to them in the
// mean, and as even. Nets of base 2 stay nets under exclusive or; strata move around the square.
uvec2 apart(Points points, uvec2 position, uint salt) {
    if (salt == 0u || MODE_IS(PATTERNS, PATTERN_CENTER, points.pattern) || MODE_IS(PATTERNS, PATTERN_GRID, points.pattern)) {
        return position;
    }
    uvec3 bits = pcg3d(uvec3(points.key, ~salt));
    uvec2 by = uvec2(mix_bits(bits.x), mix_bits(bits.y)) >> 8u;
    bool net = MODE_IS(PATTERNS, PATTERN_SOBOL_OWEN, points.pattern) || MODE_IS(PATTERNS, PATTERN_BLUE_NOISE, points.pattern);
    return net ? position ^ by : (position + by) & 0xFFFFFFu;
}

// All that sample s chooses for the hit after `depth` bounces, where its path starts also its place and what
// the camera needs. One loop: the patterns' code is there once.
Choices choose(Header header, Points points, uint s, uint depth, bool starts) {
    Choices choices = NO_CHOICES;
    uint wanted = (CHOICES & header.chances.x) << 1u;
    wanted = starts ? wanted | 1u : wanted & (0xFFFFFFFFu << (1u + CHOICE_LIGHT));
    uint round = depth / HITS_APART;
    while (wanted != 0u) {
        uint i = uint(findLSB(wanted));
        wanted &= wanted - 1u;
        bool of_hit = i > CHOICE_LIGHT;
        bool fresnel = FRESNEL && i == 1u + CHOICE_FRESNEL;
        uint first = fresnel ? 1u + CHOICE_LIGHT : i;
        Points drawn = pair_points(points, of_hit ? first + 2u * (depth - round * HITS_APART) : first);
        uvec2 position = sample_pair(drawn, s, fresnel);
        position = apart(points, position, of_hit ? round : 0u);
        choices.place = i == 0u ? position : choices.place;
        choices.lens = i == 1u + CHOICE_LENS ? position : choices.lens;
        choices.time = i == 1u + CHOICE_TIME ? position : choices.time;
        choices.light = i == 1u + CHOICE_LIGHT ? position : choices.light;
        choices.lobe = i == 1u + CHOICE_LOBE ? position : choices.lobe;
        choices.fresnel = fresnel ? position.x : choices.fresnel;
    }
    return choices;
}

// The place of the hit's choice on the light `i`.
vec2 chosen_light(Points points, Choices choices, uint i) {
    return unit_square(apart(points, choices.light, 16u * i));
}

#endif
