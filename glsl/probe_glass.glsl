// Rays that meet glass, from a list: one thread per query, the direction behind the surface and the
// reflectance.
#include "schema/blocks.glsl"
#include "shared/features.glsl"
#include "shared/layout.glsl"
#include "shared/bsdf/dielectric.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

struct Query {
    vec4 direction; // w: ratio of refractive indices
    vec4 normal;
};

layout(std430, set = 0, binding = BINDING_OUTPUT) writeonly buffer Answers { vec4 answers[]; };
layout(std430, set = 0, binding = BINDING_LIST) readonly buffer Queries { Query queries[]; };
layout(push_constant) uniform Push { QueryRange range; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    vec4 d = queries[i].direction;
    vec3 n = queries[i].normal.xyz;
    answers[i] = vec4(refracted(d.xyz, n, d.w), fresnel_dielectric(d.xyz, n, d.w));
}
