// The triangles of a mesh that may shade what a pixel sees of it from a directional light. Where there are few, or none, no
// shadow ray goes through the tree: those that remain are tested alone. Lit surfaces shade themselves nowhere near, as of
// two triangles one lies below the plane of the other or both above each other's.
#ifndef MESH_SHADES_GLSL
#define MESH_SHADES_GLSL

#include "mesh_receivers.glsl"
#include "mesh_team.glsl"
#include "../shading_normal.glsl"

const bool SHADES = BY_LISTS && LISTS_SHADES;

// Leaves of the tree above what a pixel sees, and nodes that wait; and their triangles above it, before they are tested
// against each triangle that is seen.
const uint NODE_ROOM = 192u;
const uint SHADE_ROOM = 96u;

#define EACH_SHADE(DO) DO(0) DO(1) DO(2) DO(3)
const uint HELD_SHADES = 4u;

// A triangle that may shade; corners that are all alike shade nothing.
struct Shade {
    vec3 a;
    vec3 b;
    vec3 c;
};
#define DECLARE_SHADE(k) Shade shade_##k;
EACH_SHADE(DECLARE_SHADE)
#undef DECLARE_SHADE

// True if nothing of a box, as the light sees it, is above the region.
bool is_beside(vec3 least, vec3 greatest) {
    float size = max(float(largest_part(real3(least))), float(largest_part(real3(greatest)))) + shade_reach;
    float margin = 64.0 * ULP * size;
    return any(greaterThan(least.xy, shade_greatest.xy + margin)) || any(lessThan(greatest, shade_least - margin));
}

bool is_box_beside(vec3 least, vec3 greatest) {
    vec3 middle = in_frame(0.5 * (least + greatest));
    vec3 half_size = 0.5 * (greatest - least);
    vec3 extent = vec3(dot3(abs(shade_frame[0]), half_size), dot3(abs(shade_frame[1]), half_size), dot3(abs(shade_frame[2]), half_size));
    return is_beside(middle - extent, middle + extent);
}

// True if the light sees an edge from p to q between the triangle's third corner and the region.
bool parts(vec2 p, vec2 q, vec2 third) {
    vec2 along = q - p;
    vec2 n = vec2(-along.y, along.x);
    float side = n.x * (third.x - p.x) + n.y * (third.y - p.y);
    n = side > 0.0 ? -n : n;
    vec2 corner = vec2(n.x > 0.0 ? shade_least.x : shade_greatest.x, n.y > 0.0 ? shade_least.y : shade_greatest.y);
    float size = max(max(abs(p.x), abs(p.y)), max(abs(q.x), abs(q.y))) + shade_reach;
    return n.x * (corner.x - p.x) + n.y * (corner.y - p.y) > 64.0 * ULP * size * (abs(n.x) + abs(n.y));
}

bool is_above_in_frame(vec3 pa, vec3 pb, vec3 pc) {
    if (is_beside(min(min(pa, pb), pc), max(max(pa, pb), pc))) return false;
    return !(parts(pa.xy, pb.xy, pc.xy) || parts(pb.xy, pc.xy, pa.xy) || parts(pc.xy, pa.xy, pb.xy));
}

bool is_above(vec3 a, vec3 b, vec3 c) { return is_above_in_frame(in_frame(a), in_frame(b), in_frame(c)); }

// The triangles above the region; in the end, those that may shade.
uint above[SHADE_ROOM];
uint shades = 0u;

// Begins the region of what a pixel sees; returns its rays, a little more of them than there are.
PixelRays receiving_rays(const Header header, uvec2 pixel) {
    vec3 to_light = vec3(light_at(0u).direction);
    vec3 first = any_tangent(to_light);
    shade_frame = mat3(first, cross3(to_light, first), to_light);
    shade_least = vec3(FAR);
    shade_greatest = vec3(-FAR);
    shade_reach = 0.0;
    PixelRays rays = pixel_rays(header, pixel);
    rays.x = (1.001 * header.filter_radius) * vec3(header.step_x);
    rays.y = (1.001 * header.filter_radius) * vec3(header.step_y);
    return rays;
}

bool is_region_empty() { return shade_least.x > shade_greatest.x; }

// Ends the region. Returns false if it is not known well enough.
bool close_region(bool is_sure) {
    float widened = 128.0 * ULP * shade_reach;
    shade_least -= widened;
    shade_greatest += widened;
    return is_sure || is_region_empty();
}

// Sets up the region of what the pixel sees. Returns false if that is not known well enough.
bool receive_all(const Header header, uvec2 pixel, Candidates marked) {
    PixelRays rays = receiving_rays(header, pixel);
    bool is_sure = true;
    if (GROUPED || TEAMED) {
        while (any_left(marked)) {
            Receiver receiver;
            is_sure = receive(held_triangle(listed_texel(marked, first_of(marked))), rays, receiver) && is_sure;
        }
    } else {
#define RECEIVE(k) is_sure = receive(held_##k, rays, receiver_##k) && is_sure;
        EACH_HELD(RECEIVE)
#undef RECEIVE
    }
    return close_region(is_sure);
}

