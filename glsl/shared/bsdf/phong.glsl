// Model `phong`: Lambert, and beside it a highlight, energy-normalised: specular (n + 2)/2pi cos^n of the angle to
// the mirror direction (Lafortune & Willems 1994). Twin: src/oracle/bsdf/phong.rs.
#ifndef PHONG_GLSL
#define PHONG_GLSL

#include "../footprint.glsl"
#include "../math.glsl"

const float LN_2 = 0.69314718055994531;

// cos^n alpha (n + 2) / 2 between the mirror direction and the way to the light.
float phong_lobe(vec3 mirror, vec3 way, float exponent) {
    float cosine = dot3(mirror, way) * inversesqrt(dot3(mirror, mirror) * dot3(way, way));
    float power = cosine > 0.0 ? exponent * log2_accurate(max(min(cosine, 1.0), 1e-30)) : -126.0;
    return power > -126.0 ? exp2_accurate(power) * (0.5 * exponent + 1.0) : 0.0;
}

// The lobe that the albedo colours, and the highlight.
vec2 phong_lobes(vec3 mirror, vec3 way, float exponent) { return vec2(1.0, phong_lobe(mirror, way, exponent)); }

// Density over solid angle with which `sampled_highlight` returns a way.
float highlight_density(vec3 mirror, vec3 way, float exponent) {
    return phong_lobe(mirror, way, exponent) * ((exponent + 1.0) / (exponent + 2.0)) * (1.0 / PI);
}

// A way around the mirror direction, as often as cos^n is large (Walter 2005); of a point that is uniform in the disc.
vec3 sampled_highlight(vec3 mirror, vec2 disc, float exponent) {
    float squared = dot(disc, disc);
    float rise = log2_accurate(max(1.0 - squared, 1e-7)) / (exponent + 1.0);
    // Near the middle 1 - cos² says nothing of the sine.
    float small = 2.0 * LN_2 * rise;
    float sine = small > -0.02 ? -small * (1.0 + 0.5 * small) : 1.0 - exp2_accurate(2.0 * rise);
    float size = sqrt(max(sine, 0.0) / max(squared, 1e-30));
    return around(mirror * inversesqrt(dot3(mirror, mirror)), vec3(disc * size, sqrt(max(1.0 - sine, 0.0))));
}

vec3 with_highlight(vec3 diffuse, vec3 carried, vec3 specular, vec3 light) {
    vec3 sum = diffuse + carried * specular * light;
    return sum;
}

#endif
