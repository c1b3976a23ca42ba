// Glossy mirrors and glass: facets whose normals follow GGX (Walter et al. 2007). A sample takes one of those
// that its ray can see (Heitz 2018; sampled as by Dupuy & Benyoub 2023) and is weighted by how much of that
// facet's light others do not hold back, G2 / G1 of Smith. alpha = roughness². Twin: src/oracle/bsdf/facets.rs.
#ifndef FACETS_GLSL
#define FACETS_GLSL

#include "../sample_dimensions.glsl"
#include "../footprint.glsl"
#include "mirror.glsl"

// The normal of a facet that a ray along `direction` meets, on a surface with unit normal n against the ray.
// In a space stretched by alpha the facets are those of a sphere: the half vectors of a cap and the view.
vec3 visible_normal(vec3 direction, vec3 n, float alpha, vec2 square) {
    vec3 tangent = any_tangent(n);
    vec3 bitangent = cross3(n, tangent);
    vec3 view = -vec3(alpha * dot3(direction, tangent), alpha * dot3(direction, bitangent), min(dot3(direction, n), 0.0));
    view *= inversesqrt(max(dot3(view, view), 1e-30));
    vec3 sum = on_cap(concentric_disc(square), 1.0 + view.z) + view;
    vec3 local = vec3(alpha * sum.x, alpha * sum.y, max(sum.z, 0.0));
    return around(n, local * inversesqrt(max(dot3(local, local), 1e-30)));
}

// 2 z / (z + smith) is G1 of a direction whose cosine is z.
float smith(float cosine, float alpha) {
    return sqrt(cosine * cosine + alpha * alpha * max(1.0 - cosine * cosine, 0.0));
}

// G2 / G1 of reflection, heights correlated (Heitz 2014).
float smith_g2_over_g1(float seen, float leaving, float alpha) {
    float a = smith(seen, alpha);
    return leaving * (seen + a) / (a * leaving + smith(leaving, alpha) * seen);
}

// G2 / G1 of refraction, whose two sides are taken as independent: G1 of the way that leaves.
float smith_g1_refracted(float leaving, float alpha) {
    return 2.0 * leaving / (leaving + smith(leaving, alpha));
}

// The beam as wide as the part of the lobe that a sample stands for: about half of a lobe's light lies within
// 2 alpha, as mirrors turn a ray by twice what their normal turns.
RayDifferential widened_differential(const Header header, const RayDifferential beam, vec3 direction, float alpha) {
    if (!FILTERED) return beam;
    float size = sqrt(dot3(direction, direction));
    float by = 2.0 * alpha * float(header.sample_side) * size;
    RayDifferential next = beam;
    if (DIFFERENTIALS) {
        vec3 unit = direction / size;
        vec3 x = beam.direction_x - dot3(unit, beam.direction_x) * unit;
        float squared = dot3(x, x);
        vec3 first = squared > 0.0 ? x * inversesqrt(squared) : any_tangent(unit);
        vec3 second = cross3(unit, first);
        next.direction_x = beam.direction_x + by * first;
        next.direction_y = beam.direction_y + (dot3(second, beam.direction_y) < 0.0 ? -by : by) * second;
    }
    if (CONES) next.spread = beam.spread + by;
    return next;
}

#endif
