// The triangles of meshes that tile culling lists for a cell of pixels: those that a pixel's rays may meet, and the nearest
// that a ray meets. A list holds all that is met up to a depth; what lies behind is found by the tree.
#ifndef MESH_LISTS_GLSL
#define MESH_LISTS_GLSL

#include "../tile_culling.glsl"
#include "mesh.glsl"

// Error of edge functions in f32, relative to the products of their parts.
const float EDGE_ROUNDING = 4e-6;

// A triangle whose edge functions are held for all samples of a pixel; all zero for none.
struct Held {
    uint at;
    real3 a;
    real3 b;
    real3 c;
    real3 across_a; // of the edge that a is not at
    real3 across_b;
    real3 across_c;
    bool one_sided;
};

// Registers, where reads from memory cost more than these: the first triangles of a pixel.
Held held_0;
Held held_1;
Held held_2;
Held held_3;

#define EACH_HELD(DO) DO(0) DO(1) DO(2) DO(3)

Held held_triangle(uint at) {
    uvec4 first = mesh_texel(at);
    real3 a = real3(point_in(first));
    real3 b = real3(point_in(mesh_texel(at + 1u)));
    real3 c = real3(point_in(mesh_texel(at + 2u)));
    return Held(at, a, b, c, cross3(b + c, c - b), cross3(c + a, a - c), cross3(a + b, b - a), first.w != 0u);
}

// True if a ray of the pixel may meet the triangle. Rays are `way` and as much as x and y to either side, in which the
// edge functions are affine.
bool may_be_met(const Held triangle, vec3 way, vec3 x, vec3 y) {
    vec3 a = vec3(triangle.a);
    vec3 b = vec3(triangle.b);
    vec3 c = vec3(triangle.c);
    vec3 na = vec3(triangle.across_a);
    vec3 nb = vec3(triangle.across_b);
    vec3 nc = vec3(triangle.across_c);
    vec3 middle = vec3(dot3(way, na), dot3(way, nb), dot3(way, nc));
    vec3 aside = abs(vec3(dot3(x, na), dot3(x, nb), dot3(x, nc))) + abs(vec3(dot3(y, na), dot3(y, nb), dot3(y, nc)));
    vec3 size = abs(way) + abs(x) + abs(y);
    vec3 reach = max(max(abs(a), abs(b)), abs(c));
    vec3 longest = max(max(abs(c - b), abs(a - c)), abs(b - a));
    float product = dot3(size, vec3(reach.y * longest.z + reach.z * longest.y, reach.z * longest.x + reach.x * longest.z,
                                    reach.x * longest.y + reach.y * longest.x));
    aside += EDGE_ROUNDING * product;
    return all(greaterThanEqual(middle, -aside)) || all(lessThanEqual(middle, aside));
}

// Returns a bit for each listed triangle that rays of the pixel may meet, but for those that are held from here on; all
// for parallel rays.
uvec4 listed_in_pixel(const Header header, uvec2 pixel, uint list) {
    uint first = list + CELL_HEAD + tile_lists[list];
    uint count = tile_lists[list + 2u];
    bool parallel = MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.projection);
    vec2 place = (vec2(pixel) - 0.5 * vec2(header.image_size)) + 0.5;
    vec3 way = (place.x * vec3(header.step_x) + place.y * vec3(header.step_y)) + vec3(header.forward);
    vec3 x = header.filter_radius * vec3(header.step_x);
    vec3 y = header.filter_radius * vec3(header.step_y);
    const real3 none = real3(0.0);
#define CLEAR_HELD(k) held_##k = Held(0u, none, none, none, none, none, none, false);
    EACH_HELD(CLEAR_HELD)
#undef CLEAR_HELD
    uint kept = 0u;
    uvec4 met = uvec4(0u);
    for (uint k = 0u; k < count; k++) {
        Held triangle = held_triangle(tile_lists[first + k]);
        bool is_met = parallel || may_be_met(triangle, way, x, y);
        if (HOLDS_TRIANGLES && ORIGIN_IS_EYE) {
#define HOLD(n) if (is_met && kept == uint(n)) held_##n = triangle;
            EACH_HELD(HOLD)
#undef HOLD
            kept += is_met ? 1u : 0u;
            is_met = is_met && kept > 4u;
        }
        uint bit = is_met ? 1u << (k & 31u) : 0u;
        met |= bit * uvec4(equal(uvec4(k >> 5u), uvec4(0u, 1u, 2u, 3u)));
    }
    return met;
}

// Where a ray from the eye meets it, else -1.
real distance_to_held(const Held triangle, real3 d) {
    real3 edges = real3(dot3(d, triangle.across_a), dot3(d, triangle.across_b), dot3(d, triangle.across_c));
    return distance_by(edges, triangle.a, triangle.b, triangle.c, d, triangle.one_sided);
}

// Finds the nearest listed triangle if that is nearer than `best`; of those at the same t the first one. Returns true if
// nothing that is not listed can be nearer. Meshes that are leaves of the tree over all are in no list.
bool nearest_listed(const Ray ray, const Candidates candidates, inout real best, inout FoundTriangle triangle) {
    uint first = candidates.list + CELL_HEAD + tile_lists[candidates.list];
    float depth = uintBitsToFloat(tile_lists[candidates.list + 3u]);
    uint found = NO_SHAPE;
#define NEARER(next, at_next)                                                                              \
    {                                                                                                      \
        real t = next;                                                                                     \
        uint at = at_next;                                                                                 \
        bool nearer = t > 0.0 && (t < best || (t == best && found != NO_SHAPE && at < found));             \
        best = nearer ? t : best;                                                                          \
        found = nearer ? at : found;                                                                       \
    }
    if (HOLDS_TRIANGLES && ORIGIN_IS_EYE) {
#define TRY(k) NEARER(distance_to_held(held_##k, ray.direction), held_##k.at)
        EACH_HELD(TRY)
#undef TRY
    }
    uvec4 rest = candidates.meshes;
    while (any(notEqual(rest, uvec4(0u)))) {
        // The lowest word that is not empty comes first.
        if (rest.x == 0u) {
            rest = uvec4(rest.yzw, 0u);
            first += 32u;
            continue;
        }
        uint texel = tile_lists[first + uint(findLSB(rest.x))];
        rest.x &= rest.x - 1u;
        NEARER(distance_in(texel, ray, ORIGIN_IS_EYE, false), texel)
    }
#undef NEARER
    triangle.at = found;
    if (PLACED_MESHES) triangle.mesh = found == NO_SHAPE ? NO_SHAPE : mesh_texel(found + 1u).w;
    return best <= depth;
}

#endif
