// Ray -> radiance, one hit of the path at a time. Mirrors: colour times the radiance of the reflected ray, up
// to `max depth` times, then black. A ray that hits nothing reads the background, or the environment as if it
// were a surface with a colour alone. Twin: src/oracle/shade.rs.
#ifndef SHADE_GLSL
#define SHADE_GLSL

#include "appearance.glsl"
#include "bsdf/scattering.glsl"
#include "environment.glsl"
#include "light.glsl"
#include "quantities.glsl"
#include "geometry/rays.glsl"

// A path between two hits: the ray, its width, the path's throughput, and the shape that it leaves.
struct Path {
    Ray ray;
    RayDifferential beam;
    vec3 throughput;
    uvec2 random; // random bits for stochastic look-ups at the next hit
    uint skip;
    Candidates candidates; // of a camera ray
    uint depth;
    bool is_alive; // false: the path has ended, the next one starts at the camera
    uint layers;   // surfaces that it has passed by their alpha
    float density; // of the ray, where the environment's light is sampled by other means as well; else 0
    bool diffuse;  // the environment alone counts
};

Path camera_path(const Ray ray, const RayDifferential beam, uvec2 random, const Candidates candidates) {
    return Path(ray, beam, vec3(1.0), random, NO_SHAPE, candidates, 0u, true, 0u, 0.0, false);
}

// Continues a reflected or refracted path; returns false if the material ends it.
bool bounced(const Header header, const Hit hit, Surface surface, const Footprint print, const Material material, const SampleDimensions dimensions,
             inout Path path) {
    if (!is_specular(material.model)) return false;
    Ray ray = path.ray;
    consistent_normal(ray.direction, surface);
    Bounce bounce = sample_bsdf(material, surface, ray.direction, dimensions);
    real3 normal = bounce.mirrored ? surface.geometric_normal : -surface.geometric_normal;
    path.ray = Ray(offset_origin(surface.point, normal, surface.size), bounce.direction, ray.time);
    if (LIT_BY_ENVIRONMENT) path.density = 0.0;
    if (ROUGH_MIRRORS) {
        // Where nothing is seen from the surface by itself, no light is sampled.
        if (is_rough_mirror(material) && is_lit_by_environment(header) && !bounce.is_raised) {
            path.density = mirrored_density(vec3(surface.normal), vec3(ray.direction), vec3(bounce.direction), material.alpha);
        }
    }
    if (FILTERED) {
        RayDifferential beam = path.beam;
        if (bounce.mirrored) {
            path.beam = reflected_differential(beam, ray, hit.t, print, bounce.normal, surface.shape_operator,
                                               surface.curvature);
        } else {
            path.beam = refracted_differential(beam, ray, hit.t, print, bounce.normal, surface.shape_operator,
                                               surface.curvature, bounce.ratio);
        }
    }
    if (GLOSSY) {
        if (bounce.alpha > 0.0) {
            path.throughput *= bounce.leaves ? bounce.weight : 0.0;
            path.beam = widened_differential(header, path.beam, vec3(path.ray.direction), bounce.alpha);
        }
    }
    return bounce.leaves;
}

// Continues a path at a lit surface that reflects what is around it; returns false if it ends there.
bool goes_on(const Header header, const Hit hit, Surface surface, const Footprint print, const Material material, Bsdf bsdf, vec3 carried,
             float occlusion, const SampleDimensions dimensions, inout Path path) {
    bool to_sky = is_lit_by_environment(header);
    if (!is_glossy(bsdf.model) && !to_sky) return false;
    Ray ray = path.ray;
    consistent_normal(ray.direction, surface);
    bsdf.normal = vec3(surface.normal);
    float ratio = TRANSMISSIVE ? index_ratio(material, surface.inside) : 1.0;
    Scattered next = scattered(bsdf, surface, path.throughput, carried, dimensions, to_sky, ratio);
    path.throughput = next.occluded ? next.weight * occlusion : next.weight;
    path.density = next.density;
    path.diffuse = next.diffuse;
    real3 side = surface.geometric_normal;
    if (TRANSMISSIVE) side = next.through ? -side : side;
    path.ray = Ray(offset_origin(surface.point, side, surface.size), next.direction, ray.time);
    if (FILTERED) {
        RayDifferential beam = reflected_differential(path.beam, ray, hit.t, print, surface.normal, surface.shape_operator, surface.curvature);
        if (TRANSMISSIVE) {
            if (next.through) {
                beam = refracted_differential(path.beam, ray, hit.t, print, next.facet, surface.shape_operator, surface.curvature, ratio);
            }
        }
        path.beam = widened_differential(header, beam, vec3(next.direction), next.alpha);
    }
    return next.leaves;
}

// Continues a path straight behind a surface that lets some of its light pass.
void passes(const Hit hit, const Surface surface, const Footprint print, inout Path path) {
    Ray ray = path.ray;
    path.ray.origin = offset_origin(surface.point, -surface.geometric_normal, surface.size);
    path.layers++;
    if (FILTERED) path.beam = refracted_differential(path.beam, ray, hit.t, print, surface.geometric_normal, FLAT, 0.0, 1.0);
}

