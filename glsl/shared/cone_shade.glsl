// Cone -> radiance: each visible fragment is shaded once, at the centroid of its visible part, with a
// footprint of that size; mirrors and glass spawn narrower cones, glass two of them, weighted by the Fresnel
// equations. A light is one more cone, from the footprint to the light, so that a shadow's edge is
// fractional. All pending cones are in one list and are traced by one piece of code, as a thread group
// executes all code that any of its threads needs. Nothing is random. Twin: src/oracle/cone_shade.rs.
#ifndef CONE_SHADE_GLSL
#define CONE_SHADE_GLSL

#include "fragments.glsl"
#include "shade.glsl"

// Most pending cones, most cones per pixel, and the least weight of a cone. Anything beyond is dropped.
const uint MAX_WAITING = BOUNCES || SHADOWS ? 32u : 1u;
const uint CONE_LIMIT = BOUNCES || SHADOWS ? MAX_CONES : 1u;
const float MIN_WEIGHT = 1.0 / 1024.0;

// A pending cone.
struct Branch {
    Ray ray;
    float width;
    float spread;
    vec3 weight;
    uint skip;
    uint depth; // bounces before it, or TO_POINT_LIGHT, TO_FAR_LIGHT
};

// Replaces a depth: the weight is a light's contribution, in proportion to its visibility.
const uint TO_POINT_LIGHT = 0x80000000u;
const uint TO_FAR_LIGHT = 0x80000001u;

Branch waiting[MAX_WAITING];
uint waiting_count;
float dropped; // sum of the dropped weights

RayDifferential cone_beam(float width, float spread) {
    return RayDifferential(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), width, spread);
}

// Returns the largest absolute value of a channel; NaN and infinity count as 1, so that they stay visible.
float largest(vec3 v) {
    if (NONFINITE) {
        // Tested by the bits: compilers optimise comparisons for finite values.
        if (any(equal(floatBitsToUint(v) & 0x7F800000u, uvec3(0x7F800000u)))) return 1.0;
    }
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

void send(Branch branch) {
    if (waiting_count == MAX_WAITING) {
        count_diagnostic(DIAGNOSTIC_PIECES, true);
        dropped += largest(branch.weight);
        return;
    }
    waiting[waiting_count] = branch;
    waiting_count++;
}

// Returns the contribution of an unoccluded light by way of a surface, and the cone that tests its
// visibility: as wide as the footprint seen from the light, where it ends in a point.
Branch lit_branch(Branch branch, const Bsdf bsdf, vec3 carried, const Hit hit, const Surface surface, const Footprint print, uint skip, const Light light) {
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind) || MODE_IS(LIGHT_KINDS, LIGHT_SPOT, light.kind);
    vec3 way = point_light ? light.position - surface.point : light.direction;
    float squared = dot3(way, way);
    float facing = dot3(surface.normal, way);
    float share = point_light ? facing / (squared * sqrt(squared)) : facing;
    float above = dot3(surface.geometric_normal, way);
    if (!(facing > 0.0 && above > 0.0)) share = 0.0;
    if (RANGED && point_light) share *= punctual_share(light, way);
    vec3 more = light.power * (share * (1.0 / PI));
    vec3 lobes = evaluate(bsdf, way);
    vec3 seen = reflected(bsdf, branch.weight, carried, Lit(more * lobes.x, more * lobes.y, more * lobes.z));
    if (!SHADOWS) return Branch(branch.ray, 0.0, 0.0, seen, skip, 0u);
    vec3 start = offset_origin(surface.point, surface.geometric_normal, surface.size);
    vec3 to_light = point_light ? light.position - start : light.direction;
    vec3 across = cross3(print.point_x, print.point_y);
    float width = sqrt(sqrt(dot3(across, across)) * (max(above, 0.0) * inversesqrt(squared)));
    return Branch(Ray(start, to_light, 0.0), width, point_light ? -width : 0.0, seen, skip,
                  point_light ? TO_POINT_LIGHT : TO_FAR_LIGHT);
}

// Returns the cone reflected by a mirror or glass, or refracted if `through`.
Branch bent_branch(Branch branch, const Hit hit, const Surface surface, const Footprint print, float ratio, float share, uint skip, bool through) {
    Ray ray = branch.ray;
    RayDifferential beam = cone_beam(branch.width, branch.spread);
    vec3 direction;
    if (through) {
        beam = refracted_differential(beam, ray, hit.t, print, surface.normal, surface.shape_operator, surface.curvature, ratio);
        direction = refracted(ray.direction, surface.normal, ratio);
        if (LEANING) direction = on_its_side(ray.direction, direction, -surface.normal, -surface.geometric_normal);
    } else {
        beam = reflected_differential(beam, ray, hit.t, print, surface.normal, surface.shape_operator, surface.curvature);
        direction = mirrored(ray.direction, surface.normal);
    }
    vec3 start = offset_origin(surface.point, through ? -surface.geometric_normal : surface.geometric_normal, surface.size);
    return Branch(Ray(start, direction, 0.0), beam.width, beam.spread, branch.weight * share, skip, branch.depth + 1u);
}