// True if the triangle shades nothing that any of the receivers sees.
bool leaves_all_lit(vec3 a, vec3 b, vec3 c, Candidates marked) {
    bool is_lit = true;
    if (GROUPED || TEAMED) {
        while (is_lit && any_left(marked)) {
            Receiver receiver = receiver_of(held_triangle(listed_texel(marked, first_of(marked))));
            is_lit = is_lit && leaves_lit(a, b, c, receiver);
        }
    } else {
#define LEAVE(n) is_lit = is_lit && leaves_lit(a, b, c, receiver_##n);
        EACH_HELD(LEAVE)
#undef LEAVE
    }
    return is_lit;
}

// Finds the leaves above the region, from the end of the room on, while nodes wait at its beginning. Returns their number,
// NODE_ROOM if there are too many.
uint room[NODE_ROOM];
uint leaves_above() {
    uint height = 0u;
    uint leaves = 0u;
    uint reference = 0u;
    while (true) {
        for (uint k = 0u; k < TREE_WIDTH; k++) {
            uvec4 least = mesh_texel(reference + 2u * k);
            uvec4 greatest = mesh_texel(reference + 2u * k + 1u);
            bool is_met = least.w != NO_SHAPE && !is_box_beside(point_in(least), point_in(greatest));
            bool is_leaf = greatest.w != 0u;
            if (is_met) room[is_leaf ? NODE_ROOM - 1u - leaves : height] = least.w | (greatest.w << TREE_COUNT_SHIFT);
            leaves += is_met && is_leaf ? 1u : 0u;
            height += is_met && !is_leaf ? 1u : 0u;
        }
        if (height == 0u) break;
        if (height + leaves + TREE_WIDTH > NODE_ROOM) return NODE_ROOM;
        height--;
        reference = room[height];
    }
    return leaves;
}

// Holds what may shade the pixel; returns false if that is more than can be held.
bool gather_shades(const Header header, uvec2 pixel, const Candidates marked) {
    bool is_sure = receive_all(header, pixel, marked);
    uint count = 0u;
    uint leaves = 0u;
    if (!is_region_empty()) leaves = leaves_above();
    if (leaves == NODE_ROOM) {
        is_sure = false;
        leaves = 0u;
    }
    uint left = 0u;
    uint at = 0u;
    while ((left | leaves) != 0u) {
        if (left == 0u) {
            uint leaf = room[NODE_ROOM - leaves];
            leaves--;
            at = leaf & ((1u << TREE_COUNT_SHIFT) - 1u);
            left = leaf >> TREE_COUNT_SHIFT;
        }
        if (is_above(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)))) {
            if (count < SHADE_ROOM) above[count] = at;
            count++;
        }
        at += 3u;
        left--;
    }
#define CLEAR(k) shade_##k = Shade(vec3(0.0), vec3(0.0), vec3(0.0));
    EACH_SHADE(CLEAR)
#undef CLEAR
    shades = 0u;
    for (uint k = 0u; k < min(count, SHADE_ROOM); k++) {
        uint at = above[k];
        Shade shade = Shade(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)));
        bool is_lit = leaves_all_lit(shade.a, shade.b, shade.c, marked);
        if (GROUPED) {
            if (!is_lit) above[shades] = at;
        } else {
#define HOLD(n) if (!is_lit && shades == n) shade_##n = shade;
            EACH_SHADE(HOLD)
#undef HOLD
        }
        shades += is_lit ? 0u : 1u;
    }
    return is_sure && count <= SHADE_ROOM && (GROUPED || shades <= HELD_SHADES);
}

// True if a held triangle shades the start of a ray to the light; `place` is a corner of the triangle that it left, whose
// normal is `normal`. Sets `unfinished` where others might.
bool is_shaded(const Ray ray, real t_max, real3 place, real3 normal) {
    vec3 start = vec3(ray.origin);
    vec3 p = in_frame(start);
    bool is_within = all(greaterThanEqual(p, shade_least)) && all(lessThanEqual(p, shade_greatest));
    bool is_off = dot3(normal, ray.origin - place) >= 32.0 * ULP * shade_reach;
    unfinished = unfinished || !(is_within && is_off);
    bool blocked = false;
    if (TEAMED) {
        for (uint k = 0u; k < team_shade_counts[team_member] && !blocked; k++) {
            real t = distance_in(team_shades[k * TEAM + team_member], ray, false, true);
            blocked = t > 0.0 && t < t_max;
        }
    } else if (GROUPED) {
        for (uint k = 0u; k < shades && !blocked; k++) {
            real t = distance_in(above[k], ray, false, true);
            blocked = blocked || (t > 0.0 && t < t_max);
        }
    } else {
#define TRY(k)                                                                                                    \
    {                                                                                                             \
        real t = distance_between(real3(shade_##k.a), real3(shade_##k.b), real3(shade_##k.c), ray, false, false); \
        blocked = blocked || (t > 0.0 && t < t_max);                                                              \
    }
        EACH_SHADE(TRY)
#undef TRY
    }
    return blocked;
}

#endif
