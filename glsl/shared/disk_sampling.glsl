// Mappings from the unit square to the shapes that are sampled. They preserve areas and neighbourhoods, so
// that a pattern keeps its distribution. Twin: src/oracle/disk_sampling.rs.
#ifndef DISK_SAMPLING_GLSL
#define DISK_SAMPLING_GLSL

#include "math.glsl"

// Returns a point on the disc by the concentric map of Shirley & Chiu 1997: squares around the centre become
// circles.
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

// Returns a point on the cap of the unit sphere around +z of height `height`; 2 is the whole sphere. Areas of
// the disc become areas of the cap if 1 - z grows as the square of the disc's radius (Archimedes).
vec3 on_cap(vec2 disc, float height) {
    float fall = height * (disc.x * disc.x + disc.y * disc.y);
    float stretch = sqrt(max(height * (2.0 - fall), 0.0));
    return vec3(stretch * disc, 1.0 - fall);
}

#endif
