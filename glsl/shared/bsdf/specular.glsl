// Mirrors and glass, smooth or of facets: the ray that leaves them, by chance one of the two that glass sends on.
// Twin: src/oracle/bsdf/specular.rs.
#ifndef SPECULAR_GLSL
#define SPECULAR_GLSL

#include "../shading_normal.glsl"
#include "dielectric.glsl"
#include "facets.glsl"
#include "models.glsl"

// The ray that leaves a specular surface.
struct Bounce {
    real3 direction;
    real3 normal;   // of the surface, or of the facet that the ray met
    float ratio;    // of refractive indices, before over behind
    float alpha;    // of the facets; 0: there are none
    float weight;   // what facets let pass of its light
    bool mirrored;  // else refracted
    bool leaves;    // false: a facet sends it into the surface
    bool is_raised; // it would have entered the surface
};

// Ratio of the refractive indices before and behind a surface.
float index_ratio(const Material material, bool inside) {
    return inside ? material.ior : 1.0 / material.ior;
}

// Share of the light that is mirrored; the rest is refracted.
real mirrored_share(const Material material, real3 direction, real3 normal, float ratio) {
    real share = 1.0;
    if (MODE_IS(MODELS, MODEL_DIELECTRIC, material.model)) share = fresnel_dielectric(direction, normal, ratio);
    return share;
}

// The mirrored or the refracted way, on its own side of surfaces whose normals lean; `is_raised`: moved there.
real3 bounced_way(real3 direction, real3 normal, const Surface surface, float ratio, bool mirror, out bool is_raised) {
    real3 way = direction;
    if (mirror) way = mirrored(direction, normal);
    else way = refracted(direction, normal, ratio);
    real side = mirror ? 1.0 : -1.0;
    is_raised = false;
    if (LEANING) {
        real3 other = on_its_side(direction, way, side * surface.normal, side * surface.geometric_normal);
        is_raised = other != way;
        way = other;
    }
    return way;
}

// A sample of what a specular material sends on.
Bounce sample_bsdf(const Material material, const Surface surface, real3 direction, const SampleDimensions dimensions) {
    float alpha = GLOSSY ? material.alpha : 0.0;
    real3 normal = surface.normal;
    if (GLOSSY) {
        if (alpha > 0.0) normal = visible_normal(vec3(direction), vec3(surface.normal), alpha, unit_square(dimensions.lobe));
    }
    float ratio = index_ratio(material, surface.inside);
    bool mirror = true;
    if (HAS(MODELS, MODEL_DIELECTRIC)) {
        mirror = unit_line(dimensions.fresnel) < mirrored_share(material, direction, normal, ratio);
    }
    bool is_raised;
    real3 way = bounced_way(direction, normal, surface, ratio, mirror, is_raised);
    Bounce bounce = Bounce(way, normal, ratio, alpha, 1.0, mirror, true, is_raised);
    if (GLOSSY) {
        if (alpha > 0.0) {
            real3 outward = mirror ? way : -way;
            float seen = float(-dot3(direction, surface.normal) * inverse_root(dot3(direction, direction)));
            float leaving = float(dot3(outward, surface.normal) * inverse_root(dot3(outward, outward)));
            // Light that a facet reflects into the surface is lost.
            bounce.leaves = leaving > 0.0 && dot3(outward, surface.geometric_normal) > 0.0;
            bounce.weight = mirror ? smith_g2_over_g1(max(seen, 0.0), leaving, alpha) : smith_g1_refracted(leaving, alpha);
        }
    }
    return bounce;
}

#endif
