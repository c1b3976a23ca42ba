// The region that lit surfaces of meshes fill, in the frame of a directional light: it bounds what shines on them there, and
// so which triangles may shade them. Cells and pixels of the picture have one each.
#ifndef MESH_SHADE_REGION_GLSL
#define MESH_SHADE_REGION_GLSL

#include "../math.glsl"
#include "mesh_tests.glsl"

// Units of rounding, 2^-24. Edge functions and places of triangles are off by less than 16 of them.
const float ULP = 5.9604644775390625e-8;

// The light's frame, whose third axis is towards it.
mat3 shade_frame;

vec3 in_frame(vec3 p) { return vec3(dot3(shade_frame[0], p), dot3(shade_frame[1], p), dot3(shade_frame[2], p)); }

void set_shade_frame(vec3 to_light) {
    vec3 first = any_tangent(to_light);
    shade_frame = mat3(first, cross3(to_light, first), to_light);
}

// A box in the light's frame, and the largest coordinate of what it bounds.
struct ShadeRegion {
    vec3 least;
    vec3 greatest;
    float reach;
};

const ShadeRegion EMPTY_REGION = ShadeRegion(vec3(FAR), vec3(-FAR), 0.0);

bool is_empty(const ShadeRegion region) { return region.least.x > region.greatest.x; }

ShadeRegion joined(const ShadeRegion a, const ShadeRegion b) {
    return ShadeRegion(min(a.least, b.least), max(a.greatest, b.greatest), max(a.reach, b.reach));
}

// The region with what rounding may place beside it.
ShadeRegion widened(const ShadeRegion region) {
    float margin = 128.0 * ULP * region.reach;
    return ShadeRegion(region.least - margin, region.greatest + margin, region.reach);
}

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

Receiver receiver_of(bool is_there, vec3 a, vec3 b, vec3 c) {
    vec3 doubled = cross3(b - a, c - a);
    float area = sqrt(dot3(doubled, doubled));
    vec3 n = doubled / max(area, 1e-30);
    n = dot3(n, a) > 0.0 ? -n : n;
    return Receiver(is_there && dot3(n, shade_frame[2]) > 0.0, a, b, c, n, slack_of(b - a, c - a, area));
}

// The triangle whose corners begin at a texel.
Receiver receiver_at(uint at) { return receiver_of(true, point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u))); }

float reach_of(const Receiver receiver) {
    vec3 reach = max(max(abs(receiver.a), abs(receiver.b)), abs(receiver.c));
    return max(max(reach.x, reach.y), reach.z);
}

float sum_of_parts(vec3 v) { return abs(v.x) + abs(v.y) + abs(v.z); }

// The region of what rays see of a triangle, if it is lit: of those through `way` and as much as x and y to either side.
ShadeRegion region_of(const Receiver receiver, vec3 way, vec3 x, vec3 y) {
    vec3 n = receiver.normal;
    float height = dot3(n, receiver.a);
    vec3 pa = in_frame(receiver.a);
    vec3 pb = in_frame(receiver.b);
    vec3 pc = in_frame(receiver.c);
    vec3 least = min(min(pa, pb), pc);
    vec3 greatest = max(max(pa, pb), pc);
    vec3 near = vec3(FAR);
    vec3 far = vec3(-FAR);
    float error = 0.0;
    bool is_bounded = true;
    for (uint k = 0u; k < 4u; k++) {
        vec3 d = (way + ((k & 1u) == 0u ? -1.0 : 1.0) * x) + ((k & 2u) == 0u ? -1.0 : 1.0) * y;
        float along = dot3(n, d);
        is_bounded = is_bounded && along < -1e-4;
        float t = height / min(along, -1e-4);
        vec3 p = in_frame(t * d);
        near = min(near, p);
        far = max(far, p);
        // The plane is off by the slack, where the ray meets it by as much over the cosine.
        float reach = sum_of_parts(d);
        error = max(error, receiver.slack * (sum_of_parts(receiver.a) + abs(t) * reach) * reach / max(-along, 1e-4));
    }
    least = is_bounded ? max(least, near - error) : least;
    greatest = is_bounded ? min(greatest, far + error) : greatest;
    bool is_seen = receiver.is_lit && all(lessThanEqual(least, greatest));
    if (!is_seen) return EMPTY_REGION;
    return ShadeRegion(least, greatest, reach_of(receiver));
}

// True if nothing of a box, as the light sees it, is above the region.
bool is_beside(const ShadeRegion region, vec3 least, vec3 greatest) {
    vec3 reach = max(abs(least), abs(greatest));
    float margin = 64.0 * ULP * (max(max(reach.x, reach.y), reach.z) + region.reach);
    return any(greaterThan(least.xy, region.greatest.xy + margin)) || any(lessThan(greatest, region.least - margin));
}

// True if the light sees an edge from p to q between the triangle's third corner and the region.
bool parts(const ShadeRegion region, vec2 p, vec2 q, vec2 third) {
    vec2 along = q - p;
    vec2 n = vec2(-along.y, along.x);
    float side = n.x * (third.x - p.x) + n.y * (third.y - p.y);
    n = side > 0.0 ? -n : n;
    vec2 corner = vec2(n.x > 0.0 ? region.least.x : region.greatest.x, n.y > 0.0 ? region.least.y : region.greatest.y);
    float size = max(max(abs(p.x), abs(p.y)), max(abs(q.x), abs(q.y))) + region.reach;
    return n.x * (corner.x - p.x) + n.y * (corner.y - p.y) > 64.0 * ULP * size * (abs(n.x) + abs(n.y));
}

// True if a triangle, of which the light sees these corners, may be above the region.
bool is_above(const ShadeRegion region, vec3 pa, vec3 pb, vec3 pc) {
    if (is_empty(region) || is_beside(region, min(min(pa, pb), pc), max(max(pa, pb), pc))) return false;
    return !(parts(region, pa.xy, pb.xy, pc.xy) || parts(region, pb.xy, pc.xy, pa.xy) || parts(region, pc.xy, pa.xy, pb.xy));
}

// How far a point is from the plane through `place`, at most; all lengths count with an error of `slack`.
float above_plane(vec3 point, vec3 place, vec3 normal, float slack) {
    vec3 v = point - place;
    return dot3(normal, v) + slack * (abs(v.x) + abs(v.y) + abs(v.z));
}

// True if no point that the receiver sees, moved off it, is shaded by the triangle: it is below the receiver's plane, or
// the receiver is above its plane, which the light is above, too. `reach`: the largest coordinate of what is seen.
bool leaves_lit(vec3 a, vec3 b, vec3 c, const Receiver receiver, float reach) {
    float allowed = 8.0 * ULP * reach_of(receiver);
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
    return abs(facing) > 1e-3 && (deepest < -64.0 * ULP * reach || (leans_little && deepest <= allowed));
}

#endif
