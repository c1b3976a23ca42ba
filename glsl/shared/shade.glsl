// Ray -> radiance, one hit of the path at a time. Mirrors: colour times the radiance of the reflected ray, up
// to `max depth` times, then black. A ray that hits nothing reads the background, or the environment as if it
// were a surface with a colour alone. Twin: src/oracle/shade.rs.
#ifndef SHADE_GLSL
#define SHADE_GLSL

#include "bsdf/specular.glsl"
#include "filter/sample_texture.glsl"
#include "light.glsl"
#include "quantities.glsl"
#include "shading_normal.glsl"
#include "geometry/rays.glsl"

// Returns the inputs of the surface's mapping.
MapInput map_input(const UvProjection map, const Ray ray, const Surface surface, const Footprint print) {
    MapInput seen = MapInput(surface.at_rest, vec3(0.0), vec3(0.0), surface.own_uv, vec2(0.0), vec2(0.0), false);
    uint entity = map.entity;
    if (DERIVATIVES) {
        seen.entity_x = print.point_x;
        seen.entity_y = print.point_y;
        seen.own_x = vec2(dot3(surface.own_u, print.point_x), dot3(surface.own_v, print.point_x));
        seen.own_y = vec2(dot3(surface.own_u, print.point_y), dot3(surface.own_v, print.point_y));
    }
    if (MODE_IS(ENTITIES, ENTITY_POSITION, entity)) return seen;
    vec3 bent_x = normal_change(surface.shape_operator, print.point_x);
    vec3 bent_y = normal_change(surface.shape_operator, print.point_y);
    if (MODE_IS(ENTITIES, ENTITY_NORMAL, entity)) {
        seen.entity = surface.normal;
        seen.entity_x = bent_x;
        seen.entity_y = bent_y;
        return seen;
    }
    real3 way = ray.direction;
    vec3 way_x = print.direction_x;
    vec3 way_y = print.direction_y;
    if (MODE_IS(ENTITIES, ENTITY_REFLECTION, entity)) {
        Surface mirror = surface;
        consistent_normal(ray.direction, mirror);
        way_x = mirrored_change(vec3(way), vec3(mirror.normal), way_x, normal_change(mirror.shape_operator, print.point_x));
        way_y = mirrored_change(vec3(way), vec3(mirror.normal), way_y, normal_change(mirror.shape_operator, print.point_y));
        way = mirrored(way, mirror.normal);
    }
    // Of unit length; the change is perpendicular to it.
    real size = inverse_root(dot3(way, way));
    seen.entity = way * size;
    if (DERIVATIVES) {
        vec3 unit = vec3(seen.entity);
        float scale = float(size);
        seen.entity_x = (way_x - dot3(unit, way_x) * unit) * scale;
        seen.entity_y = (way_y - dot3(unit, way_y) * unit) * scale;
    }
    return seen;
}

#if SOURCE != SOURCE_NONE
// Returns the gradients of u and v along the surface, from their changes along two tangents.
void uv_gradients(const UvProjection map, const Ray ray, const Surface surface, out vec3 u, out vec3 v) {
    vec3 n = vec3(surface.geometric_normal);
    vec3 first = any_tangent(n);
    vec3 second = cross3(n, first);
    Footprint print = Footprint(first, second, vec3(0.0), vec3(0.0));
    MapInput seen = map_input(map, ray, surface, print);
    seen.gradients = true;
    TexCoord c = texture_coordinate(map, seen);
    vec3 along_u = first * c.dx.x + second * c.dy.x;
    vec3 along_v = first * c.dx.y + second * c.dy.y;
    u = along_u;
    v = along_v;
}

// Returns true for a map of normals, false for one of heights.
bool is_normal_map(const Material material) {
    return MODE_IS(BUMP_KINDS, BUMP_NORMAL, material.bump_kind) || MODE_IS(BUMP_KINDS, BUMP_NORMAL_DOWN, material.bump_kind);
}

// Returns the points at which a bump map is read, two on each axis, at the distance of a texel or half the
// footprint.
vec2 bump_step(const Material material, const TexCoord c) {
    vec2 texel = 1.0 / vec2(texture_at(material.bump_texture_index).size.xy);
    return max(texel, 0.5 * max(abs(c.dx.xy), abs(c.dy.xy)));
}

// Returns the shading normal after the material's bump map, from the values at those points. Normal map: 2
// rgb - 1 along increasing u, increasing v (or against it) and the normal. Bump map: n - grad h, with the
// height's gradient along the surface (Blinn 1978; Mikkelsen 2020), h by central differences.
vec3 bump_normal(const Material material, const UvProjection map, const Ray ray, const Surface surface, vec4 read, vec2 step) {
    float side = surface.inside ? -1.0 : 1.0;
    vec3 n = side * vec3(surface.normal);
    float strength = material.bump_strength;
    vec3 u;
    vec3 v;
    uv_gradients(map, ray, surface, u, v);
    vec3 result;
    if (is_normal_map(material)) {
        vec3 t = cross3(v, n);
        vec3 b = cross3(n, u);
        float handed = dot3(cross3(u, v), n) < 0.0 ? -strength : strength;
        vec3 m = 2.0 * read.xyz - 1.0;
        if (MODE_IS(BUMP_KINDS, BUMP_NORMAL_DOWN, material.bump_kind)) m.y = -m.y;
        vec2 scale = vec2(dot3(t, t), dot3(b, b));
        result = n * m.z;
        result += t * (scale.x > 0.0 ? handed * m.x * inversesqrt(scale.x) : 0.0);
        result += b * (scale.y > 0.0 ? handed * m.y * inversesqrt(scale.y) : 0.0);
    } else {
        vec2 slope = 0.5 * strength * (read.xz - read.yw) / step;
        result = n - slope.x * u - slope.y * v;
    }
    float squared = dot3(result, result);
    return side * (squared > 0.0 ? result * inversesqrt(squared) : n);
}
#endif

