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

#include "mesh_tests.glsl"

#ifndef SHAPES_IN_BEAMS
#include "mesh_search.glsl"

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
    Placement placement = placement_of(mesh);
    real3 a = placed_point(placement, real3(point_in(mesh_texel(at))));
    real3 b = placed_point(placement, real3(point_in(mesh_texel(at + 1u))));
    real3 c = placed_point(placement, real3(point_in(mesh_texel(at + 2u))));
    seen_corner = a;
    at = mesh.attributes + mesh.attribute_count * index;
    uvec4 plane = mesh_texel(at);
    vec4 first = uintBitsToFloat(mesh_texel(at + 1u));
    vec4 second = uintBitsToFloat(mesh_texel(at + 2u));
    uvec4 normals = mesh_texel(at + 3u);
    real3 normal = placed_normal(mesh, placement, real3(point_in(plane)));
    return Triangle(a, first.x, b, first.y, c, first.z, real3(first.w, second.x, second.y), normal, dot3(normal, a),
                    placed_normal(mesh, placement, octahedral(normals.x)), placed_normal(mesh, placement, octahedral(normals.y)),
                    placed_normal(mesh, placement, octahedral(normals.z)), mesh.material, mesh.uv_projection,
                    (plane.w & MESH_SMOOTH) != 0u);
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
        vec3 tangent = vec3(placed_vector(placement_of(mesh), real3(sum)));
        found.tangent = vec4(tangent, (signs & MESH_MIRRORED_UV) != 0u ? -1.0 : 1.0);
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
    if (MAP_UVS != 0u && mesh.has_second_uv) {
        found.uv_texel = at;
        found.weights = w;
        if (FILTERED || BUMPED) weight_gradients(triangle, found.weight_a, found.weight_b, found.weight_c);
    }
    return found;
}

Surface surface_of(const Mesh mesh, real3 point, real2 local) {
    uint index = uint(local.x);
    Triangle triangle = triangle_in(mesh, index);
    Surface surface = surface_of(triangle, point, local);
    if (VERTEX_COLORS || SECOND_UV || MAP_UVS != 0u || TANGENTS) surface.attributes = attributes_of(mesh, triangle, index, point);
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