// A number in [0, 1) by which a sample passes a surface or not.
float layer_choice(const Path path) {
    return unit_line(pcg2d(path.random ^ 0xA511E9B3u).x >> 8u);
}

// The share with which the environment's light counts that a ray meets by chance.
float sky_weight(const Header header, const Path path) {
    if (!LIT_BY_ENVIRONMENT || path.density <= 0.0) return 1.0;
    return path.density / (path.density + sky_density(header, vec3(path.ray.direction)));
}

// Follows the path to its next hit; returns the radiance that it adds to the sample.
vec3 advance(const Header header, const Points points, const SampleDimensions dimensions, inout Path path) {
    Hit hit = nearest_hit(path.ray, path.skip, path.candidates);
    bool missed = hit.shape == NO_SHAPE;
    if (LIT_BY_ENVIRONMENT) {
        if (missed) path.throughput *= sky_weight(header, path);
    }
    vec3 seen = MEASURES ? vec3(0.0) : path.throughput * header.background;
    bool is_alive = false;
    bool has_passed = false;
    // From here on, a ray that hits nothing is treated as a hit.
    bool surrounded = ENVIRONMENT && header.environment_material != NO_MATERIAL;
    if (surrounded || !missed) {
        if (ENVIRONMENT) hit.shape = missed ? 0u : hit.shape;
        Surface surface = hit_surface(path.ray, hit);
        Footprint print = footprint_at(header, path.beam, path.ray, hit.t, surface.geometric_normal);
        if (ENVIRONMENT && missed) {
            surface.link = uvec2(header.environment_material, header.environment_projection);
            if (VERTEX_COLORS) surface.attributes.color = vec4(1.0);
            print = endless_footprint(header, path.beam, path.ray);
        }
        Material material = material_at(surface.link.x);
        UvProjection map = uv_projection_at(surface.link.y);
        if (MEASURES) {
            seen = measured(header, hit, missed, material, map, path.ray, path.random, surface, print);
        } else {
            vec3 carried = path.throughput;
            Appearance look = appearance(material, map, path.ray, surface, print, path.random);
            path.throughput *= look.color;
            real3 direction = path.ray.direction;
            Path before = path;
            bool continues = BOUNCES && path.depth < header.max_depth;
            Bsdf bsdf;
            if (HAS_LIT) {
                bsdf = bsdf_at(material, look, surface.normal, direction);
            }
            is_alive = BOUNCES && bounced(header, hit, surface, print, material, dimensions, path);
            if (BOUNCES && HAS_LIT && (THIRD_LOBE || LIT_BY_ENVIRONMENT)) {
                if (is_lit(material.model)) {
                    is_alive = goes_on(header, hit, surface, print, material, bsdf, carried, look.occlusion, dimensions, path);
                }
            }
            seen = emitted(material.model, before.throughput);
            bool mirrors = false;
            if (ROUGH_MIRRORS) {
                mirrors = continues && is_rough_mirror(material) && is_lit_by_environment(header);
                if (mirrors) consistent_normal(direction, surface);
                bsdf.normal = vec3(surface.normal);
            }
            if (HAS_LIT) {
                if (is_lit(material.model) || mirrors) {
                    Lit lit = direct_light(header, surface, path.ray.time, hit.shape, bsdf, points, dimensions, look.occlusion, continues, before.random);
                    seen = reflected(bsdf, before.throughput, carried, lit);
                }
            }
            if (EMISSIVE) seen += carried * look.emission;
            if (LIT_BY_ENVIRONMENT) {
                if (before.diffuse && !missed) {
                    seen = vec3(0.0);
                    is_alive = false;
                }
            }
            if (TRANSPARENT) {
                float share = missed ? 1.0 : covered_share(material, surface, look.opacity);
                seen *= share;
                // A surface that ends paths is passed by all of what it does not cover, others by a part of the samples.
                bool splits = !is_alive || !continues;
                float passed = splits ? 1.0 - share : 1.0;
                has_passed = splits ? share < 1.0 : share <= layer_choice(before);
                if (has_passed && !missed) {
                    path = before;
                    path.throughput = carried * passed;
                    passes(hit, surface, print, path);
                    is_alive = path.layers < MAX_LAYERS;
                    count_diagnostic(DIAGNOSTIC_LAYERS, !is_alive);
                }
                has_passed = has_passed && !missed;
            }
        }
    }
    path.skip = hit.shape;
    path.candidates = ANYTHING;
    bool too_deep = !has_passed && path.depth >= header.max_depth;
    count_diagnostic(DIAGNOSTIC_DEPTH, is_alive && too_deep);
    path.is_alive = is_alive && !too_deep;
    path.depth += has_passed ? 0u : 1u;
    if (BOUNCES && RANDOM) path.random = pcg2d(path.random);
    return seen;
}

#endif
