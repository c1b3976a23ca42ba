// The triangles of a mesh that may shade what a pixel sees of it from a directional light. Where there are few, or none, no
// shadow ray goes through the tree: those that remain are tested alone. Lit surfaces shade themselves nowhere near, as of
// two triangles one lies below the plane of the other or both above each other's.
#ifndef MESH_SHADES_GLSL
#define MESH_SHADES_GLSL

#include "mesh_lists.glsl"
#include "../shading_normal.glsl"

const bool ONE_SUN = LIGHTS == 1u && LIGHT_KINDS == (1u << LIGHT_DIRECTIONAL) && SHADOWS;
const bool MESHES_ALONE = (PLANES | SPHERES | TRIANGLES | DISCS) == 0u && MOTIONS == 0u;
const bool SHADES = BY_LISTS && HOLDS_TRIANGLES && !BOUNCES && PROJECTIONS == (1u << PROJECTION_PERSPECTIVE) && ONE_SUN &&
                    MESHES_ALONE && ALPHA_MODES == (1u << ALPHA_OPAQUE) && !ONE_SIDED;

// Units of rounding, 2^-24. Edge functions and places of triangles are off by less than 16 of them.
const float ULP = 5.9604644775390625e-8;
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

// The region of what is seen and lit: across the light's direction, and towards the light.
mat3 shade_frame;
vec3 shade_least;
vec3 shade_greatest;
float shade_reach; // largest coordinate in it

// A triangle that is seen and may be lit; its normal is towards eye and light.
struct Receiver {
    bool is_lit;
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 normal;
    float slack; // error of the normal and of places, a unit of distance
};

// Error of the normal of a triangle of these edges, a unit of length, and that of places.
float slack_of(vec3 ab, vec3 ac, float doubled_area) {
    vec3 bc = ac - ab;
    float longest = max(max(dot3(ab, ab), dot3(ac, ac)), dot3(bc, bc));
    return ULP * (16.0 + 4.0 * longest / max(doubled_area, 1e-30));
}

vec3 in_frame(vec3 p) { return vec3(dot3(shade_frame[0], p), dot3(shade_frame[1], p), dot3(shade_frame[2], p)); }

#define DECLARE_RECEIVER(k) Receiver receiver_##k;
EACH_HELD(DECLARE_RECEIVER)
#undef DECLARE_RECEIVER

Receiver receiver_of(const Held held) {
    vec3 a = vec3(held.a);
    vec3 b = vec3(held.b);
    vec3 c = vec3(held.c);
    vec3 doubled = cross3(b - a, c - a);
    float area = sqrt(dot3(doubled, doubled));
    vec3 n = doubled / max(area, 1e-30);
    n = dot3(n, a) > 0.0 ? -n : n;
    return Receiver(held.at != 0u && dot3(n, shade_frame[2]) > 0.0, a, b, c, n, slack_of(b - a, c - a, area));
}

// Adds what the pixel sees of a triangle to the region. Returns false where it is neither lit nor dark.
bool receive(const Held held, vec3 way, vec3 x, vec3 y, out Receiver receiver) {
    receiver = receiver_of(held);
    vec3 n = receiver.normal;
    float height = dot3(n, receiver.a);
    vec3 pa = in_frame(receiver.a);
    vec3 pb = in_frame(receiver.b);
    vec3 pc = in_frame(receiver.c);
    vec3 least = min(min(pa, pb), pc);
    vec3 greatest = max(max(pa, pb), pc);
    vec3 near = vec3(FAR);
    vec3 far = vec3(-FAR);
    bool is_bounded = true;
    for (uint k = 0u; k < 4u; k++) {
        vec3 d = (way + ((k & 1u) == 0u ? -1.0 : 1.0) * x) + ((k & 2u) == 0u ? -1.0 : 1.0) * y;
        float along = dot3(n, d);
        is_bounded = is_bounded && along < -1e-4;
        vec3 p = in_frame((height / min(along, -1e-4)) * d);
        near = min(near, p);
        far = max(far, p);
    }
    least = is_bounded ? max(least, near) : least;
    greatest = is_bounded ? min(greatest, far) : greatest;
    bool is_seen = all(lessThanEqual(least, greatest));
    if (receiver.is_lit && is_seen) {
        shade_least = min(shade_least, least);
        shade_greatest = max(shade_greatest, greatest);
        vec3 reach = max(max(abs(receiver.a), abs(receiver.b)), abs(receiver.c));
        shade_reach = max(shade_reach, max(max(reach.x, reach.y), reach.z));
    }
    return held.at == 0u || abs(dot3(n, shade_frame[2])) > 1e-3;
}

