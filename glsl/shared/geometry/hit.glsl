// The hit of a ray, the surface interaction that shading and mapping use, and shapes that move. Twin:
// src/oracle/geometry/hit.rs.
#ifndef HIT_GLSL
#define HIT_GLSL

#include "../footprint.glsl"
#include "../math.glsl"

struct Hit {
    real t; // in units of the direction's length; FAR on a miss
    uint shape;
    real2 local; // the shape's own coordinates, where it has any
};

// Without bounces all rays but shadow rays are camera rays, and those of a perspective start at the
// eye, which is the coordinate origin, where there is no lens and nothing moves.
#ifndef ORIGIN_IS_EYE
#define ORIGIN_IS_EYE (!BOUNCES && !LENS && !TIMED && PROJECTIONS == (1u << PROJECTION_PERSPECTIVE))
#endif

// The displacement of a shape at the ray's time. Shapes are intersected, and textured, where they are at time 0, by rays
// that start as far back.
real3 moved_by(const Ray ray, uint shape) {
    real3 shift = real3(0.0);
    if (MOTIONS != 0u) {
        if (COUNT(MOTIONS, lengths.motions) != 0u) shift = ray.time * motion_at(shape).shift;
    }
    return shift;
}

Ray at_rest(Ray ray, uint shape) {
    if (MOTIONS != 0u) ray.origin -= moved_by(ray, shape);
    return ray;
}

// What the vertices of a mesh have beside normals and texture coordinates, interpolated.
struct VertexAttributes {
    vec4 color;
    real2 second_uv;
    vec3 second_u; // gradients along the surface
    vec3 second_v;
    vec4 tangent;  // with the sign of the bitangent, 0 for none
    uint uv_texel; // of the second texture coordinates, for maps with coordinates of their own; 0 for none
    vec3 weights;  // of the corners, and the gradients of each
    vec3 weight_a;
    vec3 weight_b;
    vec3 weight_c;
};

const VertexAttributes NO_ATTRIBUTES = 
    VertexAttributes(vec4(1.0), real2(0.0), vec3(0.0), vec3(0.0), vec4(0.0), 0u, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

struct Surface {
    real3 point;
    real3 geometric_normal; // unit, towards the incoming ray
    real3 normal;          // unit, for shading
    real2 own_uv;          // the plane's coordinates or the vertices' interpolated uv
    vec3 own_u;            // gradients of the two along the surface
    vec3 own_v;
    mat3 shape_operator;             // change of the normal a unit of way along the surface
    float curvature;       // its mean; positive where the shape bulges towards the ray
    bool inside;           // the ray comes from behind the shape's own normal
    uvec2 link;            // material, map
    real3 at_rest;         // the point where the shape does not move
    real size;             // of the largest coordinate that the point came from
    VertexAttributes attributes;
};

const mat3 FLAT = mat3(0.0);

// The surface of what surrounds the scene.
const Surface NOWHERE = Surface(real3(0.0), real3(0.0, 0.0, 1.0), real3(0.0, 0.0, 1.0), real2(0.0), vec3(0.0), vec3(0.0), FLAT, 0.0, false,
                                uvec2(0u), real3(0.0), 0.0, NO_ATTRIBUTES);

// True if the change of normals is needed: footprints that leave a mirror, or bump maps that are mapped by directions.
const bool BY_DIRECTION = (ENTITIES & ((1u << ENTITY_NORMAL) | (1u << ENTITY_REFLECTION))) != 0u;
const bool CURVED_BUMP = BUMPED && BY_DIRECTION;
const bool NEEDS_SHAPE_OPERATOR = FILTERED || CURVED_BUMP;

real largest_part(real3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

#endif
