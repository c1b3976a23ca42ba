// What a sample chooses beside its place in the pixel, each by a pair of dimensions of the same pattern:
//   0 place in the pixel   1 lens   2 time (its first dimension)
//   3 + 2d light, 4 + 2d lobe of the hit after d bounces
// From the seventh hit on the pairs begin again, with keys of their own; so do further lights of one hit.
// Twin: src/oracle/choices.rs.
#ifndef CHOICES_GLSL
#define CHOICES_GLSL

#include "patterns.glsl"

const uint PAIR_LENS = 1u;
const uint PAIR_TIME = 2u;
const uint PAIR_OF_HITS = 3u;
const uint CHOICE_LIGHT = 0u;
const uint CHOICE_LOBE = 1u;
const uint CHOICES = 2u;
const uint HITS_APART = 6u;

// A sample and its pixel's points of pair 0.
struct Choices {
    Points points;
    uint s;
};

vec2 chosen(Points points, uint s) {
    return vec2(sample_pair(points, s)) * (1.0 / 16777216.0);
}

// A choice of the hit after `depth` bounces, for the light `again`.
vec2 chosen_at_hit(Choices choices, uint depth, uint choice, uint again) {
    Points points = choices.points;
    uint round = depth / HITS_APART;
    uint salt = again * 16u + round;
    if (salt != 0u) {
        uvec3 bits = pcg3d(uvec3(points.key, ~salt));
        points.key = uvec2(mix_bits(bits.x), mix_bits(bits.y));
    }
    uint pair = PAIR_OF_HITS + CHOICES * (depth - round * HITS_APART) + choice;
    return chosen(pair_points(points, pair), choices.s);
}

#endif
