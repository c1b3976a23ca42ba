// Texture look-ups from a list: one thread per query (texture, sampler, slot, u, v), RGBA out. The same code
// that shades a hit, without a scene around it.
#include "schema/blocks.glsl"
#include "features.glsl"
#include "layout.glsl"
#include "filter/sample_texture.glsl"
#include "rng.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

struct Query {
    uvec4 link; // texture, sampler, slot, seed
    vec4 at;    // u, v, w
    vec4 dx;    // change over the footprint
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
    results[i] = sample_texture(texture_at(query.link.x), sampler_at(query.link.y), query.link.z,
                         TexCoord(query.at.xyz, query.dx.xyz, query.dy.xyz), pcg2d(uvec2(i, query.link.w)));
}
