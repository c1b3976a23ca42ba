// The triangles of a mesh that may shade what a pixel sees of it from a directional light. Where there are few, or none, no
// shadow ray goes through the tree: those that remain are tested alone.
#ifndef MESH_SHADES_GLSL
#define MESH_SHADES_GLSL

#include "mesh_receivers.glsl"
#include "mesh_team.glsl"
#include "../shading_normal.glsl"

const bool SHADES = BY_LISTS && LISTS_SHADES;

#define EACH_SHADE(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
const uint HELD_SHADES = MESH_SEARCH == SEARCH_MORE ? 8u : 0u;

// A triangle that may shade; corners that are all alike shade nothing.
struct Shade {
    vec3 a;
    vec3 b;
    vec3 c;
};
#define DECLARE_SHADE(k) Shade shade_##k;
EACH_SHADE(DECLARE_SHADE)
#undef DECLARE_SHADE

// The texels of triangles that may shade the pixel.
const uint SHADE_ROOM = 128u;
uint shade_texels[SHADE_ROOM];
uint shades = 0u;

// The first word of the shades of a pixel's cell; NO_LIST if not all are known.
uint cell_shades(uint list) { return list == NO_LIST ? NO_LIST : tile_lists[list + CELL_SHADES]; }

bool has_shades(uint first) { return first != NO_LIST && first != NO_SHADES; }

uint count_of_shades(uint first) { return has_shades(first) ? tile_lists[first + SHADES_COUNT] : 0u; }

// Words of bits of each of them.
uint bits_of_shades(uint first) { return has_shades(first) ? tile_lists[first + SHADES_BITS] : 0u; }

vec3 vector_at(uint at) { return uintBitsToFloat(uvec3(tile_lists[at], tile_lists[at + 1u], tile_lists[at + 2u])); }

// True if the one at this word may shade a triangle that is marked.
bool may_shade(uint at, uint bits, const Candidates marked) {
    uint both = bits == 0u ? 1u : 0u;
    for (uint k = 0u; k < bits; k++) both |= tile_lists[at + 1u + k] & (k < 4u ? marked.meshes[k & 3u] : marked.more[k & 3u]);
    return both != 0u;
}

// Cuts the region to that of the cell, beyond which its shades are not known.
void cut_to_cell(uint first) {
    if (first == NO_SHADES) shade_region = EMPTY_REGION;
    if (!has_shades(first)) return;
    shade_region.least = max(shade_region.least, vector_at(first + SHADES_LEAST));
    shade_region.greatest = min(shade_region.greatest, vector_at(first + SHADES_GREATEST));
}

// True if the triangle at a texel may be above the region.
bool is_shade_above(uint at) {
    return is_above(shade_region, in_frame(point_in(mesh_texel(at))), in_frame(point_in(mesh_texel(at + 1u))), in_frame(point_in(mesh_texel(at + 2u))));
}

// Holds what may shade the pixel, of which these listed triangles are seen; returns false if that is more than can be held.
bool gather_shades(const Header header, uvec2 pixel, const Candidates marked) {
    receive_all(header, pixel, marked);
    uint first = cell_shades(marked.list);
    bool is_known = first != NO_LIST || is_empty(shade_region);
    cut_to_cell(first);
    uint listed = is_empty(shade_region) ? 0u : count_of_shades(first);
    uint bits = bits_of_shades(first);
    shades = 0u;
    for (uint k = 0u; k < listed; k++) {
        uint at = first + SHADES_HEAD + k * (1u + bits);
        bool is_taken = may_shade(at, bits, marked);
        // Of many, few are above the region; else these are read below, where there are fewer.
        if (GROUPED) {
            if (is_taken) is_taken = is_shade_above(tile_lists[at]);
        }
        if (is_taken) shade_texels[min(shades, SHADE_ROOM - 1u)] = tile_lists[at];
        shades += is_taken ? 1u : 0u;
    }
    if (GROUPED) return is_known && shades <= SHADE_ROOM;
    uint count = min(shades, SHADE_ROOM);
    shades = shades > SHADE_ROOM ? shades : 0u;
#define CLEAR(k) if (k < HELD_SHADES) shade_##k = Shade(vec3(0.0), vec3(0.0), vec3(0.0));
    EACH_SHADE(CLEAR)
#undef CLEAR
    for (uint k = 0u; k < count; k++) {
        uint at = shade_texels[k];
        Shade shade = Shade(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)));
        bool is_taken = is_above(shade_region, in_frame(shade.a), in_frame(shade.b), in_frame(shade.c));
#define HOLD(n) if (n < HELD_SHADES && is_taken && shades == n) shade_##n = shade;
        EACH_SHADE(HOLD)
#undef HOLD
        shades += is_taken ? 1u : 0u;
    }
    return is_known && shades <= HELD_SHADES;
}

// True if a held triangle shades the start of a ray to the light; `place` is a corner of the triangle that it left, whose
// normal is `normal`. Sets `unfinished` where others might.
bool is_shaded(const Ray ray, real t_max, real3 place, real3 normal) {
    vec3 start = vec3(ray.origin);
    vec3 p = in_frame(start);
    bool is_within = all(greaterThanEqual(p, shade_region.least)) && all(lessThanEqual(p, shade_region.greatest));
    bool is_off = dot3(normal, ray.origin - place) >= 32.0 * ULP * shade_region.reach;
    // Triangles that the light grazes may count as dark above.
    bool is_lit = dot3(normal, real3(shade_frame[2])) > 1e-3;
    unfinished = unfinished || !(is_within && is_off && is_lit);
    bool blocked = false;
    if (TEAMED) {
        for (uint k = 0u; k < team_shade_counts[team_member] && !blocked; k++) {
            real t = distance_in(team_shades[k * TEAM + team_member], ray, false, true);
            blocked = t > 0.0 && t < t_max;
        }
    } else if (GROUPED) {
        for (uint k = 0u; k < shades && !blocked; k++) {
            real t = distance_in(shade_texels[k], ray, false, true);
            blocked = blocked || (t > 0.0 && t < t_max);
        }
    } else {
#define TRY(k)                                                                                                    \
    if (k < HELD_SHADES) {                                                                                        \
        real t = distance_between(real3(shade_##k.a), real3(shade_##k.b), real3(shade_##k.c), ray, false, false); \
        blocked = blocked || (t > 0.0 && t < t_max);                                                              \
    }
        EACH_SHADE(TRY)
#undef TRY
    }
    return blocked;
}

#endif
