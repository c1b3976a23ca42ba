// Triangles of meshes whose edge functions are held for the rays of many samples, which start at the eye: each costs three
// dot products a ray. They meet as `distance_in` of mesh_tests.glsl says, to the bit.
#ifndef MESH_HELD_GLSL
#define MESH_HELD_GLSL

#include "mesh.glsl"

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

const Held NOTHING_HELD = Held(0u, real3(0.0), real3(0.0), real3(0.0), real3(0.0), real3(0.0), real3(0.0), false);

Held held_triangle(uint at) {
    uvec4 first = mesh_texel(at);
    real3 a = real3(point_in(first));
    real3 b = real3(point_in(mesh_texel(at + 1u)));
    real3 c = real3(point_in(mesh_texel(at + 2u)));
    return Held(at, a, b, c, cross3(b + c, c - b), cross3(c + a, a - c), cross3(a + b, b - a), first.w != 0u);
}

// Where a ray from the eye meets it, else -1.
real distance_to_held(const Held triangle, real3 d) {
    real3 edges = real3(dot3(d, triangle.across_a), dot3(d, triangle.across_b), dot3(d, triangle.across_c));
    return distance_by(edges, triangle.a, triangle.b, triangle.c, d, triangle.one_sided);
}

// Takes the triangle at t if it is nearer than the best so far; of those at the same t the first one.
#define NEARER(best, found, next, at_next)                                                                 \
    {                                                                                                      \
        real t = next;                                                                                     \
        uint at = at_next;                                                                                 \
        bool nearer = t > 0.0 && (t < best || (t == best && found != NO_SHAPE && at < found));             \
        best = nearer ? t : best;                                                                          \
        found = nearer ? at : found;                                                                       \
    }

#endif
