// Meshes: triangles in a tree of boxes, whose nodes have TREE_WIDTH children that rays enter near first (Wald, Benthin &
// Boulos 2008). Boxes grow by what rounding may misplace (Ize 2013). Cones see a mesh where their axis meets it, beams as
// the ball around it. Twin: src/oracle/geometry/mesh.rs.
#ifndef MESH_GLSL
#define MESH_GLSL

#include "../layout.glsl"
#include "sphere.glsl"
#include "triangle.glsl"

// Material and map.
uvec2 links_of(const Mesh mesh) { return uvec2(mesh.material, mesh.uv_projection); }

Sphere ball_of(const Mesh mesh) { return Sphere(mesh.center, mesh.radius, mesh.material, mesh.uv_projection); }

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

// Returns where the ray enters the grown box, -1 if it does not up to the scaled distance `most`. Planes of entry and
// exit follow from the direction: a box that is inside out, in an unused place of a node, is never entered.
real entry(const Slabs slabs, vec3 least, vec3 greatest, real most) {
    real3 low = real3(least) - slabs.origin;
    real3 high = real3(greatest) - slabs.origin;
    real margin = MARGIN * max(largest_part(low), largest_part(high));
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
// A shadow ray that surfaces may let pass meets both sides of all.
bool meets_backs = false;

real distance_between(real3 a, real3 b, real3 c, const Ray ray, bool from_eye, bool one_sided) {
    if (!from_eye) {
        a -= ray.origin;
        b -= ray.origin;
        c -= ray.origin;
    }
    real3 d = ray.direction;
    real3 edges = real3(dot3(d, cross3(b + c, c - b)), dot3(d, cross3(c + a, a - c)), dot3(d, cross3(a + b, b - a)));
    return distance_by(edges, a, b, c, d, one_sided);
}

// `at`: the texel of its corners. `any`: of a shadow ray, which meets both sides.
real distance_in(uint at, const Ray ray, bool from_eye, bool any) {
    uvec4 first = mesh_texel(at);
    real3 a = real3(point_in(first));
    real3 b = real3(point_in(mesh_texel(at + 1u)));
    real3 c = real3(point_in(mesh_texel(at + 2u)));
    return distance_between(a, b, c, ray, from_eye, !any && !meets_backs && first.w != 0u);
}

// The nearest triangle before `most`, or for `any` just one; of those at the same t the first in the tree's order.
// Its number is the local coordinate.
real distance_to(const Mesh mesh, const Ray ray, bool from_eye, real most, bool any, inout real2 local) {
    Slabs slabs = slabs_of(ray, from_eye);
    real best = most;
    uint found = NO_SHAPE;
    // Children that wait, the nearest on top, and where the ray enters them.
    uint waiting[TREE_STACK];
    real entries[TREE_STACK];
    uint height = 0u;
    uint reference = 0u;
    uint count = 0u;
    while (true) {
        if (count == 0u) {
            uint at = mesh.nodes + 2u * reference;
            uint children[TREE_WIDTH];
            real enters[TREE_WIDTH];
            for (uint k = 0u; k < TREE_WIDTH; k++) {
                uvec4 least = mesh_texel(at + 2u * k);
                uvec4 greatest = mesh_texel(at + 2u * k + 1u);
                children[k] = least.w | (greatest.w << TREE_COUNT_SHIFT);
                enters[k] = entry(slabs, point_in(least), point_in(greatest), best * slabs.longest);
            }
            SORT_CHILDREN(real, enters, children)
            for (uint k = 0u; k < TREE_WIDTH; k++) {
                if (enters[k] >= 0.0) {
                    waiting[height] = children[k];
                    entries[height] = enters[k];
                    height++;
                }
            }
        } else {
            for (uint k = 0u; k < count; k++) {
                uint index = reference + k;
                real t = distance_in(mesh.corners + 3u * index, ray, from_eye, any);
                bool nearer = t > 0.0 && (t < best || (t == best && found != NO_SHAPE && index < found));
                best = nearer ? t : best;
                found = nearer ? index : found;
            }
            if (any && found != NO_SHAPE) break;
        }
        // Equal distances are entered as well, for the first of equal triangles.
        while (height > 0u && entries[height - 1u] > best * slabs.longest) height--;
        if (height == 0u) break;
        height--;
        reference = waiting[height] & ((1u << TREE_COUNT_SHIFT) - 1u);
        count = waiting[height] >> TREE_COUNT_SHIFT;
    }
    local = real2(real(found), 0.0);
    return found == NO_SHAPE ? -1.0 : best;
}

// A unit vector from two components of 16 bits (Cigolle et al. 2014).
real3 octahedral(uint word) {
    vec2 flat_part = unpackSnorm2x16(word);
    real3 v = real3(flat_part, 1.0 - abs(flat_part.x) - abs(flat_part.y));
    real fold = max(-v.z, 0.0);
    v.x += v.x < 0.0 ? fold : -fold;
    v.y += v.y < 0.0 ? fold : -fold;
    real scale = inverse_root(dot3(v, v));
    return v * scale;
}

// A corner of the triangle that is shaded.
real3 seen_corner = real3(0.0);

Triangle triangle_in(const Mesh mesh, uint index) {
    uint at = mesh.corners + 3u * index;
    real3 a = real3(point_in(mesh_texel(at)));
    real3 b = real3(point_in(mesh_texel(at + 1u)));
    real3 c = real3(point_in(mesh_texel(at + 2u)));
    seen_corner = a;
    at = mesh.attributes + mesh.attribute_count * index;
    uvec4 plane = mesh_texel(at);
    vec4 first = uintBitsToFloat(mesh_texel(at + 1u));
    vec4 second = uintBitsToFloat(mesh_texel(at + 2u));
    uvec4 normals = mesh_texel(at + 3u);
    real3 normal = real3(point_in(plane));
    return Triangle(a, first.x, b, first.y, c, first.z, real3(first.w, second.x, second.y), normal, dot3(normal, a),
                    octahedral(normals.x), octahedral(normals.y), octahedral(normals.z), mesh.material,
                    mesh.uv_projection, (plane.w & MESH_SMOOTH) != 0u);
}

// Four components of 16 bits each, from 0 to 1.
vec4 color_in(uint low, uint high) { return vec4(unpackUnorm2x16(low), unpackUnorm2x16(high)); }

// What the vertices of a triangle have beside normals and texture coordinates, at a point of it.
VertexAttributes attributes_of(const Mesh mesh, const Triangle triangle, uint index, real3 point) {
    VertexAttributes found = NO_ATTRIBUTES;
    vec3 w = vec3(weights(triangle, point));
    uint at = mesh.attributes + mesh.attribute_count * index;
    if (TANGENTS && mesh.has_tangents) {
        uint signs = mesh_texel(at).w;
        uint last = mesh_texel(at + 3u).w;
        uvec4 others = mesh_texel(at + 2u);
        vec3 sum = (w.x * vec3(octahedral(others.z)) + w.y * vec3(octahedral(others.w))) + w.z * vec3(octahedral(last));
        found.tangent = vec4(sum, (signs & MESH_MIRRORED_UV) != 0u ? -1.0 : 1.0);
    }
    at += 4u;
    if (VERTEX_COLORS && mesh.has_colors) {
        uvec4 first = mesh_texel(at);
        uvec4 second = mesh_texel(at + 1u);
        found.color = (w.x * color_in(first.x, first.y) + w.y * color_in(first.z, first.w)) + w.z * color_in(second.x, second.y);
        at += 2u;
    }
    if (SECOND_UV && mesh.has_second_uv) {
        vec4 first = uintBitsToFloat(mesh_texel(at));
        vec4 second = uintBitsToFloat(mesh_texel(at + 1u));
        vec3 u = first.xyz;
        vec3 v = vec3(first.w, second.xy);
        found.second_uv = real2(dot3(w, u), dot3(w, v));
        if (FILTERED || BUMPED) {
            vec3 wa;
            vec3 wb;
            vec3 wc;
            weight_gradients(triangle, wa, wb, wc);
            found.second_u = (wa * u.x + wb * u.y) + wc * u.z;
            found.second_v = (wa * v.x + wb * v.y) + wc * v.z;
        }
    }
    return found;
}

Surface surface_of(const Mesh mesh, real3 point, real2 local) {
    uint index = uint(local.x);
    Triangle triangle = triangle_in(mesh, index);
    Surface surface = surface_of(triangle, point, local);
    if (VERTEX_COLORS || SECOND_UV || TANGENTS) surface.attributes = attributes_of(mesh, triangle, index, point);
    return surface;
}

#endif

#ifdef SHAPES_IN_CONES
#include "../cone.glsl"

// No line stands for a mesh.
bool cut_by_shape(const Cone cone, const Mesh mesh) { return false; }

Covered covered_by(const Cone cone, const Mesh mesh) {
    real2 local;
    return distance_to(mesh, cone.ray, false, FAR, true, local) > 0.0 ? EVERYTHING : NOTHING;
}

bool touched(const Cone cone, const Mesh mesh) { return touched(cone, ball_of(mesh)); }

void complete(const Mesh mesh, const Ray ray, inout Hit hit) {
    hit.t = distance_to(mesh, ray, false, FAR, false, hit.local);
}

// The plane at t that faces the cone.
vec4 tangent_plane(const Mesh mesh, const Cone cone, float t) {
    vec3 normal = cone.ray.direction * -inversesqrt(dot3(cone.ray.direction, cone.ray.direction));
    return vec4(normal, dot3(normal, cone.ray.origin + t * cone.ray.direction));
}
#endif

#ifdef SHAPES_IN_BEAMS
// False where no ray of the polygon can meet the ball around the mesh.
bool may_meet(const Header header, const PixelFrustum frame, uint polygon, const Mesh mesh) {
    return may_meet(header, frame, polygon, ball_of(mesh));
}

// False where no way from the fragment to the light can pass that ball.
bool may_shade(const Header header, const PixelFrustum frame, vec3 near, uint polygon, const Light light, const Mesh mesh) {
    return may_shade(header, frame, near, polygon, light, ball_of(mesh));
}
#endif

#endif
