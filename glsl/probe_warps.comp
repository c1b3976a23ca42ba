#version 460
#extension GL_GOOGLE_include_directive : require
// Warps from a list: one thread a query, where a point of the unit square comes to lie.
#include "shared/warps.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

struct Query {
    vec4 square; // z: height of the cap
};

// On the disc; on the cap.
struct Answer {
    vec4 disc;
    vec4 cap;
};

layout(std430, set = 0, binding = 0) writeonly buffer Answers { Answer answers[]; };
layout(std430, set = 0, binding = 4) readonly buffer Queries { Query queries[]; };
layout(push_constant) uniform Range { uint count; } range;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    vec4 square = queries[i].square;
    vec2 disc = concentric_disc(square.xy);
    answers[i] = Answer(vec4(disc, 0.0, 0.0), vec4(on_cap(disc, square.z), 0.0));
}
