// The buffer of meshes, and what rays ask of it: where they enter a box of a tree, and where they meet a triangle. Boxes grow
// by what rounding may misplace (Ize 2013). Twin: src/oracle/geometry/mesh_tests.rs.
#ifndef MESH_TESTS_GLSL
#define MESH_TESTS_GLSL

#include "../layout.glsl"

#if !defined(SHAPES_IN_BEAMS) || defined(MESHES_IN_CELLS)
layout(set = 0, binding = BINDING_MESHES) uniform usamplerBuffer mesh_texels;

uvec4 mesh_texel(uint at) { return texelFetch(mesh_texels, int(at)); }

vec3 point_in(uvec4 texel) { return uintBitsToFloat(texel.xyz); }

// Sorts the four children of a node: the farthest first, those that are missed last.
#define EXCHANGE(number, far, children, i, j) \
    if (far[i] < far[j]) {                    \
        number here = far[i];                 \
        uint child = children[i];             \
        far[i] = far[j];                      \
        children[i] = children[j];            \
        far[j] = here;                        \
        children[j] = child;                  \
    }
#define SORT_CHILDREN(number, far, children)  \
    EXCHANGE(number, far, children, 0, 1)     \
    EXCHANGE(number, far, children, 2, 3)     \
    EXCHANGE(number, far, children, 0, 2)     \
    EXCHANGE(number, far, children, 1, 3)     \
    EXCHANGE(number, far, children, 1, 2)
#endif

#ifndef SHAPES_IN_BEAMS
#include "hit.glsl"

// Boxes grow by this part of the largest coordinate of their corners as seen from the ray's origin: planes of boxes,
// edge functions and distances of triangles are off by less than 16 roundings of it.
#ifdef F64_MATH
const double MARGIN = 2.3283064365386963e-10lf; // 2^-32
#else
const float MARGIN = 1.9073486328125e-6; // 2^-19
#endif

// Components of a direction are no less than this part of the largest, so that no reciprocal is infinite. In a box, a
// ray moves aside by less than MARGIN for it.
const real AXIAL = MARGIN * 0.0009765625;

// A ray as boxes are tested with it.
struct Slabs {
    real3 origin;
    real3 inverse;
    bvec3 falls;
    real longest; // component of the direction
};

Slabs slabs_of(const Ray ray, bool from_eye) {
    real longest = largest_part(ray.direction);
    real3 scaled = ray.direction * (1.0 / longest);
    bvec3 falls = lessThan(scaled, real3(0.0));
    real3 apart = max(abs(scaled), real3(AXIAL));
    return Slabs(from_eye ? real3(0.0) : ray.origin, 1.0 / mix(apart, -apart, falls), falls, longest);
}

// Returns where the ray enters the box grown by this part, -1 if it does not up to the scaled distance `most`. Planes of entry and
// exit follow from the direction: a box that is inside out, in an unused place of a node, is never entered.
real entry(const Slabs slabs, vec3 least, vec3 greatest, real part, real most) {
    real3 low = real3(least) - slabs.origin;
    real3 high = real3(greatest) - slabs.origin;
    real margin = part * max(largest_part(low), largest_part(high));
    low -= margin;
    high += margin;
    real3 enter = mix(low, high, slabs.falls) * slabs.inverse;
    real3 leave = mix(high, low, slabs.falls) * slabs.inverse;
    real near = max(max(enter.x, enter.y), max(enter.z, 0.0));
    real far = min(min(leave.x, leave.y), min(leave.z, most));
    return near <= far ? near : -1.0;
}

// The mean of the corners' distances along a direction, weighted by edge functions of one sign; else -1. `one_sided`: it
// is met from the front only.
real distance_by(real3 edges, real3 a, real3 b, real3 c, real3 d, bool one_sided) {
    bool back = edges.x >= 0.0 && edges.y >= 0.0 && edges.z >= 0.0;
    bool front = edges.x <= 0.0 && edges.y <= 0.0 && edges.z <= 0.0;
    if (CULLED_BACKS) back = back && !one_sided;
    bool degenerate = edges == real3(0.0);
    real whole = (edges.x + edges.y) + edges.z;
    real along = dot3(edges, real3(dot3(a, d), dot3(b, d), dot3(c, d)));
    real t = along / (whole * dot3(d, d));
    return (front || back) && !degenerate ? t : -1.0;
}

// Edge functions d·((p + q) × (q - p)), twice the volumes d·(p × q): the two triangles at a shared edge compute the same
// value with opposite sign, and the error is a part of the edge's length. They are weights of the corners in the point.
real distance_between(real3 a, real3 b, real3 c, real3 d, bool one_sided) {
    real3 edges = real3(dot3(d, cross3(b + c, c - b)), dot3(d, cross3(c + a, a - c)), dot3(d, cross3(a + b, b - a)));
    return distance_by(edges, a, b, c, d, one_sided);
}

// Of corners as seen from the eye.
real distance_between(real3 a, real3 b, real3 c, const Ray ray, bool from_eye, bool one_sided) {
    if (!from_eye) {
        a -= ray.origin;
        b -= ray.origin;
        c -= ray.origin;
    }
    return distance_between(a, b, c, ray.direction, one_sided);
}

// A shadow ray that surfaces may let pass meets both sides of all.
bool meets_backs = false;

// `at`: the texel of its corners. `any`: of a shadow ray, which meets both sides.
real distance_in(uint at, const Ray ray, bool from_eye, bool any) {
    uvec4 first = mesh_texel(at);
    real3 a = real3(point_in(first));
    real3 b = real3(point_in(mesh_texel(at + 1u)));
    real3 c = real3(point_in(mesh_texel(at + 2u)));
    return distance_between(a, b, c, ray, from_eye, !any && !meets_backs && first.w != 0u);
}
#endif

#endif
