// What a pixel sees of a mesh where a directional light may shine: the triangles, the region that they fill in the light's
// frame, and whether another triangle is surely not between one of them and the light.
#ifndef MESH_RECEIVERS_GLSL
#define MESH_RECEIVERS_GLSL

#include "mesh_lists.glsl"

// Units of rounding, 2^-24. Edge functions and places of triangles are off by less than 16 of them.
const float ULP = 5.9604644775390625e-8;
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
bool receive(const Held held, const PixelRays rays, out Receiver receiver) {
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
        vec3 d = (rays.way + ((k & 1u) == 0u ? -1.0 : 1.0) * rays.x) + ((k & 2u) == 0u ? -1.0 : 1.0) * rays.y;
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
    if (highest <= allowed || !receiver.is_lit) return true;
    vec3 doubled = cross3(b - a, c - a);
    float area = sqrt(dot3(doubled, doubled));
    vec3 own = doubled / max(area, 1e-30);
    float facing = dot3(own, shade_frame[2]);
    own = facing < 0.0 ? -own : own;
    float slack = slack_of(b - a, c - a, area);
    float deepest = max(max(above_plane(receiver.a, a, -own, slack), above_plane(receiver.b, a, -own, slack)),
                        above_plane(receiver.c, a, -own, slack));
    bool leans_little = dot3(own, n) > 0.9;
    return abs(facing) > 1e-3 && (deepest < -64.0 * ULP * shade_reach || (leans_little && deepest <= allowed));
}

#endif
