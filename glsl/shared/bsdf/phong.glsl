// Model `phong`: Lambert, and beside it a highlight, energy-normalised: specular (n + 2)/2pi cos^n of the angle to
// the mirror direction (Lafortune & Willems 1994). Twin: src/oracle/bsdf/phong.rs.
#ifndef PHONG_GLSL
#define PHONG_GLSL

#include "../math.glsl"

// cos^n alpha (n + 2) / 2 between the mirror direction and the way to the light.
float phong_lobe(vec3 mirror, vec3 way, float exponent) {
    float cosine = dot3(mirror, way) * inversesqrt(dot3(mirror, mirror) * dot3(way, way));
    float power = cosine > 0.0 ? exponent * log2_accurate(max(min(cosine, 1.0), 1e-30)) : -126.0;
    return power > -126.0 ? exp2_accurate(power) * (0.5 * exponent + 1.0) : 0.0;
}

// The lobe that the albedo colours, and the highlight.
vec2 phong_lobes(vec3 mirror, vec3 way, float exponent) { return vec2(1.0, phong_lobe(mirror, way, exponent)); }

vec3 with_highlight(vec3 diffuse, vec3 carried, vec3 specular, vec3 light) {
    vec3 sum = diffuse + carried * specular * light;
    return sum;
}

#endif
