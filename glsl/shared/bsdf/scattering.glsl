// How a lit surface continues a path: by one of its facets, through the body, or, where the environment lights surfaces, by
// its diffuse lobe to that alone. Light that the environment sends by a sampled direction of its own and by such a ray counts with
// the balance heuristic (Veach 1997, 9.2), each lobe by itself. Twin: src/oracle/bsdf/scattering.rs.
#ifndef SCATTERING_GLSL
#define SCATTERING_GLSL

#include "models.glsl"
#include "specular.glsl"

// The environment lights surfaces, by chance as other lights with an extent.
const bool LIT_BY_ENVIRONMENT = HAS(LIGHT_KINDS, LIGHT_ENVIRONMENT);

bool is_lit_by_environment(const Header header) {
    return LIT_BY_ENVIRONMENT && header.environment_rows != 0u;
}

// The ray by which a lit surface continues a path.
struct Scattered {
    real3 direction;
    vec3 weight;     // of its light
    float density;   // over solid angle; 0 where nothing else samples this light
    float alpha;     // of the lobe
    bool diffuse;    // the environment alone counts
    bool occluded;   // by what keeps its diffuse light away
    bool leaves;     // false: it enters the surface
    bool through;    // to the other side of the surface
    real3 facet;     // normal of what refracted it
};

// Facets of the least roughness refract as a smooth surface does.
const float SMOOTH_ALPHA = 0.001;

// Some highlight reflects the environment.
const bool HIGHLIGHTS = HAS(MODELS, MODEL_PHONG) && LIT_BY_ENVIRONMENT;

// Share of the bounces that facets have, or Phong's highlight. `to_sky`: the environment lights surfaces.
float facet_bounces(const Bsdf bsdf, bool to_sky) {
    if (HIGHLIGHTS && MODE_IS(MODELS, MODEL_PHONG, bsdf.model)) {
        float highlight = luminance(bsdf.specular);
        float all = highlight + luminance(bsdf.albedo);
        return all > 0.0 && to_sky ? highlight / all : 0.0;
    }
    if (ROUGH_MIRRORS && MODE_IS(MODELS, MODEL_MIRROR, bsdf.model)) return 1.0;
    if (!is_glossy(bsdf.model)) return 0.0;
    return to_sky ? bsdf.facets.bounced : 1.0;
}

// Share of the rays that pass the body.
float passing_share(const Bsdf bsdf, bool to_sky) {
    if (!TRANSMISSIVE) return 0.0;
    return to_sky ? bsdf.facets.passing.y : bsdf.facets.passing.x;
}

// Densities with which `scattered` chooses a way, by the diffuse lobe and by facets.
vec2 scattered_densities(const Bsdf bsdf, vec3 way) {
    float facets = facet_bounces(bsdf, true);
    float cosine = max(dot3(bsdf.normal, way) * inversesqrt(dot3(way, way)), 0.0);
    vec2 densities = vec2((1.0 - facets) * cosine * (1.0 / PI), 0.0);
    if (is_glossy(bsdf.model) || (ROUGH_MIRRORS && MODE_IS(MODELS, MODEL_MIRROR, bsdf.model))) {
        densities.y = facets * mirrored_density(bsdf.normal, bsdf.direction, way, bsdf.facets.alpha);
    }
    if (HIGHLIGHTS) {
        if (MODE_IS(MODELS, MODEL_PHONG, bsdf.model)) densities.y = facets * highlight_density(bsdf.mirror, way, bsdf.exponent);
    }
    if (TRANSMISSIVE) densities *= 1.0 - passing_share(bsdf, true);
    return densities;
}

// Lobes of light that is sampled with `density`, where `scattered` samples it as well.
vec3 balanced_lobes(const Bsdf bsdf, vec3 lobes, vec3 way, float density) {
    vec2 others = scattered_densities(bsdf, way);
    float diffuse = density / (density + others.x);
    float facets = density / (density + others.y);
    bool both_diffuse = MODE_IS(MODELS, MODEL_OREN_NAYAR, bsdf.model);
    return lobes * vec3(diffuse, both_diffuse ? diffuse : facets, facets);
}

// A sample of the light that passes a body: refracted, or mirrored where nothing is refracted (Snell). Nothing else samples it.
Scattered passed(const Bsdf bsdf, const Surface surface, vec3 carried, vec2 square, float ratio) {
    float alpha = bsdf.facets.alpha > SMOOTH_ALPHA ? bsdf.facets.alpha : 0.0;
    real3 direction = real3(bsdf.direction);
    real3 facet = surface.normal;
    if (alpha > 0.0) facet = real3(visible_normal(bsdf.direction, bsdf.normal, alpha, square));
    bool through = straight_behind(direction, facet, ratio) > 0.0;
    bool is_raised;
    real3 way = bounced_way(direction, facet, surface, ratio, !through, is_raised);
    vec3 weight = carried * bsdf.facets.transmitted;
    bool leaves = true;
    if (alpha > 0.0) {
        real3 outward = through ? -way : way;
        float seen = float(-dot3(direction, surface.normal) * inverse_root(dot3(direction, direction)));
        float leaving = float(dot3(outward, surface.normal) * inverse_root(dot3(outward, outward)));
        leaves = leaving > 0.0;
        weight *= through ? smith_g1_refracted(leaving, alpha) : smith_g2_over_g1(max(seen, 0.0), leaving, alpha);
    }
    return Scattered(way, weight, 0.0, alpha, false, false, leaves, through, facet);
}