// True if nothing of a box, as the light sees it, is above the region.
bool is_beside(vec3 least, vec3 greatest) {
    float size = max(float(largest_part(real3(least))), float(largest_part(real3(greatest)))) + shade_reach;
    float margin = 64.0 * ULP * size;
    return any(greaterThan(least.xy, shade_greatest.xy + margin)) || any(lessThan(greatest, shade_least - margin));
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

bool is_above(vec3 a, vec3 b, vec3 c) {
    vec3 pa = in_frame(a);
    vec3 pb = in_frame(b);
    vec3 pc = in_frame(c);
    if (is_beside(min(min(pa, pb), pc), max(max(pa, pb), pc))) return false;
    return !(parts(pa.xy, pb.xy, pc.xy) || parts(pb.xy, pc.xy, pa.xy) || parts(pc.xy, pa.xy, pb.xy));
}

// How far a point is from the plane through `place`, at most; all lengths count with an error of `slack`.
float above_plane(vec3 point, vec3 place, vec3 normal, float slack) {
    vec3 v = point - place;
    return dot3(normal, v) + slack * (abs(v.x) + abs(v.y) + abs(v.z));
}

// True if no point that the receiver sees, moved off it, is shaded by the triangle: it is below the receiver's plane, or
// the receiver is above its plane, which the light is above, too.
bool leaves_lit(vec3 a, vec3 b, vec3 c, const Receiver receiver) {
    float allowed = 8.0 * ULP * shade_reach;
    vec3 n = receiver.normal;
    float highest = max(max(above_plane(a, receiver.a, n, receiver.slack), above_plane(b, receiver.a, n, receiver.slack)),
                        above_plane(c, receiver.a, n, receiver.slack));
    vec3 doubled = cross3(b - a, c - a);
    float area = sqrt(dot3(doubled, doubled));
    vec3 own = doubled / max(area, 1e-30);
    float facing = dot3(own, shade_frame[2]);
    own = facing < 0.0 ? -own : own;
    float slack = slack_of(b - a, c - a, area);
    float deepest = max(max(above_plane(receiver.a, a, -own, slack), above_plane(receiver.b, a, -own, slack)),
                        above_plane(receiver.c, a, -own, slack));
    bool leans_little = dot3(own, n) > 0.9;
    bool is_over = abs(facing) > 1e-3 && (deepest < -64.0 * ULP * shade_reach || (leans_little && deepest <= allowed));
    return highest <= allowed || is_over || !receiver.is_lit;
}

// The triangles above the region; in the end, those that may shade.
uint above[SHADE_ROOM];
uint shades = 0u;

// Sets up the region of what the pixel sees. Returns false if that is not known well enough.
bool receive_all(const Header header, uvec2 pixel, Candidates marked) {
    vec3 to_light = vec3(light_at(0u).direction);
    vec3 first = any_tangent(to_light);
    shade_frame = mat3(first, cross3(to_light, first), to_light);
    shade_least = vec3(FAR);
    shade_greatest = vec3(-FAR);
    shade_reach = 0.0;
    vec2 place = (vec2(pixel) - 0.5 * vec2(header.image_size)) + 0.5;
    vec3 way = (place.x * vec3(header.step_x) + place.y * vec3(header.step_y)) + vec3(header.forward);
    vec3 x = (1.001 * header.filter_radius) * vec3(header.step_x);
    vec3 y = (1.001 * header.filter_radius) * vec3(header.step_y);
    bool is_sure = true;
    if (GROUPED) {
        while (any_left(marked)) {
            Receiver receiver;
            is_sure = receive(held_triangle(listed_texel(marked, first_of(marked))), way, x, y, receiver) && is_sure;
        }
    } else {
#define RECEIVE(k) is_sure = receive(held_##k, way, x, y, receiver_##k) && is_sure;
        EACH_HELD(RECEIVE)
#undef RECEIVE
    }
    float widened = 128.0 * ULP * shade_reach;
    shade_least -= widened;
    shade_greatest += widened;
    return is_sure || shade_least.x > shade_greatest.x;
}

// True if the triangle shades nothing that any of the receivers sees.
bool leaves_all_lit(vec3 a, vec3 b, vec3 c, Candidates marked) {
    bool is_lit = true;
    if (GROUPED) {
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
uint leaves_above(const Mesh mesh) {
    uint height = 0u;
    uint leaves = 0u;
    uint reference = 0u;
    while (true) {
        uint at = mesh.nodes + 2u * reference;
        for (uint k = 0u; k < TREE_WIDTH; k++) {
            uvec4 least = mesh_texel(at + 2u * k);
            uvec4 greatest = mesh_texel(at + 2u * k + 1u);
            vec3 middle = in_frame(0.5 * (point_in(least) + point_in(greatest)));
            vec3 half_size = 0.5 * (point_in(greatest) - point_in(least));
            vec3 extent = vec3(dot3(abs(shade_frame[0]), half_size), dot3(abs(shade_frame[1]), half_size), dot3(abs(shade_frame[2]), half_size));
            bool is_met = least.w != NO_SHAPE && !is_beside(middle - extent, middle + extent);
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
    COUNT_SHAPES
    for (uint m = 0u; m < meshes && shade_least.x <= shade_greatest.x; m++) {
        Mesh mesh = mesh_at(m);
        uint leaves = leaves_above(mesh);
        if (leaves == NODE_ROOM) {
            is_sure = false;
            leaves = 0u;
        }
        uint left = 0u;
        uint index = 0u;
        while ((left | leaves) != 0u) {
            if (left == 0u) {
                uint leaf = room[NODE_ROOM - leaves];
                leaves--;
                index = leaf & ((1u << TREE_COUNT_SHIFT) - 1u);
                left = leaf >> TREE_COUNT_SHIFT;
            }
            uint at = mesh.corners + 3u * index;
            if (is_above(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)))) {
                if (count < SHADE_ROOM) above[count] = at;
                count++;
            }
            index++;
            left--;
        }
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
    if (GROUPED) {
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
