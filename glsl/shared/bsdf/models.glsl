// The interface to the reflection models: emitted and reflected radiance, whether a material is specular, and whether
// beams know the integral over a region. The only place that distinguishes models, with `specular.glsl` for reflected
// and refracted rays. Twin: src/oracle/bsdf/mod.rs.
#ifndef MODELS_GLSL
#define MODELS_GLSL

#include "../features.glsl"
#include "../layout.glsl"
#include "../material_maps.glsl"
#include "lambert.glsl"
#include "metallic_roughness.glsl"
#include "mirror.glsl"
#include "oren_nayar.glsl"
#include "phong.glsl"
#include "unlit.glsl"

// A material at a hit: the parameters of its lobes, without the direction of the light.
struct Bsdf {
    uint model;
    vec3 albedo;     // the material's colour, times its texture
    vec3 specular;   // colour of the highlight, and its exponent
    float exponent;
    float roughness;
    vec3 normal;     // unit, for shading
    vec3 direction;  // of the ray
    vec3 mirror;     // its mirror reflection
    MetallicRoughness facets;
};

// Irradiance over pi from all lights, weighted by the lobes: the one that the albedo colours, and those of colours of
// their own.
struct Lit {
    vec3 first;
    vec3 second;
    vec3 third;
};

// Some model has the second lobe, or the third.
const bool THIRD_LOBE = HAS(MODELS, MODEL_METALLIC_ROUGHNESS);
const bool SECOND_LOBE = (MODELS & ((1u << MODEL_PHONG) | (1u << MODEL_OREN_NAYAR))) != 0u || THIRD_LOBE || ROUGH_MIRRORS;

// Some model reflects the light of lights. Tested before `is_lit` is called: code behind a call stays in the pipeline.
const bool HAS_LIT = (MODELS & ((1u << MODEL_LAMBERT) | (1u << MODEL_PHONG) | (1u << MODEL_OREN_NAYAR))) != 0u || THIRD_LOBE ||
                     ROUGH_MIRRORS;

// True if it reflects or refracts rays, and nothing else.
bool is_specular(uint model) {
    return MODE_IS(MODELS, MODEL_MIRROR, model) || MODE_IS(MODELS, MODEL_DIELECTRIC, model);
}

// True for a mirror that reflects an environment whose light is sampled.
bool is_rough_mirror(const Material material) {
    return ROUGH_MIRRORS && MODE_IS(MODELS, MODEL_MIRROR, material.model) && material.alpha > 0.0;
}

// True if it reflects the light of lights.
bool is_lit(uint model) {
    return MODE_IS(MODELS, MODEL_PHONG, model) || MODE_IS(MODELS, MODEL_LAMBERT, model) ||
           MODE_IS(MODELS, MODEL_OREN_NAYAR, model) || MODE_IS(MODELS, MODEL_METALLIC_ROUGHNESS, model);
}

// True if beside the light of lights it reflects rays.
bool is_glossy(uint model) { return MODE_IS(MODELS, MODEL_METALLIC_ROUGHNESS, model); }

// Radiance that a material emits, where its colour times what the path carries is `color`.
vec3 emitted(uint model, vec3 color) {
    return MODE_IS(MODELS, MODEL_UNLIT, model) ? unlit_emitted(color) : vec3(0.0);
}

Bsdf bsdf_at(const Material material, const Appearance look, real3 normal, real3 direction) {
    vec3 color = look.color;
    vec3 mirror = HAS(MODELS, MODEL_PHONG) ? vec3(mirrored(direction, normal)) : vec3(0.0);
    float diffuse_roughness = HAS(MODELS, MODEL_OREN_NAYAR) ? sqrt(material.alpha) : 0.0;
    MetallicRoughness facets = MetallicRoughness(vec3(0.0), vec3(0.0), vec3(0.0), 1.0, 0.0, vec3(0.0), vec2(0.0));
    if (MODE_IS(MODELS, MODEL_METALLIC_ROUGHNESS, material.model)) {
        float cosine = float(-dot3(normal, direction) * inverse_root(dot3(direction, direction)));
        facets = metallic_roughness(color, look.metallic, look.roughness, look.dielectric, look.edge, look.transmission, cosine);
    }
    if (ROUGH_MIRRORS) {
        if (is_rough_mirror(material)) facets = MetallicRoughness(vec3(0.0), color, color, material.alpha, 1.0, vec3(0.0), vec2(0.0));
    }
    return Bsdf(material.model, color, material.specular, material.exponent, diffuse_roughness, vec3(normal), vec3(direction),
                mirror, facets);
}

