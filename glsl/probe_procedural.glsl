// Look-ups of procedural textures from a list: one thread per query, RGB out.
#include "schema/blocks.glsl"
#include "shared/features.glsl"
#include "shared/layout.glsl"
#include "shared/procedural.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

struct Query {
    uvec4 link; // procedural texture
    vec4 at;
    vec4 dx;
    vec4 dy;
};

layout(std430, set = 0, binding = BINDING_OUTPUT) writeonly buffer Results { vec4 results[]; };
layout(std430, set = 0, binding = BINDING_LIST) readonly buffer Queries { Query queries[]; };
layout(push_constant) uniform Push { QueryRange range; };

void main() {
    preload_records();
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    Query query = queries[i];
    results[i] = vec4(procedural_color(procedural_at(query.link.x), query.at.xyz, query.dx.xyz, query.dy.xyz), 1.0);
}
