// Filter `stochastic`: one texel, with the weights of `linear` as probabilities: the nearest to a position
// that is moved by up to half a texel (Fajardo et al. 2023); of two levels one. Twin:
// src/oracle/filter/stochastic.rs.
#ifndef STOCHASTIC_GLSL
#define STOCHASTIC_GLSL

#include "nearest.glsl"
#include "../rng.glsl"

#if SOURCE != SOURCE_NONE

// Returns three numbers in [0, 1) from a sample's random bits.
vec3 look_up_dice(uvec2 random) {
    uvec3 bits = pcg3d(uvec3(random, 0x7E41u));
    return vec3(bits >> 8u) * (1.0 / 16777216.0);
}

vec3 stochastic_place(vec3 texel, vec3 dice) { return texel + (dice - 0.5); }

// Returns the level, the next one with probability `rest`, and renews both random numbers for the following
// look-up.
void stochastic_level(inout int low, inout float rest, inout vec3 dice) {
    low += dice.z < rest ? 1 : 0;
    rest = 0.0;
    dice.z = fract(dice.z * 4096.0);
}
#endif

#endif
