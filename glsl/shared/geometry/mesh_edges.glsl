// Edge functions of a mesh's triangles for the rays of a part of the picture, which bound those of each ray there.
#ifndef MESH_EDGES_GLSL
#define MESH_EDGES_GLSL

#include "../math.glsl"

// Error of edge functions in f32, relative to the products of their parts.
const float EDGE_ROUNDING = 4e-6;

// Edge functions of a triangle for rays of a perspective camera, which are affine in the place of the picture: their values
// at a place, their change for steps to the right and down, and their error for rays up to `size`.
struct EdgeForms {
    vec3 here;
    vec3 along_x;
    vec3 along_y;
    float slack;
};

EdgeForms edge_forms_of(vec3 a, vec3 b, vec3 c, vec3 way, vec3 x, vec3 y, vec3 size) {
    vec3 reach = max(max(abs(a), abs(b)), abs(c));
    vec3 longest = max(max(abs(c - b), abs(a - c)), abs(b - a));
    float slack = EDGE_ROUNDING * dot3(size, vec3(reach.y * longest.z + reach.z * longest.y, reach.z * longest.x + reach.x * longest.z,
                                                  reach.x * longest.y + reach.y * longest.x));
    vec3 na = cross3(b + c, c - b);
    vec3 nb = cross3(c + a, a - c);
    vec3 nc = cross3(a + b, b - a);
    return EdgeForms(vec3(dot3(way, na), dot3(way, nb), dot3(way, nc)), vec3(dot3(x, na), dot3(x, nb), dot3(x, nc)),
                     vec3(dot3(y, na), dot3(y, nb), dot3(y, nc)), slack);
}

#endif
