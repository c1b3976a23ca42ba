// The triangles of meshes that tile culling lists for a cell of pixels: those that a pixel's rays may meet, and the nearest
// that a ray meets. A list holds all that is met up to a depth; what lies behind is found by the tree.
#ifndef MESH_LISTS_GLSL
#define MESH_LISTS_GLSL

#include "../tile_culling.glsl"
#include "mesh_edges.glsl"
#include "mesh_held.glsl"

// A ray may meet something that no list holds.
bool unfinished = false;

// Camera rays search lists alone.
const bool BY_LISTS = MESH_SEARCH == SEARCH_FEW || MESH_SEARCH == SEARCH_MORE || MESH_SEARCH == SEARCH_MANY || MESH_SEARCH == SEARCH_TEAM;
// Pixels with more triangles than are held are left to the next pass.
const bool BY_HELD = MESH_SEARCH == SEARCH_FEW || MESH_SEARCH == SEARCH_MORE;

// Registers, where reads from memory cost more than these: the first triangles of a pixel.
#define HELD_TRIANGLES (MESH_SEARCH == SEARCH_FEW ? 6u : MESH_SEARCH == SEARCH_MORE ? 8u : 4u)
#define HOLDS (HOLDS_TRIANGLES && ORIGIN_IS_EYE)

// Pixels of many triangles: each is read once for a group of samples, of which the nearest triangles are found before.
const bool GROUPED = MESH_SEARCH == SEARCH_MANY || MESH_SEARCH == SEARCH_REST;
// A workgroup samples its pixels together: what the current sample meets of the listed triangles is found before.
const bool TEAMED = MESH_SEARCH == SEARCH_TEAM;
real team_nearest;
uint team_found;

const uint GROUP = 8u;
real3 group_ways[GROUP];
real group_nearest[GROUP];
uint group_found[GROUP];
uint group_sample = 0u; // the current one

#define EACH_HELD(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)

#define DECLARE_HELD(k) Held held_##k;
EACH_HELD(DECLARE_HELD)
#undef DECLARE_HELD

// Takes the first triangle whose bit is set: its index in the list.
uint first_of(inout Candidates marked) {
    bool later = marked.meshes == uvec4(0u);
    uvec4 words = later ? marked.more : marked.meshes;
    uvec4 lowest = words & (~words + 1u);
    bvec4 skipped = bvec4(false, words.x != 0u, (words.x | words.y) != 0u, (words.x | words.y | words.z) != 0u);
    lowest = mix(lowest, uvec4(0u), skipped);
    uvec4 lanes = uvec4(0u, 32u, 64u, 96u) + uvec4(max(findLSB(lowest), ivec4(0)));
    uvec4 chosen = mix(lanes, uvec4(0u), equal(lowest, uvec4(0u)));
    if (later) marked.more ^= lowest;
    else marked.meshes ^= lowest;
    return (chosen.x | chosen.y | chosen.z | chosen.w) + (later ? 128u : 0u);
}

bool any_left(const Candidates marked) { return (marked.meshes | marked.more) != uvec4(0u); }

// No triangle that is in no list is met up to here.
float list_depth(uint list) { return uintBitsToFloat(tile_lists[list + 3u]); }

// The texel of a listed triangle.
uint listed_texel(const Candidates candidates, uint index) {
    uint place = tile_lists[candidates.list] + index;
    uint more = tile_lists[candidates.list + CELL_MORE];
    return tile_lists[place < LIST_ROOM ? candidates.list + CELL_HEAD + place : more + place - LIST_ROOM];
}

// The rays of a pixel: the one through its middle, and as much to either side as the pixel filter reaches.
struct PixelRays {
    vec3 way;
    vec3 x;
    vec3 y;
    vec3 size;
};

PixelRays pixel_rays(const Header header, uvec2 pixel) {
    vec2 place = (vec2(pixel) - 0.5 * vec2(header.image_size)) + 0.5;
    vec3 way = (place.x * vec3(header.step_x) + place.y * vec3(header.step_y)) + vec3(header.forward);
    vec3 x = header.filter_radius * vec3(header.step_x);
    vec3 y = header.filter_radius * vec3(header.step_y);
    return PixelRays(way, x, y, abs(way) + (abs(x) + abs(y)));
}

// True if rays of the pixel may meet the triangle; always for parallel rays.
bool may_meet(const Header header, const PixelRays rays, uint at) {
    if (MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.projection)) return true;
    EdgeForms edges = edge_forms_of(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)), rays.way, rays.x, rays.y,
                                    rays.size);
    vec3 aside = (abs(edges.along_x) + abs(edges.along_y)) + edges.slack;
    return all(greaterThanEqual(edges.here, -aside)) || all(lessThanEqual(edges.here, aside));
}