// The lobes over 1/pi, for light from `way`, which need not be a unit vector.
vec3 evaluate(const Bsdf bsdf, vec3 way) {
    vec2 lobes = lambert_lobes();
    float third = 0.0;
    if (HAS(MODELS, MODEL_PHONG)) lobes = phong_lobes(bsdf.mirror, way, bsdf.exponent);
    if (MODE_IS(MODELS, MODEL_OREN_NAYAR, bsdf.model)) {
        lobes = oren_nayar_lobes(bsdf.normal, bsdf.direction, way, bsdf.roughness);
    }
    if (MODE_IS(MODELS, MODEL_METALLIC_ROUGHNESS, bsdf.model)) {
        vec2 facets = facet_lobes(bsdf.normal, bsdf.direction, way, bsdf.facets.alpha);
        lobes = vec2(1.0, facets.x);
        third = facets.y;
    }
    if (ROUGH_MIRRORS && MODE_IS(MODELS, MODEL_MIRROR, bsdf.model)) {
        vec2 facets = facet_lobes(bsdf.normal, bsdf.direction, way, bsdf.facets.alpha);
        lobes = vec2(0.0, facets.x + facets.y);
    }
    return vec3(lobes, third);
}

// Radiance that a lit material reflects to the eye; `color` is the albedo times what the path carries.
vec3 reflected(const Bsdf bsdf, vec3 color, vec3 carried, const Lit lit) {
    vec3 seen = color * lit.first;
    if (MODE_IS(MODELS, MODEL_PHONG, bsdf.model)) {
        seen = with_highlight(seen, carried, bsdf.specular, lit.second);
    }
    if (MODE_IS(MODELS, MODEL_OREN_NAYAR, bsdf.model)) {
        seen += carried * scattered_albedo(bsdf.albedo, bsdf.roughness) * lit.second;
    }
    if (MODE_IS(MODELS, MODEL_METALLIC_ROUGHNESS, bsdf.model)) {
        seen = carried * (bsdf.facets.diffuse * lit.first + bsdf.facets.head_on * lit.second + bsdf.facets.grazing * lit.third);
    }
    if (ROUGH_MIRRORS && MODE_IS(MODELS, MODEL_MIRROR, bsdf.model)) seen = color * lit.second;
    return seen;
}

// True if no light passes the material or comes from it that its model does not know of.
bool is_plain(const Material material) {
    bool opaque = MODE_IS(ALPHA_MODES, ALPHA_OPAQUE, material.alpha_mode) && !(ONE_SIDED && material.one_sided);
    return opaque && (!EMISSIVE || material.emission == vec3(0.0));
}

// True if radiance is the same in all directions, so that it changes with texture and light alone.
bool is_diffuse(uint model) { return MODE_IS(MODELS, MODEL_LAMBERT, model); }

// True if beams know the integral over a region of a flat shape, without a texture; `smooth_normals`: of a shape
// whose shading normals differ from place to place.
bool is_integrable_over_region(const Material material, bool smooth_normals) {
    bool unlit = MODE_IS(MODELS, MODEL_UNLIT, material.model);
    bool mirror = MODE_IS(MODELS, MODEL_MIRROR, material.model);
    bool plain = mirror || MODE_IS(MODELS, MODEL_LAMBERT, material.model);
    if (!is_plain(material)) return false;
    if (!unlit && (!plain || smooth_normals)) return false;
    return !(HAS(SAMPLE_DIMENSIONS, DIMENSION_LOBE) && mirror && material.alpha > 0.0);
}

#endif
