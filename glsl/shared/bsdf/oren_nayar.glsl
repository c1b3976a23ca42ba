// Model `oren-nayar`, rough and diffuse, which keeps all light: EON (Portsmouth, Kutz & Hill 2025). Its first lobe
// scatters once, after Fujii: A (1 + r s/t) with A = 1 / (1 + c1 r). What that loses goes into the second, which scatters
// more often: (1 - E(o)) (1 - E(i)) / (1 - mean E), with E = A (1 + r G/pi) the share that a direction returns.
// Twin: src/oracle/bsdf/oren_nayar.rs.
#ifndef OREN_NAYAR_GLSL
#define OREN_NAYAR_GLSL

#include "../math.glsl"

const float FUJII_A = 0.5 - 2.0 / (3.0 * PI);
const float FUJII_MEAN = 2.0 / 3.0 - 28.0 / (15.0 * PI); // mean of G/pi

// G/pi of a direction with that cosine, without the paper's quotient by the cosine.
float fujii_share(float cosine) {
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float rest = sine * cosine * (1.0 + sine + sine * sine) / (1.0 + sine);
    return (sine * (atan2_accurate(sine, cosine) - sine * cosine) + (2.0 / 3.0) * (rest - sine)) * (1.0 / PI);
}

// The lobe that the albedo colours, and that of light which was scattered more than once, over 1/pi.
vec2 oren_nayar_lobes(vec3 normal, vec3 direction, vec3 way, float roughness) {
    vec3 view = direction * -inversesqrt(dot3(direction, direction));
    vec3 light = way * inversesqrt(dot3(way, way));
    float seen = min(max(dot3(normal, view), 0.0), 1.0);
    float lit = min(max(dot3(normal, light), 0.0), 1.0);
    float s = dot3(light, view) - lit * seen;
    float over_t = s > 0.0 ? s / max(lit, seen) : s;
    float a = 1.0 / (1.0 + FUJII_A * roughness);
    float lost = (FUJII_A - fujii_share(seen)) * (FUJII_A - fujii_share(lit)) / (FUJII_A - FUJII_MEAN);
    return vec2(a * (1.0 + roughness * over_t), a * roughness * lost);
}

// The colour of the second lobe: of light that each scattering colours once more.
vec3 scattered_albedo(vec3 albedo, float roughness) {
    float mean = (1.0 + FUJII_MEAN * roughness) / (1.0 + FUJII_A * roughness);
    return albedo * albedo * mean / (1.0 - min(albedo, vec3(1.0)) * (1.0 - mean));
}

#endif