// Marks a listed triangle, if it is to be.
void mark(inout Candidates candidates, uint index, bool is_marked) {
    uint bit = is_marked ? 1u << (index & 31u) : 0u;
    uvec4 bits = bit * uvec4(equal(uvec4((index >> 5u) & 3u), uvec4(0u, 1u, 2u, 3u)));
    if (index < 128u) candidates.meshes |= bits;
    else candidates.more |= bits;
}

// Marks the listed triangles that rays of the pixel may meet.
void test_in_pixel(const Header header, uvec2 pixel, inout Candidates candidates) {
    PixelRays rays = pixel_rays(header, pixel);
    uint count = tile_lists[candidates.list + 2u];
    for (uint k = 0u; k < count; k++) mark(candidates, k, may_meet(header, rays, listed_texel(candidates, k)));
}

// Marks the listed triangles that rays of the pixel may meet. Where memory is read lane by lane, tile culling has tested them.
void mark_in_pixel(const Header header, uvec2 place, uvec2 pixel, inout Candidates candidates) {
    if (!HOLDS_TRIANGLES) {
        test_in_pixel(header, pixel, candidates);
        return;
    }
    uvec2 part = (place % header.cell_side) / (header.cell_side / CELL_PARTS);
    uint number = part.y * CELL_PARTS + part.x;
    uint more = tile_lists[candidates.list + CELL_MORE];
    uint at = candidates.list + CELL_MASKS + number * CELL_MASK_WORDS;
    candidates.meshes = uvec4(tile_lists[at], tile_lists[at + 1u], tile_lists[at + 2u], 0u);
    if (more != NO_LIST) {
        at = more + MAX_MORE_LISTED + number * MORE_MASK_WORDS;
        candidates.meshes.w = tile_lists[at];
        candidates.more = uvec4(tile_lists[at + 1u], tile_lists[at + 2u], tile_lists[at + 3u], tile_lists[at + 4u]);
    }
}

// Holds the first marked triangles, whose marks are taken.
void hold_in_pixel(inout Candidates candidates) {
    bool holds = false;
    if (HOLDS) holds = !GROUPED;
    if (holds) {
#define HOLD(n)                                                                                              \
    if (n < HELD_TRIANGLES) {                                                                                \
        held_##n = NOTHING_HELD;                                                                             \
        if (any_left(candidates)) held_##n = held_triangle(listed_texel(candidates, first_of(candidates))); \
    }
        EACH_HELD(HOLD)
#undef HOLD
    }
}

// Finds the nearest marked triangle for each sample of the group.
void find_for_group(Candidates marked) {
    for (uint k = 0u; k < GROUP; k++) {
        group_nearest[k] = FAR;
        group_found[k] = NO_SHAPE;
    }
    while (any_left(marked)) {
        Held triangle = held_triangle(listed_texel(marked, first_of(marked)));
        for (uint k = 0u; k < GROUP; k++) NEARER(group_nearest[k], group_found[k], distance_to_held(triangle, group_ways[k]), triangle.at)
    }
}

// Finds the nearest marked triangle if that is nearer than `best`; of those at the same t the first one. Returns true if
// nothing that is not listed can be nearer. Meshes that are leaves of the tree over all are in no list.
bool nearest_listed(const Ray ray, const Candidates candidates, inout real best, inout FoundTriangle triangle) {
    float depth = list_depth(candidates.list);
    uint found = NO_SHAPE;
    bool loops = !TEAMED;
    if (TEAMED) {
        NEARER(best, found, team_nearest, team_found)
    } else if (HOLDS) {
        loops = !BY_LISTS && !GROUPED;
        if (GROUPED) {
            for (uint k = 0u; k < GROUP; k++) {
                if (k == group_sample) NEARER(best, found, group_nearest[k], group_found[k])
            }
        } else {
#define TRY(k) if (k < HELD_TRIANGLES) NEARER(best, found, distance_to_held(held_##k, ray.direction), held_##k.at)
            EACH_HELD(TRY)
#undef TRY
        }
    }
    if (loops) {
        Candidates rest = candidates;
        while (any_left(rest)) {
            uint texel = listed_texel(rest, first_of(rest));
            NEARER(best, found, distance_in(texel, ray, ORIGIN_IS_EYE, false), texel)
        }
    }
    triangle.at = found;
    if (PLACED_MESHES) triangle.mesh = found == NO_SHAPE ? NO_SHAPE : mesh_texel(found + 1u).w;
    return best <= depth;
}

#endif
