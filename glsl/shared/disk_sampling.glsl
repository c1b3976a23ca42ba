// Points of the unit square onto the shapes that samples are chosen from, equal areas onto equal areas,
// neighbours beside neighbours: what a pattern does in the square it does there. Twin: src/oracle/disk_sampling.rs.
#ifndef DISK_SAMPLING_GLSL
#define DISK_SAMPLING_GLSL

#include "math.glsl"

// Shirley & Chiu 1997: squares around the middle become circles.
vec2 concentric_disc(vec2 square) {
    vec2 p = 2.0 * square - 1.0;
    bool wide = abs(p.x) > abs(p.y);
    float radius = wide ? p.x : p.y;
    float ratio = radius == 0.0 ? 0.0 : (wide ? p.y : p.x) / radius;
    float turns = 0.125 * ratio; // from the nearer axis
    float along = radius * sine_turns(0.25 + turns);
    float beside = radius * sine_turns(turns);
    return wide ? vec2(along, beside) : vec2(beside, along);
}

// The unit sphere's cap around +z that is `height` high, 2 for all of it. A disc's areas become the cap's
// where 1 - z grows as the square of the disc's radius (Archimedes).
vec3 on_cap(vec2 disc, float height) {
    float fall = height * (disc.x * disc.x + disc.y * disc.y);
    float stretch = sqrt(max(height * (2.0 - fall), 0.0));
    return vec3(stretch * disc, 1.0 - fall);
}

#endif