// Returns the material's colour, times its texture if it has one, after its bump map has changed the normal.
// One loop for all look-ups of a hit, as they are most of the code.
vec3 surface_color(const Material material, const UvProjection map, const Ray ray, inout Surface surface, const Footprint print, uvec2 random) {
    vec3 color = material.color;
#if SOURCE != SOURCE_NONE
    bool bump = BUMPED && material.bump_texture_index != NO_TEXTURE;
    uint taps = 0u;
    if (bump) taps = is_normal_map(material) ? 1u : 4u;
    vec4 read = vec4(0.0);
    vec2 step = vec2(0.0);
    uint tap = 0u;
    if (!TEXTURED && !BUMPED) return color;
    do {
        bool last = tap == taps;
        if (bump && last) surface.normal = bump_normal(material, map, ray, surface, read, step);
        if (!UNTEXTURED || !last || material.texture_index != NO_TEXTURE) {
            TexCoord c = texture_coordinate(map, map_input(map, ray, surface, print));
            uvec2 link = uvec2(material.texture_index, material.image_slot);
            if (BUMPED && !last) {
                link = uvec2(material.bump_texture_index, material.bump_image_slot);
                step = bump_step(material, c);
                if (taps == 4u) c.at[tap >> 1u] += (tap & 1u) == 0u ? step[tap >> 1u] : -step[tap >> 1u];
            }
            vec4 texel = sample_texture(texture_at(link.x), sampler_at(material.sampler_index), link.y, c, random);
            if (BUMPED && !last) {
                if (taps == 4u) read[tap] = texel.x;
                else read = texel;
            } else {
                vec3 product = color * texel.xyz;
                color = product;
            }
        }
        tap++;
    } while (BUMPED && tap <= taps);
#endif
    return color;
}

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
};

Path camera_path(const Ray ray, const RayDifferential beam, uvec2 random, const Candidates candidates) {
    return Path(ray, beam, vec3(1.0), random, NO_SHAPE, candidates, 0u, true);
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

// Returns the quantity that samples measure in place of radiance.
vec3 measured(const Header header, const Hit hit, bool missed, const Material material, const UvProjection map, const Path path,
              Surface surface, const Footprint print) {
    vec3 albedo = vec3(0.0);
    if (MEASURES_COLOR) albedo = surface_color(material, map, path.ray, surface, print, path.random);
    if (header.quantity == QUANTITY_ALBEDO && missed) albedo = vec3(0.0);
    vec3 value = surface_quantity(header.quantity, missed, hit, surface, albedo);
#if SOURCE != SOURCE_NONE
    if (!MEASURES_COLOR && header.quantity <= QUANTITY_UV) {
        value = look_up_quantity(header.quantity, material, texture_coordinate(map, map_input(map, path.ray, surface, print)));
    }
#endif
    return value;
}

// Follows the path to its next hit; returns the radiance that it adds to the sample.
vec3 advance(const Header header, const Points points, const SampleDimensions dimensions, inout Path path) {
    Hit hit = nearest_hit(path.ray, path.skip, path.candidates);
    bool missed = hit.shape == NO_SHAPE;
    vec3 seen = MEASURES ? vec3(0.0) : path.throughput * header.background;
    bool is_alive = false;
    // From here on, a ray that hits nothing is treated as a hit.
    bool surrounded = ENVIRONMENT && header.environment_material != NO_MATERIAL;
    if (surrounded || !missed) {
        if (ENVIRONMENT) hit.shape = missed ? 0u : hit.shape;
        Surface surface = hit_surface(path.ray, hit);
        Footprint print = footprint_at(header, path.beam, path.ray, hit.t, surface.geometric_normal);
        if (ENVIRONMENT && missed) {
            surface.link = uvec2(header.environment_material, header.environment_projection);
            print = endless_footprint(header, path.beam, path.ray);
        }
        Material material = material_at(surface.link.x);
        UvProjection map = uv_projection_at(surface.link.y);
        if (MEASURES) {
            seen = measured(header, hit, missed, material, map, path, surface, print);
        } else {
            vec3 carried = path.throughput;
            vec3 albedo = surface_color(material, map, path.ray, surface, print, path.random);
            path.throughput *= albedo;
            real3 direction = path.ray.direction;
            is_alive = BOUNCES && bounced(header, hit, surface, print, material, dimensions, path);
            seen = emitted(material.model, path.throughput);
            if (HAS_LIT) {
                if (is_lit(material.model)) {
                    Bsdf bsdf = bsdf_at(material, albedo, surface.normal, direction);
                    Lit lit = direct_light(surface, path.ray.time, hit.shape, bsdf, points, dimensions);
                    seen = reflected(bsdf, path.throughput, carried, lit);
                }
            }
        }
    }
    path.skip = hit.shape;
    path.candidates = ANYTHING;
    count_diagnostic(DIAGNOSTIC_DEPTH, is_alive && path.depth >= header.max_depth);
    path.is_alive = is_alive && path.depth < header.max_depth;
    path.depth++;
    if (BOUNCES && RANDOM) path.random = pcg2d(path.random);
    return seen;
}

#endif