// Returns the radiance of a part of a cone: of a shape, or of the background behind all shapes. `branch` is
// that part.
vec3 shade_part(const Header header, Branch branch, uint shape) {
    bool missed = ENVIRONMENT && shape == NO_SHAPE;
    Ray ray = branch.ray;
    Hit hit = Hit(1.0, 0u, vec2(0.0));
    if (!missed) hit = meet(ray, shape);
    // Cones know no outline of a concave shape, so that the ray may pass it.
    if (!missed && hit.t <= 0.0 && is_concave(shape)) return branch.weight * header.background;
    Surface surface = hit_surface(ray, hit);
    RayDifferential beam = cone_beam(branch.width, branch.spread);
    Footprint print = footprint_at(header, beam, ray, hit.t, surface.geometric_normal);
    if (missed) {
        surface.link = uvec2(header.environment_material, header.environment_projection);
        print = endless_footprint(header, beam, ray);
    }
    Material material = material_at(surface.link.x);
    vec3 carried = branch.weight;
    if (VERTEX_COLORS && missed) surface.attributes.color = vec4(1.0);
    Appearance look = appearance(material, uv_projection_at(surface.link.y), ray, surface, print, uvec2(0u));
    branch.weight *= look.color;
    bool lit = HAS_LIT && is_lit(material.model);
    vec3 sum = vec3(0.0);
    if (EMISSIVE) sum = carried * look.emission;
    if (!lit && !is_specular(material.model)) return sum + emitted(material.model, branch.weight);
    Bsdf bsdf;
    if (HAS_LIT) {
        bsdf = bsdf_at(material, look, surface.normal, ray.direction);
    }
    if (!lit) consistent_normal(ray.direction, surface);
    float ratio = index_ratio(material, surface.inside);
    float back = mirrored_share(material, ray.direction, surface.normal, ratio);
    // Secondary cones: those to the lights, or the refracted and then the reflected one, which as the last is
    // traced first.
    uint branches = lit ? COUNT(LIGHTS, lengths.lights) : (BOUNCES && branch.depth < header.max_depth ? 2u : 0u);
    for (uint i = 0u; i < branches; i++) {
        bool through = BOUNCES && !lit && i == 0u;
        uint skip = left_shape(hit.shape, surface.inside != through);
        Branch next = branch;
        if (lit) {
            next = lit_branch(branch, bsdf, carried, hit, surface, print, skip, light_at(i));
        } else if (BOUNCES) {
            next = bent_branch(branch, hit, surface, print, ratio, through ? 1.0 - back : back, skip, through);
        }
        float weight = largest(next.weight);
        if (lit && !SHADOWS) sum += next.weight;
        else if (weight > 0.0 && (lit || weight >= MIN_WEIGHT)) send(next);
        else if (!lit) dropped += weight;
    }
    return sum;
}

// Returns the part of a branch that is visible around `center` of its cone.
Branch part_of(Branch branch, const Cone cone, Covered covered, float norm) {
    float side = sqrt(covered.share);
    branch.ray = ray_at(cone, covered.center);
    branch.width *= side;
    branch.spread *= side;
    branch.weight *= covered.share * norm;
    return branch;
}

// Returns the radiance of the cone around a camera ray, and in w the weight that was dropped.
vec4 trace_cone(const Header header, const Ray ray, const RayDifferential beam) {
    vec3 sum = vec3(0.0);
    dropped = 0.0;
    waiting[0] = Branch(ray, beam.width, beam.spread, vec3(1.0), NO_SHAPE, 0u);
    waiting_count = 1u;
    for (uint traced = 0u; traced < CONE_LIMIT && waiting_count > 0u; traced++) {
        waiting_count--;
        Branch branch = waiting[waiting_count];
        vec3 across = branch.depth == 0u ? header.step_x : vec3(0.0);
        Cone cone = cone_of(branch.ray, cone_beam(branch.width, branch.spread), across);
        cone = leaving(cone, branch.skip);
        bool to_light = SHADOWS && branch.depth >= TO_POINT_LIGHT;
        collect_fragments(cone, branch.skip, to_light && branch.depth == TO_POINT_LIGHT ? 1.0 : FAR);
        Covered rest = composite(cone);
        if (to_light) {
            sum += branch.weight * (rest.share * clear);
            continue;
        }
        // Fragments that were kept represent those that were not.
        float replaced = rest.share * (1.0 - clear);
        float norm = 1.0 + replaced / max(1.0 - rest.share, MIN_SHARE);
        dropped += largest(branch.weight) * replaced;
        count_diagnostic(DIAGNOSTIC_PIECES, replaced > 0.0);
        rest.share -= replaced;
        // An environment is one more part, behind all fragments.
        bool surrounded = ENVIRONMENT && header.environment_material != NO_MATERIAL;
        uint parts = piece_count + (surrounded && rest.share > 0.0 ? 1u : 0u);
        for (uint i = 0u; i < parts; i++) {
            Covered part = rest;
            uint shape = NO_SHAPE;
            if (!ENVIRONMENT || i < piece_count) {
                Fragment fragment = piece_at(i);
                part = Covered(fragment.seen, fragment.center);
                shape = fragment.shape;
            }
            if (part.share > 0.0) sum += shade_part(header, part_of(branch, cone, part, shape == NO_SHAPE ? 1.0 : norm), shape);
        }
        if (!surrounded) sum += (branch.weight * rest.share) * header.background;
    }
    for (uint k = 0u; k < MAX_WAITING; k++) if (k < waiting_count) dropped += largest(waiting[k].weight);
    return vec4(sum, dropped);
}

#endif