// A sample of the ways by which a lit surface reflects what is around it, or lets it through. Its normal is towards the ray;
// `ratio` of refractive indices, before over behind.
Scattered scattered(const Bsdf bsdf, const Surface surface, vec3 color, vec3 carried, const SampleDimensions dimensions, bool to_sky, float ratio) {
    vec2 square = unit_square(dimensions.lobe);
    float passing = passing_share(bsdf, to_sky);
    bool passes_body = false;
    if (TRANSMISSIVE) {
        passes_body = square.x < passing;
        float kept = passes_body ? square.x / max(passing, 1e-6) : (square.x - passing) / max(1.0 - passing, 1e-6);
        square.x = min(kept, 1.0 - 1.0 / 16777216.0);
    }
    vec2 first = square;
    float facets = facet_bounces(bsdf, to_sky);
    bool by_facet = square.x < facets;
    // The choice leaves a number that is uniform again.
    float rest = by_facet ? square.x / max(facets, 1e-6) : (square.x - facets) / max(1.0 - facets, 1e-6);
    square.x = min(rest, 1.0 - 1.0 / 16777216.0);
    vec3 n = bsdf.normal;
    vec2 disc = concentric_disc(square);
    vec3 way = around(n, vec3(disc, sqrt(max(1.0 - (disc.x * disc.x + disc.y * disc.y), 0.0))));
    float cosine = max(dot3(n, way), 0.0);
    Scattered next = Scattered(real3(way), vec3(0.0), 0.0, 1.0, true, true, true, false, surface.normal);
    if (LIT_BY_ENVIRONMENT && to_sky) {
        vec3 lobes = evaluate(bsdf, way);
        bool second = MODE_IS(MODELS, MODEL_OREN_NAYAR, bsdf.model);
        next.weight = reflected(bsdf, color, carried, Lit(vec3(lobes.x), vec3(second ? lobes.y : 0.0), vec3(0.0))) / max(1.0 - facets, 1e-6);
        next.density = (1.0 - facets) * cosine * (1.0 / PI);
    }
    if (HIGHLIGHTS) {
        if (MODE_IS(MODELS, MODEL_PHONG, bsdf.model) && by_facet) {
            vec3 highlight = sampled_highlight(bsdf.mirror, disc, bsdf.exponent);
            float above = dot3(n, highlight);
            next.direction = real3(highlight);
            next.weight = carried * bsdf.specular * ((bsdf.exponent + 2.0) / (bsdf.exponent + 1.0) * max(above, 0.0) / max(facets, 1e-6));
            next.density = facets * highlight_density(bsdf.mirror, highlight, bsdf.exponent);
            next.alpha = sqrt(2.0 / (bsdf.exponent + 2.0));
            next.occluded = false;
            next.leaves = above > 0.0;
        }
    }
    if (is_glossy(bsdf.model)) {
        float alpha = bsdf.facets.alpha;
        vec3 facet = visible_normal(bsdf.direction, n, alpha, square);
        vec3 view = bsdf.direction * -inversesqrt(dot3(bsdf.direction, bsdf.direction));
        vec3 mirror = vec3(mirrored(real3(-view), real3(facet)));
        float leaving = dot3(n, mirror);
        float rise = schlick(dot3(view, facet));
        float passes = smith_g2_over_g1(max(dot3(n, view), 1e-4), max(leaving, 1e-6), alpha) / max(facets, 1e-6);
        if (by_facet) {
            next.direction = real3(mirror);
            next.weight = carried * (bsdf.facets.head_on * (1.0 - rise) + bsdf.facets.grazing * rise) * passes;
            next.density = to_sky ? facets * mirrored_density(n, bsdf.direction, mirror, alpha) : 0.0;
            next.alpha = alpha;
            next.diffuse = false;
            next.occluded = false;
            next.leaves = leaving > 0.0;
        }
    }
    if (TRANSMISSIVE) {
        next.weight /= max(1.0 - passing, 1e-6);
        next.density *= 1.0 - passing;
        if (passes_body) {
            next = passed(bsdf, surface, carried, first, ratio);
            next.weight /= max(passing, 1e-6);
        }
    }
    real above = dot3(next.direction, surface.geometric_normal);
    next.leaves = next.leaves && (next.through ? -above : above) > 0.0;
    return next;
}

#endif
