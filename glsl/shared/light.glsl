// What lights send to a surface: Lambert, albedo/pi · I cos/r² (point) or albedo/pi · E cos
// (directional), hard shadows; beside it the highlight of Phong, energy-normalised: specular (n + 2)/2pi
// cos^n of the angle to the mirror direction (Lafortune & Willems 1994). Twin: src/oracle/light.rs.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL

#include "surface.glsl"

// Irradiance over pi from all lights: what an albedo of 1 sends on, and a specular colour of 1.
struct Lit {
    vec3 diffuse;
    vec3 specular;
};

// cos^n alpha (n + 2) / 2 between the mirror direction and the way to the light.
float phong_lobe(vec3 mirror, vec3 way, float exponent) {
    float cosine = dot3(mirror, way) * inversesqrt(dot3(mirror, mirror) * dot3(way, way));
    float power = cosine > 0.0 ? exponent * log2_accurate(max(min(cosine, 1.0), 1e-30)) : -126.0;
    return power > -126.0 ? exp2_accurate(power) * (0.5 * exponent + 1.0) : 0.0;
}

Lit direct_light(Header header, Surface surface, uint shape, vec3 mirror, float exponent) {
    Lit sum = Lit(vec3(0.0), vec3(0.0));
    uint lights = COUNT(LIGHTS, header.key.y);
    vec3 start = SHADOWS ? offset_origin(surface.point, surface.geometric_normal) : surface.point;
    for (uint i = 0u; i < lights; i++) {
        Light light = light_at(i);
        bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.link.x);
        vec3 way = point_light ? light.place.xyz - surface.point : light.place.xyz;
        float squared = dot3(way, way);
        float facing = dot3(surface.normal, way);
        // Point: cos/r² = n·l / r³ with the unnormalised l. Directional: l is a unit vector.
        float share = point_light ? facing / (squared * sqrt(squared)) : facing;
        bool lit = facing > 0.0 && dot3(surface.geometric_normal, way) > 0.0;
        if (lit) {
            if (SHADOWS) {
                vec3 to_light = point_light ? light.place.xyz - start : light.place.xyz;
                lit = !occluded(header, Ray(start, to_light), point_light ? 1.0 : FAR, shape);
            }
            vec3 more = light.power.xyz * (share * (1.0 / PI));
            vec3 diffuse = sum.diffuse + more;
            sum.diffuse = lit ? diffuse : sum.diffuse;
            if (HAS(MODELS, MODEL_PHONG)) {
                vec3 specular = sum.specular + more * phong_lobe(mirror, way, exponent);
                sum.specular = lit ? specular : sum.specular;
            }
        }
    }
    return sum;
}

#endif
