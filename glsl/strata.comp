#version 460
#extension GL_GOOGLE_include_directive : require
// Dumps sample positions: one thread a (pixel, sample); 24-bit integers out, as the renderer has them.
#include "shared/features.glsl"
#include "shared/layout.glsl"
#include "shared/strata.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = 0) writeonly buffer Positions { uvec2 positions[]; };
layout(push_constant) uniform Range { uint count; uint samples; uint width; } range;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    Header header = load_header();
    uint pixel = i / range.samples;
    uvec2 key = pixel_key(uvec2(pixel % range.width, pixel / range.width), header.sampling.w, header.key.x != 0u);
    uint side = COUNT(STRATA_SIDE, header.sampling.y);
    uint side_log2 = uint(findMSB(side - 1u) + 1);
    positions[i] = sample_position(header.sampling.x, key, i % range.samples, side, side_log2);
}
